// The settings that the paper leaves to the user (α, ρ, e_p), found from the scene: a few slices, spread over
// all of them, are rendered with one setting after another and judged at receivers whose whole rows are
// known.
#pragma once

#include "methods/common/light_tree/light_tree.h"
#include "methods/common/slices/slices.h"
#include "methods/method.h"
#include "methods/sampling_recovery/settings.h"

namespace lumirank::methods {

struct AutomaticChoice {
  RecoverySettings settings;
  double error = 0;        // relative L1 of the method alone, as measured
  double target = 0;       // what it was to be
  std::size_t trials = 0;  // settings tried
  std::size_t rows = 0;    // receivers known
  std::size_t slices = 0;  // per trial
};

// The cheapest setting that meets the target (3 % where none is given), or the best of those tried. Costs are
// counted, not timed, so that the choice depends on the seed alone.
AutomaticChoice choose_parameters(const RecoverySettings& given, const LightTree& tree,
                                  const matrix::LightingMatrix& matrix, const Slices& slices,
                                  const RunOptions& options);

}  // namespace lumirank::methods
