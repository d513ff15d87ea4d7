# A "room" is one folder of src/ and one static library, lumirank_<name>. It links only the rooms it may include, so an
# upward dependency does not link; cmake/check_layers.py checks the includes too.

set(LUMIRANK_WARNINGS -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Wpedantic -Wno-psabi)
# g++ 12 sees overlapping copies in std::string's operator+ that cannot happen (GCC bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  list(APPEND LUMIRANK_WARNINGS -Wno-restrict)
endif()
# g++ 12's own AVX-512 headers read a variable that they leave undefined on purpose (GCC bug 105593).
if(LUMIRANK_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  list(APPEND LUMIRANK_WARNINGS -Wno-uninitialized)
endif()
if(LUMIRANK_WERROR)
  list(APPEND LUMIRANK_WARNINGS -Werror)
endif()

# -ffp-contract=off: a sum of products is rounded the same way wherever it is inlined, so an entry has one value whether
# it is asked for in a row, a column or a block.
set(LUMIRANK_FLAGS -ffp-contract=off -fno-math-errno -fno-trapping-math)
if(LUMIRANK_MARCH)
  list(APPEND LUMIRANK_FLAGS -march=${LUMIRANK_MARCH})
endif()
if(LUMIRANK_SANITIZE)
  list(APPEND LUMIRANK_FLAGS -fsanitize=${LUMIRANK_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer -g1)
  add_link_options(-fsanitize=${LUMIRANK_SANITIZE})
endif()

# Unity builds: a room's files are compiled some at a time as one, since most of a file's time goes to the headers that all
# of them share. Names in a room's anonymous namespaces therefore differ. Switch it off to work on a single file.
# Tests and benchmarks include the rooms' headers, so they are compiled for the same instructions.
function(lumirank_inner target)
  target_compile_options(${target} PRIVATE ${LUMIRANK_FLAGS})
  set_target_properties(${target} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
endfunction()

function(lumirank_unity target files_at_once)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${LUMIRANK_UNITY} UNITY_BUILD_BATCH_SIZE ${files_at_once})
endfunction()

# lumirank_room(base LINKS TBB::tbb) or lumirank_room(methods ROOMS matrix linalg)
function(lumirank_room name)
  cmake_parse_arguments(ROOM "" "" "ROOMS;LINKS" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  add_library(lumirank_${name} STATIC ${sources})
  target_include_directories(lumirank_${name} PUBLIC ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/include)
  target_compile_options(lumirank_${name} PRIVATE ${LUMIRANK_WARNINGS} ${LUMIRANK_FLAGS})
  # What a shared library of the rooms shows is what public headers mark with LUMIRANK_API.
  set_target_properties(lumirank_${name} PROPERTIES
    POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  foreach(room IN LISTS ROOM_ROOMS)
    target_link_libraries(lumirank_${name} PUBLIC lumirank_${room})
  endforeach()
  target_link_libraries(lumirank_${name} PRIVATE ${ROOM_LINKS})
  lumirank_unity(lumirank_${name} 20)
  # What fuzz targets reach tells the fuzzer where it has been.
  if(LUMIRANK_FUZZ AND name MATCHES "^(base|image|scenedesc)$")
    target_compile_options(lumirank_${name} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
endfunction()
