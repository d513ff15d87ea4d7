#include "pathtrace/light_targets.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/bounds.h"
#include "base/frame.h"
#include "base/warp.h"
#include "scatter/closure.h"

namespace lumirank::pathtrace {
namespace {

constexpr std::size_t kMaxTargets = 16;
constexpr std::size_t kAskedTriangles = 1 << 16;  // of all meshes
// Lobes that make caustics: how rough at most, and how much light they must send on of what comes aslant.
constexpr float kSharp = 0.25f, kStrong = 0.25f;
constexpr int kAskedOfMaterial = 8;  // places
// Two targets instead of one must leave out so much of its disc.
constexpr float kTighter = 0.75f;

// Squared distance of a line from what lies that far from a place on it.
float beside(Vec3f to, Vec3f direction) { return length_squared(to - direction * dot(to, direction)); }

// Light that arrives aslant and goes on sharply.
float sent_on(const scatter::Closure& closure, Vec3f wo) {
  Rgb sum = scatter::rough_albedo(scatter::sharp_part(closure, kSharp), wo);
  scatter::DeltaContinuation next[scatter::kMaxLobes + 1];
  const int count = scatter::delta_continuations(closure, wo, next, true);
  for (int k = 0; k < count; ++k)
    if (next[k].kind != scatter::LobeKind::delta_pass) sum += next[k].weight;
  return max_component(sum);
}

// Which materials do so, as asked at places where they are.
class Materials {
 public:
  explicit Materials(const world::World& world) : world_(world) {}

  bool are_sharp(std::uint32_t placement) {
    const geometry::Placement& placed = world_.rays().placements()[placement];
    auto& known = known_[placed.material];
    const std::size_t triangles = world_.rays().mesh(placed.mesh).triangle_count();
    for (int k = 0; k < 2 && known.asked < kAskedOfMaterial && triangles > 0; ++k, ++known.asked)
      known.sharp = known.sharp || is_sharp_at(placement, placed.mesh, k == 0 ? 0 : triangles / 2);
    return known.sharp;
  }

 private:
  struct Known {
    int asked = 0;
    bool sharp = false;
  };
  bool is_sharp_at(std::uint32_t placement, std::uint32_t mesh, std::size_t triangle) const {
    geometry::Hit hit;
    hit.instance = placement, hit.mesh = mesh, hit.triangle = static_cast<std::uint32_t>(triangle);
    hit.barycentric = {1.0f / 3, 1.0f / 3};
    const world::SurfaceHit at = world_.surface(hit, {0, 0, 1});
    if (at.emitter >= 0) return false;
    const Vec3f n = at.point.ng;
    const Vec3f wo = normalize(n + Frame::from_normal(n).s);
    return sent_on(world_.materials().closure(at.material, at.point, wo), wo) > kStrong;
  }

  const world::World& world_;
  std::map<std::uint32_t, Known> known_;
};

// A triangle's middle and its corners' distance.
struct Piece {
  Vec3f middle;
  float radius;
};

struct Part {
  std::vector<Piece> pieces;
  Vec3f center;
  float radius = 0;
  bool whole = false;  // not to be split

  explicit Part(std::vector<Piece> p) : pieces(std::move(p)) {
    Bounds3f box;
    for (const Piece& piece : pieces) box.extend(piece.middle);
    center = box.center();
    for (const Piece& piece : pieces) radius = std::max(radius, length(piece.middle - center) + piece.radius);
  }

