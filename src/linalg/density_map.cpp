#include "linalg/density_map.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace lumirank::linalg {

namespace {

constexpr std::size_t kReach = DensityMap::kReach;

std::array<float, 2 * kReach + 1> weights() {
  std::array<float, 2 * kReach + 1> w{};
  for (std::size_t k = 0; k < w.size(); ++k) {
    const float x = (static_cast<float>(k) - static_cast<float>(kReach)) / 1.4f;
    w[k] = std::exp(-0.5f * x * x);
  }
  return w;
}

// What of the weights falls inside, at place i of n.
float inside(const std::array<float, 2 * kReach + 1>& w, std::size_t i, std::size_t n) {
  float sum = 0;
  for (std::size_t k = 0; k < w.size(); ++k)
    if (i + k >= kReach && i + k < n + kReach) sum += w[k];
  return sum;
}

}  // namespace

void DensityMap::build(std::span<const std::uint8_t> flags, std::size_t rows, std::size_t columns) {
  if (flags.size() != rows * columns) throw InternalError("density map: wrong number of entries");
  static const auto w = weights();
  along_.resize(flags.size());
  density_.resize(flags.size());
  line_.assign(rows + 2 * kReach, 0.0f);
  for (std::size_t j = 0; j < columns; ++j) {
    const std::uint8_t* const in = &flags[j * rows];
    float* const out = &along_[j * rows];
    for (std::size_t i = 0; i < rows; ++i) line_[i + kReach] = in[i] ? 1.0f : 0.0f;
    for (std::size_t i = 0; i < rows; ++i) {
      float sum = 0;
      for (std::size_t k = 0; k < 2 * kReach + 1; ++k) sum += w[k] * line_[i + k];
      out[i] = sum;
    }
  }
  // The same across columns, and the borders' weights.
  for (std::size_t i = 0; i < rows; ++i) line_[i] = 1 / inside(w, i, rows);
  for (std::size_t j = 0; j < columns; ++j) {
    float* const out = &density_[j * rows];
    std::fill_n(out, rows, 0.0f);
    const std::size_t begin = j < kReach ? 0 : j - kReach, end = std::min(columns, j + kReach + 1);
    const float scale = 1 / inside(w, j, columns);
    for (std::size_t other = begin; other < end; ++other) {
      const float* const in = &along_[other * rows];
      const float weight = scale * w[other + kReach - j];
      for (std::size_t i = 0; i < rows; ++i) out[i] += weight * in[i];
    }
    for (std::size_t i = 0; i < rows; ++i) out[i] *= line_[i];
  }
}

}  // namespace lumirank::linalg
