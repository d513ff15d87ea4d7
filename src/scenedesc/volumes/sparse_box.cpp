#include "scenedesc/volumes/sparse_box.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace lumirank::scenedesc {
namespace {

constexpr std::int64_t kLargestStride = 8;

std::string product(std::int64_t a, std::int64_t b, std::int64_t c) {
  return std::to_string(a) + " × " + std::to_string(b) + " × " + std::to_string(c);
}

std::string quoted_list(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "\"" : ", \"") + name + "\"";
  return out;
}

}  // namespace

SparseBox::SparseBox(const std::string& filename, Index lo, Index last, std::vector<float> background,
                     std::uint64_t most)
    : filename_(filename), lo_(lo), end_(last), background_(std::move(background)) {
  for (std::int64_t& end : end_) ++end;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (end_[axis] <= lo_[axis]) {
      lo_ = {0, 0, 0}, end_ = {1, 1, 1};
      break;
    }
  numbers_.channels = static_cast<int>(background_.size());
  for (;; stride_ *= 2) {
    // In floating point: the product may be beyond all integers.
    double count = numbers_.channels;
    for (std::size_t axis = 0; axis < 3; ++axis)
      count *= static_cast<double>((end_[axis] - lo_[axis] + stride_ - 1) / stride_ + 2);
    if (count <= static_cast<double>(most)) break;
    if (stride_ == kLargestStride)
      throw InputError({filename_, 0},
                       "the box around the grid has " +
                           product(end_[0] - lo_[0], end_[1] - lo_[1], end_[2] - lo_[2]) +
                           " voxels, which is too much even with 8 × 8 × 8 of them taken as one",
                       "clip or resample the grid");
  }
  std::size_t count = background_.size();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    numbers_.size[axis] = static_cast<int>((end_[axis] - lo_[axis] + stride_ - 1) / stride_ + 2);
    count *= static_cast<std::size_t>(numbers_.size[axis]);
  }
  numbers_.values.resize(count);
  for (std::size_t k = 0; k < count; ++k) numbers_.values[k] = background_[k % background_.size()];
}

bool SparseBox::meets(const Index& lo, std::int64_t edge) const {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (lo[axis] >= end_[axis] || lo[axis] + edge <= lo_[axis]) return false;
  return true;
}

void SparseBox::fill(const Index& lo, std::int64_t edge, const float* value) {
  if (!meets(lo, edge)) return;
  Index from, to, first, last;  // of voxels, and the numbers that they go into
  for (std::size_t axis = 0; axis < 3; ++axis) {
    from[axis] = std::max(lo[axis], lo_[axis]), to[axis] = std::min(lo[axis] + edge, end_[axis]);
    first[axis] = (from[axis] - lo_[axis]) / stride_, last[axis] = (to[axis] - 1 - lo_[axis]) / stride_;
  }
  // How many of the cube's voxels a number takes in along an axis.
  const auto part = [&](std::int64_t k, std::size_t axis) {
    const std::int64_t begin = lo_[axis] + k * stride_;
    return static_cast<float>(std::min(begin + stride_, to[axis]) - std::max(begin, from[axis])) /
           static_cast<float>(stride_);
  };
  const auto wide = [](std::int64_t n) { return static_cast<std::size_t>(n); };
  const std::size_t channels = background_.size();
  for (std::int64_t z = first[2]; z <= last[2]; ++z)
    for (std::int64_t y = first[1]; y <= last[1]; ++y) {
      const std::size_t row = (wide(z + 1) * wide(numbers_.size[1]) + wide(y + 1)) * wide(numbers_.size[0]);
      const float share = stride_ == 1 ? 1 : part(y, 1) * part(z, 2);
      for (std::int64_t x = first[0]; x <= last[0]; ++x) {
        float* number = numbers_.values.data() + (row + wide(x + 1)) * channels;
        for (std::size_t c = 0; c < channels; ++c) {
          if (stride_ == 1)
            number[c] = value[c];
          else
            number[c] += (value[c] - background_[c]) * share * part(x, 0);
        }
      }
    }
}

GridFile SparseBox::finish(const Transform& to_file) && {
  if (!std::all_of(numbers_.values.begin(), numbers_.values.end(), [](float v) { return std::isfinite(v); }))
    throw InputError({filename_, 0}, "the grid has numbers that are not finite", "export it again");
  if (!to_file.is_finite() || !to_file.inverse())
    throw InputError({filename_, 0}, "the transform of the grid cannot be inverted",
                     "export it with voxels of a finite size");
  GridFile out;
  const auto s = static_cast<double>(stride_);
  // The first number is the one before the box.
  Vec3d at;
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    at[axis] = static_cast<double>(lo_[k]) + (s - 1) / 2 - s;
    numbers_.hi[axis] = static_cast<float>(numbers_.size[k] - 1);
  }
  out.to_file = to_file * Transform::translate(at) * Transform::scale(s, s, s);
  if (stride_ > 1) {
    out.too_fine = "a grid of " + product(end_[0] - lo_[0], end_[1] - lo_[1], end_[2] - lo_[2]) +
                   " voxels (" + filename_ + "), more than memory is taken for";
    out.coarser = "the mean of every " + product(stride_, stride_, stride_);
  }
  out.numbers = std::move(numbers_);
  return out;
}

std::size_t choose_grid(const std::vector<std::string>& names, const std::string& wanted,
                        const std::string& filename) {
  if (names.empty()) throw InputError({filename, 0}, "there is no grid in the file", "export it again");
  const auto at = std::find(names.begin(), names.end(), wanted.empty() ? "density" : wanted);
  if (at != names.end()) return static_cast<std::size_t>(at - names.begin());
  if (wanted.empty() && names.size() == 1) return 0;
  throw InputError({filename, 0},
                   "there is no grid \"" + (wanted.empty() ? "density" : wanted) + "\" in the file",
                   "name one of those that it has: " + quoted_list(names));
}

void refuse_level_set(const std::string& filename, const std::string& grid) {
  throw InputError({filename, 0}, "\"" + grid + "\" is a level set: distances to a surface, not a density",
                   "convert it to a fog volume, or to a mesh");
}

void refuse_type(const std::string& filename, const std::string& grid, const std::string& type) {
  throw InputError({filename, 0}, "the grid \"" + grid + "\" is one of type " + type,
                   "grids of floats, half floats, doubles and of vectors of three of them can be read");
}

}  // namespace lumirank::scenedesc
