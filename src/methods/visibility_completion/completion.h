// Which of a slice's receivers see which of its columns, from few shadow rays.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "linalg/boolean_basis.h"
#include "linalg/nested_levels.h"
#include "matrix/entry_reader.h"

namespace lumirank::methods {

struct CompletionSettings {
  std::size_t spacing = 16;  // refined: one of so many rows is looked at in every column
  // refined: share of what neighbours agree on that is looked at all the same; boolean: share of the rows
  // against which a completed column is checked
  double checks = 0.03;
  double rate = 0.1;  // boolean: share of a column's rows that is looked at to complete it
};

// Work space for one slice at a time; one thread.
class Completion {
 public:
  using Word = linalg::BooleanBasis::Word;

  explicit Completion(matrix::EntryReader& reader) : reader_(reader) {}

  // The slice's rows, their places (NestedLevels' points; neighbours follow each other) and its columns, the
  // most important first. `key`: of the random numbers.
  struct Slice {
    std::span<const matrix::Index> rows;
    std::span<const linalg::NestedLevels::Point> points;
    std::span<const matrix::Index> columns;
    std::uint64_t key;
  };

  // Wang and Holzschuch 2020: column after column, completed over a growing basis modulo 2 where samples
  // agree with it and checks confirm it, otherwise looked at in all rows. The reader's rows must be the
  // slice's.
  void complete_boolean(const Slice& slice, const CompletionSettings& settings);
  // Ours: from coarse to fine rows; where the four nearest coarser rows agree about a column their value is
  // taken, and looked up only in some of these places, where they differ in all.
  void complete_refined(const Slice& slice, const CompletionSettings& settings);

  bool visible(std::size_t row, std::size_t column) const {
    return (bits_[row * words_ + column / kBits] >> (column % kBits)) & 1u;
  }

  // Entries of reduced matrices so far: all of them, those looked at, and of those looked at only to check
  // what was filled in already, the number and how many were wrong.
  struct Counts {
    std::uint64_t entries = 0, looked_at = 0, checks = 0, wrong = 0, whole_columns = 0;
  };
  const Counts& counts() const { return counts_; }

 private:
  static constexpr std::size_t kBits = linalg::BooleanBasis::kBits;

  void start(const Slice& slice);
  void request(std::size_t row, std::size_t column, bool check) {
    wanted_.push_back({static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(column), check});
  }
  // Looks at what was requested, column by column, and writes it down.
  void look(const Slice& slice);
  void set(std::size_t row, std::size_t column, bool seen);

  // False where samples do not fit, or are too many.
  bool complete_column(const Slice& slice, const CompletionSettings& settings, std::size_t column);
  // In all rows; it joins the basis. The reader's rows must be the slice's.
  void look_at_column(const Slice& slice, std::size_t column);
  // Of one column, at the rows chosen_, into value_.
  void look_at_rows(const Slice& slice, std::size_t column);

  struct Wanted {
    std::uint32_t row, column;
    bool check;
  };

  matrix::EntryReader& reader_;
  linalg::NestedLevels levels_;
  linalg::BooleanBasis basis_;
  std::size_t words_ = 0;   // per row
  std::vector<Word> bits_;  // rows × columns
  std::vector<Wanted> wanted_, sorted_;
  std::vector<std::uint32_t> starts_, chosen_;
  std::vector<matrix::Index> rows_, columns_;
  std::vector<Rgb> seen_;
  std::vector<Word> known_, value_, sum_;  // boolean: one column
  Counts counts_;
};

}  // namespace lumirank::methods
