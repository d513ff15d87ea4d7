// Parallel loops whose results do not depend on the number of threads: the pieces are fixed by the caller's
// grain, and what is reduced is reduced in the order of the pieces.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

namespace lumirank {

// Calls body(begin, end) for the pieces [k·grain, min(n, (k+1)·grain)), in any order, on all threads of the
// arena. An exception from a piece is rethrown here. Loops nest.
void parallel_for(std::size_t n, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body);

// Runs `work` with at most `threads` threads (0: all that the machine has).
void with_threads(int threads, const std::function<void()>& work);
int current_threads();

// Sum over the pieces of piece(begin, end), added in the order of the pieces.
template <typename T, typename Piece>
T parallel_sum(std::size_t n, std::size_t grain, const T& zero, Piece&& piece) {
  const std::size_t pieces = (n + grain - 1) / grain;
  std::vector<T> partial(pieces, zero);
  parallel_for(n, grain, [&](std::size_t b, std::size_t e) { partial[b / grain] = piece(b, e); });
  T sum = zero;
  for (const T& p : partial) sum = sum + p;
  return sum;
}

// Sorts; elements that are equal under `less` may end in any order, so it should leave no two of them equal.
template <typename Iterator, typename Less>
void parallel_sort(Iterator begin, Iterator end, const Less& less) {
  constexpr std::size_t kPiece = 1 << 15;
  const auto n = static_cast<std::size_t>(end - begin);
  const auto at = [&](std::size_t k) { return begin + static_cast<std::ptrdiff_t>(std::min(k, n)); };
  parallel_for(n, kPiece, [&](std::size_t b, std::size_t e) { std::sort(at(b), at(e), less); });
  for (std::size_t sorted = kPiece; sorted < n; sorted *= 2)
    parallel_for(n, 2 * sorted, [&](std::size_t b, std::size_t e) {
      std::inplace_merge(at(b), at(b + sorted), at(e), less);
    });
}

}  // namespace lumirank
