#include "transport/segments/segment_groups.h"

#include <algorithm>
#include <map>
#include <utility>

#include "linalg/kernel_boundary.h"
#include "transport/segments/segment_graph.h"

namespace lumirank::transport {

namespace {

// Of a boundary between two groups at most: training takes the square of them.
constexpr std::size_t kMostBoundarySegments = 150;
// A cut nearer to an end than this part of the segment is not worth a segment of its own.
constexpr float kLeastPart = 0.05f;
constexpr int kBisections = 12;

using GroupPair = std::pair<std::uint32_t, std::uint32_t>;

struct Cut {
  float at = -1;                         // along the segment; below 0: none
  std::uint32_t before = 0, behind = 0;  // groups
};

// Of each pair of groups that meet the segments at which they do, ascending.
std::map<GroupPair, std::vector<std::uint32_t>> boundaries(const linalg::Graph& graph,
                                                           std::span<const std::uint32_t> group) {
  std::map<GroupPair, std::vector<std::uint32_t>> out;
  for (std::uint32_t v = 0; v < graph.nodes(); ++v)
    for (auto e = static_cast<std::size_t>(graph.first[v]); e < static_cast<std::size_t>(graph.first[v + 1]);
         ++e) {
      const std::uint32_t other = group[static_cast<std::size_t>(graph.neighbor[e])];
      if (other == group[v]) continue;
      auto& list = out[std::minmax(group[v], other)];
      if (list.empty() || list.back() != v) list.push_back(v);
    }
  return out;
}

// Where segments cross the surface between the two groups.
void cut_at_boundary(std::span<const Segment> segments, std::span<const std::uint32_t> group, GroupPair pair,
                     std::span<const std::uint32_t> at, double kernel_width, std::vector<Cut>& cuts) {
  std::vector<Vec3f> points;
  std::vector<std::uint8_t> second;
  const std::size_t stride = (at.size() + kMostBoundarySegments - 1) / kMostBoundarySegments;
  for (std::size_t k = 0; k < at.size(); k += stride) {
    const Segment& s = segments[at[k]];
    for (const Vec3f p : {s.origin, s.end()}) {
      points.push_back(p);
      second.push_back(group[at[k]] == pair.second);
    }
  }
  if (std::ranges::count(second, std::uint8_t{1}) == 0 || std::ranges::count(second, std::uint8_t{0}) == 0)
    return;
  const linalg::KernelBoundary boundary(points, second, kernel_width);
  for (const std::uint32_t v : at) {
    if (cuts[v].at >= 0) continue;  // at another boundary already
    const Segment& s = segments[v];
    const bool begins_second = boundary.side(s.origin) > 0, ends_second = boundary.side(s.end()) > 0;
    if (begins_second == ends_second) continue;
    float low = 0, high = s.length;
    for (int step = 0; step < kBisections; ++step) {
      const float middle = 0.5f * (low + high);
      ((boundary.side(s.origin + s.direction * middle) > 0) == begins_second ? low : high) = middle;
    }
    const float place = 0.5f * (low + high);
    if (place < kLeastPart * s.length || place > (1 - kLeastPart) * s.length) continue;
    cuts[v] = {place, begins_second ? pair.second : pair.first, begins_second ? pair.first : pair.second};
  }
}

// Pieces, each put together with the one before it where that is alike.
class PieceList {
 public:
  PieceList(std::span<const Segment> segments, const SegmentSimilarity& similarity, float merge_above)
      : segments_(segments), similarity_(similarity), merge_above_(merge_above) {}

  // `joined`: it goes on where the one before it ends.
  void append(std::uint32_t source, float offset, float length, std::uint32_t group, bool joined) {
    Segment piece = segments_[source];
    piece.origin = piece.origin + piece.direction * offset, piece.length = length;
    // Over part of a segment, as if the medium were the same all along it.
    if (length < segments_[source].length)
      piece.transmittance = std::pow(std::max(piece.transmittance, 1e-6f), length / segments_[source].length);
    if (joined && pieces_.back().group == group && similarity_(last_, piece) > merge_above_) {
      pieces_.back().length += length;
      last_.length += length, last_.transmittance *= piece.transmittance;
      return;
    }
    pieces_.push_back({source, offset, length, group});
    last_ = piece;
  }
  std::vector<SegmentPiece> take() && { return std::move(pieces_); }

 private:
  std::span<const Segment> segments_;
  const SegmentSimilarity& similarity_;
  float merge_above_;
  std::vector<SegmentPiece> pieces_;
  Segment last_;  // the last piece, as a segment
};

}  // namespace

std::vector<SegmentPiece> group_segments(std::span<const Segment> segments,
                                         const SegmentSimilarity& similarity,
                                         const SegmentGroupSettings& settings) {
  const linalg::Graph graph = segment_graph(segments, similarity);
  const auto group = linalg::partition_graph(graph, settings.groups, settings.seed);
  std::vector<Cut> cuts(segments.size());
  if (settings.refine)
    for (const auto& [pair, at] : boundaries(graph, group))
      cut_at_boundary(segments, group, pair, at, settings.kernel_width, cuts);

  PieceList out(segments, similarity, settings.merge ? settings.merge_above : similarity.most());
  for (std::uint32_t v = 0; v < segments.size(); ++v) {
    const Segment& s = segments[v];
    const bool joined = s.joined && v > 0;
    if (cuts[v].at < 0) {
      out.append(v, 0, s.length, group[v], joined);
    } else {
      out.append(v, 0, cuts[v].at, cuts[v].before, joined);
      out.append(v, cuts[v].at, s.length - cuts[v].at, cuts[v].behind, true);
    }
  }
  return std::move(out).take();
}

std::vector<SegmentPiece> merge_segments(std::span<const Segment> segments,
                                         const SegmentSimilarity& similarity, float merge_above) {
  PieceList out(segments, similarity, merge_above);
  for (std::uint32_t v = 0; v < segments.size(); ++v)
    out.append(v, 0, segments[v].length, 0, segments[v].joined && v > 0);
  return std::move(out).take();
}

}  // namespace lumirank::transport
