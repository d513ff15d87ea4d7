// Of how much use to the receivers light is that leaves a place: learnt from places where it was asked for.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace lumirank::transport {

// Constant over cells of space that hold a handful of sites each; the two sides of a wall are told apart by
// the axis that the normal is nearest to.
class LightImportance {
 public:
  struct Site {
    Vec3f position, normal;
    float value = 0;    // what receivers get of light that leaves here, in the mean
    bool seen = false;  // known to be seen by some receiver, whatever the value says
  };

  LightImportance() = default;  // 1 everywhere
  explicit LightImportance(std::span<const Site> sites);

  // Values are held between `low` and `high` where anything was seen, and are `unseen` elsewhere. A light's
  // chance to be kept follows them, so its power may be greater by as much as they are small: what is of
  // little use to all receivers together may be near to a few.
  struct Range {
    float low = 0, high = kInfinity, unseen = 0;
  };
  void set_range(const Range& range) { range_ = range; }

  float at(Vec3f position, Vec3f normal) const;
  bool seen(Vec3f position, Vec3f normal) const;
  bool even() const { return nodes_.empty(); }

 private:
  static constexpr std::size_t kSides = 6;
  static constexpr std::uint32_t kNone = 0xffffffffu;
  struct Node {
    float split = 0, value = 0;
    std::uint32_t child = kNone;  // the lower half; the upper one comes next. kNone: a leaf
    std::uint8_t axis = 0;
    bool seen = false;  // anything here, or in the cell that this one was cut from
    bool seen_here = false;
  };
  static std::size_t side_of(Vec3f normal);
  const Node* leaf(Vec3f position, Vec3f normal) const;
  void divide(std::uint32_t node, std::span<Site> sites);

  std::vector<Node> nodes_;
  std::array<std::uint32_t, kSides> root_{};
  Range range_;
};

}  // namespace lumirank::transport
