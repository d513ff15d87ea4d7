#include "methods/slice_cuts/settings.h"

#include <algorithm>
#include <cmath>

#include "methods/common/slices/slice_fields.h"

namespace lumirank::methods {

void SliceCutSettings::refine(const Turn& turn) {
  redraws = turn.number;
  initial_columns = turn.scaled(initial_columns);
  max_columns = turn.scaled(max_columns);
  alpha = std::min(1.0, alpha / turn.quality);
  // Where time is short, clusters are coarse, and coherent rays are worth more of them.
  drawings = std::min(drawings, turn.scaled(drawings));
}

std::size_t SliceCutSettings::samples(std::size_t rows) const {
  return static_cast<std::size_t>(std::max(4.0, std::ceil(rho * static_cast<double>(rows))));
}

const Fields<SliceCutSettings>& slice_cut_fields() {
  using S = SliceCutSettings;
  const std::vector<std::string> off_on{"off", "on"};
  static const Fields<S> fields{
      count_field<S>(
          {"slice-rows", "pixels",
           "Most pixels of a slice, whose columns are chosen and recovered together. Larger slices "
           "share their columns' choice among more pixels, and have a higher rank."},
          &S::slice_rows, 1, kMaxRows),
      count_field<S>({"initial-columns", "columns",
                      "Clusters of lights that a slice begins with, by bounds without visibility."},
                     &S::initial_columns, 1, kMaxColumns),
      count_field<S>({"max-columns", "columns", "Where splitting ends at the latest."}, &S::max_columns, 1,
                     kMaxColumns),
      experiment(
          choice_field<S>({"splitting", "", "Whether clusters are split by their greatest contribution."},
                          &S::splitting, off_on)),
      number_field<S>({"alpha", "of all clusters' greatest contributions",
                       "Clusters above this share are split; 0: all, down to single lights."},
                      &S::alpha, 0, 1),
      experiment(choice_field<S>(
          {"sparse-visibility", "", "Whether clusters that a few shadow rays do not see are left unsplit."},
          &S::sparse_visibility, off_on)),
      count_field<S>(
          {"cut-pixels", "pixels",
           "Of a slice, evenly spread, by which its clusters are chosen; 0: all of them, as in the "
           "paper. Without redraw always all."},
          &S::cut_pixels, 0, kMaxRows),
      experiment(choice_field<S>(
          {"redraw", "",
           "Whether clusters, once they are chosen, get other representatives than those by "
           "which they were: those stayed unsplit for being dark. Unbiased, and a little noisier."},
          &S::redraw, off_on)),
      number_field<S>({"rho", "of a column's entries",
                       "How many visibilities are sampled at a time, at least four. 1: all."},
                      &S::rho, 0, 1),
      slice_overlap_field<S>(&S::overlap)};
  return fields;
}

}  // namespace lumirank::methods
