#include "methods/sampling_recovery/settings.h"

#include <algorithm>

namespace lumirank::methods {

RecoverySettings RecoverySettings::at(const Turn& turn) const {
  RecoverySettings s = *this;
  s.redraws = turn.number;
  s.initial_columns = turn.scaled(initial_columns);
  s.most_columns = turn.scaled(most_columns);
  s.alpha = std::min(1.0, alpha / turn.quality);
  return s;
}

const Fields<RecoverySettings>& recovery_fields() {
  using S = RecoverySettings;
  const std::vector<std::string> off_on{"off", "on"};
  static const Fields<S> fields{
      choice_field<S>(
          {"parameters", "",
           "automatic: alpha, rho, prediction-error, uncertain and initial-columns are found on a "
           "few slices so that the target error is met (3 % where none is given); given: they are "
           "taken as set; by-target: automatic if a target error is given."},
          &S::parameters, {"by-target", "given", "automatic"}),
      count_field<S>(
          {"slice-rows", "pixels",
           "Most pixels of a slice, whose columns are chosen and recovered together. Larger slices "
           "share their columns' choice among more pixels, and have a higher rank."},
          &S::slice_rows, 1, kMostRows),
      choice_field<S>(
          {"clusters", "",
           "How a slice's lights are clustered. bounds: by bounds and sampled contributions, over "
           "the light tree, as in the paper; rows: by one whole row of each slice, as LightSlice "
           "does."},
          &S::clusters, {"bounds", "rows"}),
      count_field<S>({"columns", "columns", "Clusters of a slice where they are by rows."}, &S::columns, 1,
                     kMostColumns),
      count_field<S>({"neighbours", "slices", "Slices by whose rows one clusters, itself among them."},
                     &S::neighbours, 1, 1000),
      count_field<S>({"initial-columns", "columns",
                      "Clusters of lights that a slice begins with, by bounds without visibility."},
                     &S::initial_columns, 1, kMostColumns),
      count_field<S>({"most-columns", "columns", "Where splitting ends at the latest."}, &S::most_columns, 1,
                     kMostColumns),
      choice_field<S>({"splitting", "", "Whether clusters are split by their greatest contribution."},
                      &S::splitting, off_on),
      number_field<S>({"alpha", "of all clusters' greatest contributions",
                       "Clusters above this share are split; 0: all, down to single lights."},
                      &S::alpha, 0, 1),
      choice_field<S>(
          {"sparse-visibility", "", "Whether clusters that a few shadow rays do not see are left unsplit."},
          &S::sparse_visibility, off_on),
      count_field<S>(
          {"scouts", "pixels",
           "Of a slice, evenly spread, by which its clusters are chosen; 0: all of them, as in the "
           "paper. Without redraw always all."},
          &S::scouts, 0, kMostRows),
      choice_field<S>(
          {"redraw", "",
           "Whether clusters, once they are chosen, get other representatives than those by "
           "which they were: those stayed unsplit for being dark. Unbiased, and a little noisier."},
          &S::redraw, off_on),
      number_field<S>(
          {"rho", "of a column's entries",
           "How many visibilities are sampled at a time, at least four: for splitting, and where the others "
           "are predicted in each round of that. 1: all."},
          &S::rho, 0, 1),
      choice_field<S>({"prediction", "",
                       "Whether visibilities in between are predicted. off: they are taken as visible, after "
                       "five rounds of samples."},
                      &S::prediction, off_on),
      choice_field<S>({"predictors", "", "Which may be chosen for a column."}, &S::predictors,
                      {"all", "nearest", "plane", "bayes"}),
      choice_field<S>(
          {"draw", "",
           "random: predictions are drawn by their probability, so that errors have no structure; "
           "likely: the likelier one; mean: none is drawn where nothing is separated, else random."},
          &S::draw, {"random", "likely", "mean"}),
      choice_field<S>(
          {"calibration", "", "Whether probabilities are what the slice's tests found them to be worth."},
          &S::calibration, off_on),
      number_field<S>({"prediction-error", "of the new samples",
                       "A column is sampled on until its best predictor is wrong at less than this share of "
                       "the samples that it has not seen."},
                      &S::prediction_error, 0, 1),
      choice_field<S>({"weighted", "",
                       "Whether columns brighter than the mean may be wrong so much less often; off: all as "
                       "often, as in the paper."},
                      &S::weighted, off_on),
      count_field<S>({"rounds", "rounds", "Of sampling and validation, at most."}, &S::rounds, 1, 10'000),
      number_field<S>(
          {"uncertain", "of a pixel's light",
           "Entries whose prediction is expected to be wrong by more than this are sampled as well; "
           "0: none, as in the paper."},
          &S::uncertain, 0, 1),
      number_field<S>(
          {"bright", "of a slice's unoccluded light",
           "Columns above this share are looked at wholly: the sun, lamps close by; 0: none, as in "
           "the paper."},
          &S::bright, 0, 1),
      choice_field<S>({"separation", "",
                       "Whether the predicted matrix is separated into one of low rank and sparse errors."},
                      &S::separation, off_on),
      choice_field<S>({"separated", "",
                       "visibility: the matrix of 0s and 1s; shading: the same times the unoccluded "
                       "contributions, as in the paper, whose own rank then counts too."},
                      &S::separated, {"visibility", "shading"}),
      choice_field<S>({"constraint", "",
                       "Whether the separation uses that an error is all of an entry or nothing (equation "
                       "12)."},
                      &S::constraint, off_on),
      choice_field<S>({"fit", "",
                       "all: predictions count, and may be sparsely wrong; exact: the sampled entries alone, "
                       "as the paper prints it."},
                      &S::fit, {"all", "exact"}),
      count_field<S>({"rank", "", "Of the recovered matrix, at most (and at most 24)."}, &S::rank, 1, 1000),
      count_field<S>({"iterations", "", "Of the separation, at most."}, &S::iterations, 1, 10'000),
      choice_field<S>(
          {"correction", "", "Whether entries are sampled where the separation's errors are dense."},
          &S::correction, off_on),
      number_field<S>({"density", "of entries", "What counts as dense there."}, &S::density, 0, 1)};
  return fields;
}

const Fields<RecoverySettings>& slice_cut_fields() {
  static const Fields<RecoverySettings> fields = [] {
    const std::vector<std::string> of_clusters{"slice-rows",        "clusters",     "columns",   "neighbours",
                                               "initial-columns",   "most-columns", "splitting", "alpha",
                                               "sparse-visibility", "scouts",       "redraw",    "rho"};
    Fields<RecoverySettings> some;
    for (const auto& field : recovery_fields())
      if (std::ranges::find(of_clusters, field.info.key) != of_clusters.end()) some.push_back(field);
    return some;
  }();
  return fields;
}

}  // namespace lumirank::methods
