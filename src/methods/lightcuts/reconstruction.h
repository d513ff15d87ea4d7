// Reconstruction cuts (Walter et al. 2005, section 5): what the finished cuts of a few receivers say about
// each node tells which nodes a receiver between them must shade, which it may interpolate, and which it may
// leave out.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "methods/lightcuts/cut.h"

namespace lumirank::methods {

// A finished cut, as others see it.
struct CutSample {
  struct Node {
    std::uint32_t children = 0;  // as in CutNode
    Rgb value;                   // Σ scale × entry over the part of the cut below
  };
  matrix::Index row = 0;
  Rgb sum;
  std::vector<Node> nodes;

  void set(const Cut& cut, const LightTree& tree);
};

class ReconstructionCut {
 public:
  static constexpr std::size_t kMaxSamples = 4;

  struct Shaded {
    LightTree::Node node;
  };
  struct Interpolated {
    LightTree::Node node;
    std::array<Rgb, kMaxSamples> values;  // of the samples
  };

  // tolerance: a node is interpolated where the samples' values differ by less than this share of the least
  // of their totals and none of them is dark.
  ReconstructionCut(const LightTree& tree, double tolerance) : tree_(tree), tolerance_(tolerance) {}

  // From the top of the tree down. At most kMaxSamples samples.
  void find(std::span<const CutSample* const> samples);
  std::span<const Shaded> shaded() const { return shaded_; }
  std::span<const Interpolated> interpolated() const { return interpolated_; }

 private:
  struct Visit {
    LightTree::Node node;
    std::array<std::uint32_t, kMaxSamples> places;  // in the samples' nodes
  };
  const LightTree& tree_;
  double tolerance_;
  std::vector<Visit> stack_;
  std::vector<Shaded> shaded_;
  std::vector<Interpolated> interpolated_;
};

// A node's sum in a receiver, from the samples' by `weights` (which add up to 1): interpolated, times what
// its representative would give unoccluded here beside what it would give there. So texture and normals stay
// sharp. This stands for the paper's impostors, directional lights that are shaded anew.
Rgb interpolate(std::span<const float> weights, std::span<const Rgb> values, Rgb unoccluded_here,
                std::span<const Rgb> unoccluded_there, Rgb scale);

}  // namespace lumirank::methods
