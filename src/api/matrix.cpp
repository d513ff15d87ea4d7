#include "api/matrix.h"

#include <algorithm>
#include <string>

#include "base/error.h"

namespace lumirank {
namespace {

using matrix::LightingMatrix;

MatrixCost to_cost(const matrix::Cost& cost) { return {cost.entries, cost.culled, cost.rays}; }

matrix::Part to_part(MatrixPart part) {
  switch (part) {
    case MatrixPart::unoccluded:
      return matrix::Part::unoccluded;
    case MatrixPart::visibility:
      return matrix::Part::visibility;
    case MatrixPart::value:
      break;
  }
  return matrix::Part::value;
}

void require_length(const char* what, std::size_t given, std::size_t wanted) {
  if (given != wanted)
    throw InputError(std::string(what) + " has " + std::to_string(given) + " elements instead of " +
                     std::to_string(wanted));
}

void require_index(const char* what, std::span<const Index> indices, std::size_t size) {
  for (const Index i : indices)
    if (i >= size)
      throw InputError("there is no " + std::string(what) + " " + std::to_string(i),
                       "the matrix has " + std::to_string(size));
}

const LightingMatrix& inner(const Matrix::Impl& impl) { return *impl.prepared->matrix; }

}  // namespace

std::vector<matrix::ScaledColumn> to_scaled(std::span<const WeightedColumn> columns) {
  std::vector<matrix::ScaledColumn> scaled;
  scaled.reserve(columns.size());
  for (const WeightedColumn& c : columns) {
    matrix::ScaledColumn column{c.column, c.scale};
    column.max_contribution = c.max_contribution;
    scaled.push_back(column);
  }
  return scaled;
}

std::size_t Matrix::rows() const { return inner(*impl_).rows(); }
std::size_t Matrix::columns() const { return inner(*impl_).columns(); }

MatrixRows Matrix::row_features() const {
  const auto f = inner(*impl_).row_features();
  return {f.pixel, f.position, f.normal, f.weight};
}

MatrixColumns Matrix::column_features() const {
  const auto f = inner(*impl_).column_features();
  return {f.position, f.normal, f.power, f.emitted, f.indirect};
}

MatrixCost Matrix::row(Index i, std::span<Rgb> out, MatrixPart part) const {
  require_index("row", {&i, 1}, rows());
  require_length("a row", out.size(), columns());
  return to_cost(inner(*impl_).row(i, out, to_part(part)));
}

MatrixCost Matrix::column(Index j, std::span<Rgb> out, MatrixPart part) const {
  require_index("column", {&j, 1}, columns());
  require_length("a column", out.size(), rows());
  return to_cost(inner(*impl_).column(j, out, to_part(part)));
}

MatrixCost Matrix::block(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
                         MatrixPart part) const {
  require_index("row", rows, this->rows());
  require_index("column", columns, this->columns());
  require_length("a block", out.size(), rows.size() * columns.size());
  return to_cost(inner(*impl_).block(rows, columns, out, to_part(part)));
}

MatrixCost Matrix::entries(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
                           MatrixPart part) const {
  require_index("row", rows, this->rows());
  require_index("column", columns, this->columns());
  require_length("the list of columns", columns.size(), rows.size());
  require_length("the list of entries", out.size(), rows.size());
  return to_cost(inner(*impl_).entries(rows, columns, out, to_part(part)));
}

MatrixCost Matrix::accumulate(std::span<const WeightedColumn> columns, std::span<Rgb> sums,
                              const Sinks& sinks) const {
  for (const WeightedColumn& c : columns) require_index("column", {&c.column, 1}, this->columns());
  require_length("the list of sums", sums.size(), rows());
  const MatrixCost cost = to_cost(inner(*impl_).accumulate(to_scaled(columns), sums, sinks));
  if (sinks.cancelled()) throw Cancelled();
  return cost;
}

}  // namespace lumirank
