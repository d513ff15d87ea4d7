#include "linalg/short_rows.h"

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"
#include "linalg/short_float.h"

namespace lumirank::linalg {

namespace {
constexpr std::size_t kRowStretch = 16384;
}

void ShortRows::set(std::size_t row, std::span<const float> values) {
  if (values.size() != columns_) throw InternalError("short rows: a row of the wrong length");
  const float scale = scale_for(max_abs_of(values)), inverse = 1 / scale;
  scale_[row] = scale;
  std::uint16_t* out = entries_.data() + row * columns_;
  parallel_for(columns_, kRowStretch, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) out[j] = shorten(values[j] * inverse);
  });
}

void ShortRows::permute(std::span<const std::uint32_t> order) {
  if (order.size() > columns_) throw InternalError("short rows: more columns than there are");
  // Rows only become shorter, so they can move up in their order; each waits for those before it.
  std::vector<std::uint16_t> old(columns_);
  for (std::size_t r = 0; r < rows(); ++r) {
    const std::uint16_t* from = entries_.data() + r * columns_;
    std::copy(from, from + columns_, old.begin());
    std::uint16_t* to = entries_.data() + r * order.size();
    parallel_for(order.size(), kRowStretch, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) to[k] = old[order[k]];
    });
  }
  columns_ = order.size();
  entries_.resize(rows() * columns_);
}

void ShortRows::read(std::size_t row, std::size_t begin, std::span<float> out) const {
  const std::uint16_t* from = entries_.data() + row * columns_ + begin;
  const float scale = scale_[row];
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = scale * lengthen(from[k]);
}

}  // namespace lumirank::linalg
