#include "methods/column_completion/column_draws.h"

#include <algorithm>
#include <cmath>

namespace lumirank::methods {

using matrix::Index;

namespace {

// Of the walks above the coarse cut, those that go by power and distance.
constexpr double kByNearness = 0.5;

}  // namespace

ColumnDraws::ColumnDraws(const ColumnTree& tree, const matrix::RowFeatures& features, std::size_t asked)
    : tree_(tree), features_(features), asked_(asked), share_(tree.coarse_nodes().size()) {}

std::uint64_t ColumnDraws::begin(std::span<const Index> rows, matrix::EntryReader& reader, Rng& rng) {
  find_place(rows);
  const std::size_t asked = std::min(asked_, rows.size());
  if (asked == 0) return 0;
  // One row of each stretch of the slice, and for each of them another column of a node.
  const std::size_t cut = tree_.coarse_cut().size();
  places_.clear(), columns_.clear(), scales_.clear();
  std::vector<std::uint32_t> of_rows;
  for (std::size_t a = 0; a < asked; ++a) {
    const std::size_t first = a * rows.size() / asked, end = (a + 1) * rows.size() / asked;
    of_rows.push_back(static_cast<std::uint32_t>(first + rng.next_below(end - first)));
  }
  for (const Node c : tree_.coarse_cut())
    for (const std::uint32_t place : of_rows) {
      const auto drawn = tree_.draw_by_nearness(c, place_, rng);
      places_.push_back(place), columns_.push_back(tree_.column(drawn.place));
      scales_.push_back(1 / drawn.probability);
    }
  values_.resize(columns_.size());
  reader.entries_at(places_, columns_, values_, matrix::Part::value);
  found_.assign(cut, 0.0);
  for (std::size_t k = 0; k < values_.size(); ++k) {
    const double light = static_cast<double>(luminance(values_[k])) * scales_[k];
    found_[k / asked] += light * light;
  }
  for (double& f : found_) f = std::sqrt(f);
  share_coarse_nodes();
  return values_.size();
}

// The mean place of the rows, and the root mean square distance from it.
void ColumnDraws::find_place(std::span<const Index> rows) {
  place_ = {};
  if (features_.position.empty()) return;
  const auto share = 1 / static_cast<float>(rows.size());
  for (const Index i : rows) place_.center += features_.position[i] * share;
  float square = 0;
  for (const Index i : rows) square += length_squared(features_.position[i] - place_.center) * share;
  place_.radius = std::sqrt(square);
}

// Shares of the coarse nodes: what was found of the cut's, each root's for itself, mixed with what walks by
// nearness would give.
void ColumnDraws::share_coarse_nodes() {
  const auto nodes = tree_.coarse_nodes();
  std::vector<double> light(nodes.size(), 0.0);
  for (std::size_t c = 0; c < found_.size(); ++c) light[tree_.coarse(tree_.coarse_cut()[c])] = found_[c];
  for (std::size_t k = nodes.size(); k-- > 0;)
    if (nodes[k].divided)
      light[k] =
          light[tree_.coarse(tree_.left(nodes[k].node))] + light[tree_.coarse(tree_.right(nodes[k].node))];
  std::vector<double> near(nodes.size(), 0.0), all(nodes.size(), 0.0);
  for (const auto& root : tree_.roots())
    near[tree_.coarse(root.node)] = 1, all[tree_.coarse(root.node)] = light[tree_.coarse(root.node)];
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    share_[k] = all[k] > 0 ? kByNearness * near[k] + (1 - kByNearness) * light[k] / all[k] : near[k];
    if (!nodes[k].divided) continue;
    const double to_left = tree_.left_by_nearness(nodes[k].node, place_);
    const std::uint32_t left = tree_.coarse(tree_.left(nodes[k].node)),
                        right = tree_.coarse(tree_.right(nodes[k].node));
    near[left] = near[k] * to_left, near[right] = near[k] * (1 - to_left);
    all[left] = all[right] = all[k];
  }
}

double ColumnDraws::left_probability(Node node) const {
  if (asked_ > 0 && tree_.coarse(node) != ColumnTree::kFine) {
    const auto k = tree_.coarse(node);
    if (tree_.coarse_nodes()[k].divided) {
      const double left = share_[tree_.coarse(tree_.left(node))],
                   right = share_[tree_.coarse(tree_.right(node))];
      if (left + right > 0) return left / (left + right);
    }
  }
  return tree_.left_by_nearness(node, place_);
}

ColumnDraws::Drawn ColumnDraws::draw(Node node, Rng& rng) const {
  return tree_.walk(node, place_, rng, [this](Node n) { return left_probability(n); });
}

}  // namespace lumirank::methods
