// For every slice of rows its own clusters of columns, each with one column that stands for it (Ou and
// Pellacini 2011, sections 4.2 to 4.4). One row of each slice is read whole. By all of these rows the columns
// are clustered once, as in row-column sampling; each slice then splits these clusters further, by its own
// row and those of the slices nearest to it alone.
//
// Ours: the paper draws who stands for a cluster by norms over all rows that were read, and gives it the
// cluster's whole norm there. Here the norms are those over the slice's own few rows, with a share for the
// others (global-share), so that a column which is bright elsewhere does not stand for one that is bright
// here. Cuts are the best of 31 along the line between the two members that differ most; the paper's is the
// middle.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "linalg/local_splitter.h"
#include "linalg/partition.h"
#include "linalg/short_rows.h"
#include "methods/row_column/exploration.h"
#include "methods/row_column/settings.h"
#include "methods/slices/slices.h"

namespace lumirank::methods {

struct SliceLightSettings {
  std::size_t columns = 300;         // of a slice
  std::size_t initial_clusters = 0;  // 0: three tenths of `columns`
  std::size_t neighbours = 8;        // slices by which one is refined, itself among them
  std::size_t slice_rows = 0;        // at most; 0: as many as cost a slice as much as its row
  std::size_t projection = 50;
  ColourMode colour = ColourMode::averaged;
  ZeroColumns zero_columns = ZeroColumns::sample;
  double zero_share = 0.02;
  double global_share = 0.1;
};

// The fields of the settings of a method with slices, S derived from SliceLightSettings.
template <typename S>
Fields<S> slice_light_fields() {
  return {
      count_field<S>({"columns", "columns",
                      "Columns of a slice: clusters, each with one that stands for it. Costs one entry per "
                      "receiver each; as many as there are columns is exact."},
                     &S::columns, 1),
      count_field<S>({"slice-rows", "rows",
                      "Receivers of a slice, at most; 0: as many as cost a slice's columns as much as its "
                      "row, one entry per column."},
                     &S::slice_rows, 0),
      count_field<S>({"initial-clusters", "clusters",
                      "Of all columns by the rows of all slices, before slices split them further; 0: three "
                      "tenths of `columns`."},
                     &S::initial_clusters, 0),
      count_field<S>({"neighbours", "slices",
                      "Slices by whose rows one splits its clusters: the nearest, itself among them. Time of "
                      "the clustering is in proportion."},
                     &S::neighbours, 1),
      count_field<S>({"projection", "dimensions",
                      "Dimensions to which columns are projected for the clusters of all slices; 0: none."},
                     &S::projection, 0),
      choice_field<S>({"colour", "",
                       "averaged: who stands for a cluster gets its total colour; scalar: one factor for all "
                       "channels (unbiased)."},
                      &S::colour, {"averaged", "scalar"}),
      choice_field<S>({"zero-columns", "",
                       "Columns that are zero on all rows that a slice looks at. sample: a few drawn by "
                       "power, unbiased; ignore: taken as zero in the slice (biased, less noise)."},
                      &S::zero_columns, {"sample", "ignore"}),
      number_field<S>(
          {"zero-share", "of columns", "How many of them are drawn, as a share of `columns`; at least one."},
          &S::zero_share, 0, 1),
      number_field<S>({"global-share", "",
                       "Share of the choice of who stands for a cluster that goes by the rows of all slices "
                       "instead of by the slice's own few."},
                      &S::global_share, 0, 1)};
}

class SliceLights {
 public:
  // Reads the rows and clusters by all of them. `row_sum`: filled for every row of the matrix with the exact
  // sum at its slice's row. Where cancelled in between, ready() is false.
  SliceLights(const matrix::LightingMatrix& matrix, const RunOptions& options,
              const SliceLightSettings& settings, std::span<Rgb> row_sum);

  bool ready() const { return ready_; }
  const Slices& slices() const { return slices_; }
  const KnownRows& known() const { return exploration_.known(); }
  // Bytes that stay: the rows that were read, at two bytes an entry, and four norms per column.
  std::size_t memory_bytes() const;
  double seconds_rows() const { return seconds_rows_; }
  double seconds_clustering() const { return seconds_clustering_; }

  struct Workspace {
    linalg::LocalSplitter splitter;
    std::vector<float> entries, point, chance;
    std::vector<matrix::Index> zero;
    std::vector<matrix::ScaledColumn> chosen;
  };
  // The columns of a slice: at most `columns` of them, into workspace.chosen; all columns where there are no
  // more. A function of (seed, slice) alone. One thread.
  void choose(std::size_t slice, Workspace& workspace) const;

 private:
  void read_rows(const RunOptions& options, std::span<Rgb> row_sum);
  void find_neighbours();
  void cluster();
  void gather(std::size_t slice, Workspace& workspace) const;
  matrix::ScaledColumn draw(std::size_t slice, std::size_t cluster, double local_sum, double global_sum,
                            Workspace& workspace) const;

  const matrix::LightingMatrix& matrix_;
  SliceLightSettings settings_;
  std::uint64_t seed_;
  Slices slices_;
  Exploration exploration_;
  linalg::ShortRows rows_;  // one per slice, columns in the order of initial_
  linalg::Partition initial_;
  std::vector<matrix::Index> dark_;  // columns that are zero on all rows
  struct Norms {
    float all, channel[3];  // the channels relative to all
  };
  std::vector<Norms> norms_;               // over all rows, per column
  std::vector<std::uint32_t> neighbours_;  // per slice, itself first
  std::size_t neighbour_count_ = 0;
  double seconds_rows_ = 0, seconds_clustering_ = 0;
  bool ready_ = false;
};

}  // namespace lumirank::methods
