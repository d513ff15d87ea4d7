// Segments put together where they are alike, and in groups, cut anew where groups meet (Huo et al. 2016,
// sections 4.2.2 and 4.2.3).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "transport/segments/segment.h"

namespace lumirank::transport {

// A part of a ray: `length` from `offset` on segment `source` on, over those that are joined to it.
struct SegmentPiece {
  std::uint32_t source;
  float offset, length;
  std::uint32_t group;
};

struct SegmentGroupSettings {
  std::size_t groups = 1;
  bool refine = true;         // cut at the boundaries of groups, by a support vector machine
  bool merge = true;          // put together again what is alike, within a group
  float merge_above = 2.5f;   // similarity
  double kernel_width = 0.5;  // γ, in units of the root mean square distance of a boundary's points
  std::uint64_t seed = 1;
};

// All of all segments, in their order. Where the paper leaves it open, or does otherwise: a segment is cut at
// one boundary at most, the first of its group's; a boundary is trained on 150 of its segments at most, since
// training takes the square of them; and all neighbors on a ray that are alike are put together, not those
// alone that a cut has made: 17 pieces at 0.008 groups per ray are 2,125 in a group, and section 4.3 speaks
// of 500 to 1,000. Joined segments follow each other in the list.
std::vector<SegmentPiece> group_segments(std::span<const Segment> segments,
                                         const SegmentSimilarity& similarity,
                                         const SegmentGroupSettings& settings);

// All of all segments, in their order, as one group: neighbors on a ray are put together while the piece that
// they make is more alike to the next of them than `merge_above`. No graph is needed for that.
std::vector<SegmentPiece> merge_segments(std::span<const Segment> segments,
                                         const SegmentSimilarity& similarity, float merge_above);

}  // namespace lumirank::transport
