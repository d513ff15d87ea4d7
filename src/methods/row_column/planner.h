// Planner of how many rows and columns pay: the search for the smallest number of columns that satisfies an
// error, and for the rows that are worth their cost, which 2007 (section 5, "Discussion") leaves open.
#pragma once

#include <cstddef>
#include <vector>

namespace lumirank::methods {

// Expected errors against the number of clusters, with the rows known so far.
struct ErrorCurve {
  struct Point {
    double columns, seen,
        unseen;  // relative errors to expect on the rows that were clustered by, and on others
  };
  std::vector<Point> points;  // columns ascending

  // Interpolated and extrapolated along a straight line in logarithms (beyond the end: of the last two
  // points).
  double seen(double columns) const;
  double unseen(double columns) const;
  // The smallest number of columns at which the error falls to `error`.
  double columns_for_seen(double error) const;
  double columns_for_unseen(double error) const;
};

// What one more row and one more column cost: entries if nothing is timed, seconds if a time budget is given.
struct Costs {
  double row, column;
};

// With a target: is it worth reading as many rows again? They are taken to close half of the gap, in columns,
// between what the seen rows promise and what unseen ones show, but to save no more columns than the rows
// before them did.
struct TargetQuestion {
  double target;
  std::size_t rows;           // read so far
  double max_columns;         // more are never needed
  double columns_before = 0;  // needed before the last rows were added; 0: unknown
};
bool more_rows_pay_for_target(const ErrorCurve& curve, const TargetQuestion& question, const Costs& costs);
// With `budget` (in the unit of the costs) to spend: does the error fall further by reading as many rows
// again than by spending all on columns? They are taken to close a quarter of the gap in the logarithm of the
// error, and all rows together may not cost more than half of what is left for columns.
bool more_rows_pay_for_budget(const ErrorCurve& curve, double budget, std::size_t rows, const Costs& costs);

}  // namespace lumirank::methods
