// Entries for one thread, with work space that is kept: what code that treats slices side by side calls in
// its inner loops.
#pragma once

#include <span>
#include <vector>

#include "matrix/lighting_matrix.h"

namespace lumirank::matrix {

// Gives the same numbers as the matrix that made it; every call returns what it cost. Runs on the calling
// thread alone. The matrix must outlive it.
class EntryReader {
 public:
  virtual ~EntryReader() = default;
  // The rows of the following columns, in any order; best neighbors. Copied.
  virtual void set_rows(std::span<const Index> rows) = 0;
  // out[a] = A(rows[a], j).
  virtual Cost column(Index j, std::span<Rgb> out, Part part = Part::value) = 0;
  // out[a] = Σ weight_c · E_c(rows[a], j) over the channels c: for decisions that need a number per row
  // alone.
  virtual Cost unoccluded_scalars(Index j, Rgb weights, std::span<float> out);
  // sums[a] += Σ_k scale_k · share(of[a], k) · E(rows[a], column_k), in the order of `columns`: for
  // visibilities that the caller knows. Several rows may take the same share; share(s, k) is shares[k ·
  // (number of shares per column) + s]. Columns without any share cost nothing.
  virtual Cost add_unoccluded(std::span<const ScaledColumn> columns, std::span<const float> shares,
                              std::span<const std::uint32_t> of, std::span<Rgb> sums);
  // Some entries of the rows that are set: out[k] = A(rows[places[k]], columns[k]), rows as they were given
  // to set_rows(). Cheaper than entries() from anywhere; best with equal columns next to each other.
  virtual Cost entries_at(std::span<const std::uint32_t> places, std::span<const Index> columns,
                          std::span<Rgb> out, Part part = Part::value) = 0;
  // Entries from anywhere: out[k] = A(rows[k], columns[k]).
  virtual Cost entries(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
                       Part part = Part::value) = 0;

 private:
  std::vector<Rgb> column_;  // for those that know no faster way
};

}  // namespace lumirank::matrix
