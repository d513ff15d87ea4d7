// A cut through the product of a pixel's gather tree and the light tree (Walter et al. 2006, section 3): each
// receiver and each column meet in exactly one of its pairs.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "methods/common/light_tree/light_tree.h"
#include "methods/multidimensional_lightcuts/gather_tree.h"
#include "methods/multidimensional_lightcuts/light_instants.h"

namespace lumirank::methods {

struct PairLimits {
  double error_bound = 0.02;     // a pair is refined while its bound exceeds this share of the pixel's total
  std::size_t max_pairs = 2000;  // of a cut
  std::size_t per_round = 8;     // pairs refined before their entries are asked for
};

// One pixel at a time. Where rows and columns belong to instants, a pair is worth what its nodes have in
// common: its sum is Σ over the instants of the rows' weight times the columns' emission, its entry is that
// of the representatives of one of these instants, drawn in proportion to that, and its bound is of those
// entries alone. Pairs without a common instant are left out.
class PairCut {
 public:
  // `gather` decides by its scale how extents are measured, those of light nodes too. `instants`: null where
  // all rows and columns are of one.
  PairCut(const LightTree& lights, const LightInstants* instants, GatherTree gather, const PairLimits& limits)
      : lights_(lights), instants_(instants), gather_(std::move(gather)), limits_(limits) {}

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
  void write_sums(std::span<Rgb> sums);

 private:
  struct Pair {
    GatherTree::Node gather = 0;
    LightTree::Node light = 0;
    Rgb entry;                 // of the representatives
    float value = 0;           // luminance of weight × scale × entry
    std::uint32_t place = 0;   // representatives: a place of the gather tree
    matrix::Index column = 0;  // and a column
    bool exact = false;        // it stands for no other entry
    // With instants: what the entry is scaled by, weights and all, and what of the light node bounds are of.
    Rgb scale{1}, intensity{0}, ceiling{0};
  };
  // What its nodes have of an instant.
  struct Common {
    const GatherTree::Part* rows;
    const LightInstants::Part* columns;
    float power = 0;  // of the columns
  };
  struct Waiting {
    float bound;
    std::uint32_t place;  // in pairs_
  };
  static bool later(const Waiting& a, const Waiting& b) {
    return a.bound != b.bound ? a.bound < b.bound : a.place > b.place;
  }
  float threshold() const;
  // Representatives, and with instants what they are scaled by. False: its nodes have no instant in common.
  bool choose(Pair& p);
  // Into common_; returns Σ weight × power.
  float find_common(const Pair& p);
  void weigh(Pair& p) const;
  matrix::ColumnSet set_of(const Pair& p) const;
  void write_by_instants(const Pair& p, std::span<Rgb> sums);
  std::pair<Pair, Pair> halves(const Pair& parent) const;
  // The side with the greater extent is refined, in doubt the pixel's.
  bool split_gather(const Pair& p) const;
  void add(Pair& p);
  void wait(std::uint32_t place);

  const LightTree& lights_;
  const LightInstants* instants_;
  GatherTree gather_;
  PairLimits limits_;
  bool begun_ = false;
  std::vector<Pair> pairs_;
  std::vector<std::uint32_t> asked_, changed_;  // places in pairs_, of the round
  std::vector<Waiting> heap_;
  std::vector<Common> common_;  // of the pair that was asked for last
  std::size_t bounds_computed_ = 0;
  double total_ = 0;  // luminance
};

}  // namespace lumirank::methods
