#include "methods/sampling_recovery/settings.h"

#include "methods/common/slices/slice_fields.h"

#include <utility>

namespace lumirank::methods {

namespace {

Fields<RecoverySettings> prediction_fields() {
  using S = RecoverySettings;
  const std::vector<std::string> off_on{"off", "on"};
  return {
      experiment(choice_field<S>(
          {"prediction", "",
           "Whether visibilities in between are predicted. off: they are taken as visible, after "
           "five rounds of samples."},
          &S::prediction, off_on)),
      experiment(choice_field<S>({"predictors", "", "Which may be chosen for a column."}, &S::predictors,
                                 {"all", "nearest", "plane", "bayes"})),
      experiment(choice_field<S>(
          {"draw", "",
           "random: predictions are drawn by their probability, so that errors have no structure; "
           "likely: the likelier one; mean: none is drawn where nothing is separated, else random."},
          &S::draw, {"random", "likely", "mean"})),
      experiment(choice_field<S>(
          {"calibration", "", "Whether probabilities are what the slice's tests found them to be worth."},
          &S::calibration, off_on)),
      number_field<S>({"prediction-error", "of the new samples",
                       "A column is sampled on until its best predictor is wrong at less than this share of "
                       "the samples that it has not seen."},
                      &S::prediction_error, 0, 1),
      experiment(choice_field<S>(
          {"weighted", "",
           "Whether columns brighter than the mean may be wrong so much less often; off: all as "
           "often, as in the paper."},
          &S::weighted, off_on)),
      count_field<S>({"rounds", "rounds", "Of sampling and validation, at most."}, &S::rounds, 1, 10'000),
      number_field<S>(
          {"uncertain", "of a pixel's light",
           "Entries whose prediction is expected to be wrong by more than this are sampled as well; "
           "0: none, as in the paper."},
          &S::uncertain, 0, 1),
      number_field<S>({"bright", "of a slice's unoccluded light",
                       "Columns above this share are sampled wholly: the sun, lamps close by; 0: none, as in "
                       "the paper."},
                      &S::bright, 0, 1)};
}

Fields<RecoverySettings> separation_fields() {
  using S = RecoverySettings;
  const std::vector<std::string> off_on{"off", "on"};
  return {
      experiment(choice_field<S>(
          {"separation", "",
           "Whether the predicted matrix is separated into one of low rank and sparse errors."},
          &S::separation, off_on)),
      experiment(
          choice_field<S>({"separated", "",
                           "visibility: the matrix of 0s and 1s; shading: the same times the unoccluded "
                           "contributions, as in the paper, whose own rank then counts too."},
                          &S::separated, {"visibility", "shading"})),
      experiment(choice_field<S>(
          {"constraint", "",
           "Whether the separation uses that an error is all of an entry or nothing (equation "
           "12)."},
          &S::constraint, off_on)),
      experiment(choice_field<S>(
          {"fit", "",
           "all: predictions count, and may be sparsely wrong; exact: the sampled entries alone, "
           "as the paper prints it."},
          &S::fit, {"all", "exact"})),
      count_field<S>({"rank", "", "Of the recovered matrix, at most (and at most 24)."}, &S::rank, 1, 1000),
      count_field<S>({"iterations", "", "Of the separation, at most."}, &S::iterations, 1, 10'000),
      experiment(choice_field<S>(
          {"correction", "", "Whether entries are sampled where the separation's errors are dense."},
          &S::correction, off_on)),
      number_field<S>({"density", "of entries", "What counts as dense there."}, &S::density, 0, 1)};
}

}  // namespace

const Fields<RecoverySettings>& recovery_fields() {
  using S = RecoverySettings;
  static const Fields<S> fields = [] {
    Fields<S> all{choice_field<S>(
        {"parameters", "",
         "automatic: alpha, rho, prediction-error, uncertain and initial-columns are found on a "
         "few slices so that the target error is met (3 % where none is given); given: they are "
         "taken as set; by-target: automatic if a target error is given."},
        &S::parameters, {"by-target", "given", "automatic"})};
    for (auto& field : inherited_fields<S>(slice_cut_fields())) all.push_back(std::move(field));
    all.push_back(drawings_field<S>(&S::drawings));
    for (auto& field : prediction_fields()) all.push_back(std::move(field));
    for (auto& field : separation_fields()) all.push_back(std::move(field));
    return all;
  }();
  return fields;
}

}  // namespace lumirank::methods
