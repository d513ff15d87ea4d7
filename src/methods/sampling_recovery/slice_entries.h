// What is known of a slice's entries: for every column that was looked at, its unoccluded contributions to
// all receivers, and the visibilities that were sampled.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "linalg/visibility_predictors.h"
#include "matrix/entry_reader.h"
#include "methods/sampling_recovery/sample_patterns.h"
#include "methods/sampling_recovery/slice_rows.h"

namespace lumirank::methods {

class SliceEntries {
 public:
  struct Slot {
    matrix::Index column;
    std::uint32_t pattern;
    std::uint32_t sampled;  // the first of the pattern's rows are known where the column reaches them
    float most;             // greatest mean of r, g, b of an unoccluded entry
    bool any_visible;       // among the samples
  };

  explicit SliceEntries(const matrix::LightingMatrix& matrix)
      : features_(matrix.row_features()), reader_(matrix.reader()) {}

  // Forgets all columns.
  void start(std::span<const matrix::Index> slice, std::uint64_t key);
  std::uint64_t key() const { return key_; }
  const SliceRows& rows() const { return rows_; }
  SamplePatterns& patterns() { return patterns_; }

  // Evaluates a column without visibility; the number of its slot.
  std::size_t add(matrix::Index column);
  Slot& slot(std::size_t s) { return slots_[s]; }
  std::span<const Rgb> shades(std::size_t s) const {  // per receiver
    return std::span(shades_).subspan(s * rows_.receivers().size(), rows_.receivers().size());
  }
  // Per row: linalg::seen.
  std::span<std::uint8_t> seen(std::size_t s) {
    return std::span(seen_).subspan(s * rows_.size(), rows_.size());
  }
  // The mean over a row's receivers of the mean of r, g, b of their entries times `scale`.
  void scalars(std::size_t s, Rgb scale, std::span<float> out) const;

  // Where an entry is looked from: one of the row's receivers that the column reaches, at random but always
  // the same. kNowhere if it reaches none.
  static constexpr std::uint32_t kNowhere = 0xffffffffu;
  std::uint32_t place(std::size_t s, std::size_t row) const;
  // Asks for an entry, as seen from its place(). False if there is none. Answered by look().
  bool ask(std::size_t s, std::size_t row);
  // Asks for the next `count` rows of the slot's pattern.
  void ask_next(std::size_t s, std::size_t count);
  void look();
  // Means of r, g, b of entries (row, column) with visibility, each from one of the row's receivers at
  // random.
  void look_at(std::span<const std::uint32_t> rows, std::span<const matrix::Index> columns,
               std::vector<float>& out);
  std::size_t looked() const { return looked_; }  // entries, since start()

 private:
  matrix::RowFeatures features_;
  std::unique_ptr<matrix::EntryReader> reader_;
  SliceRows rows_;
  SamplePatterns patterns_;
  std::uint64_t key_ = 0;
  std::size_t looked_ = 0;
  std::vector<Slot> slots_;
  std::vector<Rgb> shades_, answers_;
  std::vector<std::uint8_t> seen_;
  struct Request {
    std::uint32_t slot, row;
  };
  std::vector<Request> requests_;
  std::vector<matrix::Index> asked_places_, asked_columns_;
};

}  // namespace lumirank::methods
