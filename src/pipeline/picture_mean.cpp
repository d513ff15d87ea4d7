#include "pipeline/picture_mean.h"

#include <cmath>

#include "base/error.h"

namespace lumirank::pipeline {

void PictureMean::add(const image::Image& picture, double weight, film::PixelLattice pixels) {
  if (count_++ == 0) {
    for (image::Image& sum : sum_) sum = image::Image(picture.width, picture.height);
    for (auto& weights : weight_) weights.assign(picture.pixels.size(), 0);
    next_.assign(picture.pixels.size(), 0);
  }
  if (sum_[0].width != picture.width || sum_[0].height != picture.height)
    throw InternalError("pipeline::PictureMean: pictures of different sizes");
  const auto w = static_cast<float>(weight);
  for (int y = pixels.y; y < picture.height; y += pixels.side)
    for (int x = pixels.x; x < picture.width; x += pixels.side) {
      const auto p =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x);
      sum_[next_[p]].pixels[p] += w * picture.pixels[p];
      weight_[next_[p]][p] += w;
      next_[p] = 1 - next_[p];
    }
}

image::Image PictureMean::mean() const {
  image::Image mean = sum_[0];
  for (std::size_t p = 0; p < mean.pixels.size(); ++p) {
    const float weight = weight_[0][p] + weight_[1][p];
    if (weight > 0) mean.pixels[p] = (1 / weight) * (mean.pixels[p] + sum_[1].pixels[p]);
  }
  return mean;
}

image::Image PictureMean::difference() const {
  if (count_ < 2) return {};
  image::Image difference(sum_[0].width, sum_[0].height);
  for (std::size_t p = 0; p < difference.pixels.size(); ++p) {
    const float a = weight_[0][p], b = weight_[1][p];
    if (!(a > 0 && b > 0)) continue;
    // Var(A − B) = σ² (1/a + 1/b) where the mean has σ² / (a + b).
    const float scale = 2 * std::sqrt(a * b) / (a + b);
    difference.pixels[p] = (scale / a) * sum_[0].pixels[p] - (scale / b) * sum_[1].pixels[p];
  }
  return difference;
}

double PictureMean::noise() const {
  const image::Image difference = this->difference(), mean = this->mean();
  double off = 0, light = 0;
  for (std::size_t p = 0; p < difference.pixels.size(); ++p) {
    if (!(weight_[1][p] > 0)) continue;
    for (int c = 0; c < 3; ++c) {
      off += std::abs(static_cast<double>(difference.pixels[p][c]));
      light += std::abs(static_cast<double>(mean.pixels[p][c]));
    }
  }
  return light > 0 ? off / 2 / light : 0;
}

}  // namespace lumirank::pipeline
