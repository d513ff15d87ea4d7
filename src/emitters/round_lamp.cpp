#include "emitters/round_lamp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/frame.h"

namespace lumirank::emitters {
namespace {

using Triangle = AreaEmitter::Triangle;

// Fewer are chosen among in one or two steps of a tree.
constexpr std::size_t kLeastTriangles = 32;
// Of the cone's directions that meet a convex lamp, over all places far from it (Cauchy: a convex body's mean
// shadow is a quarter of its surface).
constexpr float kLeastFill = 0.65f;
// Of the radius: by so much a corner may stand out of a triangle's plane, or lie within the ball.
constexpr float kFlat = 1e-3f;
// Twenty thousand triangles, some hundredths of a second.
constexpr std::size_t kMostComparisons = std::size_t{1} << 28;
constexpr float kAlike = 1e-3f;  // relative, of radiance
// Of all around: what may be open. More than rounding, less than what would be missed.
constexpr double kOpen = 1e-4;
// Of the distance: smaller balls are seen as points are.
constexpr float kLeastSize = 1e-4f;

std::array<Vec3f, 3> corners(const Triangle& t) { return {t.p0, t.p0 + t.e1, t.p0 + t.e2}; }

bool alike(const AreaEmitter& emitter) {
  float low = kInfinity, high = 0;
  for (const Triangle& t : emitter.triangles) {
    if (!(t.area > 0)) continue;
    low = std::min(low, luminance(t.mean_radiance)), high = std::max(high, luminance(t.mean_radiance));
  }
  return low > 0 && high - low <= kAlike * high;
}

RoundLamp ball_around(const AreaEmitter& emitter) {
  Bounds3f box;
  for (const Triangle& t : emitter.triangles)
    for (const Vec3f p : corners(t)) box.extend(p);
  RoundLamp ball{box.center(), 0};
  float radius2 = 0;
  for (const Triangle& t : emitter.triangles)
    for (const Vec3f p : corners(t)) radius2 = std::max(radius2, length_squared(p - ball.center));
  ball.radius = std::sqrt(radius2);
  return ball;
}

// Over 4π: how often the triangles, seen from a point inside, cover all around. (A. van Oosterom, J.
// Strackee, "The Solid Angle of a Plane Triangle", 1983.)
double times_around(const AreaEmitter& emitter, Vec3f inside) {
  double sum = 0;
  for (const Triangle& t : emitter.triangles) {
    if (!(t.area > 0)) continue;
    auto [a, b, c] = corners(t);
    a = normalize(a - inside), b = normalize(b - inside), c = normalize(c - inside);
    const double volume = std::abs(dot(a, cross(b, c)));
    const double facing = dot(t.normal, t.p0 - inside) > 0 ? 1 : -1;
    sum += facing * 2 * std::atan2(volume, 1.0 + dot(a, b) + dot(b, c) + dot(c, a));
  }
  return sum / (4 * kPiD);
}

bool on_ball(const AreaEmitter& emitter, const RoundLamp& ball) {
  for (const Triangle& t : emitter.triangles)
    for (const Vec3f p : corners(t))
      if (length_squared(p - ball.center) < square((1 - kFlat) * ball.radius)) return false;
  return true;
}

// Whether no corner stands out of any triangle's plane.
bool convex(const AreaEmitter& emitter, const RoundLamp& ball) {
  // Triangles that share a corner have it rounded differently: most copies go where all are rounded more.
  const float step = 0.1f * kFlat * ball.radius;
  std::vector<std::array<float, 3>> places;
  for (const Triangle& t : emitter.triangles) {
    for (const Vec3f p : corners(t)) {
      const Vec3f q = (p - ball.center) / step;
      places.push_back({std::round(q.x), std::round(q.y), std::round(q.z)});
    }
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  if (places.size() * emitter.triangles.size() > kMostComparisons) return false;
  std::array<std::vector<float>, 3> axes;
  for (int axis = 0; axis < 3; ++axis)
    for (const auto& p : places) axes[axis].push_back(p[axis] * step);
  for (const Triangle& t : emitter.triangles) {
    if (!(t.area > 0)) continue;
    const float limit = dot(t.normal, t.p0 - ball.center) + kFlat * ball.radius;
    int outside = 0;  // counted, not sought: many at a time
    for (std::size_t k = 0; k < places.size(); ++k)
      outside += t.normal.x * axes[0][k] + t.normal.y * axes[1][k] + t.normal.z * axes[2][k] > limit;
    if (outside > 0) return false;
  }
  return true;
}

}  // namespace

std::optional<RoundLamp> round_lamp(const AreaEmitter& emitter) {
  if (emitter.triangles.size() < kLeastTriangles || !emitter.seen || !alike(emitter)) return std::nullopt;
  const RoundLamp ball = ball_around(emitter);
  if (!(emitter.total_area >= kLeastFill * 4 * kPi * square(ball.radius))) return std::nullopt;
  if (!(std::abs(times_around(emitter, ball.center) - 1) < kOpen)) return std::nullopt;
  // What has its corners on the ball and goes around its center once is convex, but for how its triangles
  // meet.
  if (!on_ball(emitter, ball) && !convex(emitter, ball)) return std::nullopt;
  return ball;
}

std::optional<RoundLamp::Cone> RoundLamp::cone(Vec3f point) const {
  const Vec3f to = center - point;
  const float distance2 = length_squared(to), sin2 = square(radius) / distance2;
  if (!(sin2 < 0.999f && sin2 > square(kLeastSize))) return std::nullopt;
  return Cone{to / std::sqrt(distance2), sin2 / (1 + std::sqrt(1 - sin2))};
}

Vec3f RoundLamp::Cone::sample(Vec2f u) const {
  // As warp_cone(), of which little would be left where the cone is narrow.
  const float below = u.x * one_minus_cosine, r = std::sqrt(below * (2 - below)), phi = 2 * kPi * u.y;
  return normalize(Frame::from_normal(axis).to_world(Vec3f{r * std::cos(phi), r * std::sin(phi), 1 - below}));
}

Vec2f RoundLamp::span(Vec3f origin, Vec3f direction) const {
  const Vec3f to = center - origin;
  const float middle = dot(to, direction), slack = 1e-3f * radius + 1e-6f * std::abs(middle);
  const float half2 = square(radius + slack) - length_squared(to - direction * middle);
  if (!(half2 > 0)) return {1, 0};
  const float half = std::sqrt(half2) + slack;
  return {std::max(0.0f, middle - half), middle + half};
}

}  // namespace lumirank::emitters
