#include "transport/lights/ray_tree.h"

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"
#include "media/tracking.h"
#include "transport/lights/cut_rays.h"
#include "transport/segments/cut_points.h"
#include "transport/segments/segment_graph.h"
#include "transport/segments/segment_groups.h"

namespace lumirank::transport {

namespace {

// Segments of a group whose boundaries refine them, about.
constexpr std::size_t kSegmentsOfGroup = 1000;
// Groups that are divided no further by their graph: places do for so few.
constexpr std::size_t kSmallGroup = 256;
constexpr int kMostLevels = 60;

struct CutRays {
  RayLights lights;
  std::vector<Segment> segments;
};

const media::Medium& medium_of(const world::World& world, const RayLights& rays, std::size_t j) {
  return world.media()[static_cast<std::size_t>(rays.medium[j])];
}

// At places at which the light would collide.
CutRays cut(const world::World& world, const RayLights& rays, const RayTreeSettings& settings) {
  CutRays out;
  std::vector<float> ends;
  std::vector<Rgb> passed;
  for (std::size_t j = 0; j < rays.size(); ++j) {
    Rng rng(settings.seed, Stage::segments, rays.id[j]);
    cut_points(medium_of(world, rays, j), rays.origin[j], rays.direction[j], rays.length[j], settings.pieces,
               rng, ends);
    ends.push_back(rays.length[j]);
    const std::size_t first = out.lights.size();
    passed.clear();
    append_pieces(world, rays, j, ends, rng, out.lights, passed);
    for (std::size_t k = 0; k < passed.size(); ++k)
      out.segments.push_back({out.lights.origin[first + k], rays.direction[j], out.lights.length[first + k],
                              rays.medium[j], mean(passed[k]), Vec2f{}, k > 0});
  }
  return out;
}

CutRays regrouped(const world::World& world, const CutRays& rays, const SegmentSimilarity& similarity,
                  const RayTreeSettings& settings) {
  SegmentGroupSettings groups;
  groups.groups = std::max<std::size_t>(1, rays.segments.size() / kSegmentsOfGroup);
  groups.refine = settings.refine, groups.merge = settings.merge, groups.seed = settings.seed;
  CutRays out;
  for (const SegmentPiece& piece : group_segments(rays.segments, similarity, groups)) {
    const std::size_t j = piece.source;
    Rgb power = rays.lights.power[j];
    std::uint64_t id = rays.lights.id[j];
    Rng rng(settings.seed, Stage::segments, mix64(id ^ 0x63757473ull));
    const auto random = [&rng] { return rng.next_float(); };
    if (piece.offset > 0) {
      id = mix64(id ^ 0x63757473ull);
      power *= media::transmittance(medium_of(world, rays.lights, j), rays.lights.origin[j],
                                    rays.lights.direction[j], piece.offset, random);
    }
    if (is_black(power)) continue;
    append_piece(rays.lights, j, piece.offset, piece.length, power, id, out.lights);
    const Segment& source = rays.segments[j];
    out.segments.push_back(
        {out.lights.origin.back(), source.direction, piece.length, source.medium,
         mean(media::transmittance(medium_of(world, rays.lights, j), out.lights.origin.back(),
                                   source.direction, piece.length, random)),
         Vec2f{}, false});
  }
  return out;
}

// Halves of halves of a graph, into the bits of `branch`.
class Bisection {
 public:
  Bisection(std::uint64_t seed, std::vector<std::uint64_t>& branch) : seed_(seed), branch_(branch) {}

  // `nodes`: who the graph's nodes are.
  void divide(const linalg::Graph& graph, std::span<const std::uint32_t> nodes, int level,
              std::uint64_t code) {
    if (nodes.size() <= kSmallGroup || level >= kMostLevels) {
      for (const std::uint32_t v : nodes) branch_[v] = code;
      return;
    }
    auto side = linalg::partition_graph(
        graph, 2, hash_ids(seed_, Stage::segments, code, static_cast<std::uint64_t>(level)));
    const auto second = static_cast<std::size_t>(std::ranges::count(side, 1u));
    if (second == 0 || second == nodes.size())
      for (std::size_t v = 0; v < side.size(); ++v) side[v] = v < side.size() / 2 ? 0 : 1;
    parallel_for(2, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t half = begin; half < end; ++half) {
        std::vector<std::uint32_t> members;
        const linalg::Graph part = part_of(graph, nodes, side, static_cast<std::uint32_t>(half), members);
        divide(part, members, level + 1, code | static_cast<std::uint64_t>(half) << (63 - level));
      }
    });
  }

 private:
  static linalg::Graph part_of(const linalg::Graph& graph, std::span<const std::uint32_t> nodes,
                               std::span<const std::uint32_t> side, std::uint32_t half,
                               std::vector<std::uint32_t>& members) {
    std::vector<std::int32_t> number(nodes.size(), -1);
    for (std::size_t v = 0; v < nodes.size(); ++v)
      if (side[v] == half) {
        number[v] = static_cast<std::int32_t>(members.size());
        members.push_back(nodes[v]);
      }
    linalg::Graph part;
    for (std::size_t v = 0; v < nodes.size(); ++v) {
      if (side[v] != half) continue;
      for (auto e = static_cast<std::size_t>(graph.first[v]);
           e < static_cast<std::size_t>(graph.first[v + 1]); ++e) {
        const std::int32_t to = number[static_cast<std::size_t>(graph.neighbor[e])];
        if (to < 0) continue;
        part.neighbor.push_back(to), part.weight.push_back(graph.weight[e]);
      }
      part.first.push_back(static_cast<std::int32_t>(part.neighbor.size()));
    }
    return part;
  }

  std::uint64_t seed_;
  std::vector<std::uint64_t>& branch_;
};

}  // namespace

void build_ray_tree(const world::World& world, const RayTreeSettings& settings, RayLights& rays,
                    const Sinks& sinks) {
  const SegmentSimilarity similarity(world.media(), 2 * world.bounds().radius(), false);
  CutRays cut_rays = regrouped(world, cut(world, rays, settings), similarity, settings);
  if (sinks.cancelled()) throw Cancelled();
  rays = std::move(cut_rays.lights);
  rays.branch.assign(rays.size(), 0);
  if (rays.empty()) return;
  const linalg::Graph graph = segment_graph(cut_rays.segments, similarity);
  std::vector<std::uint32_t> all(rays.size());
  for (std::uint32_t v = 0; v < all.size(); ++v) all[v] = v;
  Bisection(settings.seed, rays.branch).divide(graph, all, 0, 0);
}

}  // namespace lumirank::transport
