#include "transport/segments/segment_graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nanoflann.hpp>

#include "base/parallel.h"

namespace lumirank::transport {

namespace {

constexpr std::size_t kNeighbors = 5;
// Points asked for at either end: some are the segment's own, and two may be of one neighbor.
constexpr std::size_t kPointsAsked = 9;
// Graphs have whole weights: what a similarity of 1 is worth.
constexpr float kWeightOfOne = 1000;

// Beginnings and ends in turn.
struct EndPoints {
  std::vector<Vec3f> points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t k, std::size_t axis) const { return points[k][static_cast<int>(axis)]; }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using EndPointTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, EndPoints>,
                                                         EndPoints, 3, std::uint32_t>;

using Neighbors = std::array<std::uint32_t, kNeighbors>;

// Those that there are; the rest is the segment itself.
Neighbors nearest(const EndPointTree& tree, const EndPoints& ends, std::uint32_t s) {
  std::array<std::pair<float, std::uint32_t>, 2 * kPointsAsked> found;
  std::size_t count = 0;
  for (const std::uint32_t point : {2 * s, 2 * s + 1}) {
    std::array<std::uint32_t, kPointsAsked> index;
    std::array<float, kPointsAsked> square;
    const Vec3f p = ends.points[point];
    const float query[3] = {p.x, p.y, p.z};
    const std::size_t here = tree.knnSearch(query, kPointsAsked, index.data(), square.data());
    for (std::size_t k = 0; k < here; ++k) found[count++] = {square[k], index[k] / 2};
  }
  std::sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count));
  Neighbors out;
  out.fill(s);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < count && kept < kNeighbors; ++k) {
    const std::uint32_t other = found[k].second;
    if (other != s && std::find(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(kept), other) ==
                          out.begin() + static_cast<std::ptrdiff_t>(kept))
      out[kept++] = other;
  }
  return out;
}

}  // namespace

linalg::Graph segment_graph(std::span<const Segment> segments, const SegmentSimilarity& similarity) {
  if (segments.empty()) return {};
  EndPoints ends;
  for (const Segment& s : segments) ends.points.push_back(s.origin), ends.points.push_back(s.end());
  const EndPointTree tree(3, ends);
  std::vector<Neighbors> neighbors(segments.size());
  constexpr std::size_t kGrain = 512;
  parallel_for(segments.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      neighbors[s] = nearest(tree, ends, static_cast<std::uint32_t>(s));
  });
  std::vector<linalg::Edge> edges;
  for (std::uint32_t s = 0; s < segments.size(); ++s)
    for (const std::uint32_t other : neighbors[s])
      if (other != s)
        edges.push_back({s, other,
                         1 + static_cast<std::int32_t>(std::lround(
                                 kWeightOfOne * std::max(0.0f, similarity(segments[s], segments[other]))))});
  return linalg::graph_of(segments.size(), std::move(edges));
}

}  // namespace lumirank::transport
