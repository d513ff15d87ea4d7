// Row-column sampling: sections 3.2 to 4 of the paper. Read r rows (row_sampler, reduced), cluster the
// columns by them (linalg/clustering), pick a scaled representative of each cluster (representatives), render
// these (column_pass).
//
// Deviations: blocks of rows follow a Hilbert curve; columns that vanish on all sampled rows are sampled by
// power instead of ignored; color averaging is bounded; without given numbers, rows and columns are found
// automatically (run.h).
#include "methods/row_column/row_column.h"

#include "methods/common/all_columns.h"
#include "methods/row_column/run.h"

namespace lumirank::methods {

namespace {

class RowColumnSampling final : public Method {
 public:
  explicit RowColumnSampling(const RowColumnSettings& settings) : settings_(settings) {}

  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    if (settings_.columns >= matrix.columns()) return brute_force_with_error(matrix, options);
    RowColumnRun run(matrix, options, settings_);
    return settings_.rows > 0 && settings_.columns > 0 ? run.fixed() : run.automatic();
  }

 private:
  RowColumnSettings settings_;
};

}  // namespace

MethodInfo row_column_info() {
  return method_info<RowColumnSampling>(
      {"row-column-sampling",
       "Reads a few rows, clusters the columns by them, and renders one representative of each cluster.",
       "Hašan, Pellacini, Bala 2007, Matrix row-column sampling for the many-light problem", "",
       matrix::kCombination},
      row_column_fields());
}

}  // namespace lumirank::methods
