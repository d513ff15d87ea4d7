#include "methods/tensor_clustering/spread_changes.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "methods/tensor_clustering/row_mapping.h"

namespace lumirank::methods {
namespace {

using matrix::Index;

constexpr int kSquare = 8;             // pixels: changes are looked for in a row's square and those around it
constexpr float kFarthestPixels = 12;  // pixels, beyond which they count for nothing
constexpr float kOutOfPlane = 8;       // a slope of 1 in this halves their weight
constexpr float kSmallestCosine = 0.5f;  // between normals
constexpr std::size_t kSpreadAtOnce = 1024;

class ChangesAround {
 public:
  ChangesAround(const matrix::RowFeatures& features, const FoundChanges& found)
      : features_(features), found_(found) {
    for (std::size_t i = 0; i < found.rows.size(); ++i) {
      const Vec2f p = pixel(found.rows[i]);
      width_ = std::max(width_, square(p.x) + 1), height_ = std::max(height_, square(p.y) + 1);
    }
    in_square_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    for (std::size_t i = 0; i < found.rows.size(); ++i) {
      const Vec2f p = pixel(found.rows[i]);
      in_square_[index(square(p.x), square(p.y))].push_back(static_cast<std::uint32_t>(i));
    }
  }

  Rgb at(Index row) const {
    const Vec2f p = pixel(row);
    const int x0 = square(p.x), y0 = square(p.y);
    Rgb sum(0);
    float weights = 0;
    for (int y = std::max(0, y0 - 1); y <= std::min(height_ - 1, y0 + 1); ++y)
      for (int x = std::max(0, x0 - 1); x <= std::min(width_ - 1, x0 + 1); ++x)
        for (const std::uint32_t k : in_square_[index(x, y)]) {
          const float w = weight(row, found_.rows[k]);
          if (w > 0) sum += w * relit(found_.change[k], found_.rows[k], row), weights += w;
        }
    return weights > 0 ? sum / weights : Rgb(0);
  }

 private:
  // Rows without places on the film lie on a line.
  Vec2f pixel(Index row) const {
    return features_.pixel.empty() ? Vec2f{static_cast<float>(row), 0} : features_.pixel[row];
  }
  static int square(float at) { return std::max(0, static_cast<int>(at)) / kSquare; }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  float weight(Index row, Index other) const {
    const Vec2f a = pixel(row), b = pixel(other);
    const float squared = (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
    if (squared >= kFarthestPixels * kFarthestPixels) return 0;
    float w = (1 - std::sqrt(squared) / kFarthestPixels) / (squared + 0.5f);
    if (features_.normal.empty()) return w;
    const float facing = dot(features_.normal[row], features_.normal[other]);
    if (!(facing > kSmallestCosine)) return 0;
    w *= std::pow(facing, 16.0f);
    if (features_.position.empty()) return w;
    const Vec3f away = features_.position[other] - features_.position[row];
    const float distance = dot(away, away), out = dot(away, features_.normal[row]);
    return distance > 0 ? w / (1 + kOutOfPlane * kOutOfPlane * out * out / distance) : w;
  }
  Rgb relit(const Rgb& change, Index from, Index to) const {
    const auto albedo = features_.albedo;
    return albedo.empty() ? change : relight(change, albedo[from], albedo[to]);
  }

  const matrix::RowFeatures& features_;
  const FoundChanges& found_;
  int width_ = 1, height_ = 1;  // in squares
  std::vector<std::vector<std::uint32_t>> in_square_;
};

}  // namespace

std::vector<Rgb> spread_changes(const matrix::RowFeatures& features, const FoundChanges& found,
                                const std::vector<bool>& known) {
  std::vector<Rgb> spread(known.size(), Rgb(0));
  if (found.rows.empty()) return spread;
  const ChangesAround around(features, found);
  parallel_for(known.size(), kSpreadAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (!known[i]) spread[i] = around.at(static_cast<Index>(i));
  });
  return spread;
}

}  // namespace lumirank::methods
