#include "methods/common/row_sampler.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "base/hilbert.h"
#include "base/random.h"

namespace lumirank::methods {

namespace {

constexpr unsigned kCurveBits = 8;  // of the curve, per side of the image
constexpr std::uint32_t kCurveSide = 1u << kCurveBits;

std::vector<matrix::Index> order_along_curve(std::size_t rows, std::span<const Vec2f> pixel) {
  std::vector<matrix::Index> order(rows);
  std::iota(order.begin(), order.end(), 0u);
  if (pixel.size() != rows || rows == 0) return order;
  Vec2f low = pixel[0], high = pixel[0];
  for (Vec2f p : pixel) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const float extent = std::max({high.x - low.x, high.y - low.y, 1e-6f});
  const float scale = static_cast<float>(kCurveSide) * 0.9999f / extent;
  std::vector<std::uint32_t> cell(rows), start(kCurveSide * kCurveSide + 1, 0);
  for (std::size_t i = 0; i < rows; ++i) {
    cell[i] = hilbert_place(static_cast<std::uint32_t>((pixel[i].x - low.x) * scale),
                            static_cast<std::uint32_t>((pixel[i].y - low.y) * scale), kCurveBits);
    ++start[cell[i] + 1];
  }
  for (std::size_t k = 1; k < start.size(); ++k) start[k] += start[k - 1];
  for (std::size_t i = 0; i < rows; ++i) order[start[cell[i]]++] = static_cast<matrix::Index>(i);
  return order;
}

// The t-th point of the van der Corput sequence with every bit flipped by a coin that depends on the bits
// above it.
std::uint32_t scrambled_radical_inverse(std::uint32_t t, std::uint64_t seed) {
  std::uint32_t value = 0, prefix = 1;  // the leading 1 makes prefixes of different lengths differ
  for (int bit = 0; bit < 32; ++bit) {
    const auto coin = static_cast<std::uint32_t>(hash_ids(seed, Stage::rows, 1, prefix) >> 63);
    const std::uint32_t digit = (t >> bit) & 1u;
    value = (value << 1) | (digit ^ coin);
    prefix = bit < 31 ? (prefix << 1) | digit : prefix;
  }
  return value;
}

}  // namespace

RowSampler::RowSampler(const matrix::LightingMatrix& matrix, std::uint64_t seed)
    : seed_(seed),
      order_(order_along_curve(matrix.rows(), matrix.row_features().pixel)),
      given_(matrix.rows(), false) {}

std::vector<SampledRow> RowSampler::stratified(std::size_t count, std::uint64_t round) const {
  const std::size_t rows = order_.size();
  count = std::min(count, rows);
  std::vector<SampledRow> sampled(count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t begin = rows * k / count, end = rows * (k + 1) / count;
    Rng rng(seed_, Stage::rows, 2 + round, k);
    const double share =
        static_cast<double>(end - begin) * static_cast<double>(count) / static_cast<double>(rows);
    sampled[k] = {order_[begin + rng.next_below(end - begin)], static_cast<float>(std::sqrt(share))};
  }
  return sampled;
}

std::vector<SampledRow> RowSampler::next(std::size_t count) {
  std::vector<SampledRow> sampled;
  const std::size_t rows = order_.size();
  while (sampled.size() < count && given_count_ < rows) {
    const std::uint64_t u = scrambled_radical_inverse(sequence_++, seed_);
    std::size_t at = static_cast<std::size_t>((u * rows) >> 32);
    // Once rows run short the sequence meets given ones: the next free one along the curve takes their place.
    while (given_[at]) at = at + 1 < rows ? at + 1 : 0;
    given_[at] = true;
    ++given_count_;
    sampled.push_back({order_[at], 1.0f});
  }
  return sampled;
}

std::vector<SampledRow> RowSampler::next_by_density(std::size_t count, std::span<const float> density) {
  const std::size_t rows = order_.size(), blocks = std::min<std::size_t>(rows, 1024);
  if (count == 0 || rows == 0) return {};
  const auto block_begin = [&](std::size_t b) { return rows * b / blocks; };
  std::vector<double> mass(blocks, 0.0), cdf(blocks + 1, 0.0);
  double total = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    for (std::size_t k = block_begin(b); k < block_begin(b + 1); ++k)
      mass[b] += static_cast<double>(density[order_[k]]);
    total += mass[b];
  }
  for (std::size_t b = 0; b < blocks; ++b) {
    const double uniform =
        static_cast<double>(block_begin(b + 1) - block_begin(b)) / static_cast<double>(rows);
    cdf[b + 1] = cdf[b] + (total > 0 ? 0.5 * uniform + 0.5 * mass[b] / total : uniform);
  }
  std::vector<SampledRow> sampled;
  Rng rng(seed_, Stage::rows, 1, sequence_);
  for (std::size_t k = 0; k < count && given_count_ < rows; ++k) {
    const double u = (static_cast<double>(k) + rng.next_double()) / static_cast<double>(count) * cdf.back();
    const auto it = std::upper_bound(cdf.begin() + 1, cdf.end() - 1, u);
    const auto b = static_cast<std::size_t>(it - cdf.begin()) - 1;
    const std::size_t begin = block_begin(b), size = block_begin(b + 1) - begin;
    const double probability = (cdf[b + 1] - cdf[b]) / cdf.back() / static_cast<double>(size);
    const std::size_t at = begin + rng.next_below(size);
    if (given_[at]) continue;  // known already
    given_[at] = true;
    ++given_count_;
    sampled.push_back(
        {order_[at], static_cast<float>(1.0 / std::sqrt(static_cast<double>(rows) * probability))});
  }
  ++sequence_;
  return sampled;
}

}  // namespace lumirank::methods
