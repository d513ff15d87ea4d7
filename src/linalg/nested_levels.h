// Points in levels from coarse to fine, each point with some of the coarser points next to it: for filling in
// what is known at few of them where these agree, and evaluating only where they do not.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lumirank::linalg {

class NestedLevels {
 public:
  using Point = std::array<float, 6>;
  static constexpr std::size_t kNear = 4;

  struct Step {
    std::uint32_t point;
    std::array<std::uint32_t, kNear> near;  // of coarser levels, nearest first; repeated if there are fewer
  };

  // About one of `spacing` points is in the coarsest level, each further level has as many points as all
  // before it. Points that follow each other should lie near each other: a level takes one of a stretch,
  // drawn by `seed`. O(n²), without allocation once buffers have grown.
  void build(std::span<const Point> points, std::size_t spacing, std::uint64_t seed);

  std::span<const std::uint32_t> coarsest() const { return {order_.data(), first_[0]}; }
  std::size_t levels() const { return first_.size() - 1; }  // beside the coarsest
  std::span<const Step> level(std::size_t l) const {
    return {steps_.data() + (first_[l] - first_[0]), first_[l + 1] - first_[l]};
  }

 private:
  void find_near(std::span<const Point> points, std::size_t coarser, Step& step) const;

  std::vector<std::uint32_t> order_;  // points, level by level
  std::vector<std::size_t> first_;    // end of the coarsest, and of each level after it
  std::vector<Step> steps_;
  std::vector<float> coordinates_;  // of order_, dimension by dimension
};

}  // namespace lumirank::linalg