  // In two, at the middle of the longest side.
  std::optional<std::pair<Part, Part>> split() const {
    Bounds3f box;
    for (const Piece& piece : pieces) box.extend(piece.middle);
    const Vec3f size = box.diagonal();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    std::vector<Piece> low, high;
    for (const Piece& piece : pieces) (piece.middle[axis] < center[axis] ? low : high).push_back(piece);
    if (low.empty() || high.empty()) return std::nullopt;
    Part a(std::move(low)), b(std::move(high));
    if (square(a.radius) + square(b.radius) > kTighter * square(radius)) return std::nullopt;
    return std::pair{std::move(a), std::move(b)};
  }
};

std::vector<Piece> pieces_of(const world::World& world) {
  Materials materials(world);
  const geometry::RayScene& rays = world.rays();
  std::vector<std::uint32_t> sharp;
  std::size_t triangles = 0;
  for (std::uint32_t k = 0; k < rays.placements().size(); ++k) {
    if (rays.mesh(rays.placements()[k].mesh).triangle_count() == 0 || !materials.are_sharp(k)) continue;
    sharp.push_back(k);
    triangles += rays.mesh(rays.placements()[k].mesh).triangle_count();
  }
  const std::size_t step = triangles / kAskedTriangles + 1;
  std::vector<Piece> pieces;
  for (const std::uint32_t k : sharp) {
    const geometry::Placement& placed = rays.placements()[k];
    const geometry::TriangleMesh& mesh = rays.mesh(placed.mesh);
    for (std::size_t t = 0; t < mesh.triangle_count(); t += step) {
      Vec3f corners[3], middle{0, 0, 0};
      for (std::size_t c = 0; c < 3; ++c) {
        corners[c] = placed.to_world.point(mesh.positions[mesh.indices[3 * t + c]]);
        middle += corners[c] * (1.0f / 3);
      }
      float radius = 0;
      for (const Vec3f corner : corners) radius = std::max(radius, length(corner - middle));
      if (std::isfinite(radius)) pieces.push_back({middle, radius});
    }
  }
  return pieces;
}

}  // namespace

LightTargets::LightTargets(const world::World& world, Vec3f eye) {
  std::vector<Piece> pieces = pieces_of(world);
  if (pieces.empty()) return;
  std::vector<Part> parts;
  parts.emplace_back(std::move(pieces));
  while (parts.size() < kMaxTargets) {
    Part* largest = nullptr;
    for (Part& p : parts)
      if (!p.whole && (!largest || p.radius > largest->radius)) largest = &p;
    if (!largest) break;
    auto two = largest->split();
    if (!two) {
      largest->whole = true;
      continue;
    }
    *largest = std::move(two->first);
    parts.push_back(std::move(two->second));
  }
  float sum = 0;
  for (const Part& p : parts) {
    if (!(p.radius > 0)) continue;
    const float part = square(p.radius) / (length_squared(p.center - eye) + square(p.radius));
    x_.push_back(p.center.x), y_.push_back(p.center.y), z_.push_back(p.center.z);
    radius_.push_back(p.radius), part_.push_back(part);
    sum += part;
  }
  for (float& part : part_) part *= kShare / sum;
}

std::optional<std::size_t> LightTargets::draw(float& u) const {
  float left = u;
  for (std::size_t k = 0; k < size(); ++k) {
    if (left < part_[k]) {
      u = std::min(left / part_[k], 0x1.fffffep-1f);
      return k;
    }
    left -= part_[k];
  }
  u = std::clamp(left / (1 - kShare), 0.0f, 0x1.fffffep-1f);
  return std::nullopt;
}

float LightTargets::per_area(Vec3f place, Vec3f direction, float own) const {
  float sum = (1 - kShare) * own;
  for (std::size_t k = 0; k < size(); ++k) {
    const Vec3f to{x_[k] - place.x, y_[k] - place.y, z_[k] - place.z};
    const float disc = square(radius_[k]);
    sum += beside(to, direction) < disc ? part_[k] / (kPi * disc) : 0.0f;
  }
  return sum;
}

float LightTargets::height_seen(float distance2, float along_normal, float radius) const {
  const float sine2 = square(radius) / distance2;
  const bool left = !(sine2 < 0.99f) || along_normal < -radius;
  return left ? 0.0f : sine2 / (1 + std::sqrt(1 - sine2));
}

float LightTargets::per_solid_angle(Vec3f place, Vec3f normal, Vec3f direction, float own) const {
  float sum = (1 - kShare) * own;
  for (std::size_t k = 0; k < size(); ++k) {
    const Vec3f to{x_[k] - place.x, y_[k] - place.y, z_[k] - place.z};
    const float height = height_seen(length_squared(to), dot(to, normal), radius_[k]);
    if (!(height > 0))
      sum += part_[k] * own;
    else if (dot(to, direction) > 0 && beside(to, direction) < square(radius_[k]))
      sum += part_[k] / (2 * kPi * height);
  }
  return sum;
}

Vec3f LightTargets::place_on(std::size_t target, Vec3f direction, Vec2f u) const {
  const Vec2f disc = warp_disk(u) * radius_[target];
  const Frame frame = Frame::from_normal(direction);
  return Vec3f{x_[target], y_[target], z_[target]} + frame.s * disc.x + frame.t * disc.y;
}

std::optional<Vec3f> LightTargets::direction_to(std::size_t target, Vec3f place, Vec3f normal,
                                                Vec2f u) const {
  const Vec3f to = Vec3f{x_[target], y_[target], z_[target]} - place;
  const float distance2 = length_squared(to);
  const float height = height_seen(distance2, dot(to, normal), radius_[target]);
  if (!(height > 0)) return std::nullopt;
  // By height instead of the cosine, of which a small cone leaves few bits.
  const float h = u.x * height, across = std::sqrt(h * (2 - h)), angle = 2 * kPi * u.y;
  const Vec3f local{across * std::cos(angle), across * std::sin(angle), 1 - h};
  return Frame::from_normal(to / std::sqrt(distance2)).to_world(local);
}

}  // namespace lumirank::pathtrace
