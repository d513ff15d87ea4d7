// Grids of numbers from files of all kinds.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/transform.h"
#include "scenedesc/schema/media.h"

namespace lumirank::scenedesc {

struct GridFile {
  GridData numbers;
  Transform to_file = {};     // from the coordinates of the numbers' box to the file's
  bool floats = true;         // whether they are 32-bit floats in a .vol, the only ones that Mitsuba 3 reads
  std::string too_fine = {};  // what of it was too large to be kept, and
  std::string coarser = {};   // what is there instead; both "" if nothing was
};

// Numbers of the largest grid that is made of a sparse one: 1 GiB of them.
inline constexpr std::uint64_t kMostSparseNumbers = std::uint64_t{1} << 28;

// InputError, naming the file, for whatever cannot be read.
GridFile read_grid_file(const GridFileDesc& file);

// The names of the grids of a sparse file, in its order.
std::vector<std::string> grid_names(const std::string& filename);

}  // namespace lumirank::scenedesc
