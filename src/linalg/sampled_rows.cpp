#include "linalg/sampled_rows.h"

#include "base/error.h"
#include "base/parallel.h"
#include "linalg/short_float.h"

namespace lumirank::linalg {

void SampledRows::add(std::span<const float> row) {
  if (row.size() != columns_) throw InternalError("sampled rows: a row of the wrong length");
  const std::size_t place = rows_ % kBlockRows;
  if (place == 0)
    blocks_.push_back({std::vector<std::uint16_t>(columns_ * kBlockRows, std::uint16_t{0}),
                       std::vector<float>((columns_ + kStretch - 1) / kStretch * kBlockRows, 0.0f)});
  Block& block = blocks_.back();
  parallel_for(columns_, kStretch, [&](std::size_t begin, std::size_t end) {
    const float scale = scale_for(max_abs_of(row.subspan(begin, end - begin))), inverse = 1 / scale;
    block.scale[begin / kStretch * kBlockRows + place] = scale;
    for (std::size_t j = begin; j < end; ++j)
      block.entries[j * kBlockRows + place] = shorten(row[j] * inverse);
  });
  ++rows_;
}

void SampledRows::read(std::size_t block, std::size_t j, float* out) const {
  const std::uint16_t* from = blocks_[block].entries.data() + j * kBlockRows;
  const float* scale = blocks_[block].scale.data() + j / kStretch * kBlockRows;
  for (std::size_t k = 0; k < kBlockRows; ++k) out[k] = scale[k] * lengthen(from[k]);
}

std::size_t SampledRows::memory_bytes() const {
  std::size_t bytes = 0;
  for (const Block& b : blocks_)
    bytes += b.entries.size() * sizeof(std::uint16_t) + b.scale.size() * sizeof(float);
  return bytes;
}

}  // namespace lumirank::linalg
