#include "pathtrace/lit_stretch.h"

#include <algorithm>
#include <cmath>

#include "media/tracking.h"

namespace lumirank::pathtrace {
namespace {

// Behind so much of the channel that reaches farthest, a thousandth of the light is left.
constexpr float kDeepest = 7;
// Of the squares of the distances to a lamp, from the nearest place to the farthest.
constexpr float kLeastSpread = 4;

Rgb middle(const media::Medium::Walk::Piece& piece) {
  return (piece.extinction.least + piece.extinction.most) * 0.5f;
}

// Where the last of the channels that are attenuated at all gets to kDeepest.
float where_dark(const media::Medium::Walk::Piece& piece, Rgb depth, Rgb extinction) {
  float last = piece.begin;
  for (int c = 0; c < 3; ++c) {
    if (extinction[c] > 0)
      last = std::max(last, piece.begin + (kDeepest - depth[c]) / extinction[c]);
    else if (depth[c] > 0 && depth[c] < kDeepest)
      return kInfinity;
  }
  return last;
}

}  // namespace

LitStretch::LitStretch(const media::Medium& medium, Vec3f origin, Vec3f direction, float distance,
                       float share, float u)
    : medium_(&medium), origin_(origin), direction_(direction), share_(share) {
  media::Medium::Walk walk(medium, origin, direction, distance);
  media::Medium::Walk::Piece piece;
  float begin = -1, end = -1;
  Rgb depth{0};
  while (walk.next(piece)) {
    const Rgb extinction = middle(piece);
    if (is_black(extinction)) continue;
    if (begin < 0) begin = piece.begin;
    const float dark = where_dark(piece, depth, extinction);
    end = std::min(piece.end, dark);
    depth += extinction * (end - piece.begin);
    if (dark <= piece.end) break;
  }
  if (!(end > begin) || !std::isfinite(end)) return;
  begin_ = begin, length_ = end - begin;
  // As a path of the mean extinction would collide.
  const float thickness = mean(depth);
  const float along = thickness > 1e-3f ? -std::log1p(u * std::expm1(-thickness)) / thickness : u;
  chosen_for_ = {origin + direction * (begin + length_ * along), Vec3f{}, true};
}

bool LitStretch::worthwhile(Vec3f lamp) const {
  const Vec3f to_lamp = lamp - origin_ - direction_ * begin_;
  const float closest = dot(to_lamp, direction_);
  const float aside2 = length_squared(to_lamp - direction_ * closest);
  const float nearest = closest - std::clamp(closest, 0.0f, length_);
  const float farthest = std::max(std::abs(closest), std::abs(length_ - closest));
  return aside2 + square(farthest) > kLeastSpread * (aside2 + square(nearest));
}

bool LitStretch::near(const Bounds3f& lamps) const {
  Vec3f away;
  const Vec3f begin = origin_ + direction_ * begin_;
  for (int axis = 0; axis < 3; ++axis)
    away[axis] = std::max({lamps.lo[axis] - begin[axis], begin[axis] - lamps.hi[axis], 0.0f});
  // Beyond twice its length from where it begins, its farthest place is less than twice as far as its
  // nearest.
  static_assert(kLeastSpread >= 4);
  return length_squared(away) <= square(2 * length_);
}

RayPlace LitStretch::sample(Vec3f lamp, float u) const {
  if (empty() || !worthwhile(lamp)) return {};
  RayPlace place = sample_equiangular(origin_ + direction_ * begin_, direction_, length_, lamp, u);
  place.t += begin_, place.pdf *= share_;
  return place;
}

float LitStretch::pdf(Vec3f lamp, float t) const {
  if (empty() || !covers(t) || !worthwhile(lamp)) return 0;
  return share_ * pdf_equiangular(origin_ + direction_ * begin_, direction_, length_, lamp, t - begin_);
}

Rgb LitStretch::collision_density(float t, Rgb extinction) const {
  media::Medium::Walk walk(*medium_, origin_, direction_, t);
  media::Medium::Walk::Piece piece;
  Rgb depth{0};
  while (walk.next(piece)) depth += middle(piece) * (piece.end - piece.begin);
  return extinction * media::exp_minus(depth);
}

}  // namespace lumirank::pathtrace
