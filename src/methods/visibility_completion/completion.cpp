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
  const std::size_t bits = 64, from = word * bits;
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

void Completion::resolve(const Slice& slice) {
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
  counts_.sampled += sorted_.size();
}

void Completion::complete(const Slice& slice, const CompletionSettings& settings) {
  start(slice);
  levels_.build(slice.points, settings.spacing, slice.key);
  for (const std::uint32_t row : levels_.coarsest())
    for (std::size_t column = 0; column < slice.columns.size(); ++column) request(row, column, false);
  resolve(slice);
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
    resolve(slice);
  }
}

}  // namespace lumirank::methods
