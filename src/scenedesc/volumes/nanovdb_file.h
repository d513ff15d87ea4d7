// Sparse grids of NanoVDB (.nvdb), version 32: not compressed, or by zlib.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenedesc/volumes/grid_file.h"

namespace lumirank::scenedesc {

bool looks_like_nanovdb(std::string_view first_bytes);
// `grid` as in GridFileDesc; `filename` only names the source.
GridFile parse_nanovdb(std::string_view bytes, const std::string& filename, const std::string& grid,
                       std::uint64_t most = kMostSparseNumbers);
std::vector<std::string> nanovdb_grid_names(std::string_view bytes, const std::string& filename);

}  // namespace lumirank::scenedesc
