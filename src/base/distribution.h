// Discrete distributions that are sampled by inverting their running sum, so strata stay strata.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/prefetch.h"

namespace lumirank {

class Distribution1D {
 public:
  Distribution1D() = default;
  // Weights must be finite and not negative. All zero is allowed: then `total()` is 0 and nothing may be
  // sampled.
  // `bins_at_once`: among how many sample() searches, on average. Fewer take more memory; by default so
  // little that what is looked up first stays in the cache for all rows of an environment map, which its sums
  // do not.
  explicit Distribution1D(std::span<const float> weights, std::size_t bins_at_once = 8);

  struct Sample {
    std::size_t index;
    float pmf;       // probability of `index`
    float remapped;  // u, stretched again over [0, 1) within the chosen bin
  };
  Sample sample(float u) const;
  // sample(u) waits for memory twice, one after the other. Asks for the first; and when that has come, for
  // the second.
  void fetch(float u) const;
  void fetch_bins(float u) const;
  float pmf(std::size_t i) const;
  void fetch_pmf(std::size_t i) const { prefetch(&cdf_[i]); }
  double total() const { return total_; }
  std::size_t size() const { return cdf_.empty() ? 0 : cdf_.size() - 1; }

 private:
  static constexpr std::size_t kGuidedFrom = 32;
  std::vector<double> cdf_;  // size + 1 entries, not normalized
  double total_ = 0;  // of all, beside what is looked up first: the last sum lies far from those that are
  // The bins at equal parts of the sum, between which a search begins; empty for few bins.
  std::vector<std::uint32_t> guide_;
  std::size_t part(float u) const;
};

}  // namespace lumirank
