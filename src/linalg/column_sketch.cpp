#include "linalg/column_sketch.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "linalg/blas.h"

namespace lumirank::linalg {

namespace {
constexpr std::size_t kBlock =
    2048;  // columns per GEMM: batch and points of a block stay in the second-level cache
constexpr std::size_t kBatchRows = 32;
constexpr std::size_t kBatchFloats = std::size_t{1}
                                     << 24;  // with more columns the batch gets shorter, not larger
}  // namespace

ColumnSketch::ColumnSketch(std::size_t columns, std::size_t dimension, std::uint64_t seed)
    : columns_(columns),
      dimension_(dimension),
      batch_rows_(std::clamp<std::size_t>(kBatchFloats / std::max<std::size_t>(columns, 1), 4, kBatchRows)),
      projected_(dimension > 0),
      seed_(seed),
      points_(columns * dimension, 0.0f),
      squares_(columns * 4, 0.0f),
      batch_(columns * batch_rows_) {}

void ColumnSketch::add_row(std::uint64_t id, float weight, std::span<const float> values) {
  if (values.size() != columns_ * kChannels) throw InternalError("sketch: a row of the wrong length");
  float* row = batch_.data() + batch_ids_.size() * columns_;
  parallel_for(columns_, 8192, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      float sum = 0;
      for (std::size_t c = 0; c < kChannels; ++c) {
        const float v = weight * values[j * kChannels + c];
        squares_[j * 4 + 1 + c] += v * v;
        sum += v * v;
      }
      squares_[j * 4] += sum;
      row[j] = std::sqrt(sum);
    }
  });
  batch_ids_.push_back(id);
  ++rows_;
  if (batch_ids_.size() == batch_rows_) flush();
}

void ColumnSketch::flush() {
  const std::size_t batch = batch_ids_.size();
  if (batch == 0) return;
  if (!projected_) {
    const std::size_t grown = dimension_ + batch;
    std::vector<float> next(columns_ * grown);
    parallel_for(columns_, kBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t j = begin; j < end; ++j) {
        std::copy_n(points_.data() + j * dimension_, dimension_, next.data() + j * grown);
        for (std::size_t b = 0; b < batch; ++b) next[j * grown + dimension_ + b] = batch_[b * columns_ + j];
      }
    });
    points_ = std::move(next);
    dimension_ = grown;
  } else {
    std::vector<float> gaussian(batch * dimension_);
    const double scale = 1.0 / std::sqrt(static_cast<double>(dimension_));
    for (std::size_t b = 0; b < batch; ++b) {
      Rng rng(seed_, Stage::projection, batch_ids_[b]);
      for (std::size_t d = 0; d < dimension_; ++d)
        gaussian[b * dimension_ + d] = static_cast<float>(scale * rng.next_gaussian());
    }
    parallel_for(columns_, kBlock, [&](std::size_t begin, std::size_t end) {
      gemm({end - begin, dimension_, batch, true, false, 1.0f}, batch_.data() + begin, columns_,
           gaussian.data(), dimension_, points_.data() + begin * dimension_, dimension_);
    });
  }
  batch_ids_.clear();
}

Points ColumnSketch::points() {
  flush();
  return {points_.data(), columns_, dimension_};
}

float ColumnSketch::norm(std::size_t j) const { return std::sqrt(squares_[j * 4]); }
float ColumnSketch::channel_norm(std::size_t j, std::size_t channel) const {
  return std::sqrt(squares_[j * 4 + 1 + channel]);
}

}  // namespace lumirank::linalg
