// How columns are drawn for one slice of rows: by walks down the tree of columns.
//
// The paper draws in proportion to power. Of a node around the slice the few columns next to it, which bring
// most of its light, are then seldom drawn; and where most of what is powerful is behind a wall, columns that
// are drawn are dark, agree with each other, and seem to be known. So a few of the slice's rows are asked
// first what a coarse cut of the tree brings them, by one column of each of its nodes: a row of the matrix is
// an exact record of importance (importance caching: Georgiev, Křivánek, Popov, Slusallek 2012). Above the
// cut, walks go half by what was found and half by power over the square of the distance from the slice,
// below it by the latter alone, so that every column has a chance wherever a record is wrong.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/random.h"
#include "matrix/entry_reader.h"
#include "methods/column_completion/column_tree.h"

namespace lumirank::methods {

class ColumnDraws {
 public:
  using Node = ColumnTree::Node;
  // `asked`: rows of a slice; with 0 walks go by power and distance alone.
  ColumnDraws(const ColumnTree& tree, const matrix::RowFeatures& features, std::size_t asked);

  using Drawn = ColumnTree::Drawn;

  // The slice for which columns are drawn from now on: the rows that `reader` is set to. Returns how many
  // entries were read.
  std::uint64_t begin(std::span<const matrix::Index> rows, matrix::EntryReader& reader, Rng& rng);

  Drawn draw(Node node, Rng& rng) const;
  // Of an inner node, that a walk goes to the left.
  double left_probability(Node node) const;

 private:
  void find_place(std::span<const matrix::Index> rows);
  void share_coarse_nodes();

  const ColumnTree& tree_;
  matrix::RowFeatures features_;
  std::size_t asked_;
  // Of the slice.
  ColumnTree::Place place_;
  std::vector<double> share_;  // by ColumnTree::coarse(): that a walk from its root comes by
  // Work space.
  std::vector<std::uint32_t> places_;
  std::vector<matrix::Index> columns_;
  std::vector<double> scales_, found_;
  std::vector<Rgb> values_;
};

}  // namespace lumirank::methods
