#include "linalg/reduced_tensor.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace lumirank::linalg {
namespace {

constexpr float kShortOne = 65535;           // stands for 1
constexpr std::size_t kTensorStretch = 256;  // columns at a time

}  // namespace

ReducedTensor::ReducedTensor(const Shape& shape) : shape_(shape), norms_(shape.columns * shape.frames) {
  const std::size_t entries = shape.rows * shape.columns * shape.frames;
  if (shape.precision == Precision::bits16)
    short_.resize(entries);
  else
    long_.resize(entries);
}

void ReducedTensor::set_frame(std::size_t frame, std::span<const Rgb> entries) {
  const std::size_t rows = shape_.rows, columns = shape_.columns;
  parallel_for(columns, kTensorStretch, [&](std::size_t begin, std::size_t end) {
    std::vector<float> scalar(rows);
    for (std::size_t j = begin; j < end; ++j) {
      double square[3] = {}, sum[3] = {};
      for (std::size_t i = 0; i < rows; ++i) {
        const Rgb v = entries[i * columns + j];
        for (int c = 0; c < 3; ++c) {
          const auto channel = static_cast<double>(v[c]);
          square[c] += channel * channel, sum[c] += channel;
        }
        scalar[i] = norm2(v);
      }
      Norms& n = norms_[at(j, frame)];
      for (int c = 0; c < 3; ++c)
        n.channel[c] = static_cast<float>(std::sqrt(square[c])), n.sum[c] = static_cast<float>(sum[c]);
      n.all = static_cast<float>(std::sqrt(square[0] + square[1] + square[2]));
      const float inverse = n.all > 0 ? 1 / n.all : 0.0f;
      const std::size_t to = at(j, frame) * rows;
      for (std::size_t i = 0; i < rows; ++i) {
        const float x = std::min(scalar[i] * inverse, 1.0f);
        if (shape_.precision == Precision::bits16)
          short_[to + i] = static_cast<std::uint16_t>(std::lround(x * kShortOne));
        else
          long_[to + i] = x;
      }
    }
  });
}

void ReducedTensor::information(std::size_t column, std::size_t frame, float* out) const {
  const std::size_t from = at(column, frame) * shape_.rows;
  if (shape_.precision == Precision::bits32) {
    std::copy_n(long_.data() + from, shape_.rows, out);
    return;
  }
  for (std::size_t i = 0; i < shape_.rows; ++i)
    out[i] = static_cast<float>(short_[from + i]) * (1 / kShortOne);
}

std::size_t ReducedTensor::memory_bytes() const { return static_cast<std::size_t>(memory_bytes(shape_)); }

double ReducedTensor::memory_bytes(const Shape& shape) {
  const double pairs = static_cast<double>(shape.columns) * static_cast<double>(shape.frames);
  return pairs *
         (sizeof(Norms) + static_cast<double>(shape.rows) *
                              (shape.precision == Precision::bits16 ? sizeof(std::uint16_t) : sizeof(float)));
}

}  // namespace lumirank::linalg
