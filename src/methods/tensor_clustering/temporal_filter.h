// Means over neighboring frames, so that what is left of error does not flicker (ours; not in the paper).
//
// A row takes the mean of what it and the rows that it maps to show in one earlier and one later frame. The
// mean of such a pair leaves alone what changes evenly, so light that slides over a surface stays where it
// is; what is averaged out is what goes up and down. A pair counts the less the farther its mean is from what
// the row has (Tukey's biweight), and not at all where a mapping does not reach: there something has moved
// past. Between the rows of the other frames light is interpolated, or what moves would be jittered by up to
// half the distance of rows; where those rows differ much there is detail that this would blur, so a pair
// counts the less for that as well.
#pragma once

#include <cstddef>
#include <vector>

#include "base/rgb.h"
#include "methods/tensor_clustering/row_mapping.h"

namespace lumirank::methods {

struct TemporalFilter {
  std::size_t passes = 0;   // each averages over one frame on either side; 0: none
  double max_distance = 0;  // of a mapping, see reaches()
  // Of a pair's mean from a row's light, and of the rows that it is interpolated from among each other, as a
  // part of the row's light and `unseen`: there a pair has lost a fifth of its
  // weight, and at three times as much all of it. So a pass changes light by at most 0.6 of it. 0: any
  double max_change = 0;
};

struct FilteredShot {
  std::vector<std::vector<Rgb>> sums;  // light of all rows of each frame
  const FrameMappings& mappings;
  std::vector<matrix::RowFeatures> features;  // of the rows of each frame; for as long as it is filtered
  std::vector<float> unseen;                  // light of each frame that counts as none
  float scale = 0;                            // that the mappings were made with
};

// Light of all rows of each frame. Where a frame and those around it are equal they stay so, to the bit.
std::vector<std::vector<Rgb>> filter_in_time(FilteredShot shot, const TemporalFilter& filter);

}  // namespace lumirank::methods
