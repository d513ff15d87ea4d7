// The columns of one slice: chosen by a cut of the light tree, at some of the slice's pixels, and added up
// for the slice's receivers once it is known who sees which of them.
#pragma once

#include <span>
#include <vector>

#include "methods/slice_cuts/slice_cut.h"
#include "methods/slice_cuts/slice_entries.h"

namespace lumirank::methods {

// Work space of one thread.
class SliceColumns {
 public:
  SliceColumns(const LightTree& tree, const matrix::LightingMatrix& matrix)
      : entries_(matrix), cut_entries_(matrix), cut_(tree, matrix) {}

  // Starts the entries of the slice and chooses its columns. Random numbers are keyed by `key`.
  void choose(const SliceCutSettings& settings, std::span<const matrix::Index> slice, std::uint64_t key);
  // After choose(): the columns of other representatives (SliceCut::redraw), for some of the slice's
  // receivers, which take its place.
  void redraw(const SliceCutSettings& settings, std::span<const matrix::Index> receivers, std::uint64_t key,
              std::uint64_t drawing);
  // Evaluates the columns that the choice has left unevaluated.
  void evaluate();
  // Writes the sums of the slice's receivers: each gets its own unoccluded contributions times its row's
  // visibility, 0 … 1, column after column.
  void gather(std::span<const float> visibility, std::span<Rgb> sums);

  std::span<const ReducedColumn> columns() const { return columns_; }
  SliceEntries& entries() { return entries_; }
  const SliceEntries& entries() const { return entries_; }
  const SliceCut& cut() const { return cut_; }
  // Visibilities that were evaluated since choose() or redraw(); those of the choice count with the first.
  std::size_t sampled() const { return entries_.sampled() + sampled_before_; }

 private:
  SliceEntries entries_;
  SliceEntries cut_entries_;  // of the cut's pixels
  SliceCut cut_;
  bool at_cut_pixels_ = false;  // whether the choice went by these
  std::size_t sampled_before_ = 0;
  void take_clusters();

  std::vector<matrix::Index> cut_receivers_;
  std::vector<ReducedColumn> columns_;
  std::vector<matrix::ScaledColumn> scaled_;
  std::vector<Rgb> gathered_;
};

}  // namespace lumirank::methods
