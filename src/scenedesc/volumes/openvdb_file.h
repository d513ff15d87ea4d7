// Sparse grids of OpenVDB (.vdb). The one file that knows the library is openvdb_file.cpp.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenedesc/volumes/grid_file.h"

namespace lumirank::scenedesc {

bool looks_like_openvdb(std::string_view first_bytes);
// `grid` as in GridFileDesc.
GridFile read_openvdb(const std::string& filename, const std::string& grid,
                      std::uint64_t most = kMostSparseNumbers);
std::vector<std::string> openvdb_grid_names(const std::string& filename);

}  // namespace lumirank::scenedesc
