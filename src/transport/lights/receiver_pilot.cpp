#include "transport/lights/receiver_pilot.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "base/frame.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/warp.h"
#include "matrix/lighting_matrix.h"

namespace lumirank::transport {
namespace {

constexpr int kRaysPerReceiver = 2;              // to what it sees
constexpr int kEmitterSamples = 8;               // at each end of these
constexpr int kDirectSamples = 2;                // at each receiver
constexpr std::uint64_t kRandomId = 1ull << 60;  // of the numbers; no path has it
constexpr float kBelowOne = 0x1.fffffep-1f;

// The inverse of warp_disk.
Vec2f disk_to_square(Vec2f d) {
  const float r = std::sqrt(d.x * d.x + d.y * d.y);
  if (!(r > 0)) return {0.5f, 0.5f};
  float a, b;
  if (std::abs(d.x) > std::abs(d.y)) {
    a = std::copysign(r, d.x);
    b = a * (std::atan(d.y / d.x) / (kPi / 4));
  } else {
    b = std::copysign(r, d.y);
    a = b * (std::atan(d.x / d.y) / (kPi / 4));
  }
  const auto coordinate = [](float x) { return std::clamp(0.5f * (x + 1), 0.0f, kBelowOne); };
  return {coordinate(a), coordinate(b)};
}

// The inverse of warp_cone (warp_sphere: cos_max −1).
Vec2f cone_to_square(Vec3f local, float cos_max) {
  float turn = std::atan2(local.y, local.x) * (0.5f * kInvPi);
  if (turn < 0) turn += 1;
  const float height = (1 - local.z) / std::max(1 - cos_max, 1e-12f);
  return {std::clamp(height, 0.0f, kBelowOne), std::clamp(turn, 0.0f, kBelowOne)};
}

// Numbers with which world.sample_emission would send a particle from a direct sample's place on the emitter
// to the point.
struct StartNumbers {
  const Bounds3f& scene;
  Vec3f point;
  const emitters::DirectSample& sample;
  Vec2f drawn;  // the sample's own numbers
  Vec2f free;   // for coordinates that do not matter
  Vec2f position{}, direction{};

  bool operator()(const emitters::AreaEmitter& e) {
    const Vec3f normal = e.triangles[sample.triangle].normal;
    const Vec3f local = Frame::from_normal(normal).to_local(-sample.direction);
    position = drawn, direction = disk_to_square({local.x, local.y});
    return true;
  }
  bool operator()(const emitters::PointEmitter&) {
    position = free, direction = cone_to_square(-sample.direction, -1);
    return true;
  }
  bool operator()(const emitters::SpotEmitter& e) {
    position = free, direction = cone_to_square(e.frame.to_local(-sample.direction), e.cos_cutoff);
    return true;
  }
  // The table's own sampling has no inverse at hand; nor is the start of such light hard to find.
  bool operator()(const emitters::ProfileEmitter&) { return false; }
  bool operator()(const emitters::DirectionalEmitter&) { return far(); }
  bool operator()(const emitters::EnvironmentEmitter&) { return far(); }
  bool far() {
    const Frame frame = Frame::from_normal(-sample.direction);
    const Vec3f off = (point - scene.center()) / scene.radius();
    position = disk_to_square({dot(off, frame.s), dot(off, frame.t)}), direction = drawn;
    return true;
  }
};

struct Lit {
  Vec3f position, normal, ng;
};

class EmitterPilot {
 public:
  EmitterPilot(const world::World& world, const world::EmitterChoice& choice)
      : world_(world), choice_(choice) {}

  // One direct sample: its irradiance, and where a path that brings it would start.
  float irradiance(const Lit& at, Rng& rng, std::array<float, kStartDimensions>* start) const {
    const double u = rng.next_double();
    const world::EmitterChoice::Drawn drawn = choice_.draw(u);
    const Vec2f u2 = rng.next_2d(), free = rng.next_2d();
    const std::uint64_t opacity = rng.next_bits();
    const auto s = world_.sample_direct(drawn.emitter, at.position, drawn.remapped, u2);
    if (!(s.pdf > 0)) return 0;
    const float cosine = dot(at.normal, s.direction);
    if (!(cosine > 0) || !(dot(at.ng, s.direction) > 0)) return 0;
    const float value = max_component(s.radiance) * cosine / (s.pdf * static_cast<float>(drawn.probability));
    if (!(value > 0) || !std::isfinite(value)) return 0;
    const Vec3f from = world::World::offset_origin(at.position, at.ng, s.direction);
    const float reach = std::min(s.distance * (1 - 1e-3f), 4 * world_.bounds().radius());
    if (world_.rays().occluded({from, s.direction, 0, reach}, opacity)) return 0;
    if (start) {
      StartNumbers numbers{world_.bounds(), at.position, s, u2, free};
      if (!std::visit(numbers, world_.emitters()[static_cast<std::size_t>(drawn.emitter)].kind)) {
        (*start)[0] = -1;
      } else {
        *start = {std::min(static_cast<float>(u), kBelowOne), numbers.position.x, numbers.position.y,
                  numbers.direction.x, numbers.direction.y};
      }
    }
    return value;
  }

