// What a user can set of matrix sampling and recovery, and of the cuts of slices. Defaults are those of the
// paper (section 7.1), but for the columns (its 200 and 0.02 give 270 per slice here, where it reports about
// a thousand: rays per pixel over sampling rate in table 1) and the separation's iterations (20 there, with
// no gain over four here). What is ours (redraw, scouts, calibration, weighted, uncertain, bright) is
// explained in docs/sampling-recovery.md.
#pragma once

#include "linalg/separation.h"
#include "methods/common/turns.h"
#include "methods/parameters.h"

namespace lumirank::methods {

struct RecoverySettings {
  enum class Parameters { by_target, given, automatic } parameters = Parameters::by_target;
  std::size_t slice_rows = 1024;
  // Columns of a slice.
  enum class Clusters { bounds, rows } clusters = Clusters::bounds;
  std::size_t columns = 300, neighbours = 16;
  std::size_t initial_columns = 500, most_columns = 2000;
  bool splitting = true, sparse_visibility = true, redraw = true;
  std::size_t scouts = 128;  // rows by which clusters are chosen; 0: all
  double alpha = 0.003;
  // Visibility: few looked at and the others recovered, or all looked at.
  enum class Visibility { sampled, traced } visibility = Visibility::sampled;
  double rho = 0.01;
  bool prediction = true;
  enum class Predictors { all, nearest, plane, bayes } predictors = Predictors::all;
  enum class Draw { random, likely, mean } draw = Draw::random;
  bool calibration = true;
  double prediction_error = 0.1;
  bool weighted = true;
  std::size_t rounds = 20;
  double uncertain = 0.003, bright = 0.03;
  // Recovery.
  bool separation = true, constraint = true;
  enum class Separated { visibility, shading } separated = Separated::visibility;
  linalg::SeparationSettings::Fit fit = linalg::SeparationSettings::Fit::all;
  std::size_t rank = 16, iterations = 4;
  bool correction = true;
  double density = 0.4;
  std::uint64_t redraws = 0;  // a turn's number: each has other representatives

  // So much finer, or coarser: see turns.h.
  RecoverySettings at(const Turn& turn) const;
};

const Fields<RecoverySettings>& recovery_fields();
// Of these, what clusters depend on.
const Fields<RecoverySettings>& slice_cut_fields();

}  // namespace lumirank::methods
