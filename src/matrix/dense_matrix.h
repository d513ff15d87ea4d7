// A lighting matrix that is held in memory: for tests, and for small matrices whose singular values are
// wanted.
#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include "matrix/lighting_matrix.h"

namespace lumirank::matrix {

class DenseMatrix : public LightingMatrix {
 public:
  // unoccluded: rows × columns, row-major. visibility: the same number of values from 0 to 1, or empty (all
  // visible); it is binary where none lies between.
  DenseMatrix(std::size_t rows, std::size_t columns, std::vector<Rgb> unoccluded,
              std::vector<float> visibility = {});
  DenseMatrix(DenseMatrix&& other) noexcept;

  std::size_t rows() const override { return rows_; }
  std::size_t columns() const override { return columns_; }
  Cost row(Index i, std::span<Rgb> out, Part part = Part::value) const override;
  Cost column(Index j, std::span<Rgb> out, Part part = Part::value) const override;
  Cost block(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
             Part part = Part::value) const override;
  Cost entries(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
               Part part = Part::value) const override;
  Cost accumulate(std::span<const ScaledColumn> columns, std::span<Rgb> sums,
                  const Sinks& sinks = {}) const override;
  Capabilities capabilities() const override;
  // The greatest entries of the column, whatever the row: bounds know nothing better of a made-up matrix.
  ColumnSet column_set(Index j) const override;
  std::unique_ptr<RowBounds> row_bounds() const override;
  RowFeatures row_features() const override;
  ColumnFeatures column_features() const override;

  Rgb at(std::size_t i, std::size_t j, Part part = Part::value) const;
  // Sums of all columns, in double precision and in the order of the columns: what every method estimates.
  std::vector<Rgb> exact_sums() const;

  // Features, empty unless set; lengths must be those of the matrix.
  std::vector<Vec2f> pixel;
  std::vector<Vec3f> row_position, row_normal;
  std::vector<float> row_weight;
  std::vector<Vec3f> column_position, column_normal;
  std::vector<float> power;
  std::vector<std::uint16_t> group;
  std::vector<std::uint8_t> indirect, half;
  std::vector<Rgb> emitted;
  std::vector<Rgb> row_albedo;
  std::vector<std::uint64_t> row_id, column_id;
  std::vector<std::uint16_t> row_instant, column_instant;

 private:
  // Adds an entry to what a call cost.
  void add_to(Cost& cost, std::size_t i, std::size_t j) const;

  std::size_t rows_, columns_;
  std::vector<Rgb> unoccluded_;
  std::vector<float> visibility_;
  bool binary_ = true;
  mutable std::once_flag max_entries_known_;
  mutable std::vector<Rgb> max_entries_;  // by column: the greatest entries, as if all were visible
};

}  // namespace lumirank::matrix
