// Settings of the cuts of slices: how large slices are, and how finely the light tree is cut for each.
// Defaults are those of the paper (Huo et al. 2015, section 7.1), but for the columns: its 200 and 0.02 give
// 270 per slice here, where it reports about a thousand (rays per pixel over sampling rate in table 1). What
// is ours (redraw, cut-pixels) is explained in docs/sampling-recovery.md.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "methods/common/turns.h"
#include "methods/parameters.h"

namespace lumirank::methods {

struct SliceCutSettings {
  std::size_t slice_rows = 1024;
  std::size_t initial_columns = 500, max_columns = 2000;
  bool splitting = true, sparse_visibility = true, redraw = true;
  std::size_t cut_pixels = 128;  // by which clusters are chosen; 0: all of the slice
  double alpha = 0.003;
  double rho = 0.01;
  double overlap = 0.05;      // see SliceOverlap
  std::size_t drawings = 1;   // of representatives in a slice
  std::uint64_t redraws = 0;  // a turn's number: each has other representatives

  // So much finer, or coarser: see turns.h.
  void refine(const Turn& turn);
  // Samples of a column at a time, of a slice with so many rows.
  std::size_t samples(std::size_t rows) const;
};

const Fields<SliceCutSettings>& slice_cut_fields();

}  // namespace lumirank::methods
