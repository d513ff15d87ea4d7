#include "transport/pairs/media_row_bounds.h"

#include <algorithm>
#include <cmath>

#include "media/tracking.h"
#include "transport/pairs/bound_geometry.h"

namespace lumirank::transport {

using matrix::BoundParts;
using matrix::ColumnSet;
using matrix::Cone;
using matrix::Emission;
using matrix::Index;
using scatter::DirectionCone;

namespace {

struct CosineRange {
  float min = -1, max = 1;
};
// Between directions of either cone.
CosineRange cosines(const Cone& a, const DirectionCone& b) {
  if (a.cosine <= -1 || b.angle >= kPi) return {};
  const auto angle_of_cosine = [](float cosine) { return std::acos(std::clamp(cosine, -1.0f, 1.0f)); };
  const float between = angle_of_cosine(dot(a.axis, b.axis));
  // Where angles are small their cosines tell them roughly.
  const float spread = (a.cosine < 1 ? angle_of_cosine(a.cosine) : 0.0f) + b.angle + 1e-3f;
  return {std::cos(std::min(kPi, between + spread)), std::cos(std::max(0.0f, between - spread))};
}
DirectionCone opposite(const DirectionCone& cone) { return {-cone.axis, cone.angle}; }

// What a medium scatters at most from flights of `a` into directions of `b`, per steradian.
Rgb max_phase(const media::PhaseFunction& phase, const Cone& a, const DirectionCone& b) {
  if (phase.isotropic()) return phase.max_value();
  const CosineRange turned = cosines(a, b);
  return phase.max_value(turned.min, turned.max);
}

// Of a length, what is nearer to it counts as so far away.
constexpr float kNearest = 0.25f;

// ∫ 1/d² along a length, over the length.
float along_line(float distance2, float length) {
  distance2 = std::max(distance2, square(kNearest * length));
  if (!(distance2 > 0)) return kInfinity;
  return std::min(1 / distance2, kPi / (std::sqrt(distance2) * std::max(length, 1e-30f)));
}

// The least of the lengths along which each channel would be scattered at its greatest rate.
float spread_of(const media::Medium::Scattering& scattering) {
  float spread = kInfinity;
  for (int c = 0; c < 3; ++c)
    if (scattering.most[c] > 0) spread = std::min(spread, scattering.total[c] / scattering.most[c]);
  return spread;
}

Bounds3f box_of_line(Vec3f from, Vec3f to) {
  Bounds3f box;
  box.extend(from), box.extend(to);
  return box;
}

}  // namespace

ColumnSet ray_set(const media::Medium& medium, std::int16_t number, Vec3f origin, Vec3f direction,
                  float length, Rgb power) {
  const media::Medium::Scattering scattering = medium.max_scattering(origin, direction, length);
  ColumnSet set;
  set.emission = Emission::ray;
  set.box = box_of_line(origin, origin + direction * length);
  set.cone = {direction, 1};
  set.intensity = power * scattering.total;
  set.medium = number;
  set.min_length = spread_of(scattering);
  return set;
}

MediaRowBounds::MediaRowBounds(const world::World& world, const Receivers& receivers, const BoundRules& rules)
    : world_(world), receivers_(receivers), surfaces_(receivers, rules) {}

void MediaRowBounds::set_rows(std::span<const Index> rows) {
  on_surfaces_.clear(), pieces_.clear();
  const std::size_t surfaces = receivers_.size();
  for (const Index i : rows)
    if (i < surfaces) on_surfaces_.push_back(i);
  surfaces_.set_rows(on_surfaces_);
  const bool apart = rows.size() - on_surfaces_.size() <= kRowsApart;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (rows[k] < surfaces) continue;
    if (apart)
      take_apart(rows[k] - surfaces, static_cast<std::uint32_t>(k));
    else
      merge(rows[k] - surfaces);
  }
  for (Piece& piece : pieces_) piece.spread = spread_of(piece.scattering);
}

void MediaRowBounds::take_apart(std::size_t segment, std::uint32_t sum) {
  const EyeSegments& s = receivers_.segments;
  const float part = s.length[segment] / kPartsOfRow;
  for (int k = 0; k < kPartsOfRow; ++k) {
    const Vec3f from = s.origin[segment] + s.direction[segment] * (part * static_cast<float>(k));
    const media::Medium::Scattering scattering =
        medium(s.medium[segment]).max_scattering(from, s.direction[segment], part);
    if (is_black(scattering.total)) continue;
    pieces_.push_back({.box = box_of_line(from, from + s.direction[segment] * part),
                       .directions = {s.direction[segment], 1},
                       .scattering = scattering,
                       .medium = s.medium[segment],
                       .sum = sum});
  }
}

