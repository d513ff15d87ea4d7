// Little files of sparse grids, written by OpenVDB and NanoVDB themselves. Only sparse_files.cpp includes
// them.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/transform.h"

namespace lumirank::scenedesc::test_files {

enum class Kind { f32, half, f64, color, color64, whole, fp4, fp8, fp16, fpn };

struct Voxel {
  std::array<int, 3> at;
  float value;  // of colors: value, 2·value, 3·value
};

struct Grid {
  std::string name = "density";
  std::vector<Voxel> voxels;
  // A box of the same value all over, corners included; left out if `last` is below `first`.
  std::array<int, 3> first{0, 0, 0}, last{-1, -1, -1};
  float value = 0;
  Kind kind = Kind::f32;
  float background = 0;
  Transform to_file;
  bool level_set = false, frustum = false;
  std::string shares_with = {};  // has the tree of this grid, which comes before it
};

// `as_stream`: without places of the grids, as where a stream cannot go back.
void write_vdb(const std::string& filename, const std::vector<Grid>& grids, bool as_stream = false);
enum class Packing { none, zip };
void write_nvdb(const std::string& filename, const std::vector<Grid>& grids, Packing packing = Packing::none);

}  // namespace lumirank::scenedesc::test_files
