# The library as others use it: one shared library of all rooms, the public headers, and what finds them.
include(CMakePackageConfigHelpers)

# Of all objects, so that everything that a public header declares is there; linked for what lies outside of the rooms.
add_library(lumirank_library SHARED)
foreach(room IN LISTS LUMIRANK_ROOMS)
  target_sources(lumirank_library PRIVATE $<TARGET_OBJECTS:lumirank_${room}>)
endforeach()
set_target_properties(lumirank_library PROPERTIES LINKER_LANGUAGE CXX)
add_library(lumirank::lumirank ALIAS lumirank_library)
target_link_libraries(lumirank_library PRIVATE lumirank_api)
target_include_directories(lumirank_library INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(lumirank_library INTERFACE cxx_std_20)
# Nothing of static libraries within is shown either.
target_link_options(lumirank_library PRIVATE -Wl,--exclude-libs,ALL -Wl,--no-undefined)
set_target_properties(lumirank_library PROPERTIES
  OUTPUT_NAME lumirank EXPORT_NAME lumirank VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}
  LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/lumirank)
install(TARGETS lumirank_library EXPORT lumirank COMPONENT library)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/lumirank TYPE INCLUDE COMPONENT library FILES_MATCHING PATTERN *.h)
install(EXPORT lumirank NAMESPACE lumirank:: DESTINATION ${package} FILE lumirank-config.cmake COMPONENT library)
write_basic_package_version_file(lumirank-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/lumirank-config-version.cmake DESTINATION ${package} COMPONENT library)
configure_file(cmake/lumirank.pc.in lumirank.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/lumirank.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT library)
install(FILES LICENSE THIRD-PARTY-NOTICES.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT library)