void MediaRowBounds::merge(std::size_t segment) {
  const EyeSegments& s = receivers_.segments;
  const std::int16_t number = s.medium[segment];
  const media::Medium::Scattering scattering =
      medium(number).max_scattering(s.origin[segment], s.direction[segment], s.length[segment]);
  if (is_black(scattering.total)) return;
  const Bounds3f box =
      box_of_line(s.origin[segment], s.origin[segment] + s.direction[segment] * s.length[segment]);
  const Cone direction{s.direction[segment], 1};
  for (Piece& piece : pieces_) {
    if (piece.medium != number) continue;
    piece.box.extend(box);
    piece.directions = join(piece.directions, direction);
    piece.scattering.total = greater(piece.scattering.total, scattering.total);
    piece.scattering.most = greater(piece.scattering.most, scattering.most);
    return;
  }
  pieces_.push_back({.box = box,
                     .directions = direction,
                     .scattering = scattering,
                     .medium = number,
                     .sum = static_cast<std::uint32_t>(pieces_.size())});
}

BoundParts MediaRowBounds::of_surfaces(const ColumnSet& set) const {
  if (on_surfaces_.empty()) return {Rgb(0)};
  if (set.emission != Emission::ray) return surfaces_.parts(set);
  const Differences d = differences(surfaces_.box(), set.box);
  ColumnSet points = set;
  points.emission = Emission::omni;
  points.intensity *= max_phase(medium(set.medium).phase(), set.cone, opposite(directions(d)));
  BoundParts parts = surfaces_.parts(points);
  parts.near = std::min(parts.near, along_line(d.distance2, set.min_length));
  parts.far = std::min(parts.far, parts.near);
  return parts;
}

BoundParts MediaRowBounds::of_piece(const Piece& piece, const ColumnSet& set) const {
  BoundParts parts{Rgb(0)};
  DirectionCone towards_light;
  Rgb sent = set.intensity * kBoundSlack;
  if (set.emission == Emission::directional) {
    towards_light.axis = set.cone.axis;
    towards_light.angle = set.cone.cosine >= 1 ? 0.0f : std::acos(std::max(-1.0f, set.cone.cosine)) + 1e-3f;
  } else {
    Differences d = differences(piece.box, set.box);
    towards_light = directions(d);
    parts.far = 1 / max_distance2(d);
    float length = piece.spread;
    if (set.emission == Emission::ray) {
      const media::Medium& scatters = medium(set.medium);
      sent *= max_phase(scatters.phase(), set.cone, opposite(towards_light));
      length = std::max(length, set.min_length);
      if (set.medium == piece.medium && scatters.homogeneous())
        sent *= media::passed(scatters.even_extinction(), std::sqrt(d.distance2));
    } else if (set.emission == Emission::oriented) {
      Differences back = d;
      back.center = -back.center;
      const float cosine = towards(max_cosine(set.cone.axis, back, set.cone.cosine >= 1), set.cone.cosine,
                                   sine_of(set.cone.cosine));
      if (cosine <= 0) return parts;
      sent *= cosine;
    }
    parts.near = along_line(d.distance2, length);
    parts.far = std::min(parts.far, parts.near);
  }
  const CosineRange turned = cosines(piece.directions, towards_light);
  parts.reflected =
      sent * piece.scattering.total * medium(piece.medium).phase().max_value(turned.min, turned.max);
  return parts;
}

MediaRowBounds::Sums MediaRowBounds::greatest(const ColumnSet& set) const {
  Sums most, sum;
  for (std::size_t k = 0; k < pieces_.size(); ++k) {
    if (k > 0 && pieces_[k].sum != pieces_[k - 1].sum) sum = {};
    const BoundParts parts = of_piece(pieces_[k], set);
    sum.reflected += parts.reflected;
    sum.near += media::over_length(parts.reflected, parts.near);
    sum.far += media::over_length(parts.reflected, parts.far);
    most.reflected = greater(most.reflected, sum.reflected);
    most.near = greater(most.near, sum.near), most.far = greater(most.far, sum.far);
  }
  return most;
}

Rgb MediaRowBounds::bound(const ColumnSet& set) const {
  const BoundParts surfaces = of_surfaces(set);
  Rgb bound = media::over_length(surfaces.reflected, surfaces.near);
  for (int c = 0; c < 3; ++c) bound[c] = std::min(bound[c], set.ceiling[c] * kBoundSlack);
  return greater(bound, greatest(set).near);
}

BoundParts MediaRowBounds::parts(const ColumnSet& set) const {
  const BoundParts surfaces = of_surfaces(set);
  if (pieces_.empty()) return surfaces;
  const Sums sums = greatest(set);
  BoundParts segments;
  segments.reflected = sums.reflected;
  if (const float one = luminance(sums.reflected); one > 0) {
    segments.near = luminance(sums.near) / one;
    segments.far = std::min(segments.near, luminance(sums.far) / one);
  }
  if (on_surfaces_.empty()) return segments;
  // Of rows of both kinds what is greater of either.
  return {greater(surfaces.reflected, segments.reflected), std::max(surfaces.near, segments.near),
          std::max(surfaces.far, segments.far)};
}

}  // namespace lumirank::transport
