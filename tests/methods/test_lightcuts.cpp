#include <gtest/gtest.h>

#include "methods/cut_matrices.h"
#include "methods/lightcuts/cut.h"

namespace lumirank::methods {
namespace {

using matrix::DenseMatrix;
using matrix::Index;

TEST(Lightcuts, WithoutBoundAndLimitEqualsBruteForce) {
  for (const DenseMatrix& m : test::cut_matrices()) {
    const Estimate e = find_method("lightcuts")
                           .make({{"error-bound", "0"}, {"max-nodes", "1000000"}, {"reconstruction", "off"}})
                           ->run(m, {});
    // Sums of 300 floats in another order.
    EXPECT_LT(relative_difference(e.sums, m.exact_sums()), 1e-6);
  }
}

TEST(Lightcuts, ErrorFallsToNothingAsCutsGrow) {
  test::expect_error_falls_to_nothing("lightcuts", {{"error-bound", "0"}, {"reconstruction", "off"}},
                                      "max-nodes", {"5", "75", "1000"});
}

// What refining one node after another would reach is reached by rounds as well: every node on the cut has a
// bound below the threshold, or the cut is full.
TEST(Lightcuts, CutsEndWhereBoundsAreSmallOrTheLimitIsReached) {
  const DenseMatrix m = matrix::low_rank_matrix({60, 800, 1}, 6);
  const LightTree tree(m, 1);
  const auto reader = m.reader();
  const auto bounds = m.row_bounds();
  for (const std::size_t per_round : {1u, 7u, 32u})
    for (const std::size_t max_columns : {40u, 100000u}) {
      std::vector<Cut> cuts;
      for (Index row = 0; row < 5; ++row) {
        cuts.emplace_back(tree, CutLimits{0.02, max_columns, per_round});
        cuts.back().begin(row, *bounds);
      }
      CutRounds rounds;
      rounds.finish(cuts, *reader);
      for (const Cut& cut : cuts) {
        const float limit = 0.02f * luminance(cut.total());
        std::size_t on_cut = 0, columns = 0;
        float max_bound = 0;
        for (const CutNode& n : cut.nodes()) {
          EXPECT_EQ(n.entry, m.at(cut.row(), tree.representative(n.node)));
          if (n.children != 0) continue;
          ++on_cut, columns += tree.columns(n.node).size();
          if (!tree.is_leaf(n.node))
            max_bound = std::max(max_bound, luminance(bounds->bound(tree.set(n.node))));
        }
        EXPECT_EQ(on_cut, cut.size());
        EXPECT_EQ(columns, tree.leaves());  // it is a cut
        EXPECT_LE(on_cut, max_columns);
        if (on_cut < max_columns) {
          EXPECT_LE(max_bound, 1.00001f * limit);
        }
      }
    }
}

}  // namespace
}  // namespace lumirank::methods
