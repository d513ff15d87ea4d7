// Curves cut into segments, and the ribbons that Embree traces in their place.
#include "geometry/fibers.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/frame.h"
#include "base/random.h"
#include "base/warp.h"
#include "geometry/ray_scene.h"

namespace lumirank::geometry {
namespace {

Fibers straight(Vec3f a, Vec3f b, float ra, float rb) {
  return make_fibers(CurveBasis::linear, std::vector<Vec3f>{a, b}, std::vector<float>{ra, rb},
                     std::vector<std::uint32_t>{0, 2});
}

RayScene scene_of(Fibers fibers, std::vector<Placement> placements = {{}},
                  Blocking blocking = Blocking::opaque, std::size_t flatten = RayScene::kFlattenLimit) {
  std::vector<TriangleMesh> meshes(1);
  meshes[0].fibers = std::move(fibers);
  for (Placement& p : placements) p.blocking = blocking;
  return RayScene(std::move(meshes), std::move(placements),
                  {[](const Hit&) { return 0.5f; }, [](const Hit&, Vec3f) { return Rgb(0.25f); }}, flatten);
}

// 200 short fibers in a unit cube.
Fibers tangle(std::uint64_t seed) {
  Rng rng(seed, Stage::test);
  std::vector<Vec3f> points;
  std::vector<float> radii;
  std::vector<std::uint32_t> first{0};
  for (int k = 0; k < 200; ++k) {
    Vec3f p{rng.next_float(), rng.next_float(), rng.next_float()};
    for (int i = 0; i < 3; ++i) {
      points.push_back(p), radii.push_back(0.004f + 0.004f * rng.next_float());
      p += warp_sphere(rng.next_2d()) * 0.15f;
    }
    first.push_back(static_cast<std::uint32_t>(points.size()));
  }
  return make_fibers(CurveBasis::linear, points, radii, first);
}

// The definition of a ribbon that faces the ray: the point of the segment that comes nearest to the line of
// the ray, seen along it. Beyond a segment's ends only the wedge counts that a bend leaves open: where the
// segment next to it ends at that point too, seen so. Within `margin` of a rim either answer is right.
std::optional<float> ribbon_hit(const Fibers& f, std::uint32_t segment, const Ray& ray, float margin) {
  const Vec3f d = normalize(ray.direction);
  const Fibers::Point a = f.points[f.segments[segment]], b = f.points[f.segments[segment] + 1];
  const auto flat = [&](Vec3f p) { return p - ray.origin - d * dot(p - ray.origin, d); };
  const Vec3f p = flat(a.position), q = flat(b.position) - p;
  const float free_u = -dot(p, q) / dot(q, q), u = std::clamp(free_u, 0.0f, 1.0f);
  const float slack = margin > 1 ? 1e-3f : -1e-3f;
  if (free_u < -slack || free_u > 1 + slack) {
    if (free_u < 0 ? !f.follows(segment) : !f.goes_on(segment)) return std::nullopt;
    const std::uint32_t joint = f.segments[segment] + (free_u < 0 ? 0 : 1);
    const Vec3f j = flat(f.points[joint].position);
    const Vec3f next = flat(f.points[free_u < 0 ? joint - 1 : joint + 1].position) - j;
    if (-dot(j, next) / dot(next, next) > slack) return std::nullopt;
  }
  const float t = dot(lerp(a.position, b.position, u) - ray.origin, d);
  if (length(p + q * u) > lerp(a.radius, b.radius, u) * margin) return std::nullopt;
  return t > 0 ? std::optional(t) : std::nullopt;
}

TEST(Fibers, CubicBsplineFollowsItsCurve) {
  // A helix; the uniform b-spline at parameter t of piece k by the basis polynomials.
  std::vector<Vec3f> c;
  for (int k = 0; k < 9; ++k) {
    const float a = 0.7f * static_cast<float>(k);
    c.push_back({std::cos(a), std::sin(a), 0.2f * a});
  }
  const std::vector<float> r(9, 0.01f);
  const Fibers f = make_fibers(CurveBasis::bspline, c, r, std::vector<std::uint32_t>{0, 9});
  ASSERT_TRUE(f.smooth);
  const auto on_curve = [&](std::size_t k, float t) {
    const float s = 1 - t, w0 = s * s * s / 6, w3 = t * t * t / 6;
    const float w1 = (3 * t * t * t - 6 * t * t + 4) / 6, w2 = (3 * s * s * s - 6 * s * s + 4) / 6;
    return c[k] * w0 + c[k + 1] * w1 + c[k + 2] * w2 + c[k + 3] * w3;
  };
  EXPECT_LT(length(f.points.front().position - on_curve(0, 0)), 1e-6f);
  EXPECT_LT(length(f.points.back().position - on_curve(5, 1)), 1e-6f);
  // A circle of radius ρ cut every 5° leaves its chords by ρ(1 - cos 2.5°) = 0.1 % of ρ at most.
  for (std::size_t k = 0; k < 6; ++k)
    for (float t = 0; t <= 1; t += 0.05f) {
      float nearest = kInfinity;
      for (const std::uint32_t i : f.segments) {
        const Vec3f a = f.points[i].position, e = f.points[i + 1].position - a, p = on_curve(k, t);
        const float u = std::clamp(dot(p - a, e) / dot(e, e), 0.0f, 1.0f);
        nearest = std::min(nearest, length(p - a - e * u));
      }
      EXPECT_LT(nearest, 0.004f);
    }
  // Tangents are continuous from segment to segment.
  for (std::uint32_t s = 0; s + 1 < f.segments.size(); ++s)
    EXPECT_LT(length(fiber_point(f, s, 1).tangent - fiber_point(f, s + 1, 0).tangent), 1e-6f);
}

TEST(Fibers, BezierPiecesShareTheirEnds) {
  const std::vector<Vec3f> c{{0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {2, 2, 0}, {2, 3, 0}, {1, 4, 0}, {0, 4, 0}};
  const Fibers f = make_fibers(CurveBasis::bezier, c, std::vector<float>{1, 1, 1, 0.5f, 0, 0, 0},
                               std::vector<std::uint32_t>{0, 7});
  EXPECT_EQ(f.points.front().position, c[0]);
  EXPECT_EQ(f.points.back().position, c[6]);
  bool met = false;
  for (const auto& p : f.points)
    met |= length(p.position - c[3]) < 1e-6f && std::abs(p.radius - 0.5f) < 1e-6f;
  EXPECT_TRUE(met);
  EXPECT_EQ(f.segments.size() + 1, f.points.size());
}

TEST(Fibers, PointsWithoutDistanceAreLeftOutAndWrongCountsRefused) {
  const std::vector<Vec3f> c{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}};
  const std::vector<float> r(4, 1);
  EXPECT_EQ(make_fibers(CurveBasis::linear, c, r, std::vector<std::uint32_t>{0, 4}).segments.size(), 1u);
  EXPECT_TRUE(make_fibers(CurveBasis::linear, c, r, std::vector<std::uint32_t>{0, 2, 4}).empty());
  EXPECT_THROW(make_fibers(CurveBasis::bspline, c, r, std::vector<std::uint32_t>{0, 3, 4}), InternalError);
  EXPECT_THROW(make_fibers(CurveBasis::bezier, c, r, std::vector<std::uint32_t>{0, 3, 4}), InternalError);
  EXPECT_THROW(make_fibers(CurveBasis::linear, c, r, std::vector<std::uint32_t>{0, 4, 3}), InternalError);
}

TEST(Fibers, HitIsWhereTheRayPassesTheAxis) {
  const RayScene scene = scene_of(straight({-1, 0, 5}, {3, 0, 5}, 0.1f, 0.2f));
  // At x = 1 the radius is 0.15; the ray passes 0.06 beside the axis.
  const auto hit = scene.intersect({{1, 0.06f, 0}, {0, 0, 2}});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->t, 2.5f, 1e-5f);
  EXPECT_NEAR(hit->barycentric.x, 0.5f, 1e-5f);
  // along × -direction = x × -z = y.
  EXPECT_NEAR(hit->barycentric.y, 0.06f / 0.15f, 1e-4f);
  EXPECT_FALSE(scene.intersect({{1, 0.151f, 0}, {0, 0, 1}}));
  EXPECT_TRUE(scene.intersect({{1, -0.149f, 0}, {0, 0, 1}}));
}

TEST(Fibers, TracesWhatTheDefinitionOfARibbonSays) {
  const Fibers fibers = tangle(1);
  const RayScene scene = scene_of(fibers);
  Rng rng(2, Stage::test);
  int hits = 0;
  for (int k = 0; k < 4000; ++k) {
    const Vec3f target{rng.next_float(), rng.next_float(), rng.next_float()};
    const Ray ray{warp_sphere(rng.next_2d()) * 3.0f, {}};
    const Ray aimed{ray.origin, (target - ray.origin) * 0.7f};
    // Within a thousandth of the rim either answer is right.
    float surely = kInfinity, perhaps = kInfinity;
    for (std::uint32_t s = 0; s < fibers.segments.size(); ++s) {
      if (const auto t = ribbon_hit(fibers, s, aimed, 0.999f)) surely = std::min(surely, *t);
      if (const auto t = ribbon_hit(fibers, s, aimed, 1.001f)) perhaps = std::min(perhaps, *t);
    }
    const auto hit = scene.intersect(aimed);
    const float t = hit ? hit->t * length(aimed.direction) : kInfinity;
    EXPECT_GE(t, perhaps * (1 - 1e-5f));
    EXPECT_LE(t, surely * (1 + 1e-5f));
    hits += hit.has_value();
    EXPECT_EQ(scene.occluded(aimed, 0), hit.has_value());
  }
  EXPECT_GT(hits, 1000);
}

TEST(Fibers, RaysLeaveAndReachTheAxisUnhindered) {
  const RayScene scene = scene_of(straight({-1, 0.3f, 5}, {3, 0, 4}, 0.1f, 0.2f));
  const Fibers& fibers = scene.mesh(0).fibers;
  Rng rng(3, Stage::test);
  for (int k = 0; k < 4000; ++k) {
    const Vec3f axis = fiber_point(fibers, 0, rng.next_float()).axis, w = warp_sphere(rng.next_2d());
    const Vec3f origin = axis + w * 2e-4f;  // as far off as World::offset_origin() puts it here
    EXPECT_FALSE(scene.occluded({origin, w}, 0));
    EXPECT_FALSE(scene.intersect({origin, w}));
    EXPECT_FALSE(scene.occluded({axis + w * 7.0f, -w, 0, 7 * (1 - kShadowEpsilon)}, 0));
    EXPECT_TRUE(scene.occluded({axis + w * 7.0f, -w}, 0));
  }
}

TEST(Fibers, BendsDoNotCatchTheRaysThatLeaveTheirAxis) {
  // A quarter of a circle in 9 chords. Seen from outside along any direction, the axis is hidden at most
  // where another part of the thread lies in front, which from within its plane and from above its middle
  // none does.
  std::vector<Vec3f> points;
  for (int k = 0; k <= 9; ++k) {
    const float a = static_cast<float>(k) * kPi / 18;
    points.push_back({std::cos(a), std::sin(a), 0});
  }
  const Fibers f = make_fibers(CurveBasis::linear, points, std::vector<float>(10, 0.05f),
                               std::vector<std::uint32_t>{0, 10});
  const RayScene scene = scene_of(f);
  Rng rng(6, Stage::test);
  for (int k = 0; k < 4000; ++k) {
    const auto s = static_cast<std::uint32_t>(9 * rng.next_float());
    const FiberPoint at = fiber_point(f, s, rng.next_float());
    // Along the tangent but for a little, and outwards: the curve bends away below.
    const Vec3f w = normalize(at.along * (rng.next_float() < 0.5f ? 1.0f : -1.0f) +
                              normalize(at.axis) * (0.2f + 0.2f * rng.next_float()));
    EXPECT_FALSE(scene.occluded({at.axis + w * 1e-5f, w}, 0));
    EXPECT_FALSE(scene.occluded({at.axis + w * 3.0f, -w, 0, 3 - 1e-4f}, 0));
  }
}

TEST(Fibers, AreaSeenIsTheWidthTimesTheSine) {
  // Of a straight taper, wherever it is seen from: 2∫r dl·sinθ, without caps. By a grid of rays, so to a
  // cell's width on the rim: 4·(0.4 + 2·0.02)/1000 of 0.02 m².
  const Vec3f a{0, 0, 0}, b{0.2f, 0.3f, 0.1f};
  const RayScene scene =
      scene_of(make_fibers(CurveBasis::linear, std::vector<Vec3f>{a, lerp(a, b, 0.3f), b},
                           std::vector<float>{0.03f, 0.024f, 0.01f}, std::vector<std::uint32_t>{0, 3}));
  Rng rng(7, Stage::test);
  for (int view = 0; view < 6; ++view) {
    const Vec3f d = normalize(view == 0 ? b + Vec3f{0.1f, 0, 0} : warp_sphere(rng.next_2d()));
    const Frame frame = Frame::from_normal(d);
    constexpr int kGrid = 800;
    constexpr float kSide = 0.5f;
    int hits = 0;
    for (int k = 0; k < kGrid * kGrid; ++k) {
      const float u = (static_cast<float>(k % kGrid) + 0.5f) / kGrid - 0.5f;
      const float v = (static_cast<float>(k / kGrid) + 0.5f) / kGrid - 0.5f;
      hits += scene.occluded({lerp(a, b, 0.5f) + frame.to_world({u * kSide, v * kSide, 0}) - d * 2.0f, d}, 0);
    }
    const double cell = kSide / kGrid, area = hits * cell * cell;
    const double expected = 2 * 0.02 * length(cross(b, d));
    EXPECT_NEAR(area, expected, 4 * (length(cross(b, d)) + 0.08) * cell * 0.5) << view;
  }
}

TEST(Fibers, NearFibersBlockARay) {
  // From within a radius of it.
  const RayScene scene = scene_of(straight({-1, 0, 1}, {1, 0, 1}, 0.1f, 0.1f));
  for (const float gap : {0.001f, 0.01f, 0.15f, 0.25f}) {
    const auto hit = scene.intersect({{0, 0.02f, 1 - gap}, {0, 0, 2}});
    ASSERT_TRUE(hit) << gap;
    EXPECT_NEAR(hit->t, gap / 2, 1e-6f);
    ShadowPacket packet{};
    for (std::size_t k = 0; k < 16; ++k) {
      packet.ox[k] = 0, packet.oy[k] = 0.02f, packet.oz[k] = 1 - gap;
      packet.dz[k] = k % 2 ? 1.0f : gap / 2;
      packet.t_far[k] = 1, packet.valid[k] = -1;
    }
    EXPECT_EQ(scene.visible16(packet), 0x5555u) << gap;
    EXPECT_FALSE(scene.occluded({{0, 0.02f, 1 + gap}, {0, 0, 1}}, 0));
  }
}

TEST(Fibers, PacketsAgreeWithSingleRaysInInstancesToo) {
  const Fibers fibers = tangle(4);
  const std::vector<Placement> two{{0, Transform{}},
                                   {0, Transform::translate(1, 0.5, 0) * Transform::rotate(1, 2, 3, 50) *
                                           Transform::scale(1.5, 1.5, 1.5)}};
  for (const std::size_t flatten : {RayScene::kFlattenLimit, std::size_t{1}}) {
    for (const Blocking blocking : {Blocking::opaque, Blocking::cutout, Blocking::attenuating}) {
      const RayScene scene = scene_of(fibers, two, blocking, flatten);
      Rng rng(5, Stage::test);
      int blocked = 0;
      for (int p = 0; p < 200; ++p) {
        ShadowPacket packet{};
        packet.seed = 77;
        for (std::size_t k = 0; k < 16; ++k) {
          const Vec3f o = warp_sphere(rng.next_2d()) * 3.0f;
          const Vec3f d = Vec3f{2 * rng.next_float(), rng.next_float(), rng.next_float()} * 2.0f - o;
          packet.ox[k] = o.x, packet.oy[k] = o.y, packet.oz[k] = o.z;
          packet.dx[k] = d.x, packet.dy[k] = d.y, packet.dz[k] = d.z;
          packet.t_far[k] = 1, packet.valid[k] = -1;
          packet.from[k] = static_cast<std::uint32_t>(k), packet.to[k] = static_cast<std::uint32_t>(p);
        }
        const unsigned visible = scene.visible16(packet);
        for (unsigned k = 0; k < 16; ++k) {
          const Ray ray{{packet.ox[k], packet.oy[k], packet.oz[k]},
                        {packet.dx[k], packet.dy[k], packet.dz[k]},
                        kShadowEpsilon,
                        1 - kShadowEpsilon};
          EXPECT_EQ(visible >> k & 1, scene.occluded(ray, packet.key(k)) ? 0u : 1u);
          blocked += !(visible >> k & 1);
          if (blocking == Blocking::attenuating) {
            const float through = scene.transmittance(ray).r, crossings = std::log(through) / std::log(0.25f);
            EXPECT_NEAR(crossings, std::round(crossings), 1e-4f);
            EXPECT_EQ(through < 1, scene.intersect(ray).has_value());
          }
        }
      }
      EXPECT_EQ(blocked > 200, blocking != Blocking::attenuating) << blocked;
    }
  }
}

TEST(Fibers, AreaAndBoundsAreThoseOfTheRoundThread) {
  Fibers f = straight({0, 0, 0}, {0, 0, 4}, 0.5f, 0.25f);
  EXPECT_NEAR(f.area(), 3.14159265 * 4 * 0.75, 1e-5);
  f.transform(Transform::scale(2, 2, 2));
  EXPECT_NEAR(f.area(), 4 * 3.14159265 * 4 * 0.75, 1e-4);
  EXPECT_EQ(f.bounds().lo, (Vec3f{-1, -1, -1}));
  EXPECT_EQ(f.bounds().hi, (Vec3f{1, 1, 8.5f}));
}

}  // namespace
}  // namespace lumirank::geometry
