// The sums of one slice of rows over all columns: adaptive sampling of columns and their completion (Huo et
// al. 2016, section 5, algorithms 1 and 2).
#pragma once

#include <cstdint>
#include <queue>
#include <span>
#include <unordered_map>
#include <vector>

#include "base/random.h"
#include "linalg/column_space.h"
#include "matrix/entry_reader.h"
#include "methods/column_completion/column_draws.h"
#include "methods/column_completion/column_tree.h"

namespace lumirank::methods {

struct CompletionSpaceSettings {
  double rho = 0;        // of a column's rows that are sampled; 0: found for each slice
  double sigma = 0.005;  // of the slice's light that completion may miss in what a column stands for
  double beta = 0.01;    // of the slice's light by which a node's columns may err
  std::size_t samples = 10;
  std::size_t asked = 8;  // rows of a slice that tell first what coarse nodes bring; the paper: 0
};

// Deviations from the paper, and why (docs/participating-media.md has the measurements):
// - Norms are Euclidean, since the basis is orthonormal and coordinates then have the norm of the column; the
//   paper's are sums of absolute values. Equation 17 is a square and is compared with a norm; here its root,
//   the standard error of the mean, is.
// - Equation 16: what a column may miss is measured by what it stands for, its share of a node's power
//   included: its own light alone is never much of all.
// - A column is judged by rows that took no part in its fit, each foretold by the others; a residual over the
//   rows that were fitted would be 0 when the space has as many directions as there are rows.
// - Points and rays have spaces of their own (the paper's sub-matrices), and share the measure of light.
// - The rows in which columns are sampled (algorithm 2, ρ) stay until more of them are needed: the paper
//   draws and factors them anew for every direction. How many is found, with an end for each direction.
// - Columns are drawn by what a few rows were found to get (column_draws.h), and those of a node that lie in
//   one of its children are draws of the child as well, which needs so many less.
// - The columns that decide whether a node is divided give no light: dark ones let it seem well known, and a
//   tenth of the light in fog was lost. It is drawn anew once the cut is known.
// - Columns of strong emitters are summed in all rows: they keep places of their own for every pair, so no
//   space foretells them, and as directions they left white specks.
// - Slices and the tree are by place, not by the graphs of sections 4.2 and 4.3 (figure 6): these gave spaces
//   with more directions and no less error. They are the experiments `partition` and `tree`.
// - A node with no more columns than would be drawn gets them all. The first nodes are divided by power.
class SliceEstimate {
 public:
  SliceEstimate(const ColumnTree& tree, const matrix::RowFeatures& features,
                const CompletionSpaceSettings& settings)
      : tree_(tree),
        settings_(settings),
        draws_(tree, features, settings.asked),
        kinds_(tree.roots().size()) {}

  // Writes sums[i] of all `rows`. `quality`: both tolerances are divided by it. `seed`: of the rows drawn.
  void run(std::span<const matrix::Index> rows, matrix::EntryReader& reader, double quality,
           std::uint64_t seed, std::span<Rgb> sums);

  struct Counts {
    std::uint64_t slices = 0, nodes = 0, columns = 0, dense = 0, entries = 0, rank = 0, max_rank = 0,
                  sampled_rows = 0, max_entries_per_row = 0;
  };
  const Counts& counts() const { return counts_; }

 private:
  using Node = ColumnTree::Node;
  // Columns that were completed already, by their coordinates.
  struct Kind {
    linalg::ColumnSpace space;
    std::vector<std::uint32_t> sampled;  // rows, by place in the slice
    std::size_t wanted = 0;              // rows to be sampled
    std::unordered_map<matrix::Index, std::vector<float>> known;
    std::vector<double> total;  // coordinates of all nodes of the cut
  };
  struct Estimated {
    Node node;
    std::uint32_t kind;
    double error;
    std::vector<double> sum;  // coordinates
    std::vector<ColumnDraws::Drawn> drawn;
    friend bool operator<(const Estimated& a, const Estimated& b) {
      return a.error != b.error ? a.error < b.error : a.node > b.node;
    }
  };

  // `parent`: whose draws among the node's columns are draws of the node; may be nullptr.
  Estimated estimate(Node node, std::uint32_t kind, const Estimated* parent);
  const std::vector<float>& complete(matrix::Index j, double scale, Kind& kind);
  const std::vector<float>& sample_wholly(matrix::Index j, Kind& kind);
  void add_strong_emitters();
  void draw_rows(Kind& kind, std::size_t count);
  double light() const;
  void refine();
  void draw_again(const Estimated& e);
  void write(std::span<Rgb> sums);

  const ColumnTree& tree_;
  CompletionSpaceSettings settings_;
  ColumnDraws draws_;
  // Of the slice that is being estimated.
  std::span<const matrix::Index> rows_;
  matrix::EntryReader* reader_ = nullptr;
  double sigma_ = 0, beta_ = 0;
  Rng rng_{0, Stage::method};
  std::vector<Kind> kinds_;
  std::vector<Rgb> emitters_;  // by row of the slice: sums of the tree's strong emitters
  double emitters_square_ = 0;
  std::priority_queue<Estimated> queue_;
  std::uint64_t entries_ = 0;
  // Work space.
  std::vector<Rgb> values_;
  std::vector<matrix::Index> columns_;
  std::vector<float> numbers_, coordinates_;
  Counts counts_;
};

}  // namespace lumirank::methods
