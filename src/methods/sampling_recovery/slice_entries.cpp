#include "methods/sampling_recovery/slice_entries.h"

#include <algorithm>
#include <bit>

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
  looked_ = 0;
  slots_.clear();
  requests_.clear();
  first_layer_.resize(rows_.size());
  row_of_.resize(rows_.receivers().size());
  std::uint32_t most = 1;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const std::uint32_t count = receivers_of(r);
    // Four receivers are in four layers by their number, so that a mask of them needs no turning.
    first_layer_[r] = count > 4 ? static_cast<std::uint8_t>(mix64(key ^ mix64(r)) >> 56) : 0;
    most = std::max(most, count);
    for (std::uint32_t k = rows_.begin(r); k < rows_.end(r); ++k) row_of_[k] = static_cast<std::uint32_t>(r);
  }
  layer_count_ = std::min<std::size_t>(most, kLayers);
  while (layers_.size() < layer_count_) layers_.push_back(matrix_.reader());
  layer_receivers_.resize(rows_.size());
  for (std::size_t l = 0; l < layer_count_; ++l) {
    for (std::size_t r = 0; r < rows_.size(); ++r) layer_receivers_[r] = rows_.receivers()[receiver(r, l)];
    layers_[l]->set_rows(layer_receivers_);
  }
}

std::size_t SliceEntries::new_slot(const matrix::ScaledColumn& column) {
  const std::size_t s = slots_.size(), rows = rows_.size();
  if (seen_.size() < (s + 1) * rows) {
    const std::size_t room = std::max(2 * s, s + 16) * rows;
    seen_.resize(room);
    scalars_.resize(room);
    lit_.resize(room);
  }
  const std::uint64_t bits = mix64(key_ ^ mix64(column.column));
  slots_.push_back({column.column, static_cast<std::uint32_t>(bits % SamplePatterns::kPatterns), 0, 0,
                    static_cast<std::uint16_t>((bits >> 32) % layer_count_), false});
  std::ranges::fill(seen(s), linalg::seen::kUnknown);
  return s;
}

std::size_t SliceEntries::add(const matrix::ScaledColumn& column) {
  const std::size_t s = new_slot(column);
  Slot& slot = slots_[s];
  const auto out = std::span(scalars_).subspan(s * rows_.size(), rows_.size());
  layers_[slot.layer]->unoccluded_scalars(column.column, weights(column.scale), out);
  for (const float e : out) slot.most = std::max(slot.most, e);
  return s;
}

std::size_t SliceEntries::add_whole(const matrix::ScaledColumn& column) {
  const std::size_t s = new_slot(column);
  make_whole(s, column);
  return s;
}

void SliceEntries::make_whole(std::size_t s, const matrix::ScaledColumn& column) {
  slots_[s].layer = kWhole;
  receiver_scalars_.resize(rows_.receivers().size());
  reader_->unoccluded_scalars(column.column, weights(column.scale), receiver_scalars_);
  float* const out = &scalars_[s * rows_.size()];
  std::uint16_t* const lit = &lit_[s * rows_.size()];
  const float* const all = receiver_scalars_.data();
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const float* const e = all + rows_.begin(r);
    const std::uint32_t count = receivers_of(r);
    if (count == 4) {  // by far most rows of a picture with four samples per pixel
      out[r] = 0.25f * ((e[0] + e[1]) + (e[2] + e[3]));
      lit[r] = static_cast<std::uint16_t>((e[0] > 0) | (e[1] > 0) << 1 | (e[2] > 0) << 2 | (e[3] > 0) << 3);
      continue;
    }
    float sum = 0;
    for (std::uint32_t k = 0; k < count; ++k) sum += e[k];
    out[r] = sum / static_cast<float>(count);
    std::uint32_t reached = 0;
    if (count <= kMostLayers) {
      for (std::uint32_t l = 0; l < count; ++l) reached |= (all[receiver(r, l)] > 0 ? 1u : 0u) << l;
    } else if (sum > 0) {
      reached = static_cast<std::uint32_t>((draw(s, r) * count) >> 32);
      while (!(e[reached] > 0)) reached = reached + 1 < count ? reached + 1 : 0;
    }
    lit[r] = static_cast<std::uint16_t>(reached);
  }
}

std::uint32_t SliceEntries::place(std::size_t s, std::size_t row) const {
  const std::size_t at = s * rows_.size() + row;
  const Slot& slot = slots_[s];
  if (slot.layer != kWhole) return scalars_[at] > 0 ? receiver(row, slot.layer) : kNowhere;
  if (!(scalars_[at] > 0)) return kNowhere;
  std::uint32_t lit = lit_[at];
  if (receivers_of(row) > kMostLayers) return rows_.begin(row) + lit;
  for (auto skip = (draw(s, row) * static_cast<std::uint64_t>(std::popcount(lit))) >> 32; skip > 0; --skip)
    lit &= lit - 1;
  return receiver(row, static_cast<std::size_t>(std::countr_zero(lit)));
}

bool SliceEntries::ask(std::size_t s, std::size_t row) {
  const std::uint32_t receiver = place(s, row);
  if (receiver == kNowhere) return false;
  requests_.push_back({static_cast<std::uint32_t>(s), static_cast<std::uint32_t>(row)});
  asked_places_.push_back(receiver);
  asked_columns_.push_back(slots_[s].column);
  return true;
}

void SliceEntries::ask_next(std::size_t s, std::size_t count) {
  Slot& slot = slots_[s];
  const auto order = patterns_.order(slot.pattern);
  const std::size_t end = std::min(order.size(), slot.sampled + count);
  // In the rows' order, so that rays that are shot together start near each other.
  asked_rows_.assign(order.begin() + slot.sampled, order.begin() + static_cast<std::ptrdiff_t>(end));
  std::sort(asked_rows_.begin(), asked_rows_.end());
  for (const std::uint32_t row : asked_rows_) ask(s, row);
  slot.sampled = static_cast<std::uint32_t>(end);
}

void SliceEntries::look() {
  answers_.resize(requests_.size());
  reader_->entries_at(asked_places_, asked_columns_, answers_, Part::visibility);
  for (std::size_t k = 0; k < requests_.size(); ++k) {
    const bool visible = answers_[k].r > 0.5f;
    seen(requests_[k].slot)[requests_[k].row] = visible ? linalg::seen::kVisible : linalg::seen::kHidden;
    slots_[requests_[k].slot].any_visible |= visible;
  }
  looked_ += requests_.size();
  requests_.clear();
  asked_places_.clear();
  asked_columns_.clear();
}

void SliceEntries::look_at(std::span<const std::uint32_t> rows, std::span<const Index> columns,
                           std::vector<float>& out) {
  asked_places_.clear();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::uint32_t begin = rows_.begin(rows[k]), count = rows_.end(rows[k]) - begin;
    const auto draw =
        static_cast<std::uint32_t>(mix64(key_ ^ mix64((std::uint64_t{columns[k]} << 32) | rows[k])) >> 32);
    asked_places_.push_back(begin + draw % count);
  }
  answers_.resize(rows.size());
  reader_->entries_at(asked_places_, columns, answers_, Part::value);
  asked_places_.clear();
  looked_ += rows.size();
  out.resize(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) out[k] = mean(answers_[k]);
}

}  // namespace lumirank::methods