 private:
  const world::World& world_;
  const world::EmitterChoice& choice_;
};

// The part of what a receiver reflects whose direct light goes through columns.
float part_by_columns(const Receivers& receivers, std::size_t i, float traced_below) {
  if (!(traced_below > 0)) return 1;
  if (receivers.closure[i] == Receivers::kLambertian) return traced_below > 1 ? 0.0f : 1.0f;
  const scatter::Closure closure = receivers.closure_at(i);
  const float all = max_component(scatter::albedo(closure, receivers.wo[i]));
  if (!(all > 0)) return 0;
  const scatter::Closure broad = scatter::broad_part(closure, traced_below);
  return std::min(1.0f, max_component(scatter::albedo(broad, receivers.wo[i])) / all);
}

}  // namespace

ReceiverPilot run_receiver_pilot(const world::World& world, const world::EmitterChoice& choice,
                                 const Receivers& receivers, std::uint64_t seed, float traced_below) {
  constexpr std::size_t kReceiversAtOnce = 256;
  ReceiverPilot all;
  if (receivers.size() == 0 || choice.empty()) return all;
  const EmitterPilot emitter_pilot(world, choice);
  std::vector<ReceiverPilot> pieces((receivers.size() + kReceiversAtOnce - 1) / kReceiversAtOnce);
  parallel_for(receivers.size(), kReceiversAtOnce, [&](std::size_t begin, std::size_t end) {
    ReceiverPilot& piece = pieces[begin / kReceiversAtOnce];
    for (std::size_t i = begin; i < end; ++i) {
      Rng rng(seed, Stage::pilot, kRandomId, matrix::id_of(receivers.id, i));
      const float weight = max_component(receivers.weight[i]);
      const Lit here{receivers.position[i], receivers.normal[i], receivers.ng[i]};
      piece.places.push_back({here.position, here.normal, 0, true});
      // A fiber has no side to trace from; the surfaces around it suffice.
      if (here.ng == Vec3f{}) continue;
      const float part = part_by_columns(receivers, i, traced_below);
      for (int k = 0; k < kDirectSamples; ++k)
        piece.direct += weight * part * emitter_pilot.irradiance(here, rng, nullptr) / kDirectSamples;

      const Frame frame = Frame::from_normal(here.normal);
      for (int ray = 0; ray < kRaysPerReceiver; ++ray) {
        const Vec3f w = frame.to_world(warp_cosine_hemisphere(rng.next_2d()));
        if (!(dot(w, here.ng) > 0)) continue;
        const auto hit = world.intersect({world::World::offset_origin(here.position, here.ng, w), w});
        if (!hit) continue;
        const scatter::Closure closure = world.materials().closure(hit->material, hit->point, -w);
        if (!closure.has_non_delta() || closure.is_fiber() || !closure.sides_agree(-w)) continue;
        const float side = dot(closure.frame.n, w) < 0 ? 1.0f : -1.0f;
        const Lit there{hit->point.position, closure.frame.n * side, closure.ng * side};
        piece.places.push_back({there.position, there.normal, 0, true});
        const float reflectance = closure.is_lambertian() ? max_component(closure.diffuse_color()) : 0.5f;
        for (int k = 0; k < kEmitterSamples; ++k) {
          EmissionGuide::Observation o;
          o.value = weight * reflectance * emitter_pilot.irradiance(there, rng, &o.at);
          if (o.value > 0 && o.at[0] >= 0) piece.starts.push_back(o);
        }
      }
    }
  });
  for (const ReceiverPilot& piece : pieces) {
    all.starts.insert(all.starts.end(), piece.starts.begin(), piece.starts.end());
    all.places.insert(all.places.end(), piece.places.begin(), piece.places.end());
    all.direct += piece.direct;
  }
  all.direct /= static_cast<double>(receivers.size());
  return all;
}

}  // namespace lumirank::transport
