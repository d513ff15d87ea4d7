#include "transport/rows/eye_groups.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "media/tracking.h"
#include "transport/segments/segment_groups.h"

namespace lumirank::transport {

namespace {

constexpr std::uint32_t kRaysOfStretch = 4096;
// From which a stretch has as many groups as its rays ask for: one at the edge of a medium has fewer, of the
// same size.
constexpr std::size_t kFullStretch = std::size_t{kRaysOfStretch} * 4;
// Weights below this were put up by roulette (eye_chain.cpp), so that what they stand for is not known from
// the segment before.
constexpr float kCertainWeight = 0.01f;

// Whether segment k goes on where the one before it ends, on the same ray, and none between was left out.
bool joins(const EyeSegments& s, std::size_t k) {
  if (k == 0 || s.sample[k] != s.sample[k - 1] || s.medium[k] != s.medium[k - 1]) return false;
  if (s.depth[k] != s.depth[k - 1] || s.direction[k] != s.direction[k - 1]) return false;
  const float scale = s.length[k - 1] + s.length[k];
  const Vec3f end = s.origin[k - 1] + s.direction[k - 1] * s.length[k - 1];
  return length(end - s.origin[k]) <= 1e-3f * scale &&
         std::min(max_component(s.weight[k - 1]), max_component(s.weight[k])) > kCertainWeight;
}

Rgb through(const world::World& world, const EyeSegments& s, std::size_t k, float t, Rng& rng) {
  return media::transmittance(world.media()[static_cast<std::size_t>(s.medium[k])], s.origin[k],
                              s.direction[k], t, [&rng] { return rng.next_float(); });
}

struct GroupedStretch {
  std::vector<EyeSegment> segments;
  std::vector<std::uint32_t> group;
};

// Those of [begin, end), as they are compared.
std::vector<Segment> stretch_of(const world::World& world, const EyeSegments& all,
                                std::span<const Vec2f> film, std::size_t begin, std::size_t end,
                                std::uint64_t seed) {
  std::vector<Segment> segments(end - begin);
  for (std::size_t k = begin; k < end; ++k) {
    Rng rng(seed, Stage::segments, all.id[k]);
    segments[k - begin] = {all.origin[k],
                           all.direction[k],
                           all.length[k],
                           all.medium[k],
                           mean(through(world, all, k, all.length[k], rng)),
                           film[all.sample[k]],
                           k > begin && joins(all, k)};
  }
  return segments;
}

GroupedStretch as_eye_segments(const world::World& world, const EyeSegments& all, std::size_t begin,
                               std::span<const SegmentPiece> pieces, std::uint64_t seed) {
  GroupedStretch out;
  for (const SegmentPiece& piece : pieces) {
    const std::size_t k = begin + piece.source;
    EyeSegment s{all.origin[k], all.direction[k], piece.length, all.weight[k],
                 all.id[k],     all.sample[k],    all.depth[k], all.medium[k]};
    if (piece.offset > 0) {
      s.id = mix64(s.id ^ 0x63757473ull);
      Rng rng(seed, Stage::segments, s.id);
      s.weight *= through(world, all, k, piece.offset, rng);
      s.origin = s.origin + s.direction * piece.offset;
    }
    if (is_black(s.weight)) continue;
    out.segments.push_back(s), out.group.push_back(piece.group);
  }
  return out;
}

// Of segments that are compared and put into `group` by `pieces_of(segments, begin)`. Stretches end where a
// film sample does.
template <typename PiecesOf>
std::vector<GroupedStretch> by_stretches(const world::World& world, const EyeSegments& segments,
                                         std::span<const Vec2f> film, std::uint64_t seed, const Sinks& sinks,
                                         const PiecesOf& pieces_of) {
  std::vector<std::size_t> first{0};
  for (std::size_t k = 1; k < segments.size(); ++k)
    if (segments.sample[k] / kRaysOfStretch != segments.sample[k - 1] / kRaysOfStretch) first.push_back(k);
  if (!segments.empty()) first.push_back(segments.size());
  std::vector<GroupedStretch> grouped(first.size() - 1);
  std::atomic<std::size_t> done{0};
  parallel_for(grouped.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end && !sinks.cancelled(); ++t) {
      const auto compared = stretch_of(world, segments, film, first[t], first[t + 1], seed);
      grouped[t] = as_eye_segments(world, segments, first[t], pieces_of(compared, first[t]), seed);
      sinks.report("segments", static_cast<double>(++done) / static_cast<double>(grouped.size()));
    }
  });
  if (sinks.cancelled()) throw Cancelled();
  return grouped;
}

// Writes them, and what slice each is of: `groups` for each stretch, or with 0 none.
void write(std::span<const GroupedStretch> grouped, std::size_t groups, EyeSegments& segments) {
  std::size_t count = 0;
  for (const GroupedStretch& g : grouped) count += g.segments.size();
  segments.resize(count);
  segments.slice.clear();
  std::size_t next = 0;
  for (std::size_t t = 0; t < grouped.size(); ++t)
    for (std::size_t k = 0; k < grouped[t].segments.size(); ++k) {
      segments.set(next++, grouped[t].segments[k]);
      if (groups > 0) segments.slice.push_back(static_cast<std::uint32_t>(t * groups) + grouped[t].group[k]);
    }
}

}  // namespace

void group_eye_segments(const world::World& world, std::span<const Vec2f> film,
                        const EyeGroupSettings& settings, EyeSegments& segments, const Sinks& sinks) {
  const auto groups = static_cast<std::size_t>(
      std::max(1.0, std::round(settings.groups_per_ray * static_cast<double>(kRaysOfStretch))));
  const SegmentSimilarity similarity(world.media(), 2 * world.bounds().radius(), true);
  const auto grouped = by_stretches(
      world, segments, film, settings.seed, sinks, [&](std::span<const Segment> compared, std::size_t begin) {
        SegmentGroupSettings own;
        own.groups = std::clamp<std::size_t>(groups * compared.size() / kFullStretch, 1, groups);
        own.refine = settings.refine, own.merge = settings.merge;
        own.seed = hash_ids(settings.seed, Stage::segments, begin);
        return group_segments(compared, similarity, own);
      });
  write(grouped, groups, segments);
}

void merge_eye_segments(const world::World& world, std::span<const Vec2f> film, float merge_above,
                        std::uint64_t seed, EyeSegments& segments, const Sinks& sinks) {
  const SegmentSimilarity similarity(world.media(), 2 * world.bounds().radius(), true);
  const auto merged =
      by_stretches(world, segments, film, seed, sinks, [&](std::span<const Segment> compared, std::size_t) {
        return merge_segments(compared, similarity, merge_above);
      });
  write(merged, 0, segments);
}

}  // namespace lumirank::transport
