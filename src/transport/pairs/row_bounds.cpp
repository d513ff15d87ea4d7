#include "transport/pairs/row_bounds.h"

#include <algorithm>
#include <cmath>

#include "transport/pairs/bound_geometry.h"

namespace lumirank::transport {

using matrix::ColumnSet;
using matrix::Emission;
using matrix::Index;
using scatter::CosineFactor;
using scatter::DirectionCone;

namespace {

// Solid angle of a sphere over π times its radius squared, where it is largest; from inside, a hemisphere's.
float sphere_geometry(float distance2, float radius, float min_radius, float beyond) {
  distance2 = std::max(distance2, square(beyond * min_radius));
  if (distance2 <= radius * radius) return 2 / std::max(distance2, min_radius * min_radius);
  return 2 / (distance2 * (1 + std::sqrt(1 - radius * radius / distance2)));
}

}  // namespace

SceneRowBounds::SceneRowBounds(std::vector<const Receivers*> parts, const BoundRules& rules)
    : parts_(std::move(parts)), rules_(rules) {
  std::size_t rows = 0;
  for (const Receivers* part : parts_) {
    first_.push_back(rows);
    rows += part->size();
  }
}

SceneRowBounds::Row SceneRowBounds::row(Index i) const {
  if (parts_.size() == 1) return {*parts_[0], i};
  const auto part = std::upper_bound(first_.begin(), first_.end(), i) - first_.begin() - 1;
  const auto k = static_cast<std::size_t>(part);
  return {*parts_[k], static_cast<Index>(i - first_[k])};
}

scatter::ClosureBound SceneRowBounds::closure_bound(const Row& row) {
  const auto& [receivers, i] = row;
  const scatter::ClosurePool& pool = receivers.closures;
  const std::uint32_t c = receivers.closure[i];
  const Vec3f n = receivers.normal[i], wo = receivers.wo[i];
  return {pool.lobes(pool.recipe(c)), pool.colors(c), n, pool.tangent(c), wo, dot(n, wo) * pool.side(c) > 0};
}

void SceneRowBounds::set_rows(std::span<const Index> rows) {
  box_ = {};
  matt_ = max_f_ = max_direct_ = Rgb(0);
  closures_.clear();
  behind_ = sharp_ = false;
  std::size_t closures = 0;
  Vec3f axis;
  for (const Index number : rows) {
    const Row from = row(number);
    const auto& [receivers, i] = from;
    box_.extend(receivers.position[i]);
    const Vec3f n = receivers.normal[i];
    axis += dot(n, receivers.wo[i]) < 0 ? -n : n;
    closures += receivers.closure[i] != Receivers::kLambertian;
  }
  many_ = closures > kMaxClosures;
  const float size = length(axis);
  normals_ = {size > 0 ? axis / size : Vec3f{0, 0, 1}, size > 0 ? 1.0f : -1.0f};
  for (const Index number : rows) {
    const Row from = row(number);
    const auto& [receivers, i] = from;
    const Vec3f n = receivers.normal[i];
    // Of one row the axis is its normal.
    if (rows.size() == 1) {
      normals_.axis = dot(n, receivers.wo[i]) < 0 ? -n : n;
    } else {
      normals_.cosine = std::min(normals_.cosine, std::abs(dot(n, normals_.axis)) - kCosineSlack);
      if (dot(n, normals_.axis) * dot(n, receivers.wo[i]) < 0) normals_.cosine = -1;
    }
    if (receivers.closure[i] == Receivers::kLambertian) {
      matt_ = greater(matt_, receivers.albedo[i] * kInvPi);
      continue;
    }
    const auto lobes = receivers.closures.lobes(receivers.closures.recipe(receivers.closure[i]));
    for (const scatter::Lobe& lobe : lobes) {
      behind_ = behind_ || scatter::shines_through(lobe.kind) || scatter::is_hair(lobe.kind);
      sharp_ = sharp_ || scatter::lobe_roughness(lobe) < 0.5f;
    }
    if (many_) {
      const scatter::ClosureBound bound = closure_bound(from);
      max_f_ = greater(max_f_, bound.anywhere(CosineFactor::cosine));
      max_direct_ = greater(max_direct_, bound.anywhere(CosineFactor::cosine, rules_.traced_direct_below));
    } else {
      closures_.push_back(closure_bound(from));
    }
  }
  normals_sine_ = sine_of(normals_.cosine);
}

// f times the cosine for light from a cone of directions that make at most this cosine with a normal.
Rgb SceneRowBounds::scattered(const DirectionCone& cone, float cosine, bool direct) const {
  Rgb max_f = cosine > 0 ? matt_ * cosine : Rgb(0);
  if (many_) return cosine > 0 || behind_ ? greater(max_f, direct ? max_direct_ : max_f_) : max_f;
  for (const scatter::ClosureBound& closure : closures_)
    max_f =
        greater(max_f, closure.within(cone, CosineFactor::cosine, direct ? rules_.traced_direct_below : 0));
  return max_f;
}

matrix::BoundParts SceneRowBounds::parts(const ColumnSet& set) const {
  matrix::BoundParts parts{Rgb(0)};
  // Lobes have a roughness of 1 at most: above it, all direct light is traced.
  if (box_.empty() || (set.direct && rules_.traced_direct_below > 1)) return parts;
  DirectionCone cone;
  float cosine, factor = kBoundSlack;
  if (set.emission == Emission::directional) {
    cone.axis = set.cone.axis;
    if (!closures_.empty())
      cone.angle = set.cone.cosine >= 1 ? 0.0f : std::acos(std::max(-1.0f, set.cone.cosine)) + 1e-3f;
    cosine =
        towards(dot(normals_.axis, set.cone.axis) + kCosineSlack, set.cone.cosine, sine_of(set.cone.cosine));
    cosine = towards(std::min(cosine, 1.0f), normals_.cosine, normals_sine_);
  } else {
    Differences d = differences(box_, set.box);
    parts.far = 1 / max_distance2(d);
    // A sphere sends light from all of its box.
    if (set.spherical) d.half += Vec3f{set.radius, set.radius, set.radius};
    cosine = towards(max_cosine(normals_.axis, d, normals_.cosine >= 1), normals_.cosine, normals_sine_);
    if (cosine <= 0 && closures_.empty() && !behind_) return {Rgb(0)};
    if (!closures_.empty()) cone = directions(d);
    bool has_cosine = set.emission == Emission::oriented;
    if (!set.spherical) {
      parts.near = d.distance2 > 0 ? 1 / d.distance2 : kInfinity;
    } else {
      parts.near = sphere_geometry(d.distance2, set.radius, set.min_radius, rules_.spheres.beyond);
      parts.far = std::min(parts.near, parts.far);
      const bool near = d.distance2 < square(kDiscReach * set.radius) * 1.00001f;
      if (near && rules_.spheres.indicator == SphereRules::Indicator::disc) has_cosine = false;
      // The center's distance alone says whether a row is inside, where light comes from everywhere.
      if (d.distance2 <= set.radius * set.radius * 1.00001f) cone.angle = kPi, cosine = 1;
      if (sharp_) factor *= 3.5f;  // see SceneMatrix::column_set()
    }
    if (has_cosine) {
      d.center = -d.center;
      const float cos_y = towards(max_cosine(set.cone.axis, d, set.cone.cosine >= 1), set.cone.cosine,
                                  sine_of(set.cone.cosine));
      if (cos_y <= 0) return {Rgb(0)};
      factor *= cos_y;
    }
  }
  parts.reflected = scattered(cone, std::min(cosine, 1.0f), set.direct) * set.intensity * factor;
  return parts;
}

Rgb SceneRowBounds::bound(const ColumnSet& set) const {
  const matrix::BoundParts at = parts(set);
  Rgb bound;
  for (int c = 0; c < 3; ++c)
    bound[c] = at.reflected[c] > 0 ? std::min(at.reflected[c] * at.near, set.ceiling[c] * kBoundSlack) : 0.0f;
  return bound;
}

}  // namespace lumirank::transport
