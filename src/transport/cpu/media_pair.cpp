#include "transport/cpu/media_pair.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "scatter/closure.h"
#include "transport/pairs/pair_kernel.h"

namespace lumirank::transport {
namespace {

// One field of 16 items, which often are the same one 16 times.
class Picker {
 public:
  explicit Picker(const std::uint32_t* items) : items_(items) {
    for (int k = 1; k < kLanes; ++k) same_ &= items[k] == items[0];
  }
  Lane operator()(const std::vector<float>& from) const {
    if (same_) return splat(from[items_[0]]);
    float lanes[kLanes];
    for (int k = 0; k < kLanes; ++k) lanes[k] = from[items_[k]];
    return load(lanes);
  }
  Lane3 operator()(const std::vector<Vec3f>& from) const {
    if (same_) return splat(from[items_[0]]);
    return pick([&](int k) { return from[items_[k]]; });
  }
  Lane3 operator()(const std::vector<Rgb>& from) const {
    if (same_) return splat(from[items_[0]]);
    return pick([&](int k) {
      const Rgb c = from[items_[k]];
      return Vec3f{c.r, c.g, c.b};
    });
  }
  LaneBits operator()(const std::vector<std::uint32_t>& from) const {
    LaneBits lanes;
    for (int k = 0; k < kLanes; ++k) lanes[k] = from[items_[k]];
    return lanes;
  }

 private:
  template <typename Get>
  static Lane3 pick(Get&& get) {
    float x[kLanes], y[kLanes], z[kLanes];
    for (int k = 0; k < kLanes; ++k) {
      const Vec3f v = get(k);
      x[k] = v.x, y[k] = v.y, z[k] = v.z;
    }
    return {load(x), load(y), load(z)};
  }

