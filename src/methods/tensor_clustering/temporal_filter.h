// Means over neighboring frames, so that what is left of error does not flicker (ours; not in the paper).
//
// A row takes the mean of what it and the rows that it maps to show in as many earlier as later frames. A
// mean of such pairs leaves alone what changes evenly, so light that slides over a surface stays where it is;
// what is averaged out is what goes up and down. A pair is left out, with all that are farther off, if a
// mapping does not reach, or if its mean is far from what the row has: there something has moved past.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/rgb.h"
#include "methods/tensor_clustering/row_mapping.h"

namespace lumirank::methods {

struct TemporalFilter {
  std::size_t radius = 0;   // frames on either side; 0: none
  double max_distance = 0;  // of a mapping, in distances of neighboring rows; 0: any
  double max_change = 0;    // of a pair's mean from a row's light, as a part of this and `unseen`; 0: any
};

struct FilteredShot {
  const std::vector<std::vector<Rgb>>& sums;  // light of all rows of each frame
  const FrameMappings& mappings;
  // Of the rows of each frame, by which light is divided on the way; empty where it is not known.
  std::vector<std::span<const Rgb>> albedo;
  std::vector<float> unseen;  // light of each frame that counts as none
};

// Light of all rows of each frame. Where a frame and those around it are equal they stay so, to the bit.
std::vector<std::vector<Rgb>> filter_in_time(const FilteredShot& shot, const TemporalFilter& filter);

}  // namespace lumirank::methods
