#include "linalg/column_sketch.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "linalg/blas.h"
#include "linalg/short_float.h"

namespace lumirank::linalg {

namespace {
// Columns per GEMM and per scale of the batch: batch and points of a block stay in the second-level cache.
constexpr std::size_t kSketchBlock = 2048;
constexpr std::size_t kBatchRows = 32;
// With more columns the batch gets shorter, not larger.
constexpr std::size_t kBatchEntries = std::size_t{1} << 26;

std::size_t blocks(std::size_t columns) { return (columns + kSketchBlock - 1) / kSketchBlock; }
}  // namespace

ColumnSketch::ColumnSketch(const Shape& shape, std::uint64_t seed)
    : columns_(shape.columns),
      dimension_(shape.dimension),
      batch_rows_(std::clamp<std::size_t>(kBatchEntries / std::max<std::size_t>(columns_, 1), 4, kBatchRows)),
      projected_(shape.projected),
      seed_(seed),
      units_(columns_ * dimension_, std::int16_t{0}),
      unit_(columns_, 0.0f),
      squares_(columns_ * kChannels, 0.0f),
      batch_scale_(blocks(columns_) * batch_rows_) {
  if (projected_ && dimension_ == 0) throw InternalError("sketch: a projection to no dimension");
}

double ColumnSketch::add_row(std::uint64_t id, float weight, std::span<const float> values) {
  if (values.size() != columns_ * kChannels) throw InternalError("sketch: a row of the wrong length");
  const std::size_t b = batch_ids_.size();
  if (batch_.empty()) batch_.resize(columns_ * batch_rows_);
  const double total = parallel_sum(columns_, kSketchBlock, 0.0, [&](std::size_t begin, std::size_t end) {
    float scalar[kSketchBlock];
    double some = 0;
    for (std::size_t j = begin; j < end; ++j) {
      float sum = 0;
      for (std::size_t c = 0; c < kChannels; ++c) {
        const float v = weight * values[j * kChannels + c];
        squares_[j * kChannels + c] += v * v;
        sum += v * v;
      }
      scalar[j - begin] = std::sqrt(sum);
      some += static_cast<double>(scalar[j - begin]);
    }
    const float scale = scale_for(max_abs_of({scalar, end - begin})), inverse = 1 / scale;
    batch_scale_[b * blocks(columns_) + begin / kSketchBlock] = scale;
    std::uint16_t* out = batch_.data() + b * columns_ + begin;
    for (std::size_t k = 0; k < end - begin; ++k) out[k] = shorten(scalar[k] * inverse);
    return some;
  });
  batch_ids_.push_back(id);
  ++rows_;
  if (batch_ids_.size() == batch_rows_) flush();
  return total;
}

void ColumnSketch::read_batch(std::size_t b, std::size_t begin, std::size_t end, float* out) const {
  const float scale = batch_scale_[b * blocks(columns_) + begin / kSketchBlock];
  const std::uint16_t* from = batch_.data() + b * columns_ + begin;
  for (std::size_t k = 0; k < end - begin; ++k) out[k] = scale * lengthen(from[k]);
}

void ColumnSketch::make_room(std::size_t rows) {
  if (rows <= dimension_) return;
  const std::size_t grown = std::max(rows, 2 * dimension_);
  std::vector<std::int16_t> next(columns_ * grown, std::int16_t{0});
  parallel_for(columns_, kSketchBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j)
      std::copy_n(units_.data() + j * dimension_, dimension_, next.data() + j * grown);
  });
  units_ = std::move(next);
  dimension_ = grown;
}

void ColumnSketch::add_rows_as_dimensions(std::size_t begin, std::size_t end) {
  const std::size_t size = end - begin, batch = batch_ids_.size(), first = rows_ - batch;
  std::vector<float> rows(batch * size), point(dimension_);
  for (std::size_t b = 0; b < batch; ++b) read_batch(b, begin, end, rows.data() + b * size);
  const PointReader before(Points{nullptr, columns_, dimension_, units_.data(), unit_.data()});
  for (std::size_t j = begin; j < end; ++j) {
    before.read(j, point.data());
    for (std::size_t b = 0; b < batch; ++b) point[first + b] = rows[b * size + j - begin];
    unit_[j] = pack_point(point, units_.data() + j * dimension_);
  }
}

void ColumnSketch::project(std::span<const float> gaussian, std::size_t begin, std::size_t end) {
  const std::size_t size = end - begin, batch = batch_ids_.size();
  std::vector<float> rows(batch * size), block(size * dimension_);
  for (std::size_t b = 0; b < batch; ++b) read_batch(b, begin, end, rows.data() + b * size);
  const PointReader before(Points{nullptr, columns_, dimension_, units_.data(), unit_.data()});
  for (std::size_t j = begin; j < end; ++j) before.read(j, block.data() + (j - begin) * dimension_);
  gemm({size, dimension_, batch, true, false, 1.0f}, rows.data(), size, gaussian.data(), dimension_,
       block.data(), dimension_);
  for (std::size_t j = begin; j < end; ++j)
    unit_[j] =
        pack_point({block.data() + (j - begin) * dimension_, dimension_}, units_.data() + j * dimension_);
}

void ColumnSketch::flush() {
  const std::size_t batch = batch_ids_.size();
  if (batch == 0) return;
  if (!projected_) {
    make_room(rows_);
    parallel_for(columns_, kSketchBlock,
                 [&](std::size_t begin, std::size_t end) { add_rows_as_dimensions(begin, end); });
  } else {
    std::vector<float> gaussian(batch * dimension_);
    const double scale = 1.0 / std::sqrt(static_cast<double>(dimension_));
    for (std::size_t b = 0; b < batch; ++b) {
      Rng rng(seed_, Stage::projection, batch_ids_[b]);
      for (std::size_t d = 0; d < dimension_; ++d)
        gaussian[b * dimension_ + d] = static_cast<float>(scale * rng.next_gaussian());
    }
    parallel_for(columns_, kSketchBlock,
                 [&](std::size_t begin, std::size_t end) { project(gaussian, begin, end); });
  }
  batch_ids_.clear();
}

Points ColumnSketch::points() {
  flush();
  batch_ = std::vector<std::uint16_t>();  // clustering needs its room
  return {nullptr, columns_, dimension_, units_.data(), unit_.data()};
}

float ColumnSketch::norm(std::size_t j) const { return std::sqrt(square(j)); }
float ColumnSketch::channel_norm(std::size_t j, std::size_t channel) const {
  return std::sqrt(squares_[j * kChannels + channel]);
}

std::size_t ColumnSketch::memory_bytes() const {
  return units_.size() * sizeof(std::int16_t) + batch_.size() * sizeof(std::uint16_t) +
         (unit_.size() + squares_.size() + batch_scale_.size()) * sizeof(float);
}

}  // namespace lumirank::linalg
