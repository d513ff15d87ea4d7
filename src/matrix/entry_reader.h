// Entries for one thread, with work space that is kept: what code that treats slices side by side calls in
// its inner loops.
#pragma once

#include <span>

#include "matrix/lighting_matrix.h"

namespace lumirank::matrix {

// Gives the same numbers as the matrix that made it, and pays for them in the same counters (at the latest
// when it goes). Runs on the calling thread alone. The matrix must outlive it.
class EntryReader {
 public:
  virtual ~EntryReader() = default;
  // The rows of the following columns, in any order; best neighbours. Copied.
  virtual void set_rows(std::span<const Index> rows) = 0;
  // out[a] = A(rows[a], j).
  virtual void column(Index j, std::span<Rgb> out, Part part = Part::value) = 0;
  // Some entries of the rows that are set: out[k] = A(rows[places[k]], columns[k]), rows as they were given
  // to set_rows(). Cheaper than entries() from anywhere; best with equal columns next to each other.
  virtual void entries_at(std::span<const std::uint32_t> places, std::span<const Index> columns,
                          std::span<Rgb> out, Part part = Part::value) = 0;
  // Entries from anywhere: out[k] = A(rows[k], columns[k]).
  virtual void entries(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
                       Part part = Part::value) = 0;
};

}  // namespace lumirank::matrix
