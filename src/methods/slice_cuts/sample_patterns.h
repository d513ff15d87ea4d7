// Patterns in which columns are sampled. A column follows one of a few orders of the rows, so that nearest
// neighbors need not be found for each column anew; which one is random.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "methods/common/hilbert_neighbors.h"

namespace lumirank::methods {

class SamplePatterns {
 public:
  static constexpr std::size_t kPatterns = 4;
  using Few = SampledNeighbors::Few;

  // Orders whose every beginning is spread evenly along the curve (a random bit flip of van der Corput's
  // sequence). `curves` must outlive what is asked of this. Keeps its buffers.
  void build(const HilbertCurves& curves, std::uint64_t key);
  std::span<const std::uint32_t> order(std::size_t pattern) const { return patterns_[pattern].order; }

  // For every row its neighbors among the first `count` of an order. Remembered until the next build().
  std::span<const Few> nearest(std::size_t pattern, std::size_t count);
  // The same for the rows count … count + more − 1 of the order alone.
  std::span<const Few> nearest_of_next(std::size_t pattern, std::size_t count, std::size_t more);

 private:
  struct Pattern {
    std::vector<std::uint32_t> order;
    std::vector<std::uint32_t> counts, next_counts;  // of the tables
    std::vector<std::unique_ptr<SampledNeighbors>> tables;
    std::vector<std::vector<Few>> next_tables;
  };

  const HilbertCurves* curves_ = nullptr;
  std::vector<Pattern> patterns_;
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint8_t> sampled_;
};

}  // namespace lumirank::methods
