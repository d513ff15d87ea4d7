// Columns of 0s and 1s as sums modulo 2 of few columns that are known whole (Wang and Holzschuch 2020,
// "Adaptive matrix completion for fast visibility computations with many lights rendering"; adaptive column
// sampling is Krishnamurthy and Singh's, 2013, over the reals).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lumirank::linalg {

class BooleanBasis {
 public:
  using Word = std::uint64_t;  // row i of a column: bit i mod 64 of word i / 64
  static constexpr std::size_t kBits = 64;

  // Forgets all columns. Buffers stay.
  void clear(std::size_t rows);
  std::size_t words() const { return words_; }
  std::size_t rank() const { return pivots_.size(); }
  // A row for each vector in which it alone has a 1: who knows a sum there knows how it is made.
  std::span<const std::uint32_t> pivots() const { return pivots_; }

  // False if the column is a sum of those before it. Bits beyond the last row must be 0.
  bool add(std::span<const Word> column);
  // The sum of vectors that has the values `value` at the known pivots; vectors whose pivot is not known are
  // left out. Returns at how many known rows it has another value.
  std::size_t complete(std::span<const Word> known, std::span<const Word> value, std::span<Word> sum) const;

 private:
  std::size_t words_ = 0;
  std::vector<Word> vectors_;  // rank × words: reduced, with rows as unknowns
  std::vector<std::uint32_t> pivots_;
};

}  // namespace lumirank::linalg
