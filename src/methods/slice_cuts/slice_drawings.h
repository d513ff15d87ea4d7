// A slice's columns for one picture: chosen once, and drawn as often as the settings say, each time for a
// part of the slice's pixels.
#pragma once

#include "methods/common/slices/slices.h"
#include "methods/slice_cuts/slice_columns.h"
#include "methods/slice_cuts/slice_tally.h"

namespace lumirank::methods {

// Work space of one thread.
class SliceDrawings {
 public:
  explicit SliceDrawings(const matrix::RowFeatures& features) : features_(features) {}

  // body() with `columns` as drawn, of all of the slice or of each part. Their choice counts in `tally`.
  template <typename Body>
  void run(const SliceCutSettings& settings, std::span<const matrix::Index> slice, std::uint64_t key,
           SliceColumns& columns, SliceTally& tally, Body&& body) {
    StepTimer timer;
    columns.choose(settings, slice, key);
    tally.add_choice(timer.step(), columns.cut());
    // Without redrawing, representatives are those that the choice went by: there is one of each.
    if (settings.drawings <= 1 || !settings.splitting || !settings.redraw) {
      body();
      return;
    }
    deal_.deal(features_, slice, settings.drawings, key);
    for (std::size_t d = 0; d < settings.drawings; ++d) {
      if (deal_.part(d).empty()) continue;
      timer.step();
      columns.redraw(settings, deal_.part(d), key, d);
      tally.seconds_splitting += timer.step();
      body();
    }
  }

 private:
  matrix::RowFeatures features_;
  PixelDeal deal_;
};

}  // namespace lumirank::methods
