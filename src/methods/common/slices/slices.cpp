#include "methods/common/slices/slices.h"

#include <algorithm>
#include <numeric>

#include "base/bounds.h"
#include "base/error.h"
#include "base/parallel.h"

namespace lumirank::methods {

using matrix::Index;

namespace {

constexpr float kNormalWeight = 0.125f;  // of the diagonal of the box of places
constexpr std::size_t kBoxGrain = 8192;

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
  Cutter(const SlicePoints& points, Slices& slices) : points_(points), slices_(slices) {}

  void cut(std::size_t begin, std::size_t end, std::size_t first_slice, std::size_t count) {
    if (count == 1) {
      slices_.first[first_slice] = static_cast<std::uint32_t>(begin);
      std::sort(at(begin), at(end));
      return;
    }
    const std::size_t left = count / 2, middle = begin + (end - begin) * left / count;
    const std::size_t axis = longest_axis(begin, end);
    // The same order whatever the algorithm: no two rows are equal in it.
    std::nth_element(at(begin), at(middle), at(end), [&](Index a, Index b) {
      const float x = points_[a][axis], y = points_[b][axis];
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
  std::size_t longest_axis(std::size_t begin, std::size_t end) const {
    return parallel_sum(end - begin, kBoxGrain, Box{},
                        [&](std::size_t b, std::size_t e) {
                          Box box;
                          for (std::size_t k = b; k < e; ++k) box.extend(points_[slices_.rows[begin + k]]);
                          return box;
                        })
        .longest_axis();
  }

  const SlicePoints& points_;
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

Slices make_slices(const matrix::RowFeatures& features, std::size_t rows, std::size_t max_rows) {
  if (max_rows == 0) throw InternalError("make_slices: slices of no rows");
  Slices slices;
  slices.rows.resize(rows);
  std::iota(slices.rows.begin(), slices.rows.end(), Index{0});
  // Rounding makes no slice too large: if n ≤ c·max_rows, both ⌊n·a/c⌋ and ⌈n·a/c⌉ are at most a·max_rows.
  const std::size_t count = (rows + max_rows - 1) / max_rows;
  slices.first.assign(count + 1, static_cast<std::uint32_t>(rows));
  if (count > 0) Cutter(SlicePoints(features, rows), slices).cut(0, rows, 0, count);
  return slices;
}

}  // namespace lumirank::methods
