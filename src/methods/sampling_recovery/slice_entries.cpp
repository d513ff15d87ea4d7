#include "methods/sampling_recovery/slice_entries.h"

#include <algorithm>

#include "base/random.h"

namespace lumirank::methods {

using matrix::Index;
using matrix::Part;

void SliceEntries::start(std::span<const Index> slice, std::uint64_t key) {
  rows_.build(features_, slice);
  patterns_.build(rows_.curves(), mix64(key));
  reader_->set_rows(rows_.receivers());
  key_ = key;
  looked_ = 0;
  slots_.clear();
  requests_.clear();
}

std::size_t SliceEntries::add(Index column) {
  const std::size_t s = slots_.size(), receivers = rows_.receivers().size();
  if (shades_.size() < (s + 1) * receivers) shades_.resize(std::max(2 * s, s + 16) * receivers);
  if (seen_.size() < (s + 1) * rows_.size()) seen_.resize(std::max(2 * s, s + 16) * rows_.size());
  const auto out = std::span(shades_).subspan(s * receivers, receivers);
  reader_->column(column, out, Part::unoccluded);
  Slot slot{column, static_cast<std::uint32_t>(mix64(key_ ^ mix64(column)) % SamplePatterns::kPatterns), 0, 0,
            false};
  float most = 0;
  for (const Rgb e : out) most = std::max(most, e.r + e.g + e.b);
  slot.most = most * (1.0f / 3.0f);
  slots_.push_back(slot);
  std::ranges::fill(seen(s), linalg::seen::kUnknown);
  return s;
}

void SliceEntries::scalars(std::size_t s, Rgb scale, std::span<float> out) const {
  const auto e = shades(s);
  const Rgb third = scale * (1.0f / 3.0f);
  for (std::size_t r = 0; r < out.size(); ++r) {
    float sum = 0;
    for (std::uint32_t k = rows_.begin(r); k < rows_.end(r); ++k)
      sum += third.r * e[k].r + third.g * e[k].g + third.b * e[k].b;
    out[r] = sum / static_cast<float>(rows_.end(r) - rows_.begin(r));
  }
}

std::uint32_t SliceEntries::place(std::size_t s, std::size_t row) const {
  const auto e = shades(s);
  const std::uint32_t begin = rows_.begin(row), count = rows_.end(row) - begin;
  const auto draw =
      static_cast<std::uint32_t>(mix64(key_ ^ mix64((std::uint64_t{slots_[s].column} << 32) | row)) >> 32);
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t receiver = begin + (draw + k) % count;
    if (!is_black(e[receiver])) return receiver;
  }
  return kNowhere;
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
  for (std::size_t k = slot.sampled; k < end; ++k) ask(s, order[k]);
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
