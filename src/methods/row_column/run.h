// One run of row-column sampling: its state, and the two ways through it.
#pragma once

#include <set>
#include <string>

#include "methods/common/column_clusters.h"
#include "methods/common/column_pass.h"
#include "methods/common/run_clock.h"
#include "methods/row_column/blend.h"
#include "methods/row_column/planner.h"
#include "methods/row_column/settings.h"

namespace lumirank::methods {

class RowColumnRun {
 public:
  RowColumnRun(const matrix::LightingMatrix& matrix, const RunOptions& options,
               const RowColumnSettings& settings);

  // Rows and columns are given: the paper's four phases, once.
  Estimate fixed();
  // One of them, or both, is to be found:
  //  1. read some rows, a fifth of them apart from the clustering (held out); render a small pilot, which is
  //     shown at once;
  //  2. split clusters and follow the errors to expect on seen and on held-out rows; read as many rows again
  //     as long as that pays (planner.h);
  //  3. cluster so finely that the error to expect on held-out rows meets the target, or the time that is
  //     left; render;
  //  4. if the held-out rows disagree with the picture, or time is left: read rows where the last two
  //     estimates differ, and repeat from 2. Passes are averaged by expected precision (blend.h).
  // Without a time budget costs count entries, so the result is a function of the seed; with one they are
  // seconds.
  Estimate automatic();

 private:
  // Reads rows until done, cancelled or `until` (seconds since the call; 0: no limit) has passed. One in
  // `hold_out` is held out; 0: none.
  void explore(const std::vector<SampledRow>& rows, std::size_t hold_out, double until);
  bool pass(const ColumnClusters& known, const linalg::Splitter& clusters, double expected_error);
  void pass_over_all_columns();
  void pilot();
  void more_rows_while_they_pay(double needed);
  linalg::Splitter cluster_for(ColumnClusters& known, double needed);
  ErrorCurve error_curve(ColumnClusters& known, double until_error);
  double needed_error() const;     // of the next pass, for the blend to meet the target; 0: no target
  double sampling_target() const;  // what the other parts of the error leave to sampling; 0: no target
  bool target_met() const;
  // Of the sums so far, by all rows that were read; its sampling part by those that were held out.
  ErrorParts errors() const;
  double time_left() const;  // seconds; a large number without a budget
  Costs costs() const;
  std::size_t rows_read() const { return seen_.rows() + unseen_.rows(); }
  bool stopped() const { return cancelled_ || out_of_time_; }
  void report_errors();
  // Without a target or a time the run is for a picture in seconds: it ends at an error that is hard to see,
  // or at as many columns as a patient person's picture takes. A target, if given, is pursued to the end.
  // 3.5 % relative L1 is about as far as 5 % relative L2.
  static constexpr double kUnaskedTarget = 0.035;
  Estimate finish();

  const matrix::LightingMatrix& matrix_;
  const RunOptions& options_;
  const RowColumnSettings& settings_;
  RunClock timer_;
  double target_;
  std::size_t rows_, columns_;  // of the matrix
  RowSampler sampler_;
  ReducedMatrix seen_;
  HeldOutRows unseen_;
  std::vector<Rgb> row_;  // the last row that was read
  Blend blend_;
  std::vector<matrix::ScaledColumn> combination_;  // whose sums are the blend's
  Trace trace_;
  ExactRows afterwards_;  // rows that were read to know the error of the finished sums
  std::set<matrix::Index> rendered_;
  std::size_t rendered_count_ = 0;
  std::size_t passes_ = 0;
  bool cancelled_ = false, out_of_time_ = false;
};

}  // namespace lumirank::methods
