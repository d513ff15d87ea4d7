// Known entries of a slice: for every column that was added, its unoccluded contribution to each row, and the
// visibilities that were sampled.
//
// A row is a pixel's receivers of one surface, any of which speaks for the others: they are dealt to a few
// layers of one per row, and a column is evaluated and seen from a random layer. What reaches each receiver
// is evaluated again when it is added up.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/random.h"
#include "matrix/entry_reader.h"
#include "methods/common/visibility_predictors.h"
#include "methods/slice_cuts/sample_patterns.h"
#include "methods/slice_cuts/slice_rows.h"

namespace lumirank::methods {

// Of the reduced matrix: a cluster of lights by its representative.
struct ReducedColumn {
  std::uint32_t slot;
  matrix::ScaledColumn column;
};

class SliceEntries {
 public:
  struct Slot {
    matrix::Index column;
    std::uint32_t pattern;
    std::uint32_t sampled;  // the first of the pattern's rows are known where the column reaches them
    float max_scalar;       // unoccluded
    std::uint16_t layer;
    bool any_visible;  // among the samples
  };

  explicit SliceEntries(const matrix::LightingMatrix& matrix)
      : features_(matrix.row_features()),
        ids_(matrix.column_features().id),
        matrix_(matrix),
        reader_(matrix.reader()) {}

  // Forgets all columns.
  void start(std::span<const matrix::Index> slice, std::uint64_t key);
  std::uint64_t key() const { return key_; }
  const SliceRows& rows() const { return rows_; }
  SamplePatterns& patterns() { return patterns_; }

  // Evaluates a column without visibility, at one receiver of each row; the number of its slot. Colors count
  // by its scale.
  std::size_t add(const matrix::ScaledColumn& column);
  // Visibilities of all rows of a slot that it reaches.
  void sample_all(std::size_t s);
  // Visibility, 0 or 1, of all rows.
  void trace(matrix::Index column, std::span<float> out);
  Slot& slot(std::size_t s) { return slots_[s]; }
  // Per row: the mean of r, g, b of an entry times the scale that it was added with, over the mean of that
  // scale.
  std::span<const float> scalars(std::size_t s) const {
    return std::span(scalars_).subspan(s * rows_.size(), rows_.size());
  }
  // Per row: seen.
  std::span<std::uint8_t> seen(std::size_t s) {
    return std::span(seen_).subspan(s * rows_.size(), rows_.size());
  }
  // Adds to each receiver's sum, in the order of rows().receivers(), its own E of these columns times its
  // row's visibility; visibility: column after column.
  void add_to(std::span<Rgb> sums, std::span<const matrix::ScaledColumn> columns,
              std::span<const float> visibility) {
    reader_->add_unoccluded(columns, visibility, row_of_, sums);
  }

  // The receiver whose visibility an entry takes; kNowhere if the column does not reach it.
  static constexpr std::uint32_t kNowhere = 0xffffffffu;
  std::uint32_t place(std::size_t s, std::size_t row) const {
    return scalars_[s * rows_.size() + row] > 0 ? receiver(row, slots_[s].layer) : kNowhere;
  }
  // Asks for an entry, as seen from its place(). False if there is none. Answered by resolve().
  bool request(std::size_t s, std::size_t row);
  // Asks for the next `count` rows of the slot's pattern.
  void request_next(std::size_t s, std::size_t count);
  void resolve();
  // Means of r, g, b of entries (row, column) with visibility, each from one of the row's receivers at
  // random.
  void values_at(std::span<const std::uint32_t> rows, std::span<const matrix::Index> columns,
                 std::vector<float>& out);
  std::size_t sampled() const { return sampled_; }  // entries, since start()
  // Random bits of a column in this slice.
  std::uint64_t bits(matrix::Index column) const { return mix64(key_ ^ mix64(matrix::id_of(ids_, column))); }

 private:
  static constexpr std::size_t kLayers = 4;
  std::uint32_t receivers_of(std::size_t row) const { return rows_.end(row) - rows_.begin(row); }
  // The receiver of a row in a layer.
  std::uint32_t receiver(std::size_t row, std::size_t layer) const {
    return rows_.begin(row) + static_cast<std::uint32_t>(first_layer_[row] + layer) % receivers_of(row);
  }

  matrix::RowFeatures features_;
  std::span<const std::uint64_t> ids_;  // of columns
  const matrix::LightingMatrix& matrix_;
  std::unique_ptr<matrix::EntryReader> reader_;  // of all receivers
  std::vector<std::unique_ptr<matrix::EntryReader>> layers_;
  std::size_t layer_count_ = 1;
  std::vector<std::uint8_t> first_layer_;  // by row
  std::vector<matrix::Index> layer_receivers_;
  std::vector<std::uint32_t> row_of_;  // by receiver
  SliceRows rows_;
  SamplePatterns patterns_;
  std::uint64_t key_ = 0;
  std::size_t sampled_ = 0;
  std::vector<Slot> slots_;
  std::vector<Rgb> answers_;
  std::vector<float> scalars_;
  std::uint16_t layer(matrix::Index column) const {
    return static_cast<std::uint16_t>((bits(column) >> 32) % layer_count_);
  }
  std::vector<std::uint8_t> seen_;
  struct Request {
    std::uint32_t slot, row;
  };
  std::vector<Request> requests_;
  std::vector<matrix::Index> requested_places_, requested_columns_;
  std::vector<std::uint32_t> requested_rows_;
};

}  // namespace lumirank::methods
