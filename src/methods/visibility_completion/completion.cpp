#include "methods/visibility_completion/completion.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "base/random.h"

namespace lumirank::methods {

using Word = Completion::Word;

namespace {

// Every bit is 1 with this probability, in steps of 2⁻¹⁰.
class RareBits {
 public:
  explicit RareBits(double probability)
      : share_(static_cast<std::uint32_t>(std::lround(std::clamp(probability, 0.0, 1.0) * kScale))) {}
  Word draw(std::uint64_t key) const {
    if (share_ >= kScale) return ~Word{0};
    Word bits = 0;
    // The binary digits of the share, last first: each halves what is there and adds a half if it is 1.
    for (std::uint32_t digit = 1; digit < kScale; digit *= 2) {
      key = mix64(key);
      bits = (share_ & digit) != 0 ? bits | key : bits & key;
    }
    return bits;
  }

 private:
  static constexpr std::uint32_t kScale = 1024;
  std::uint32_t share_;
};

// The lowest `size` bits of the last of some words, all of the others.
Word used_bits(std::size_t word, std::size_t size) {
  const std::size_t bits = linalg::BooleanBasis::kBits, from = word * bits;
  return size - from >= bits ? ~Word{0} : (Word{1} << (size - from)) - 1;
}

}  // namespace

void Completion::start(const Slice& slice) {
  words_ = (slice.columns.size() + kBits - 1) / kBits;
  bits_.assign(slice.rows.size() * words_, 0);
  wanted_.clear();
  counts_.entries += slice.rows.size() * slice.columns.size();
}

void Completion::set(std::size_t row, std::size_t column, bool seen) {
  Word& word = bits_[row * words_ + column / kBits];
  const Word bit = Word{1} << (column % kBits);
  word = seen ? word | bit : word & ~bit;
}

void Completion::look(const Slice& slice) {
  // Rays of a packet share a light.
  starts_.assign(slice.columns.size() + 1, 0);
  for (const Wanted& w : wanted_) ++starts_[w.column + 1];
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  sorted_.resize(wanted_.size());
  for (const Wanted& w : wanted_) sorted_[starts_[w.column]++] = w;
  rows_.clear(), columns_.clear();
  for (const Wanted& w : sorted_) {
    rows_.push_back(slice.rows[w.row]);
    columns_.push_back(slice.columns[w.column]);
  }
  seen_.resize(sorted_.size());
  reader_.entries(rows_, columns_, seen_, matrix::Part::visibility);
  for (std::size_t k = 0; k < sorted_.size(); ++k) {
    const Wanted& w = sorted_[k];
    const bool seen = seen_[k].r > 0;
    counts_.checks += w.check;
    counts_.wrong += w.check && seen != visible(w.row, w.column);
    set(w.row, w.column, seen);
  }
  counts_.looked_at += sorted_.size();
}

void Completion::complete_refined(const Slice& slice, const CompletionSettings& settings) {
  start(slice);
  levels_.build(slice.points, settings.spacing, slice.key);
  for (const std::uint32_t row : levels_.coarsest())
    for (std::size_t column = 0; column < slice.columns.size(); ++column) request(row, column, false);
  look(slice);
  const RareBits check(settings.checks);
  for (std::size_t l = 0; l < levels_.levels(); ++l) {
    wanted_.clear();
    for (const auto& step : levels_.level(l))
      for (std::size_t w = 0; w < words_; ++w) {
        Word any = 0, all = ~Word{0};
        for (const std::uint32_t near : step.near) {
          any |= bits_[near * words_ + w];
          all &= bits_[near * words_ + w];
        }
        const Word used = used_bits(w, slice.columns.size()), differing = (any & ~all) & used;
        const Word checked = check.draw(slice.key ^ (step.point * words_ + w)) & used & ~differing;
        bits_[step.point * words_ + w] = all & used;
        for (Word bits = differing | checked; bits != 0; bits &= bits - 1) {
          const auto bit = static_cast<std::size_t>(std::countr_zero(bits));
          request(step.point, w * kBits + bit, (checked >> bit) & 1u);
        }
      }
    look(slice);
  }
}

void Completion::complete_boolean(const Slice& slice, const CompletionSettings& settings) {
  start(slice);
  basis_.clear(slice.rows.size());
  known_.resize(basis_.words()), value_.resize(basis_.words()), sum_.resize(basis_.words());
  for (std::size_t column = 0; column < slice.columns.size(); ++column)
    if (!complete_column(slice, settings, column)) look_at_column(slice, column);
}

bool Completion::complete_column(const Slice& slice, const CompletionSettings& settings, std::size_t column) {
  const std::size_t rows = slice.rows.size();
  const auto samples = static_cast<std::size_t>(std::ceil(settings.rate * static_cast<double>(rows)));
  const auto checks = static_cast<std::size_t>(std::ceil(settings.checks * static_cast<double>(rows)));
  if (basis_.rank() == 0 || 2 * (samples + checks) >= rows) return false;
  Rng rng(slice.key, Stage::method, column);
  std::fill(known_.begin(), known_.end(), Word{0});
  std::fill(value_.begin(), value_.end(), Word{0});
  // Half of them where a vector shows itself, as in the paper.
  const auto pivots = basis_.pivots();
  std::size_t pivots_left = std::min(pivots.size(), samples / 2);
  chosen_.clear();
  const auto choose = [&](std::size_t row) {
    Word& word = known_[row / kBits];
    const Word bit = Word{1} << (row % kBits);
    if ((word & bit) != 0) return false;
    word |= bit;
    chosen_.push_back(static_cast<std::uint32_t>(row));
    return true;
  };
  for (std::size_t k = 0; k < pivots.size() && pivots_left > 0; ++k)
    if (rng.next_below(pivots.size() - k) < pivots_left) --pivots_left, choose(pivots[k]);
  while (chosen_.size() < samples) choose(rng.next_below(rows));
  look_at_rows(slice, column);
  if (basis_.complete(known_, value_, sum_) > 0) return false;
  chosen_.clear();
  while (chosen_.size() < checks) choose(rng.next_below(rows));
  look_at_rows(slice, column);
  counts_.checks += checks;
  for (const std::uint32_t row : chosen_) {
    const Word bit = Word{1} << (row % kBits);
    if (((sum_[row / kBits] ^ value_[row / kBits]) & bit) == 0) continue;
    ++counts_.wrong;
    return false;
  }
  for (std::size_t row = 0; row < rows; ++row)
    if ((sum_[row / kBits] >> (row % kBits)) & 1u) set(row, column, true);
  return true;
}

void Completion::look_at_rows(const Slice& slice, std::size_t column) {
  rows_.clear();
  for (const std::uint32_t row : chosen_) rows_.push_back(slice.rows[row]);
  columns_.assign(rows_.size(), slice.columns[column]);
  seen_.resize(rows_.size());
  reader_.entries(rows_, columns_, seen_, matrix::Part::visibility);
  for (std::size_t k = 0; k < chosen_.size(); ++k)
    if (seen_[k].r > 0) value_[chosen_[k] / kBits] |= Word{1} << (chosen_[k] % kBits);
  counts_.looked_at += chosen_.size();
}

void Completion::look_at_column(const Slice& slice, std::size_t column) {
  seen_.resize(slice.rows.size());
  reader_.column(slice.columns[column], seen_, matrix::Part::visibility);
  std::fill(value_.begin(), value_.end(), Word{0});
  for (std::size_t row = 0; row < seen_.size(); ++row)
    if (seen_[row].r > 0) {
      value_[row / kBits] |= Word{1} << (row % kBits);
      set(row, column, true);
    }
  basis_.add(value_);
  counts_.looked_at += slice.rows.size();
  ++counts_.whole_columns;
}

}  // namespace lumirank::methods
