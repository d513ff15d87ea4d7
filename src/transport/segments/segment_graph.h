// The graph of segments: each is linked to those nearest to it (Huo et al. 2016, section 4.2.1).
#pragma once

#include <span>

#include "linalg/graph_partition.h"
#include "transport/segments/segment.h"

namespace lumirank::transport {

// Five neighbors of each, found by the nearest beginnings and ends, weighted by similarity.
linalg::Graph segment_graph(std::span<const Segment> segments, const SegmentSimilarity& similarity);

}  // namespace lumirank::transport
