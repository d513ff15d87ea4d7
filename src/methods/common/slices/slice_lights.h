// For every slice of rows its own clusters of columns, each with one representative
// (Ou and Pellacini 2011, sections 4.2 to 4.4). One row of each slice is read whole. By all of these rows the
// columns are clustered once, as in row-column sampling; each slice then splits these clusters further, by
// its own row and those of the slices nearest to it alone.
//
// Ours: nearer slices count for more, the k-th as 1/(k + 1), so that twice the paper's eight can be read:
// fewer columns are zero on all of them. The paper draws representatives by norms over all rows that were
// read, and gives it the cluster's whole norm there. Here the norms are those over the slice's own few rows,
// with a share for the others (global-share), so that a column which is bright elsewhere does not represent
// one that is bright here. What one column adds can be bounded where it represents others (max-sum-share).
// Cuts are the best of 31 along the line between the two members that differ most; the paper's is the middle.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "linalg/local_splitter.h"
#include "linalg/partition.h"
#include "linalg/short_rows.h"
#include "methods/common/cluster_settings.h"
#include "methods/common/reduced_matrix.h"
#include "methods/common/slices/slices.h"
#include "methods/parameters.h"

namespace lumirank::methods {

struct SliceLightSettings {
  std::size_t columns = 300;         // of a slice
  std::size_t initial_clusters = 0;  // 0: three tenths of `columns`
  std::size_t neighbors = 16;        // slices by which one is refined, itself among them
  std::size_t slice_rows = 0;        // at most; 0: as many as cost a slice as much as its row
  std::size_t projection = 50;
  ColorMode color = ColorMode::averaged;
  ZeroColumns zero_columns = ZeroColumns::sample;
  double zero_share = 0.02;
  double global_share = 0.1;
  double max_sum_share = 0;
  double enough = 0;  // of a slice's light: no more columns once its clusters err by less; 0: all `columns`
  double overlap = 0.05;  // see SliceOverlap
};

const Fields<SliceLightSettings>& slice_light_fields();
// The same for a method whose settings S are these and more, with another default of `columns`.
template <typename S>
Fields<S> with_slice_light_fields(Fields<S> others) {
  auto all = inherited_fields<S>(slice_light_fields());
  all.front().info.default_text = std::to_string(S{}.columns);
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

class SliceLights {
 public:
  // row_seconds: what a row takes, where that is known; else 0. Reads the rows and clusters by all of them.
  // `row_sum`: filled for every row of the matrix with the exact sum at its slice's row. Where cancelled in
  // between, or out of time (the timed choice "slice_rows"), ready() is false. Under --time there are as many
  // slices, rows and clusters as a few rows show to fit (the timed choice "slices").
  SliceLights(const matrix::LightingMatrix& matrix, const RunOptions& options, const RunClock& clock,
              double row_seconds, const SliceLightSettings& settings, std::span<Rgb> row_sum);

  bool ready() const { return ready_; }
  // Columns of a slice, and the least that the clusters of all slices allow.
  std::size_t columns() const { return settings_.columns; }
  std::size_t min_columns() const { return initial_.clusters() + 1; }
  // From now on, but no fewer than those; and what is drawn is another turn's (0 at first).
  void set_turn(std::size_t columns, std::uint64_t turn);
  const Slices& slices() const { return slices_; }
  const ExactRows& known() const { return reduced_.known(); }
  // Bytes that stay: the rows that were read, at two bytes an entry, and four norms per column.
  std::size_t memory_bytes() const;
  double seconds_rows() const { return seconds_rows_; }
  double seconds_clustering() const { return seconds_clustering_; }

  struct Workspace {
    linalg::LocalSplitter splitter;
    std::vector<float> entries, point, chance;
    std::vector<matrix::Index> zero;
    std::vector<matrix::ScaledColumn> chosen;
    std::size_t zero_draws = 0;            // of these, at the end
    double local_sum = 0, global_sum = 0;  // of norms, over all lit columns of the slice
    // A column that represents others may not add more than this to a row (2-norm); 0: no bound.
    float max_added = 0;
    // What a chosen column adds where its entry is `entry`.
    Rgb added(const matrix::ScaledColumn& column, Rgb entry) const {
      const Rgb scaled = column.scale * entry;
      if (!(max_added > 0)) return scaled;
      const float limit = std::max(max_added, norm2(entry)), own = norm2(scaled);
      return own > limit ? scaled * (limit / own) : scaled;
    }
  };
  // The columns of a slice: at most `columns` of them, into workspace.chosen; all columns where there are no
  // more. A function of (seed, slice) alone, whatever the order of columns within a cluster. One thread.
  void choose(std::size_t slice, Workspace& workspace) const;
  // After choose(slice): other representatives of the same clusters, of drawing 1, 2, …; independent of each
  // other.
  void redraw(std::size_t slice, std::uint64_t drawing, Workspace& workspace) const;

 private:
  bool read_rows(const RunOptions& options, const RunClock& clock, std::span<Rgb> row_sum);
  void find_neighbors();
  void cluster();
  void gather(std::size_t slice, Workspace& workspace) const;
  matrix::ScaledColumn draw(std::uint64_t key, std::size_t cluster, Workspace& workspace) const;

  const matrix::LightingMatrix& matrix_;
  SliceLightSettings settings_;
  std::span<const std::uint64_t> ids_;  // of columns
  std::uint64_t seed_, turn_seed_;
  Slices slices_;
  ReducedMatrix reduced_;
  linalg::ShortRows rows_;  // one per slice, columns in the order of initial_
  linalg::Partition initial_;
  std::vector<matrix::Index> dark_;  // columns that are zero on all rows
  struct Norms {
    float all, channel[3];  // the channels relative to all
  };
  std::vector<Norms> norms_;              // over all rows, per column
  std::vector<std::uint32_t> neighbors_;  // per slice, itself first
  std::size_t neighbor_count_ = 0;
  double seconds_rows_ = 0, seconds_clustering_ = 0;
  bool ready_ = false;
};

}  // namespace lumirank::methods
