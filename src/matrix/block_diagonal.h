// The lighting matrix of several instants (Walter et al. 2006): each has rows, columns and a
// matrix of its own, which stand one after the other, and entries of different instants are 0.
#pragma once

#include <memory>
#include <vector>

#include "matrix/lighting_matrix.h"

namespace lumirank::matrix {

class BlockDiagonal : public LightingMatrix {
 public:
  // At least one block; at most 65,535. Ids of rows and columns are theirs mixed with the instant, so that
  // blocks may count alike. InternalError if rows or columns are too many to be numbered.
  explicit BlockDiagonal(std::vector<std::shared_ptr<const LightingMatrix>> blocks);

  std::size_t instants() const { return blocks_.size(); }
  // Rows of an instant: from first_row(k) to first_row(k + 1). Columns likewise.
  std::size_t first_row(std::size_t k) const { return first_row_[k]; }
  std::size_t first_column(std::size_t k) const { return first_column_[k]; }

  std::size_t rows() const override { return first_row_.back(); }
  std::size_t columns() const override { return first_column_.back(); }
  Cost row(Index i, std::span<Rgb> out, Part part = Part::value) const override;
  Cost column(Index j, std::span<Rgb> out, Part part = Part::value) const override;
  Cost block(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
             Part part = Part::value) const override;
  Cost entries(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
               Part part = Part::value) const override;
  Cost accumulate(std::span<const ScaledColumn> columns, std::span<Rgb> sums,
                  const Sinks& sinks = {}) const override;
  std::unique_ptr<EntryReader> reader() const override;
  // What all blocks can tell.
  Capabilities capabilities() const override;
  ColumnSet column_set(Index j) const override;
  // The greatest of the blocks' own bounds.
  std::unique_ptr<RowBounds> row_bounds() const override;
  RowFeatures row_features() const override;
  ColumnFeatures column_features() const override;

 protected:
  std::size_t instant_of_row(Index i) const { return row_instant_[i]; }
  const LightingMatrix& at(std::size_t k) const { return *blocks_[k]; }
  // Makes the power of a column, which only compares columns, commensurable with those of other instants.
  void scale_power(std::size_t column, float factor);

 private:
  class Bounds;
  class Reader;
  std::vector<std::shared_ptr<const LightingMatrix>> blocks_;
  std::vector<std::size_t> first_row_, first_column_;
  std::vector<std::uint16_t> row_instant_, column_instant_;
  // Features, one block's after the other's; empty where a block has none.
  std::vector<Vec2f> pixel_;
  std::vector<Vec3f> row_position_, row_normal_, column_position_, column_normal_;
  std::vector<float> weight_, power_;
  std::vector<std::uint64_t> row_id_, column_id_;
  std::vector<Rgb> albedo_, emitted_;
  std::vector<std::uint16_t> group_;
  std::vector<std::uint8_t> indirect_, half_;
};

}  // namespace lumirank::matrix
