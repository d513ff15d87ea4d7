#include "methods/row_column/planner.h"

#include <algorithm>
#include <cmath>

namespace lumirank::methods {

namespace {

using Point = ErrorCurve::Point;
constexpr double kTiny = 1e-9;  // errors below are 0 to a logarithm

struct Line {
  double x, y, slope;
};

// The piece of the curve on which `columns` lies; errors fall by at least the tenth root, so that a flat end
// still ends.
Line piece(const std::vector<Point>& points, double Point::*error, std::size_t k) {
  const auto y = [&](std::size_t i) { return std::log(std::max(points[i].*error, kTiny)); };
  const double x0 = std::log(points[k].columns), x1 = std::log(points[k + 1].columns);
  return {x0, y(k), std::min((y(k + 1) - y(k)) / (x1 - x0), -0.1)};
}

double error_at(const std::vector<Point>& points, double Point::*error, double columns) {
  if (points.empty()) return 0;
  if (points.size() == 1) return points[0].*error * std::sqrt(points[0].columns / std::max(columns, 1.0));
  std::size_t k = 0;
  while (k + 2 < points.size() && points[k + 1].columns < columns) ++k;
  const Line l = piece(points, error, k);
  return std::exp(l.y + l.slope * (std::log(std::max(columns, 1.0)) - l.x));
}

double columns_at(const std::vector<Point>& points, double Point::*error, double wanted) {
  if (points.empty()) return 1;
  if (points[0].*error <= wanted) return points[0].columns;
  if (points.size() == 1) return points[0].columns * std::pow(points[0].*error / wanted, 2.0);
  std::size_t k = 0;
  while (k + 2 < points.size() && points[k + 1].*error > wanted) ++k;
  const Line l = piece(points, error, k);
  return std::exp(l.x + (std::log(std::max(wanted, kTiny)) - l.y) / l.slope);
}

}  // namespace

double ErrorCurve::seen(double columns) const { return error_at(points, &Point::seen, columns); }
double ErrorCurve::unseen(double columns) const { return error_at(points, &Point::unseen, columns); }
double ErrorCurve::columns_for_seen(double error) const { return columns_at(points, &Point::seen, error); }
double ErrorCurve::columns_for_unseen(double error) const {
  return columns_at(points, &Point::unseen, error);
}

bool more_rows_pay_for_target(const ErrorCurve& curve, const TargetQuestion& question, const Costs& costs) {
  const double unseen = std::min(curve.columns_for_unseen(question.target), question.max_columns);
  const double seen = std::min(curve.columns_for_seen(question.target), question.max_columns);
  double saved = 0.5 * (unseen - seen);
  if (question.columns_before > 0) saved = std::min(saved, question.columns_before - unseen);
  return saved * costs.column > static_cast<double>(question.rows) * costs.row;
}

bool more_rows_pay_for_budget(const ErrorCurve& curve, double budget, std::size_t rows, const Costs& costs) {
  const double now = budget / costs.column;
  const double later = (budget - static_cast<double>(rows) * costs.row) / costs.column;
  // Not more than a third for all rows: the paper's ratios of rows to columns, 1:2 to 1:3.
  if (later * costs.column < 2 * 2 * static_cast<double>(rows) * costs.row) return false;
  const double hoped = std::pow(curve.unseen(later), 0.75) * std::pow(curve.seen(later), 0.25);
  return hoped < 0.97 * curve.unseen(now);
}

}  // namespace lumirank::methods
