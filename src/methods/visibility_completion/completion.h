// Visibility between a slice's receivers and its columns, from few shadow rays.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "linalg/nested_levels.h"
#include "matrix/entry_reader.h"

namespace lumirank::methods {

struct CompletionSettings {
  std::size_t spacing = 16;  // one of so many rows is sampled in every column
  double checks = 0.03;      // share of what neighbors agree on that is sampled all the same
};

// Work space for one slice at a time; one thread.
class Completion {
 public:
  using Word = std::uint64_t;

  explicit Completion(matrix::EntryReader& reader) : reader_(reader) {}

  // The slice's rows, their places (NestedLevels' points; neighbors follow each other) and its columns.
  // `key`: of the random numbers.
  struct Slice {
    std::span<const matrix::Index> rows;
    std::span<const linalg::NestedLevels::Point> points;
    std::span<const matrix::Index> columns;
    std::uint64_t key;
  };

  // From coarse to fine rows; where the four nearest coarser rows agree about a column their value is taken,
  // and sampled only in some of these places, where they differ in all.
  void complete(const Slice& slice, const CompletionSettings& settings);

  bool visible(std::size_t row, std::size_t column) const {
    return (bits_[row * words_ + column / kBits] >> (column % kBits)) & 1u;
  }

  // Entries of reduced matrices so far: all of them, those sampled, and of those sampled only to check what
  // was filled in already, the number and how many were wrong.
  struct Counts {
    std::uint64_t entries = 0, sampled = 0, checks = 0, wrong = 0;
  };
  const Counts& counts() const { return counts_; }

 private:
  static constexpr std::size_t kBits = 64;

  void start(const Slice& slice);
  void request(std::size_t row, std::size_t column, bool check) {
    wanted_.push_back({static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(column), check});
  }
  // Samples what was requested, column by column, and writes it down.
  void resolve(const Slice& slice);
  void set(std::size_t row, std::size_t column, bool seen);

  struct Wanted {
    std::uint32_t row, column;
    bool check;
  };

  matrix::EntryReader& reader_;
  linalg::NestedLevels levels_;
  std::size_t words_ = 0;   // per row
  std::vector<Word> bits_;  // rows × columns
  std::vector<Wanted> wanted_, sorted_;
  std::vector<std::uint32_t> starts_;
  std::vector<matrix::Index> rows_, columns_;
  std::vector<Rgb> seen_;
  Counts counts_;
};

}  // namespace lumirank::methods
