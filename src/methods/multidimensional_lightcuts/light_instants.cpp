#include "methods/multidimensional_lightcuts/light_instants.h"

#include "base/parallel.h"
#include "methods/multidimensional_lightcuts/race.h"

namespace lumirank::methods {

using matrix::Index;

namespace {

LightInstants::Part joined_part(const LightInstants::Part& a, const LightInstants::Part& b) {
  LightInstants::Part part = a;
  if (b.turn < a.turn) part.turn = b.turn, part.representative = b.representative;
  part.columns += b.columns, part.power += b.power;
  part.emitted += b.emitted, part.intensity += b.intensity, part.ceiling += b.ceiling;
  return part;
}

}  // namespace

LightInstants::LightInstants(const LightTree& tree, const matrix::LightingMatrix& matrix)
    : tree_(tree), stretch_(tree.leaves()), of_column_(matrix.columns()) {
  const matrix::ColumnFeatures features = matrix.column_features();
  parallel_for(of_column_.size(), 1 << 12, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto j = static_cast<Index>(k);
      const matrix::ColumnSet set = matrix.column_set(j);
      const std::uint64_t bits =
          hash_ids(tree.seed(), Stage::representatives, matrix::id_of(features.id, j), 2);
      of_column_[k] = {features.instant[k],
                       1,
                       j,
                       race_turn(bits, tree.power_of(j)),
                       tree.power_of(j),
                       tree.emitted_of(j),
                       set.intensity,
                       set.ceiling};
    }
  });
  for (const LightTree::Node root : tree.roots()) join_children(root);
}

void LightInstants::join_children(LightTree::Node node) {
  if (tree_.is_leaf(node)) return;
  join_children(tree_.left(node)), join_children(tree_.right(node));
  const auto left = parts(tree_.left(node)), right = parts(tree_.right(node));
  std::vector<Part> joined;
  auto a = left.begin(), b = right.begin();
  while (a != left.end() || b != right.end()) {
    if (b == right.end() || (a != left.end() && a->instant < b->instant))
      joined.push_back(*a++);
    else if (a == left.end() || b->instant < a->instant)
      joined.push_back(*b++);
    else
      joined.push_back(joined_part(*a++, *b++));
  }
  stretch_[node] = {of_nodes_.size(), joined.size()};
  of_nodes_.insert(of_nodes_.end(), joined.begin(), joined.end());
}

}  // namespace lumirank::methods
