// A lighting matrix whose columns are those of another by other numbers; some of them may be black.
#pragma once

#include <memory>
#include <vector>

#include "matrix/lighting_matrix.h"

namespace lumirank::matrix {

class RenumberedColumns : public LightingMatrix {
 public:
  static constexpr Index kBlack = 0xffffffffu;

  // Column j is column whole[j] of `matrix`, or black. What is known of columns beside their entries
  // (features, bounds) is not passed on; what is known of rows is.
  RenumberedColumns(std::shared_ptr<const LightingMatrix> matrix, std::vector<Index> whole);

  std::size_t rows() const override { return matrix_->rows(); }
  std::size_t columns() const override { return whole_.size(); }
  Cost row(Index i, std::span<Rgb> out, Part part = Part::value) const override;
  Cost column(Index j, std::span<Rgb> out, Part part = Part::value) const override;
  Cost block(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
             Part part = Part::value) const override;
  Cost entries(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
               Part part = Part::value) const override;
  Cost accumulate(std::span<const ScaledColumn> columns, std::span<Rgb> sums,
                  const Sinks& sinks = {}) const override;
  std::unique_ptr<EntryReader> reader() const override;
  RowFeatures row_features() const override { return matrix_->row_features(); }

 private:
  class Reader;
  std::shared_ptr<const LightingMatrix> matrix_;
  std::vector<Index> whole_;
};

}  // namespace lumirank::matrix
