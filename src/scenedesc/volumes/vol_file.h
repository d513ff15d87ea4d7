// Mitsuba's grids of numbers (.vol), version 3.
#pragma once

#include <string>

#include "scenedesc/schema/media.h"

namespace lumirank::scenedesc {

// InputError, naming the file, for whatever is not such a file, has numbers that are not finite, or has more
// or fewer of them than it says. `floats`: whether it has 32-bit floats, the only numbers that Mitsuba 3
// reads.
GridData read_vol(const std::string& filename, bool* floats = nullptr);
// From memory; `filename` only names the source.
GridData parse_vol(const std::string& bytes, const std::string& filename);

// Of 32-bit floats.
std::string vol_bytes(const GridData& grid);

}  // namespace lumirank::scenedesc
