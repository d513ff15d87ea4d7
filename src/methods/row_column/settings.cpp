#include "methods/row_column/settings.h"

namespace lumirank::methods {

const Fields<RowColumnSettings>& row_column_fields() {
  using S = RowColumnSettings;
  static const Fields<S> fields{
      count_field<S>({"rows", "rows",
                      "Receivers whose whole row is evaluated; 0: chosen automatically. Costs one entry per "
                      "column each."},
                     &S::rows, 0, kMaxRows),
      count_field<S>(
          {"columns", "columns",
           "Clusters, each rendered by one representative; 0: chosen automatically, for the target. Costs "
           "one entry per "
           "receiver each; as many as there are columns: all are rendered, which is exact."},
          &S::columns, 0, kMaxColumns),
      count_field<S>({"projection", "dimensions",
                      "Dimensions to which reduced columns are projected for clustering; 0: none. Time and "
                      "memory of the "
                      "clustering are in proportion."},
                     &S::projection, 0, 1000),
      choice_field<S>({"row-weights", "",
                       "What a row that was read counts for where columns are clustered. light: as it is, so "
                       "bright receivers "
                       "decide; eye: over its own light and a little, so that a room beside a stripe of sun "
                       "counts as well."},
                      &S::row_weights, {"light", "eye"}),
      choice_field<S>({"clustering", "",
                       "combined: some by sampling (two thirds; two fifths of many), the rest by splitting; "
                       "or one of them alone."},
                      &S::clustering, {"combined", "sampling", "splitting"}),
      choice_field<S>({"color", "",
                       "averaged: a representative gets its cluster's total color (less color noise, a "
                       "little bias); scalar: "
                       "one factor for all channels (unbiased)."},
                      &S::color, {"averaged", "scalar"}),
      choice_field<S>({"zero-columns", "",
                       "Columns that are zero on all sampled rows. sample: a few drawn by power, unbiased; "
                       "ignore: taken as zero "
                       "everywhere, as in the paper (biased, less noise)."},
                      &S::zero_columns, {"sample", "ignore"}),
      number_field<S>(
          {"zero-share", "of columns", "How many of them are drawn, as a share of `columns`; at least one."},
          &S::zero_share, 0, 1),
      number_field<S>(
          {"power-share", "",
           "Share of a representative's probability that follows its light's power instead of "
           "its effect on the "
           "sampled rows; 0: none, as in the paper. Guards against lights that matter only "
           "between sampled rows. Where rows or columns are automatic, held-out rows may choose another."},
          &S::power_share, 0, 1),
      number_field<S>(
          {"max-contribution", "of the hemisphere",
           "A representative stands for its cluster's lights and so for their area; near it, it may not "
           "show more than this share of what would fill the receiver's view. Keeps specks away, and takes "
           "a little light from corners that more columns give back; 0: no bound, unbiased."},
          &S::max_contribution, 0, 1e9)};
  return fields;
}

}  // namespace lumirank::methods
