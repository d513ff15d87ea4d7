// Settings of matrix sampling and recovery, beside those of the cuts of slices. Defaults are those of the
// paper (section 7.1), but for the separation's iterations (20 there, with no gain over four here). What is
// ours (calibration, weighted, uncertain, bright) is explained in docs/sampling-recovery.md.
#pragma once

#include "linalg/separation.h"
#include "methods/slice_cuts/settings.h"

namespace lumirank::methods {

struct RecoverySettings : SliceCutSettings {
  RecoverySettings() { drawings = 0; }  // see drawings_of()
  enum class Parameters { by_target, given, automatic } parameters = Parameters::by_target;
  // Prediction.
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
};

const Fields<RecoverySettings>& recovery_fields();

}  // namespace lumirank::methods
