#include "pipeline/picture_mean.h"

#include <cmath>

#include "base/error.h"

namespace lumirank::pipeline {

void PictureMean::add(const image::Image& picture, double weight) {
  const std::size_t half = count() % 2;
  image::Image& sum = sum_[half];
  weight_[half] += weight;
  if (count_[half]++ == 0) sum = image::Image(picture.width, picture.height);
  if (sum.width != picture.width || sum.height != picture.height)
    throw InternalError("pipeline::PictureMean: pictures of different sizes");
  for (std::size_t p = 0; p < sum.pixels.size(); ++p)
    sum.pixels[p] += picture.pixels[p] * static_cast<float>(weight);
}

image::Image PictureMean::mean() const {
  if (count() == 0) return {};
  image::Image mean = sum_[0];
  const auto part = static_cast<float>(1 / (weight_[0] + weight_[1]));
  for (std::size_t p = 0; p < mean.pixels.size(); ++p) {
    if (count_[1] > 0) mean.pixels[p] += sum_[1].pixels[p];
    mean.pixels[p] = part * mean.pixels[p];
  }
  return mean;
}

image::Image PictureMean::difference() const {
  if (count_[1] == 0) return {};
  const double a = weight_[0], b = weight_[1];
  // Var(A − B) = σ² (1/a + 1/b) where the mean has σ² / (a + b).
  const double scale = 2 * std::sqrt(a * b) / (a + b);
  const auto of_a = static_cast<float>(scale / a), of_b = static_cast<float>(scale / b);
  image::Image difference = sum_[0];
  for (std::size_t p = 0; p < difference.pixels.size(); ++p)
    difference.pixels[p] = of_a * difference.pixels[p] - of_b * sum_[1].pixels[p];
  return difference;
}

double PictureMean::noise() const {
  const image::Image difference = this->difference(), mean = this->mean();
  double off = 0, light = 0;
  for (std::size_t p = 0; p < difference.pixels.size(); ++p)
    for (int c = 0; c < 3; ++c) {
      off += std::abs(static_cast<double>(difference.pixels[p][c]));
      light += std::abs(static_cast<double>(mean.pixels[p][c]));
    }
  return light > 0 ? off / 2 / light : 0;
}

}  // namespace lumirank::pipeline
