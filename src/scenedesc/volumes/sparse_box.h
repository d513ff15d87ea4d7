// The numbers of a sparse grid within its box, laid out densely.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scenedesc/volumes/grid_file.h"

namespace lumirank::scenedesc {

// Around the box lies one more number on all sides: from there on there is nothing but the background, so
// that numbers interpolated between corners are those that sparse grids have everywhere.
class SparseBox {
 public:
  using Index = std::array<std::int64_t, 3>;

  // The voxels from `lo` to `last`; an empty box counts as one voxel. Of boxes with more than `most` numbers
  // 2, 4 or 8 voxels along each axis become one, which is their mean. InputError if that is not enough.
  SparseBox(const std::string& filename, Index lo, Index last, std::vector<float> background,
            std::uint64_t most);

  // Whether a cube of voxels from `lo` on reaches into the box.
  bool meets(const Index& lo, std::int64_t edge) const;
  // The cube has this value all over, one number for each channel. No voxel is filled twice.
  void fill(const Index& lo, std::int64_t edge, const float* value);

  int channels() const { return numbers_.channels; }
  const std::vector<float>& background() const { return background_; }
  // `to_file`: of indices of voxels. InputError if a number is not finite.
  GridFile finish(const Transform& to_file) &&;

 private:
  std::string filename_;
  Index lo_, end_;
  std::int64_t stride_ = 1;
  std::vector<float> background_;
  GridData numbers_;
};

// Which of these grids is meant by GridFileDesc::grid; InputError if none is.
std::size_t choose_grid(const std::vector<std::string>& names, const std::string& wanted,
                        const std::string& filename);

// What files of sparse grids are refused for, whatever their format.
[[noreturn]] void refuse_level_set(const std::string& filename, const std::string& grid);
[[noreturn]] void refuse_type(const std::string& filename, const std::string& grid, const std::string& type);

}  // namespace lumirank::scenedesc
