#include "methods/slice_cuts/slice_columns.h"

#include <algorithm>

namespace lumirank::methods {

using matrix::Index;

// Splitting asks for a cluster's greatest contribution alone, which few rows tell as well as all. What they
// know of columns is of no use to the others, so it is left behind; without redrawing it would be the columns
// themselves.
void SliceColumns::choose(const SliceCutSettings& settings, std::span<const Index> slice, std::uint64_t key) {
  entries_.start(slice, key);
  const SliceRows& rows = entries_.rows();
  const std::size_t pixels = settings.cut_pixels;
  at_cut_pixels_ = pixels > 0 && pixels < rows.size() && settings.splitting && settings.redraw;
  if (at_cut_pixels_) {
    cut_receivers_.clear();
    for (std::size_t k = 0; k < pixels; ++k) {
      const std::size_t row = k * rows.size() / pixels;
      for (std::uint32_t r = rows.begin(row); r < rows.end(row); ++r)
        cut_receivers_.push_back(rows.receivers()[r]);
    }
    cut_entries_.start(cut_receivers_, key);
    // As many samples of a column as of the whole slice's rows.
    SliceCutSettings of_pixels = settings;
    of_pixels.rho =
        std::min(1.0, settings.rho * static_cast<double>(rows.size()) / static_cast<double>(pixels));
    cut_.choose(of_pixels, cut_entries_);
  } else {
    cut_.choose(settings, entries_);
  }
  sampled_before_ = at_cut_pixels_ ? cut_entries_.sampled() : 0;
  take_clusters();
}

void SliceColumns::redraw(const SliceCutSettings& settings, std::span<const Index> receivers,
                          std::uint64_t key, std::uint64_t drawing) {
  sampled_before_ = drawing == 0 ? sampled() : 0;
  entries_.start(receivers, key);
  cut_.redraw(settings, drawing);
  take_clusters();
}

void SliceColumns::take_clusters() {
  columns_.clear();
  for (const SliceCut::Cluster& c : cut_.clusters())
    columns_.push_back({at_cut_pixels_ ? SliceCut::kNoSlot : c.slot, c.column});
}

void SliceColumns::evaluate() {
  for (ReducedColumn& c : columns_)
    if (c.slot == SliceCut::kNoSlot) c.slot = static_cast<std::uint32_t>(entries_.add(c.column));
}

void SliceColumns::gather(std::span<const float> visibility, std::span<Rgb> sums) {
  const SliceRows& rows = entries_.rows();
  gathered_.assign(rows.receivers().size(), Rgb(0));
  scaled_.clear();
  for (const ReducedColumn& c : columns_) scaled_.push_back(c.column);
  entries_.add_to(gathered_, scaled_, visibility);
  for (std::size_t k = 0; k < gathered_.size(); ++k) sums[rows.receivers()[k]] = gathered_[k];
}

}  // namespace lumirank::methods
