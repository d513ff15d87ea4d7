// A tree over lights: draws one for a point in proportion to a bound of what it can send there, in
// logarithmic time, with a probability that can be asked for afterwards. A. Conty Estevez, C. Kulla,
// "Importance Sampling of Many Lights with Adaptive Tree Splitting", 2018; here with eight children to a node
// and without splitting. Knows bounds only, so anything that shines can be a leaf.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "emitters/light_extents.h"

namespace lumirank::emitters {

struct LightItem;

class LightTree {
 public:
  LightTree() = default;
  // Lights of no intensity are never drawn. At most 2³¹ lights.
  explicit LightTree(std::span<const LightBound> lights);

  bool empty() const { return nodes_.empty(); }
  // False: no light can matter at the point.
  bool reaches(const LitPoint& at) const;

  struct Pick {
    std::uint32_t light = 0;  // index into the constructor's list
    float pmf = 0;            // 0: none found, which means that the light drawn from cannot reach the point
  };
  // `u` in [0, 1). A double, since a deep tree needs more bits than a float has.
  Pick sample(const LitPoint& at, double u) const;
  // Probability that sample() draws this light.
  float pmf(const LitPoint& at, std::uint32_t light) const;

 private:
  static constexpr int kWidth = LightExtents::kCount;
  static constexpr std::uint32_t kLeaf = 0x80000000u, kNone = 0xffffffffu;
  static constexpr std::uint32_t kNothing = 0;  // the topmost node is no child
  struct Node {
    LightExtents extents;
    std::uint32_t child[kWidth] = {};  // a node, kLeaf | light, or kNothing
    std::uint32_t parent = kNone;      // its node times kWidth, plus the slot
  };
  struct Weights;
  // Appends the nodes over `items`, the topmost first, without their parents.
  static void build(std::span<LightItem> items, std::vector<Node>& nodes);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> leaf_of_;  // per light, its node times kWidth, plus the slot
};

}  // namespace lumirank::emitters