  const std::uint32_t* items_;
  bool same_ = true;
};

// The lanes for which `holds`.
template <typename Holds>
std::uint32_t lanes_where(Holds&& holds) {
  std::uint32_t out = 0;
  for (int k = 0; k < kLanes; ++k) out |= std::uint32_t{holds(k)} << k;
  return out;
}

template <typename Use>
void for_each_lane(std::uint32_t lanes, Use&& use) {
  for (; lanes != 0; lanes &= lanes - 1) use(std::countr_zero(lanes));
}

void set_color(Lane3& v, int lane, Rgb c) { set_lane(v, lane, {c.r, c.g, c.b}); }

// The unit direction and the distance between two places.
struct Way {
  Lane3 w;
  Lane d2;
  LaneMask some;
};
Way between(const Lane3& from, const Lane3& to) {
  const Lane3 v = to - from;
  Way way;
  const Lane d2 = dot(v, v);
  way.some = d2 > splat(1e-30f);
  way.d2 = select(way.some, d2, splat(1));
  way.w = v * (splat(1) / sqrt(way.d2));
  return way;
}

Lane inverse(Lane x, LaneMask where) { return splat(1) / select(where, x, splat(1)); }

void keep(Connections& out, const Lane3& value, LaneMask alive) {
  PairResult noted;
  // What overflows is no number to be estimated with.
  note_values(noted, value, alive & (max_component(value) < splat(1e37f)));
  out.value = noted.e, out.alive = noted.alive;
}

// What a light that is not lambertian and knows directions sends along -w, where w is the unit direction
// towards it: radiant intensity.
Rgb sent_along(const VirtualLights& lights, std::size_t j, Vec3f w) {
  const Rgb power = lights.power[j];
  if (lights.kind[j] == LightKind::spot) {
    const SpotShape& spot = lights.spots[lights.closure[j]];
    return power * spot_share(spot, -dot(lights.normal[j], w), -w);
  }
  const scatter::Closure closure = lights.closure_at(j);
  // f without the cosine of the shading normal: flux leaves through the geometric surface.
  const Rgb f = scatter::eval_f(closure, lights.incoming[j], -w, true);
  const float cosine = closure.is_fiber() ? closure.cosine(-w) : std::abs(dot(lights.ng[j], w));
  return power * f * cosine;
}

// Scattered to where it comes from by a lambertian surface, if its normals agree that this is its front.
Rgb facing_power(const VirtualLights& lights, std::size_t j) {
  if (lights.kind[j] != LightKind::surface) return lights.power[j];
  const bool front =
      dot(lights.normal[j], lights.incoming[j]) > 0 && dot(lights.ng[j], lights.incoming[j]) > 0;
  return front ? lights.power[j] * lights.albedo[j] * kInvPi : Rgb{0};
}

std::vector<std::uint32_t> keys_of(const std::vector<std::uint64_t>& ids) {
  std::vector<std::uint32_t> keys(ids.size());
  for (std::size_t k = 0; k < ids.size(); ++k) keys[k] = static_cast<std::uint32_t>(mix64(ids[k]) >> 32);
  return keys;
}

}  // namespace

MediaPairs::MediaPairs(const world::World& world, const Receivers& receivers, const LightsInMedia& lights,
                       const Settings& settings)
    : world_(world),
      receivers_(receivers),
      lights_(lights),
      settings_(settings),
      receiver_key_(keys_of(receivers.id)),
      segment_key_(keys_of(receivers.segments.id)),
      point_key_(keys_of(lights.points.id)),
      ray_key_(keys_of(lights.rays.id)) {
  const VirtualLights& points = lights.points;
  for (std::size_t j = 0; j < points.size(); ++j) {
    const LightKind kind = points.kind[j];
    const bool facing = kind == LightKind::oriented ||
                        (kind == LightKind::surface && points.closure[j] == VirtualLights::kLambertian);
    const bool evenly = kind == LightKind::omni || kind == LightKind::directional;
    sends_.push_back(facing ? Sends::facing : evenly ? Sends::evenly : Sends::otherwise);
    sent_.push_back(facing ? facing_power(points, j) : points.power[j]);
  }
}

bool MediaPairs::too_deep(PairKind kind, std::uint32_t row, std::uint32_t column) const {
  if (settings_.max_depth < 0) return false;
  const int before = has_segment(kind) ? receivers_.segments.depth[row] : receivers_.depth[row];
  const int after = has_ray(kind) ? lights_.rays.depth[column] : lights_.points.depth[column];
  return before + after + 1 > settings_.max_depth;
}

Rng MediaPairs::random_of(PairKind kind, std::uint32_t row, std::uint32_t column) const {
  return {settings_.seed, Stage::ray_pairs,
          has_segment(kind) ? receivers_.segments.id[row] : receivers_.id[row],
          has_ray(kind) ? lights_.rays.id[column] : lights_.points.id[column]};
}

std::uint32_t MediaPairs::row_key(PairKind kind, std::uint32_t row) const {
  return (has_segment(kind) ? segment_key_ : receiver_key_)[row];
}
std::uint32_t MediaPairs::column_key(PairKind kind, std::uint32_t column) const {
  return (has_ray(kind) ? ray_key_ : point_key_)[column];
}

std::size_t MediaPairs::memory_bytes() const {
  return 4 * (receiver_key_.size() + segment_key_.size() + point_key_.size() + ray_key_.size()) +
         sends_.size() * (sizeof(Sends) + sizeof(Rgb));
}

void MediaPairs::connect(PairKind kind, const std::uint32_t rows[16], const std::uint32_t columns[16],
                         Connections& out) const {
  switch (kind) {
    case PairKind::ray_to_receiver:
      return ray_to_receiver(rows, columns, out);
    case PairKind::point_to_segment:
      return point_to_segment(rows, columns, out);
    case PairKind::ray_to_segment:
      return ray_to_segment(rows, columns, out);
    case PairKind::point_to_receiver:
      break;
  }
  out.alive = 0;
}

MediaPairs::Numbers MediaPairs::numbers(PairKind kind, const std::uint32_t* rows,
                                        const std::uint32_t* columns) const {
  LaneBits row = Picker(rows)(has_segment(kind) ? segment_key_ : receiver_key_);
  // Emitters are few, and an error that all rows share would not go away in their sum.
  if (settings_.shared_places)
    for (int k = 0; k < 16; ++k)
      if (has_ray(kind) || lights_.points.depth[columns[k]] > 0) row[k] = 0;
  const LaneBits column = Picker(columns)(has_ray(kind) ? ray_key_ : point_key_);
  const LaneBits key = mix_pair(row, column, static_cast<std::uint32_t>(mix64(settings_.seed)));
  return {unit_lane(key), unit_lane(mix(key ^ 0x68bc21ebu))};
}

Lane3 MediaPairs::scattered(const std::vector<std::int16_t>& number, const std::uint32_t* items,
                            LaneMask wanted, const Lane3& places, Lane cosine) const {
  Lane3 out{};
  for (std::uint32_t left = bits(wanted); left != 0;) {
    const std::int16_t one = number[items[std::countr_zero(left)]];
    const std::uint32_t here = lanes_where([&](int k) { return number[items[k]] == one; });
    const media::Medium& medium = world_.media()[static_cast<std::size_t>(one)];
    Lane3 scattering = splat(medium.scatters_evenly() ? medium.at({}).scattering : Rgb{0});
    if (!medium.scatters_evenly())
      for_each_lane(left & here,
                    [&](int k) { set_color(scattering, k, medium.at(lane_of(places, k)).scattering); });
    out = select(mask_from_bits(here), medium.phase().eval(cosine) * scattering, out);
    left &= ~here;
  }
  return out;
}

Lane3 MediaPairs::shining(const std::uint32_t* points, LaneMask wanted, const Lane3& w) const {
  const VirtualLights& lights = lights_.points;
  const Picker point(points);
  const LaneMask facing =
      mask_from_bits(lanes_where([&](int k) { return sends_[points[k]] == Sends::facing; }));
  const Lane zero{}, cosine = -dot(point(lights.ng), w);
  const Lane turned = select((cosine > zero) & (dot(point(lights.normal), w) < zero), cosine, zero);
  Lane3 out = point(sent_) * select(facing, turned, splat(1));
  for_each_lane(bits(wanted) & lanes_where([&](int k) { return sends_[points[k]] == Sends::otherwise; }),
                [&](int k) { set_color(out, k, sent_along(lights, points[k], lane_of(w, k))); });
  return out;
}

Lane3 MediaPairs::reflected(const std::uint32_t* receivers, LaneMask wanted, const Lane3& w) const {
  const Picker receiver(receivers);
  const Lane zero{};
  const Lane3 n = receiver(receivers_.normal), ng = receiver(receivers_.ng), wo = receiver(receivers_.wo);
  // Both normals agree about the sides of both directions, which are the same one.
  const Lane side = dot(n, wo), cosine = dot(n, w), flat = dot(ng, w);
  const LaneMask front = (side * dot(ng, wo) > zero) & (side * cosine > zero) & (cosine * flat > zero);
  Lane3 out = receiver(receivers_.albedo) * select(front, abs(cosine) * splat(kInvPi), zero);
  for_each_lane(bits(wanted) & lanes_where([&](int k) {
                  return receivers_.closure[receivers[k]] != Receivers::kLambertian;
                }),
                [&](int k) {
                  const std::size_t i = receivers[k];
                  set_color(out, k, scatter::eval(receivers_.closure_at(i), receivers_.wo[i], lane_of(w, k)));
                });
  return out;
}

void MediaPairs::ray_to_receiver(const std::uint32_t* rows, const std::uint32_t* columns,
                                 Connections& out) const {
  const RayLights& rays = lights_.rays;
  const Picker row(rows), column(columns);
  const Lane3 flight = column(rays.direction), start = column(rays.origin);
  out.from = row(receivers_.position);
  const RayPlaces place = sample_equiangular(start, flight, column(rays.length), out.from,
                                             numbers(PairKind::ray_to_receiver, rows, columns).first);
  out.to = start + flight * place.t;
  out.column_way = place.t, out.row_way = Lane{};
  const Way way = between(out.from, out.to);
  LaneMask alive = (place.pdf > Lane{}) & way.some;
  const Lane3 f = reflected(rows, alive, way.w);
  alive &= max_component(f) > Lane{};
  const Lane3 there = scattered(rays.medium, columns, alive, out.to, -dot(flight, way.w));
  keep(out, column(rays.power) * f * there * inverse(way.d2 * place.pdf, alive), alive);
}

void MediaPairs::point_to_segment(const std::uint32_t* rows, const std::uint32_t* columns,
                                  Connections& out) const {
  const EyeSegments& segments = receivers_.segments;
  const VirtualLights& points = lights_.points;
  const Picker row(rows), column(columns);
  const Lane3 along = row(segments.direction), start = row(segments.origin);
  const Lane3 target = column(points.position);
  const Lane length = row(segments.length), u = numbers(PairKind::point_to_segment, rows, columns).first;
  const std::uint32_t far_lanes =
      lanes_where([&](int k) { return points.kind[columns[k]] == LightKind::directional; });
  const LaneMask far = mask_from_bits(far_lanes);
  RayPlaces place = sample_equiangular(start, along, length, target, u);
  if (far_lanes != 0) {
    const RayPlaces even = sample_evenly(length, u);
    place = {select(far, even.t, place.t), select(far, even.pdf, place.pdf)};
  }
  out.from = start + along * place.t;
  out.row_way = place.t, out.column_way = Lane{};
  const Way way = between(out.from, target);
  const Lane3 w = select(far, column(points.normal) * splat(-1), way.w);
  out.to = select(far, w, target);
  LaneMask alive = (place.pdf > Lane{}) & (far | way.some);
  const Lane3 light = shining(columns, alive, w);
  alive &= max_component(light) > Lane{};
  const Lane3 here = scattered(segments.medium, rows, alive, out.from, dot(along, w));
  const Lane d2 = select(far, splat(1), way.d2);
  keep(out, light * here * inverse(d2 * place.pdf, alive), alive);
}

void MediaPairs::ray_to_segment(const std::uint32_t* rows, const std::uint32_t* columns,
                                Connections& out) const {
  const EyeSegments& segments = receivers_.segments;
  const RayLights& rays = lights_.rays;
  const Picker row(rows), column(columns);
  const Lane3 along = row(segments.direction), start = row(segments.origin);
  const Lane3 flight = column(rays.direction), source = column(rays.origin);
  const Numbers u = numbers(PairKind::ray_to_segment, rows, columns);
  const RayPlaces on_ray = sample_near_line(source, flight, column(rays.length), start, along, u.first);
  out.to = source + flight * on_ray.t;
  const RayPlaces on_segment = sample_equiangular(start, along, row(segments.length), out.to, u.second);
  out.from = start + along * on_segment.t;
  out.row_way = on_segment.t, out.column_way = on_ray.t;
  const Way way = between(out.from, out.to);
  LaneMask alive = (on_ray.pdf > Lane{}) & (on_segment.pdf > Lane{}) & way.some;
  const Lane3 there = scattered(rays.medium, columns, alive, out.to, -dot(flight, way.w));
  alive &= max_component(there) > Lane{};
  const Lane3 here = scattered(segments.medium, rows, alive, out.from, dot(along, way.w));
  keep(out, column(rays.power) * there * here * inverse(way.d2 * on_ray.pdf * on_segment.pdf, alive), alive);
}

}  // namespace lumirank::transport
