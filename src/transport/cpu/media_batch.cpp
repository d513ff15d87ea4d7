#include "transport/cpu/media_batch.h"

#include <algorithm>
#include <bit>
#include <optional>

#include "transport/pairs/groups.h"
#include "world/straight_path.h"

namespace lumirank::transport {

using matrix::Part;

MediaBatch::MediaBatch(const MediaPairs& pairs, Part part)
    : pairs_(pairs), part_(part), has_attenuating_(pairs.world().rays().has_attenuating()) {}

void MediaBatch::add(PairKind kind, std::uint32_t row, std::uint32_t column, Rgb& out) {
  out = Rgb{0};
  ++cost_.entries;
  if (pairs_.too_deep(kind, row, column)) {
    ++cost_.culled;
    return;
  }
  Queue& queue = queues_[static_cast<std::size_t>(kind)];
  const auto at = static_cast<std::size_t>(queue.count++);
  queue.rows[at] = row, queue.columns[at] = column, queue.out[at] = &out;
  if (queue.count == kLanes) connect(kind);
}

void MediaBatch::attenuate(std::uint32_t receiver, std::uint32_t point, Rgb& value) {
  const VirtualLights& points = pairs_.lights().points;
  const bool far = points.kind[point] == LightKind::directional;
  Connection c{.kind = PairKind::point_to_receiver,
               .far = far,
               .medium = -1,
               .row = receiver,
               .column = point,
               .value = value,
               .from = pairs_.receivers().position[receiver],
               .to = far ? -points.normal[point] : points.position[point],
               .row_way = 0,
               .column_way = 0,
               .out = &value};
  leave_surface(c);
  wait(c);
}

matrix::Cost MediaBatch::finish() {
  for (int kind = 0; kind < kPairKinds; ++kind)
    if (queues_[static_cast<std::size_t>(kind)].count > 0) connect(static_cast<PairKind>(kind));
  if (waiting_count_ > 0) trace();
  return cost_;
}

void MediaBatch::connect(PairKind kind) {
  Queue& queue = queues_[static_cast<std::size_t>(kind)];
  const int count = queue.count;
  queue.count = 0;
  for (auto k = static_cast<std::size_t>(count); k < kLanes; ++k)
    queue.rows[k] = queue.rows[0], queue.columns[k] = queue.columns[0];
  Connections all;
  pairs_.connect(kind, queue.rows.data(), queue.columns.data(), all);
  std::uint32_t alive = all.alive & ((1u << count) - 1);
  cost_.culled += static_cast<std::uint64_t>(count - std::popcount(alive));
  for (; alive != 0; alive &= alive - 1) {
    const int k = std::countr_zero(alive);
    const auto at = static_cast<std::size_t>(k);
    Connection c{
        .kind = kind,
        .far = !has_ray(kind) && pairs_.lights().points.kind[queue.columns[at]] == LightKind::directional,
        .medium = -1,
        .row = queue.rows[at],
        .column = queue.columns[at],
        .value = {all.value.x[k], all.value.y[k], all.value.z[k]},
        .from = lane_of(all.from, k),
        .to = lane_of(all.to, k),
        .row_way = all.row_way[k],
        .column_way = all.column_way[k],
        .out = queue.out[at]};
    if (has_segment(kind))
      c.medium = pairs_.receivers().segments.medium[c.row];
    else
      leave_surface(c);
    wait(c);
  }
}

void MediaBatch::leave_surface(Connection& c) const {
  const Receivers& receivers = pairs_.receivers();
  const Vec3f ng = receivers.ng[c.row], w = c.far ? c.to : c.to - c.from;
  c.medium = receivers.media[c.row][dot(ng, w) >= 0 ? 0 : 1];
  if (w != Vec3f{}) c.from = world::World::offset_origin(c.from, ng, w);
}

void MediaBatch::wait(const Connection& connection) {
  waiting_[static_cast<std::size_t>(waiting_count_++)] = connection;
  if (waiting_count_ == kLanes) trace();
}

void MediaBatch::trace() {
  geometry::ShadowPacket packet;
  packet.seed = pairs_.seed();
  packet.alike = false;  // both ends are places of their own on rays and segments
  for (std::size_t k = 0; k < kLanes; ++k) {
    const auto count = static_cast<std::size_t>(waiting_count_);
    const Connection& c = waiting_[k < count ? k : 0];
    const Vec3f d = c.far ? c.to : c.to - c.from;
    packet.ox[k] = c.from.x, packet.oy[k] = c.from.y, packet.oz[k] = c.from.z;
    packet.dx[k] = d.x, packet.dy[k] = d.y, packet.dz[k] = d.z;
    packet.t_far[k] = c.far ? kInfinity : 1.0f;
    packet.from[k] = pairs_.row_key(c.kind, c.row), packet.to[k] = pairs_.column_key(c.kind, c.column);
    packet.valid[k] = k < count ? -1 : 0;
  }
  const std::uint32_t all = (1u << waiting_count_) - 1;
  const std::uint32_t lanes = part_ == Part::unoccluded ? all : visible(packet);
  if (part_ == Part::visibility) {
    for (std::uint32_t k = 0; k < kLanes; ++k)
      if (lanes >> k & 1) *waiting_[k].out = Rgb{1};
  } else {
    attenuate_waiting(lanes, packet);
  }
  waiting_count_ = 0;
}

std::uint32_t MediaBatch::visible(geometry::ShadowPacket& packet) {
  // Of two points it is known already.
  std::uint32_t known = 0, asked = 0;
  for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(waiting_count_); ++k) {
    const bool points = waiting_[k].kind == PairKind::point_to_receiver;
    (points ? known : asked) |= 1u << k;
    if (points) packet.valid[k] = 0;
  }
  if (asked == 0) return known;
  cost_.rays += static_cast<std::uint64_t>(std::popcount(asked));
  return known | pairs_.world().rays().visible16(packet);
}

