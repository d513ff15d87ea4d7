#include "matrix/renumbered_columns.h"

#include <algorithm>

namespace lumirank::matrix {

RenumberedColumns::RenumberedColumns(std::shared_ptr<const LightingMatrix> matrix, std::vector<Index> whole)
    : matrix_(std::move(matrix)), whole_(std::move(whole)) {}

Cost RenumberedColumns::row(Index i, std::span<Rgb> out, Part part) const {
  std::vector<Rgb> all(matrix_->columns());
  const Cost cost = matrix_->row(i, all, part);
  for (std::size_t j = 0; j < whole_.size(); ++j) out[j] = whole_[j] == kBlack ? Rgb(0) : all[whole_[j]];
  return cost;
}

Cost RenumberedColumns::column(Index j, std::span<Rgb> out, Part part) const {
  if (whole_[j] != kBlack) return matrix_->column(whole_[j], out, part);
  std::fill(out.begin(), out.end(), Rgb(0));
  return {};
}

Cost RenumberedColumns::block(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
                              Part part) const {
  std::vector<Index> asked;
  for (const Index j : columns)
    if (whole_[j] != kBlack) asked.push_back(whole_[j]);
  std::vector<Rgb> found(rows.size() * asked.size());
  const Cost cost = matrix_->block(rows, asked, found, part);
  for (std::size_t a = 0; a < rows.size(); ++a) {
    std::size_t next = a * asked.size();
    for (std::size_t b = 0; b < columns.size(); ++b)
      out[a * columns.size() + b] = whole_[columns[b]] == kBlack ? Rgb(0) : found[next++];
  }
  return cost;
}

Cost RenumberedColumns::entries(std::span<const Index> rows, std::span<const Index> columns,
                                std::span<Rgb> out, Part part) const {
  std::vector<Index> asked_rows, asked_columns;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (whole_[columns[k]] != kBlack)
      asked_rows.push_back(rows[k]), asked_columns.push_back(whole_[columns[k]]);
  std::vector<Rgb> found(asked_rows.size());
  const Cost cost = matrix_->entries(asked_rows, asked_columns, found, part);
  std::size_t next = 0;
  for (std::size_t k = 0; k < rows.size(); ++k)
    out[k] = whole_[columns[k]] == kBlack ? Rgb(0) : found[next++];
  return cost;
}

Cost RenumberedColumns::accumulate(std::span<const ScaledColumn> columns, std::span<Rgb> sums,
                                   const Sinks& sinks) const {
  std::vector<ScaledColumn> asked;
  for (ScaledColumn c : columns) {
    if (whole_[c.column] == kBlack) continue;
    c.column = whole_[c.column];
    asked.push_back(c);
  }
  return matrix_->accumulate(asked, sums, sinks);
}

}  // namespace lumirank::matrix
