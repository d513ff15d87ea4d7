#include "methods/slice_cuts/slice_entries.h"

#include <algorithm>

#include "base/random.h"

namespace lumirank::methods {

using matrix::Index;
using matrix::Part;

namespace {
// Of the channels, when the scale times an entry is averaged and divided by the mean of the scale.
Rgb weights(Rgb scale) {
  const float sum = scale.r + scale.g + scale.b;
  return sum > 0 ? scale * (1 / sum) : Rgb(1.0f / 3.0f);
}
}  // namespace

void SliceEntries::start(std::span<const Index> slice, std::uint64_t key) {
  rows_.build(features_, slice);
  patterns_.build(rows_.curves(), mix64(key));
  reader_->set_rows(rows_.receivers());
  key_ = key;
  sampled_ = 0;
  slots_.clear();
  requests_.clear();
  first_layer_.resize(rows_.size());
  row_of_.resize(rows_.receivers().size());
  std::uint32_t max_count = 1;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const std::uint32_t count = receivers_of(r);
    first_layer_[r] = static_cast<std::uint8_t>(mix64(key ^ mix64(r)) >> 56);
    max_count = std::max(max_count, count);
    for (std::uint32_t k = rows_.begin(r); k < rows_.end(r); ++k) row_of_[k] = static_cast<std::uint32_t>(r);
  }
  layer_count_ = std::min<std::size_t>(max_count, kLayers);
  while (layers_.size() < layer_count_) layers_.push_back(matrix_.reader());
  layer_receivers_.resize(rows_.size());
  for (std::size_t l = 0; l < layer_count_; ++l) {
    for (std::size_t r = 0; r < rows_.size(); ++r) layer_receivers_[r] = rows_.receivers()[receiver(r, l)];
    layers_[l]->set_rows(layer_receivers_);
  }
}

std::size_t SliceEntries::add(const matrix::ScaledColumn& column) {
  const std::size_t s = slots_.size(), rows = rows_.size();
  if (seen_.size() < (s + 1) * rows) {
    const std::size_t room = std::max(2 * s, s + 16) * rows;
    seen_.resize(room);
    scalars_.resize(room);
  }
  slots_.push_back({column.column,
                    static_cast<std::uint32_t>(bits(column.column) % SamplePatterns::kPatterns), 0, 0,
                    layer(column.column), false});
  std::ranges::fill(seen(s), seen::kUnknown);
  Slot& slot = slots_[s];
  const auto out = std::span(scalars_).subspan(s * rows, rows);
  layers_[slot.layer]->unoccluded_scalars(column.column, weights(column.scale), out);
  for (const float e : out) slot.max_scalar = std::max(slot.max_scalar, e);
  return s;
}

void SliceEntries::sample_all(std::size_t s) {
  Slot& slot = slots_[s];
  answers_.resize(rows_.size());
  layers_[slot.layer]->column(slot.column, answers_, Part::visibility);
  const auto reach = scalars(s);
  const auto known = seen(s);
  for (std::size_t i = 0; i < answers_.size(); ++i) {
    if (!(reach[i] > 0)) continue;
    const bool visible = answers_[i].r > 0.5f;
    known[i] = visible ? seen::kVisible : seen::kHidden;
    slot.any_visible |= visible;
    ++sampled_;
  }
  slot.sampled = static_cast<std::uint32_t>(rows_.size());
}

void SliceEntries::trace(Index column, std::span<float> out) {
  answers_.resize(rows_.size());
  layers_[layer(column)]->column(column, answers_, Part::visibility);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = answers_[i].r;
  sampled_ += rows_.size();
}

bool SliceEntries::request(std::size_t s, std::size_t row) {
  const std::uint32_t receiver = place(s, row);
  if (receiver == kNowhere) return false;
  requests_.push_back({static_cast<std::uint32_t>(s), static_cast<std::uint32_t>(row)});
  requested_places_.push_back(receiver);
  requested_columns_.push_back(slots_[s].column);
  return true;
}

void SliceEntries::request_next(std::size_t s, std::size_t count) {
  Slot& slot = slots_[s];
  const auto order = patterns_.order(slot.pattern);
  const std::size_t end = std::min(order.size(), slot.sampled + count);
  // In the rows' order, so that rays that are shot together start near each other.
  requested_rows_.assign(order.begin() + slot.sampled, order.begin() + static_cast<std::ptrdiff_t>(end));
  std::sort(requested_rows_.begin(), requested_rows_.end());
  for (const std::uint32_t row : requested_rows_) request(s, row);
  slot.sampled = static_cast<std::uint32_t>(end);
}

void SliceEntries::resolve() {
  answers_.resize(requests_.size());
  reader_->entries_at(requested_places_, requested_columns_, answers_, Part::visibility);
  for (std::size_t k = 0; k < requests_.size(); ++k) {
    const bool visible = answers_[k].r > 0.5f;
    seen(requests_[k].slot)[requests_[k].row] = visible ? seen::kVisible : seen::kHidden;
    slots_[requests_[k].slot].any_visible |= visible;
  }
  sampled_ += requests_.size();
  requests_.clear();
  requested_places_.clear();
  requested_columns_.clear();
}

void SliceEntries::values_at(std::span<const std::uint32_t> rows, std::span<const Index> columns,
                             std::vector<float>& out) {
  requested_places_.clear();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::uint32_t begin = rows_.begin(rows[k]), count = rows_.end(rows[k]) - begin;
    const auto draw = static_cast<std::uint32_t>(mix64(bits(columns[k]) ^ rows[k]) >> 32);
    requested_places_.push_back(begin + draw % count);
  }
  answers_.resize(rows.size());
  reader_->entries_at(requested_places_, columns, answers_, Part::value);
  requested_places_.clear();
  sampled_ += rows.size();
  out.resize(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) out[k] = mean(answers_[k]);
}

}  // namespace lumirank::methods
