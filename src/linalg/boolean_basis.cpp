#include "linalg/boolean_basis.h"

#include <algorithm>
#include <bit>

namespace lumirank::linalg {

namespace {

using Word = BooleanBasis::Word;

bool bit(const Word* words, std::uint32_t row) {
  return (words[row / BooleanBasis::kBits] >> (row % BooleanBasis::kBits)) & 1u;
}
void add_to(Word* sum, const Word* vector, std::size_t words) {
  for (std::size_t w = 0; w < words; ++w) sum[w] ^= vector[w];
}

}  // namespace

void BooleanBasis::clear(std::size_t rows) {
  words_ = (rows + kBits - 1) / kBits;
  vectors_.clear();
  pivots_.clear();
}

bool BooleanBasis::add(std::span<const Word> column) {
  const std::size_t rank = pivots_.size();
  vectors_.insert(vectors_.end(), column.begin(), column.begin() + static_cast<std::ptrdiff_t>(words_));
  Word* fresh = vectors_.data() + rank * words_;
  for (std::size_t k = 0; k < rank; ++k)
    if (bit(fresh, pivots_[k])) add_to(fresh, vectors_.data() + k * words_, words_);
  const Word* first = std::find_if(fresh, fresh + words_, [](Word w) { return w != 0; });
  if (first == fresh + words_) {
    vectors_.resize(rank * words_);
    return false;
  }
  const auto pivot = static_cast<std::uint32_t>(static_cast<std::size_t>(first - fresh) * kBits +
                                                static_cast<std::size_t>(std::countr_zero(*first)));
  for (std::size_t k = 0; k < rank; ++k)
    if (bit(vectors_.data() + k * words_, pivot)) add_to(vectors_.data() + k * words_, fresh, words_);
  pivots_.push_back(pivot);
  return true;
}

std::size_t BooleanBasis::complete(std::span<const Word> known, std::span<const Word> value,
                                   std::span<Word> sum) const {
  std::fill(sum.begin(), sum.end(), Word{0});
  for (std::size_t k = 0; k < pivots_.size(); ++k)
    if (bit(known.data(), pivots_[k]) && bit(value.data(), pivots_[k]))
      add_to(sum.data(), vectors_.data() + k * words_, words_);
  std::size_t wrong = 0;
  for (std::size_t w = 0; w < words_; ++w)
    wrong += static_cast<std::size_t>(std::popcount((sum[w] ^ value[w]) & known[w]));
  return wrong;
}

}  // namespace lumirank::linalg