void MediaBatch::attenuate_waiting(std::uint32_t lanes, geometry::ShadowPacket& packet) {
  std::uint32_t clear = lanes;
  if (has_attenuating_ && lanes != 0) {
    for (std::uint32_t k = 0; k < kLanes; ++k) packet.valid[k] = lanes >> k & 1 ? -1 : 0;
    clear = pairs_.world().rays().clear16(packet);
  }
  Lane3 depth{}, ratio{};
  for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
    const int k = std::countr_zero(left);
    media::OpticalPath path;
    fly(waiting_[static_cast<std::size_t>(k)], clear >> k & 1, path);
    set_lane(depth, k, {path.depth.r, path.depth.g, path.depth.b});
    set_lane(ratio, k, {path.ratio.r, path.ratio.g, path.ratio.b});
  }
  const Lane3 through{exp_negative(-depth.x), exp_negative(-depth.y), exp_negative(-depth.z)};
  const Lane3 passed = ratio * through;
  for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(waiting_count_); ++k) {
    const Connection& c = waiting_[k];
    *c.out = lanes >> k & 1 ? c.value * Rgb{passed.x[k], passed.y[k], passed.z[k]} : Rgb{0};
  }
}

void MediaBatch::fly(const Connection& c, bool clear, media::OpticalPath& path) {
  const world::World& world = pairs_.world();
  const auto medium = [&world](int number) -> const media::Medium& {
    return world.media()[static_cast<std::size_t>(number)];
  };
  // Few media need random numbers.
  std::optional<Rng> rng;
  const auto random = [&] {
    if (!rng) rng = pairs_.random_of(c.kind, c.row, c.column);
    return rng->next_float();
  };
  if (has_ray(c.kind)) {
    const RayLights& rays = pairs_.lights().rays;
    path.add(medium(rays.medium[c.column]), rays.origin[c.column], rays.direction[c.column], c.column_way,
             random);
  }
  if (has_segment(c.kind)) {
    const EyeSegments& segments = pairs_.receivers().segments;
    path.add(medium(segments.medium[c.row]), segments.origin[c.row], segments.direction[c.row], c.row_way,
             random);
  }
  const Vec3f way = c.far ? c.to : c.to - c.from;
  const float distance = c.far ? kInfinity : length(way);
  if (!(distance > 0)) return;
  const Vec3f w = c.far ? way : way / distance;
  if (clear) {
    if (c.medium >= 0) path.add(medium(c.medium), c.from, w, distance, random);
    return;
  }
  const auto panes = c.kind == PairKind::point_to_receiver ? world::Panes::left_out : world::Panes::counted;
  world::pass_open(world, {c.from, Vec3f{}, w, distance, c.medium}, panes, path, crossed_, random);
}

}  // namespace lumirank::transport
