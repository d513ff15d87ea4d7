// The settings that the paper leaves to the user (α, ρ, e_p), found from the scene: a few slices, spread over
// all of them, are rendered with one setting after another and judged at receivers whose whole rows are
// known.
#pragma once

#include <functional>

#include "methods/common/slices/slices.h"
#include "methods/method.h"
#include "methods/slice_cuts/settings.h"

namespace lumirank::methods {

// Settings from coarse to fine, along two ladders: how finely the light tree is cut, and how strictly
// predictions of visibility are tested.
struct SliceLevel {
  std::size_t cut = 3, visibility = 1;
  friend bool operator<(const SliceLevel& a, const SliceLevel& b) {
    return a.cut != b.cut ? a.cut < b.cut : a.visibility < b.visibility;
  }
};
inline constexpr std::size_t kCutLevels = 7, kVisibilityLevels = 5;

void set_cut_level(std::size_t level, SliceCutSettings& settings);
void write_cut_level(const SliceCutSettings& settings, Trace& trace);

struct LevelTrials {
  bool predicts;  // whether levels of visibility differ
  // Renders a slice as the level says; what it cost (SliceTally::cost). Called by several threads.
  std::function<double(const SliceLevel&, std::size_t slice, std::span<Rgb> sums)> render;
};

struct LevelChoice {
  SliceLevel level;
  double error = 0;        // relative L1 of the method alone, as measured
  double target = 0;       // what it was to be
  std::size_t trials = 0;  // levels tried
  std::size_t rows = 0;    // receivers known
};

// The cheapest level that meets the target (3 % where none is given), or the best of those tried. Costs are
// counted, not timed, so that the choice depends on the seed alone.
LevelChoice choose_level(const matrix::LightingMatrix& matrix, const Slices& slices,
                         const RunOptions& options, const LevelTrials& trials);

}  // namespace lumirank::methods
