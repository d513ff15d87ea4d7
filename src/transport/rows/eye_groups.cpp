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

GroupedStretch group_stretch(const world::World& world, const EyeSegments& all, std::span<const Vec2f> film,
                             std::size_t begin, std::size_t end, std::size_t groups,
                             const EyeGroupSettings& settings) {
  std::vector<Segment> segments(end - begin);
  for (std::size_t k = begin; k < end; ++k) {
    Rng rng(settings.seed, Stage::segments, all.id[k]);
    segments[k - begin] = {all.origin[k],
                           all.direction[k],
                           all.length[k],
                           all.medium[k],
                           mean(through(world, all, k, all.length[k], rng)),
                           film[all.sample[k]],
                           k > begin && joins(all, k)};
  }
  const SegmentSimilarity similarity(world.media(), 2 * world.bounds().radius(), true);
  SegmentGroupSettings of_groups;
  of_groups.groups = groups, of_groups.refine = settings.refine, of_groups.merge = settings.merge;
  of_groups.seed = hash_ids(settings.seed, Stage::segments, begin);
  GroupedStretch out;
  for (const SegmentPiece& piece : group_segments(segments, similarity, of_groups)) {
    const std::size_t k = begin + piece.source;
    EyeSegment s{all.origin[k], all.direction[k], piece.length, all.weight[k],
                 all.id[k],     all.sample[k],    all.depth[k], all.medium[k]};
    if (piece.offset > 0) {
      s.id = mix64(s.id ^ 0x63757473ull);
      Rng rng(settings.seed, Stage::segments, s.id);
      s.weight *= through(world, all, k, piece.offset, rng);
      s.origin = s.origin + s.direction * piece.offset;
    }
    if (is_black(s.weight)) continue;
    out.segments.push_back(s), out.group.push_back(piece.group);
  }
  return out;
}

}  // namespace

void group_eye_segments(const world::World& world, std::span<const Vec2f> film,
                        const EyeGroupSettings& settings, EyeSegments& segments, const Sinks& sinks) {
  // Stretches end where a film sample does.
  std::vector<std::size_t> first{0};
  for (std::size_t k = 1; k < segments.size(); ++k)
    if (segments.sample[k] / kRaysOfStretch != segments.sample[k - 1] / kRaysOfStretch) first.push_back(k);
  first.push_back(segments.size());
  if (segments.empty()) first = {0};
  const std::size_t stretches = first.size() - 1;
  const auto groups = static_cast<std::size_t>(
      std::max(1.0, std::round(settings.groups_per_ray * static_cast<double>(kRaysOfStretch))));
  std::vector<GroupedStretch> grouped(stretches);
  std::atomic<std::size_t> done{0};
  parallel_for(stretches, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end && !sinks.cancelled(); ++t) {
      const std::size_t own = first[t + 1] - first[t];
      grouped[t] = group_stretch(world, segments, film, first[t], first[t + 1],
                                 std::clamp<std::size_t>(groups * own / kFullStretch, 1, groups), settings);
      sinks.report("segments", static_cast<double>(++done) / static_cast<double>(stretches));
    }
  });
  if (sinks.cancelled()) throw Cancelled();
  std::size_t count = 0;
  for (const GroupedStretch& g : grouped) count += g.segments.size();
  segments.resize(count);
  segments.slice.clear();
  std::size_t next = 0;
  for (std::size_t t = 0; t < stretches; ++t)
    for (std::size_t k = 0; k < grouped[t].segments.size(); ++k) {
      segments.set(next++, grouped[t].segments[k]);
      segments.slice.push_back(static_cast<std::uint32_t>(t * groups) + grouped[t].group[k]);
    }
}

}  // namespace lumirank::transport
