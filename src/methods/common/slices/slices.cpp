#include "methods/common/slices/slices.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/bounds.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"

namespace lumirank::methods {

using matrix::Index;

namespace {

constexpr float kNormalWeight = 0.125f;  // of the diagonal of the box of places
constexpr std::size_t kBoxGrain = 8192;

// The same for all rows of a pixel.
std::uint64_t pixel_number(std::span<const Vec2f> pixels, Index i) {
  if (pixels.empty()) return i;
  const auto x = static_cast<std::int32_t>(std::floor(pixels[i].x)),
             y = static_cast<std::int32_t>(std::floor(pixels[i].y));
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(y)) << 32) | static_cast<std::uint32_t>(x);
}

struct Box {
  SlicePoints::Point low, high;
  Box() { low.fill(kInfinity), high.fill(-kInfinity); }
  void extend(const SlicePoints::Point& p) {
    for (std::size_t d = 0; d < p.size(); ++d)
      low[d] = std::min(low[d], p[d]), high[d] = std::max(high[d], p[d]);
  }
  Box operator+(const Box& o) const {
    Box b = *this;
    b.extend(o.low), b.extend(o.high);
    return b;
  }
  std::size_t longest_axis() const {
    std::size_t axis = 0;
    for (std::size_t d = 1; d < low.size(); ++d)
      if (high[d] - low[d] > high[axis] - low[axis]) axis = d;
    return axis;
  }
};

// Cuts rows[begin, end) into slices; first[s] of each is written where it belongs, since their number is
// known beforehand.
class Cutter {
 public:
  Cutter(const SlicePoints& points, const matrix::RowFeatures& features, SliceOverlap overlap, Slices& slices)
      : points_(points), pixels_(features.pixel), overlap_(overlap), slices_(slices) {}

  void cut(std::size_t begin, std::size_t end, std::size_t first_slice, std::size_t count) {
    if (count == 1) {
      slices_.first[first_slice] = static_cast<std::uint32_t>(begin);
      std::sort(at(begin), at(end));
      return;
    }
    const std::size_t left = count / 2, middle = begin + (end - begin) * left / count;
    const Box box = box_of(begin, end);
    const std::size_t axis = box.longest_axis();
    // Rows lie on surfaces: a slice's side is to the cell's as the root of their numbers.
    const float reach =
        overlap_.share * (box.high[axis] - box.low[axis]) / std::sqrt(static_cast<float>(count));
    // The same order whatever the algorithm: no two rows are equal in it.
    std::nth_element(at(begin), at(middle), at(end), [&](Index a, Index b) {
      const float x = moved(a, axis, reach), y = moved(b, axis, reach);
      return x != y ? x < y : a < b;
    });
    parallel_for(2, 1, [&](std::size_t half, std::size_t) {
      if (half == 0)
        cut(begin, middle, first_slice, left);
      else
        cut(middle, end, first_slice + left, count - left);
    });
  }

 private:
  std::vector<Index>::iterator at(std::size_t k) {
    return slices_.rows.begin() + static_cast<std::ptrdiff_t>(k);
  }
  float moved(Index i, std::size_t axis, float reach) const {
    const float x = points_[i][axis];
    if (!(reach > 0) || !points_.known()) return x;
    const std::uint64_t pixel = pixel_number(pixels_, i);
    const double u = unit_double(hash_ids(overlap_.seed, Stage::method, pixel, axis));
    return x + reach * static_cast<float>(2 * u - 1);
  }
  Box box_of(std::size_t begin, std::size_t end) const {
    return parallel_sum(end - begin, kBoxGrain, Box{}, [&](std::size_t b, std::size_t e) {
      Box box;
      for (std::size_t k = b; k < e; ++k) box.extend(points_[slices_.rows[begin + k]]);
      return box;
    });
  }

  const SlicePoints& points_;
  std::span<const Vec2f> pixels_;
  SliceOverlap overlap_;
  Slices& slices_;
};

}  // namespace

SlicePoints::SlicePoints(const matrix::RowFeatures& features, std::size_t rows)
    : features_(features),
      known_(rows > 0 && features.position.size() == rows && features.normal.size() == rows) {
  if (!known_) return;
  Bounds3f box;
  for (const Vec3f& p : features.position) box.extend(p);
  normal_weight_ = kNormalWeight * length(box.diagonal());
}

SlicePoints::Point SlicePoints::operator[](Index i) const {
  if (!known_) return {static_cast<float>(i), 0, 0, 0, 0, 0};
  const Vec3f p = features_.position[i], n = features_.normal[i] * normal_weight_;
  return {p.x, p.y, p.z, n.x, n.y, n.z};
}

void PixelDeal::deal(const matrix::RowFeatures& features, std::span<const Index> slice, std::size_t parts,
                     std::uint64_t key) {
  parts_.resize(parts);
  for (auto& part : parts_) part.clear();
  std::size_t pixel = 0;
  std::uint64_t turn = 0;
  for (std::size_t k = 0; k < slice.size(); ++k) {
    if (k > 0 && pixel_number(features.pixel, slice[k]) != pixel_number(features.pixel, slice[k - 1]))
      ++pixel;
    if (pixel % parts == 0) turn = hash_ids(key, Stage::method, pixel);
    parts_[(pixel + turn) % parts].push_back(slice[k]);
  }
}

Slices make_slices(const matrix::RowFeatures& features, std::size_t rows, std::size_t max_rows,
                   SliceOverlap overlap) {
  if (max_rows == 0) throw InternalError("make_slices: slices of no rows");
  Slices slices;
  slices.rows.resize(rows);
  std::iota(slices.rows.begin(), slices.rows.end(), Index{0});
  // Rounding makes no slice too large: if n ≤ c·max_rows, both ⌊n·a/c⌋ and ⌈n·a/c⌉ are at most a·max_rows.
  const std::size_t count = (rows + max_rows - 1) / max_rows;
  slices.first.assign(count + 1, static_cast<std::uint32_t>(rows));
  if (count > 0) Cutter(SlicePoints(features, rows), features, overlap, slices).cut(0, rows, 0, count);
  return slices;
}

}  // namespace lumirank::methods
