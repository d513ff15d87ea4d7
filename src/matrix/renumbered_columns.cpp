#include "matrix/renumbered_columns.h"

#include <algorithm>

#include "matrix/entry_reader.h"

namespace lumirank::matrix {
namespace {

// Entries of a list, whose columns that are not black `ask` knows by their own numbers.
template <typename Ask>
Cost of_lit(const std::vector<Index>& whole, std::span<const Index> rows, std::span<const Index> columns,
            std::span<Rgb> out, const Ask& ask) {
  std::vector<Index> asked_rows, asked_columns;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (whole[columns[k]] != RenumberedColumns::kBlack)
      asked_rows.push_back(rows[k]), asked_columns.push_back(whole[columns[k]]);
  std::vector<Rgb> found(asked_rows.size());
  const Cost cost =
      ask(std::span<const Index>(asked_rows), std::span<const Index>(asked_columns), std::span<Rgb>(found));
  std::size_t next = 0;
  for (std::size_t k = 0; k < rows.size(); ++k)
    out[k] = whole[columns[k]] == RenumberedColumns::kBlack ? Rgb(0) : found[next++];
  return cost;
}

}  // namespace

class RenumberedColumns::Reader final : public EntryReader {
 public:
  explicit Reader(const RenumberedColumns& matrix)
      : whole_(matrix.whole_), reader_(matrix.matrix_->reader()) {}
  void set_rows(std::span<const Index> rows) override { reader_->set_rows(rows); }
  Cost column(Index j, std::span<Rgb> out, Part part) override {
    if (whole_[j] != kBlack) return reader_->column(whole_[j], out, part);
    std::fill(out.begin(), out.end(), Rgb(0));
    return {};
  }
  Cost entries_at(std::span<const std::uint32_t> places, std::span<const Index> columns, std::span<Rgb> out,
                  Part part) override {
    return of_lit(whole_, places, columns, out,
                  [&](auto p, auto c, auto o) { return reader_->entries_at(p, c, o, part); });
  }
  Cost entries(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
               Part part) override {
    return of_lit(whole_, rows, columns, out,
                  [&](auto r, auto c, auto o) { return reader_->entries(r, c, o, part); });
  }

 private:
  const std::vector<Index>& whole_;
  std::unique_ptr<EntryReader> reader_;
};

std::unique_ptr<EntryReader> RenumberedColumns::reader() const { return std::make_unique<Reader>(*this); }

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
  return of_lit(whole_, rows, columns, out,
                [&](auto r, auto c, auto o) { return matrix_->entries(r, c, o, part); });
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
