// Sums over slices of what they took and had.
#pragma once

#include <cstdint>
#include <string>

#include "base/timer.h"
#include "methods/method.h"
#include "methods/slice_cuts/slice_columns.h"

namespace lumirank::methods {

struct SliceTally {
  double seconds_cut = 0, seconds_splitting = 0, seconds_visibility = 0, seconds_gather = 0;
  std::uint64_t slices = 0, rows = 0, columns = 0, max_columns = 0;
  std::uint64_t shades = 0;   // unoccluded entries, per receiver
  std::uint64_t entries = 0;  // of the reduced matrices
  std::uint64_t sampled = 0;  // of these, exactly evaluated visibilities; with those of splitting

  SliceTally& operator+=(const SliceTally& o);
  // The time of SliceColumns::choose(), which the cut divides into its two parts.
  void add_choice(double seconds, const SliceCut& cut);
  // A slice that is finished.
  void add(const SliceColumns& slice);
  // In unoccluded entries; a visibility costs about as much as eight of them.
  double cost() const { return static_cast<double>(shades) + 8 * static_cast<double>(sampled); }
};

// visibility: what the step is called by which visibility became known.
void write_tally(const SliceTally& tally, const std::string& visibility, Trace& trace);

// CPU time of a thread, step after step.
class StepTimer {
 public:
  // Seconds since the step before.
  double step() {
    const double now = timer_.seconds(), since = now - last_;
    last_ = now;
    return since;
  }

 private:
  ThreadTimer timer_;
  double last_ = 0;
};

}  // namespace lumirank::methods
