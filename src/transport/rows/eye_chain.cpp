#include "transport/rows/eye_chain.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "media/tracking.h"
#include "transport/rows/receivers.h"
#include "transport/segments/cut_points.h"

namespace lumirank::transport {
namespace {

using scatter::Closure;
using scatter::LobeKind;

// Chains lighter than this survive in proportion to their weight, so that dense glass does not fill the
// matrix with rows that nobody can see.
constexpr float kFaint = 1e-3f;
// From this many surfaces on, a chain survives with the probability below: two mirrors may face each other.
constexpr int kLong = 16;
constexpr float kLongSurvival = 0.75f;

// True if the chain goes on; its weight then makes up for those that do not.
bool roulette(Rgb& weight, int vertices, Rng& rng) {
  float survival = std::min(1.0f, max_component(weight) / kFaint);
  if (vertices >= kLong) survival = std::min(survival, kLongSurvival);
  if (survival >= 1) return true;
  if (rng.next_float() >= survival) return false;
  weight *= 1 / survival;
  return true;
}

// Which of the six faces of a cube around the origin `n` points at.
int face(Vec3f n) {
  const float x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  const int axis = x >= y && x >= z ? 0 : (y >= z ? 1 : 2);
  return 2 * axis + (n[axis] < 0 ? 1 : 0);
}

}  // namespace

void sort_by_shading(std::vector<EyeVertex>::iterator begin, std::vector<EyeVertex>::iterator end) {
  const auto key = [](const EyeVertex& v) {
    return std::array<int, 3>{v.closure == Receivers::kLambertian ? 0 : 1, v.depth, face(v.normal)};
  };
  std::stable_sort(begin, end, [&](const EyeVertex& a, const EyeVertex& b) { return key(a) < key(b); });
}

void EyeChain::add_receiver(const world::SurfaceHit& hit, const Closure& closure, const Segment& s,
                            std::uint32_t sample, std::vector<EyeVertex>& out,
                            scatter::ClosurePool* pool) const {
  EyeVertex v;
  v.position = hit.point.position;
  v.wo = -s.ray.direction;
  const float side = dot(closure.frame.n, v.wo) < 0 ? -1.0f : 1.0f;
  v.normal = closure.frame.n * side;
  v.ng = closure.ng * side;
  v.weight = s.weight;
  v.id = s.id;
  v.sample = sample;
  v.depth = static_cast<std::uint16_t>(std::min(s.depth, 0xffff));
  v.surface = static_cast<std::uint32_t>(mix64(s.chain ^ static_cast<std::uint64_t>(hit.material)) >> 32);
  v.distance = s.length + hit.hit.t;
  v.medium[0] = static_cast<std::int16_t>(s.medium);
  v.medium[1] = static_cast<std::int16_t>(world_.medium_beyond(hit, s.ray.direction, s.medium));
  v.closure = Receivers::kLambertian;
  if (closure.is_lambertian()) {
    v.albedo = closure.diffuse_color();
  } else if (pool) {
    v.closure = pool->add(closure, v.normal);
  } else {
    const Closure seen = scatter::broad_part(closure, 0);
    v.albedo = scatter::rough_albedo(seen, v.wo);
    v.roughness = seen.roughness();
  }
  out.push_back(v);
}

void EyeChain::continue_from(const world::SurfaceHit& hit, const Closure& closure, const Segment& s, Rng& rng,
                             bool straight_only) {
  scatter::DeltaContinuation next[scatter::kMaxLobes + 1];
  const int all = scatter::delta_continuations(closure, -s.ray.direction, next);
  const auto out_of_depth = [&](const scatter::DeltaContinuation& c) {
    return is_black(c.weight) || (straight_only && c.kind != LobeKind::delta_pass) ||
           (c.kind != LobeKind::delta_pass && settings_.max_depth >= 0 && s.depth + 1 > settings_.max_depth);
  };
  // Which of all continuations each is: part of its id, whether or not the others are followed.
  std::uint64_t numbers[scatter::kMaxLobes + 1];
  int count = 0;
  for (int k = 0; k < all; ++k) {
    if (out_of_depth(next[k])) continue;
    numbers[count] = static_cast<std::uint64_t>(k);
    next[count++] = next[k];
  }
  if (count == 0) return;

  int splits = s.splits;
  bool unlikely = s.unlikely;
  if (count > 1 && splits >= settings_.max_splits) {
    float total = 0;
    for (int k = 0; k < count; ++k) total += max_component(next[k].weight);
    float u = rng.next_float() * total;
    int drawn = 0;
    while (drawn + 1 < count && u >= max_component(next[drawn].weight))
      u -= max_component(next[drawn++].weight);
    bool likeliest = true;
    for (int k = 0; k < count; ++k)
      likeliest = likeliest && max_component(next[k].weight) <= max_component(next[drawn].weight);
    next[0] = next[drawn];
    numbers[0] = numbers[drawn];
    next[0].weight *= total / max_component(next[0].weight);
    if (!likeliest && !unlikely) unlikely_ += luminance(s.weight * next[0].weight);
    unlikely = unlikely || !likeliest;
    count = 1;
  } else if (count > 1) {
    ++splits;
  }
  for (int k = 0; k < count; ++k) {
    Rgb weight = s.weight * next[k].weight;
    if (!roulette(weight, s.vertices + 1, rng)) continue;
    const int depth = s.depth + (next[k].kind == LobeKind::delta_pass ? 0 : 1);
    const Vec3f origin = world::World::offset_origin(hit.point.position, hit.point.ng, next[k].wi);
    // What is seen straight through something is the place that is seen past it.
    std::uint64_t chain = s.chain;
    if (next[k].kind != LobeKind::delta_pass)
      chain = mix64(
          chain + (static_cast<std::uint64_t>(hit.material) << 8 | static_cast<std::uint64_t>(next[k].kind)) +
          1);
    pending_.push_back({{origin, next[k].wi},
                        weight,
                        depth,
                        splits,
                        s.vertices + 1,
                        mix64(s.id + 1 + numbers[k]),
                        chain,
                        s.length + hit.hit.t,
                        world_.medium_beyond(hit, next[k].wi, s.medium),
                        unlikely});
  }
}

// Leaves rows along the way of the segment through its medium, takes from its weight what does not come
// through, and returns what the medium itself emits towards the eye.
Rgb EyeChain::cross_medium(Segment& s, float length, std::uint32_t sample, Rng& rng) {
  const media::Medium& medium = world_.media()[static_cast<std::size_t>(s.medium)];
  const auto random = [&rng] { return rng.next_float(); };
  const Vec3f direction = normalize(s.ray.direction);
  // Without a surface behind it a ray ends where the scene does.
  if (!std::isfinite(length))
    length = 2 * world_.bounds().radius() + lumirank::length(s.ray.origin - world_.bounds().center());
  if (settings_.segments_by_depth) {
    profile_.follow(medium, s.ray.origin, direction, length);
    cut_points_by_depth(profile_, length, settings_.segments, cuts_);
  } else {
    cut_points(medium, s.ray.origin, direction, length, settings_.segments, rng, cuts_);
  }
  cuts_.push_back(length);
  Rgb emitted{0};
  float from = 0;
  // Light that scatters once more must not make the path too long.
  const bool gathers = settings_.max_depth < 0 || s.depth + 1 <= settings_.max_depth;
  for (std::size_t k = 0; k < cuts_.size(); ++k) {
    const Vec3f origin = s.ray.origin + direction * from;
    const float part = cuts_[k] - from;
    EyeSegment segment;
    segment.origin = origin, segment.direction = direction, segment.length = part;
    segment.weight = s.weight;
    segment.id = mix64(s.id + 0x5e6ull + k);
    segment.sample = sample;
    segment.depth = static_cast<std::uint16_t>(std::min(s.depth, 0xffff));
    segment.medium = static_cast<std::int16_t>(s.medium);
    if (settings_.segments_by_depth)
      segment.through = media::exp_minus(profile_.depth(cuts_[k]) - profile_.depth(from));
    Rgb weight = segment.weight;
    if (gathers && medium.scatters() && roulette(weight, 0, rng)) {
      segment.weight = weight;
      segments_.push_back(segment);
    }
    if (medium.emits()) {
      const float t = part * random();
      emitted += s.weight * media::transmittance(medium, origin, direction, t, random) *
                 medium.at(origin + direction * t).emission * part;
    }
    s.weight *= settings_.segments_by_depth ? segment.through
                                            : media::transmittance(medium, origin, direction, part, random);
    from = cuts_[k];
    if (is_black(s.weight)) break;
  }
  return emitted;
}

Rgb EyeChain::follow(const geometry::Ray& eye, std::uint64_t id, std::uint32_t sample, Rng& rng,
                     std::vector<EyeVertex>& out, scatter::ClosurePool* pool, FirstHit* first) {
  Rgb emission{0};
  straight_emission_.clear();
  unlikely_ = 0;
  const auto add_emission = [&](const Segment& s, const world::SurfaceHit* at, Rgb value) {
    if (is_black(value)) return;
    emission += s.weight * value;
    if (s.depth > 1) return;
    const float distance = at ? s.length + at->hit.t * lumirank::length(s.ray.direction) : kInfinity;
    straight_emission_.push_back({s.weight * value, distance});
  };
  pending_.clear();
  segments_.clear();
  if (settings_.max_depth != 0) pending_.push_back({eye, Rgb(1), 1, 0, 0, id, 0, 0, settings_.eye_medium});
  for (bool from_eye = true; !pending_.empty(); from_eye = false) {
    Segment s = pending_.back();
    pending_.pop_back();
    const bool seen = s.depth == 1;  // by nothing but the eye
    const auto hit = seen ? world_.intersect_from_eye(s.ray) : world_.intersect(s.ray);
    if (settings_.segments > 0 && s.medium >= 0) {
      emission +=
          cross_medium(s, hit ? hit->hit.t * lumirank::length(s.ray.direction) : kInfinity, sample, rng);
      if (is_black(s.weight)) continue;
    }
    if (!hit) {
      if (!(seen && world_.hides_emitters()))
        add_emission(s, nullptr, world_.background(s.ray.direction) + world_.sun_disc(s.ray.direction));
      continue;
    }
    if (s.medium >= 0 && settings_.segments == 0) {
      s.weight *= world_.left_by_glass(s.medium, hit->hit.t * lumirank::length(s.ray.direction));
      if (is_black(s.weight)) continue;
    }
    const Vec3f wo = -s.ray.direction;
    if (hit->emitter >= 0) add_emission(s, &*hit, world_.emitted(*hit, wo));
    Closure closure = world_.materials().closure(world_.materials().seen(hit->material), hit->point, wo);
    scatter::face_viewer(closure, wo);
    if (from_eye && first) {
      const float side = dot(closure.frame.n, wo) < 0 ? -1.0f : 1.0f;
      const float ng_side = dot(closure.ng, wo) < 0 ? -1.0f : 1.0f;
      *first = {scatter::albedo(closure, wo), closure.frame.n * side, closure.ng * ng_side,
                hit->point.position, hit->hit.t};
    }
    const bool light_may_follow = settings_.max_depth < 0 || s.depth + 1 <= settings_.max_depth;
    if (light_may_follow && closure.sides_agree(wo) && closure.has_non_delta())
      add_receiver(*hit, closure, s, sample, out, pool);
    if (closure.has_delta()) continue_from(*hit, closure, s, rng, false);
  }
  return emission;
}

void EyeChain::follow_from(const EyeVertex& from, const geometry::Ray& ray, Rng& rng,
                           std::vector<EyeVertex>& out, scatter::ClosurePool& pool) {
  pending_.clear();
  pending_.push_back({ray, from.weight, from.depth + 1, 0, 0, from.id, 0, 0, -1});
  while (!pending_.empty()) {
    Segment s = pending_.back();
    pending_.pop_back();
    const auto hit = world_.intersect(s.ray);
    if (!hit) continue;
    s.weight *= world_.left_by_glass(s.medium, hit->hit.t * lumirank::length(s.ray.direction));
    const Vec3f wo = -s.ray.direction;
    const Closure closure = world_.materials().closure(hit->material, hit->point, wo);
    if (closure.sides_agree(wo) && closure.has_non_delta())
      add_receiver(*hit, closure, s, from.sample, out, &pool);
    if (closure.has_delta()) continue_from(*hit, closure, s, rng, true);
  }
}

}  // namespace lumirank::transport
