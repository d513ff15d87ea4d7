// A cut through the product of a pixel's gather tree and the light tree (Walter et al. 2006, section 3): each
// receiver and each column meet in exactly one of its pairs.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "methods/common/light_tree/light_tree.h"
#include "methods/multidimensional_lightcuts/gather_tree.h"

namespace lumirank::methods {

struct PairLimits {
  double error_bound = 0.02;     // a pair is refined while its bound exceeds this share of the pixel's total
  std::size_t max_pairs = 2000;  // of a cut
  std::size_t per_round = 8;     // pairs refined before their entries are asked for
};

// One pixel at a time.
class PairCut {
 public:
  // `gather` decides by its scale how extents are measured, those of light nodes too.
  PairCut(const LightTree& lights, GatherTree gather, const PairLimits& limits)
      : lights_(lights), gather_(std::move(gather)), limits_(limits) {}

  void use(const PairLimits& limits) { limits_ = limits; }
  // Begins anew.
  void begin(std::span<const matrix::Index> rows);
  // The pixel's rows in the order of its places.
  std::span<const matrix::Index> rows() const { return gather_.order(); }
  // Appends the entries that are needed next: places of rows(), counted from `first_place`, and columns;
  // false: none are, the cut is finished.
  bool request(std::uint32_t first_place, std::vector<std::uint32_t>& places,
               std::vector<matrix::Index>& columns);
  // Their values, in the same order.
  void take(std::span<const Rgb> values);

  std::size_t size() const { return pairs_.size(); }
  std::size_t bounds_computed() const { return bounds_computed_; }
  // Each row's part: over the pairs that hold it, scale × entry of the pair's representatives. Weighted, the
  // rows' parts add up to the pixel's estimate, which is all that the method is about; row by row they are
  // exact only where the cut goes down to single receivers.
  void write_sums(std::span<Rgb> sums) const;

 private:
  struct Pair {
    GatherTree::Node gather = 0;
    LightTree::Node light = 0;
    Rgb entry;        // of the representatives
    float value = 0;  // luminance of weight × scale × entry
  };
  struct Waiting {
    float bound;
    std::uint32_t place;  // in pairs_
  };
  static bool later(const Waiting& a, const Waiting& b) {
    return a.bound != b.bound ? a.bound < b.bound : a.place > b.place;
  }
  float threshold() const;
  bool exact(const Pair& p) const { return gather_.is_leaf(p.gather) && lights_.is_leaf(p.light); }
  // The side with the greater extent is refined, in doubt the pixel's.
  bool split_gather(const Pair& p) const;
  void add(Pair& p);
  void wait(std::uint32_t place);

  const LightTree& lights_;
  GatherTree gather_;
  PairLimits limits_;
  bool begun_ = false;
  std::vector<Pair> pairs_;
  std::vector<std::uint32_t> asked_, changed_;  // places in pairs_, of the round
  std::vector<Waiting> heap_;
  std::size_t bounds_computed_ = 0;
  double total_ = 0;  // luminance
};

}  // namespace lumirank::methods
