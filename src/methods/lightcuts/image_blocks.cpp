#include "methods/lightcuts/image_blocks.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace lumirank::methods {

using matrix::Index;

namespace {

constexpr Index kNoBlock = 0xffffffffu;
constexpr int kMinGroupSide = 16, kMaxGroupSide = 32;  // pixels
constexpr int kEnoughGroups = 256;
constexpr float kCosine30 = 0.8660254f;
constexpr float kSine30 = 0.5f;

int unit_side(int width, int height) {
  int side = kMaxGroupSide;
  const auto row_groups = [&] { return ((width + side - 1) / side) * ((height + side - 1) / side); };
  while (side > kMinGroupSide && row_groups() < kEnoughGroups) side /= 2;
  return side;
}

}  // namespace

struct ImageBlocks::Placed {
  std::uint64_t key;  // row group, then block
  Index row;
};

ImageBlocks::ImageBlocks(const matrix::LightingMatrix& matrix) : row_groups_(group(matrix)) {}

RowGroups ImageBlocks::group(const matrix::LightingMatrix& matrix) {
  const auto film = matrix.row_features().pixel;
  const auto floor_of = [](float x) { return static_cast<int>(std::floor(x)); };
  int left = 0, top = 0, right = -1, bottom = -1;
  for (std::size_t i = 0; i < film.size(); ++i) {
    const int x = floor_of(film[i].x), y = floor_of(film[i].y);
    left = i == 0 ? x : std::min(left, x), top = i == 0 ? y : std::min(top, y);
    right = i == 0 ? x : std::max(right, x), bottom = i == 0 ? y : std::max(bottom, y);
  }
  width_ = right - left + 1, height_ = bottom - top + 1;
  const int side = unit_side(width_, height_);
  pixel_row_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), kNoBlock);
  std::vector<Placed> placed(film.size());
  for (std::size_t i = film.size(); i-- > 0;) {
    const int x = floor_of(film[i].x) - left, y = floor_of(film[i].y) - top;
    pixel_row_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)] =
        static_cast<Index>(i);
    const auto bits = [](int v) { return static_cast<std::uint64_t>(v); };
    placed[i] = {
        bits(y / side) << 48 | bits(x / side) << 32 | bits(y % side / kSide) << 16 | bits(x % side / kSide),
        static_cast<Index>(i)};
  }
  parallel_sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
    return a.key != b.key ? a.key < b.key : a.row < b.row;
  });
  std::vector<Index> rows;
  std::vector<std::uint32_t> first;
  rows.reserve(placed.size());
  for (std::size_t k = 0; k < placed.size(); ++k) {
    const std::uint64_t key = placed[k].key;
    const auto at = static_cast<std::uint32_t>(k);
    if (k == 0 || key >> 32 != placed[k - 1].key >> 32) {
      first.push_back(at);
      first_block_.push_back(static_cast<std::uint32_t>(first_row_.size()));
    }
    if (k == 0 || key != placed[k - 1].key) {
      first_row_.push_back(at - first.back());
      const auto part = [&](int shift) { return static_cast<int>(key >> shift & 0xffff); };
      place_.push_back({part(32) * side + part(0) * kSide, part(48) * side + part(16) * kSide});
    }
    rows.push_back(placed[k].row);
  }
  first.push_back(static_cast<std::uint32_t>(rows.size()));
  first_block_.push_back(static_cast<std::uint32_t>(first_row_.size()));
  return {std::move(rows), std::move(first)};
}

ImageBlocks::Block ImageBlocks::block(std::size_t group, std::size_t which) const {
  const auto all = row_groups_[group];
  const std::size_t b = first_block_[group] + which;
  const std::size_t end = which + 1 < blocks(group) ? first_row_[b + 1] : all.size();
  Block block{all.subspan(first_row_[b], end - first_row_[b]), {}, 0};
  for (const int dy : {0, kSide})
    for (const int dx : {0, kSide}) {
      const int x = std::min(place_[b][0] + dx, width_ - 1), y = std::min(place_[b][1] + dy, height_ - 1);
      const Index row = pixel_row_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                   static_cast<std::size_t>(x)];
      const auto known = block.corners.begin() + block.corner_count;
      if (row != kNoBlock && std::find(block.corners.begin(), known, row) == known)
        block.corners[static_cast<std::size_t>(block.corner_count++)] = row;
    }
  return block;
}

bool alike(const matrix::RowFeatures& features, Index a, Index b) {
  if (features.position.empty() || features.normal.empty()) return true;
  const Vec3f na = features.normal[a], nb = features.normal[b];
  if (dot(na, nb) < kCosine30) return false;
  const Vec3f between = features.position[b] - features.position[a];
  const float far = kSine30 * length(between);
  return std::abs(dot(between, na)) <= far && std::abs(dot(between, nb)) <= far;
}

}  // namespace lumirank::methods
