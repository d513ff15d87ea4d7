#include "emitters/projected_picture.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace lumirank::emitters {
namespace {

// A part dA of the plane at distance 1 is seen under cos³θ dA.
float cube_of_cosine(Vec2f on_plane) {
  const float cosine2 = 1 / (1 + square(on_plane.x) + square(on_plane.y));
  return cosine2 * std::sqrt(cosine2);
}

}  // namespace

ProjectedPicture::ProjectedPicture(int width, int height, std::vector<Rgb> values, Vec2f half)
    : width_(width), height_(height), half_(half), values_(std::move(values)) {
  const bool good = width > 0 && height > 0 && half.x > 0 && half.y > 0 && std::isfinite(half.x) &&
                    std::isfinite(half.y) &&
                    values_.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height) &&
                    std::all_of(values_.begin(), values_.end(), [](Rgb c) {
                      return is_finite(c) && std::min({c.r, c.g, c.b}) >= 0;
                    });
  if (!good) throw InternalError("emitters::ProjectedPicture: a picture that is not one");
  const float area = 4 * half.x * half.y / (static_cast<float>(width) * static_cast<float>(height));
  std::vector<float> of_rows, weights(static_cast<std::size_t>(width));
  double sums[3] = {0, 0, 0};
  for (int y = 0; y < height; ++y) {
    double row = 0;
    for (int x = 0; x < width; ++x) {
      const Vec2f middle{half.x * (2 * (static_cast<float>(x) + 0.5f) / static_cast<float>(width) - 1),
                         half.y * (2 * (static_cast<float>(y) + 0.5f) / static_cast<float>(height) - 1)};
      const Rgb light = value(x, y) * (area * cube_of_cosine(middle));
      for (int c = 0; c < 3; ++c) sums[c] += static_cast<double>(light[c]);
      // What a neighbor shines into a dark pixel must be found as well.
      float most = 0;
      for (int v = y - 1; v <= y + 1; ++v)
        for (int u = x - 1; u <= x + 1; ++u) most = std::max(most, max_component(value(u, v)));
      weights[static_cast<std::size_t>(x)] =
          (0.75f * max_component(value(x, y)) + 0.25f * most) * area * cube_of_cosine(middle);
      row += static_cast<double>(weights[static_cast<std::size_t>(x)]);
      max_value_ = std::max(max_value_, max_component(value(x, y)));
    }
    of_rows.push_back(static_cast<float>(row));
    columns_.emplace_back(weights);
  }
  rows_ = Distribution1D(of_rows);
  total_ = {static_cast<float>(sums[0]), static_cast<float>(sums[1]), static_cast<float>(sums[2])};
}

const Rgb& ProjectedPicture::value(int x, int y) const {
  const auto column = static_cast<std::size_t>(std::clamp(x, 0, width_ - 1)),
             row = static_cast<std::size_t>(std::clamp(y, 0, height_ - 1));
  return values_[row * static_cast<std::size_t>(width_) + column];
}

bool ProjectedPicture::place_of(Vec3f local, Vec2f& place) const {
  if (!(local.z > 0)) return false;
  const Vec2f part{local.x / (local.z * half_.x), local.y / (local.z * half_.y)};
  if (!(std::abs(part.x) <= 1 && std::abs(part.y) <= 1)) return false;
  place = {0.5f * (part.x + 1) * static_cast<float>(width_),
           0.5f * (part.y + 1) * static_cast<float>(height_)};
  return true;
}

Rgb ProjectedPicture::intensity(Vec3f local) const {
  Vec2f place;
  if (!place_of(local, place)) return Rgb{};
  const float x = place.x - 0.5f, y = place.y - 0.5f;
  const float left = std::floor(x), low = std::floor(y), fx = x - left, fy = y - low;
  const int u = static_cast<int>(left), v = static_cast<int>(low);
  return (value(u, v) * (1 - fx) + value(u + 1, v) * fx) * (1 - fy) +
         (value(u, v + 1) * (1 - fx) + value(u + 1, v + 1) * fx) * fy;
}

IntensityProfile::Sample ProjectedPicture::sample(Vec2f u) const {
  if (!(rows_.total() > 0)) return {};
  const auto row = rows_.sample(u.x);
  const auto column = columns_[row.index].sample(u.y);
  const auto place = [](const Distribution1D::Sample& at, int count, float half) {
    return half * (2 * (static_cast<float>(at.index) + at.remapped) / static_cast<float>(count) - 1);
  };
  const Vec2f at{place(column, width_, half_.x), place(row, height_, half_.y)};
  const Vec3f local = normalize(Vec3f{at.x, at.y, 1});
  return {local, pdf(local)};
}

float ProjectedPicture::pdf(Vec3f local) const {
  Vec2f place;
  if (!(rows_.total() > 0) || !place_of(local, place)) return 0;
  const auto column = static_cast<std::size_t>(std::min(static_cast<int>(place.x), width_ - 1)),
             row = static_cast<std::size_t>(std::min(static_cast<int>(place.y), height_ - 1));
  if (!(columns_[row].total() > 0)) return 0;
  const float area = 4 * half_.x * half_.y / (static_cast<float>(width_) * static_cast<float>(height_));
  return rows_.pmf(row) * columns_[row].pmf(column) / (area * local.z * local.z * local.z);
}

float ProjectedPicture::max_theta() const { return std::atan(std::sqrt(square(half_.x) + square(half_.y))); }

}  // namespace lumirank::emitters
