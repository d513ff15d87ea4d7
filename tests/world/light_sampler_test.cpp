// Light sampling: densities agree with the samples, and no light is lost by the choice among thousands.
#include "world/light_sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/random.h"
#include "base/warp.h"
#include "emitters/round_lamp.h"
#include "scenedesc/readers.h"
#include "support/statistics.h"
#include "world/scene_maker.h"

namespace lumirank::world {
namespace {

using emitters::LitPoint;
using test::build;
using test::mean_of;
using test::student_quantile;

World example(const std::string& name) {
  return build(scenedesc::read_mitsuba(std::string(LUMIRANK_EXAMPLES) + "/" + name + ".xml"));
}

// Every kind of emitter, the near ones around a floor.
World every_emitter() {
  return build(scenedesc::parse_mitsuba(R"(<scene version="3.0.0">
    <sensor type="perspective"/>
    <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/><scale value="5"/></transform></shape>
    <shape type="sphere"><point name="center" x="1" y="2" z="0"/><float name="radius" value="0.5"/>
      <emitter type="area"><rgb name="radiance" value="3, 2, 1"/></emitter></shape>
    <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="90"/><translate x="-2" y="3"/></transform>
      <emitter type="area"><texture type="checkerboard" name="radiance"><rgb name="color0" value="0"/><rgb name="color1" value="4"/>
      </texture></emitter></shape>
    <emitter type="point"><point name="position" x="0" y="1" z="2"/><rgb name="intensity" value="2"/></emitter>
    <emitter type="spot"><transform name="to_world"><lookat origin="0,2,-3" target="0,0,-2" up="1,0,0"/></transform>
      <rgb name="intensity" value="9"/></emitter>
    <emitter type="ies"><string name="filename" value=")" LUMIRANK_TEST_DATA
                                        R"(/ies/downlight.ies"/><float name="scale" value="100"/>
      <transform name="to_world"><lookat origin="-2,2,1" target="-1,0,1" up="1,0,0"/></transform></emitter>
    <emitter type="directional"><vector name="direction" x="1" y="-2" z="0"/><rgb name="irradiance" value="0.5"/></emitter>
    <emitter type="constant"><rgb name="radiance" value="0.3"/></emitter>
    </scene>)",
                                        "every_emitter.xml"));
}

// Round lamps, of which much is hidden close by: one half sunk into a ceiling, one squeezed and with a foot,
// one in a shell full of holes, one too small to be seen as more than a point; and one below the floor.
World round_lamps() {
  return build(scenedesc::parse_mitsuba(R"(<scene version="3.0.0">
    <sensor type="perspective"/>
    <shape type="cube"><transform name="to_world"><scale x="3" y="2" z="3"/></transform>
      <bsdf type="twosided"><bsdf type="diffuse"/></bsdf></shape>
    <shape type="sphere"><transform name="to_world"><scale value="0.4"/><translate x="1" y="2"/></transform>
      <emitter type="area"><rgb name="radiance" value="3, 2, 1"/></emitter></shape>
    <shape type="sphere"><transform name="to_world"><scale x="0.5" y="0.4" z="0.5"/><translate x="-1.5" y="-1.5" z="1"/></transform>
      <emitter type="area"><rgb name="radiance" value="2"/></emitter></shape>
    <shape type="cube"><transform name="to_world"><scale x="0.1" y="0.3" z="0.1"/><translate x="-1.5" y="-1.7" z="1"/></transform></shape>
    <shape type="sphere"><point name="center" x="0" y="0.5" z="-2"/><float name="radius" value="0.3"/>
      <emitter type="area"><rgb name="radiance" value="5"/></emitter></shape>
    <shape type="sphere"><point name="center" x="0" y="0.5" z="-2"/><float name="radius" value="0.3002"/>
      <bsdf type="mask"><texture type="checkerboard" name="opacity"><transform name="to_uv"><scale value="7"/></transform></texture>
      <bsdf type="diffuse"/></bsdf></shape>
    <shape type="sphere"><point name="center" x="0.1" y="0.05" z="0.1"/><float name="radius" value="0.0001"/>
      <emitter type="area"><rgb name="radiance" value="1e7"/></emitter></shape>
    <shape type="sphere"><point name="center" x="0" y="-4" z="0"/><float name="radius" value="0.5"/>
      <emitter type="area"><rgb name="radiance" value="9"/></emitter></shape>
    </scene>)",
                                        "round_lamps.xml"));
}

World named(const std::string& name) {
  return name.empty() ? every_emitter() : name == "round lamps" ? round_lamps() : example(name);
}

LitPoint random_point(const World& world, Rng& rng) {
  const Vec3f size = world.bounds().diagonal();
  const float x = rng.next_float(), y = rng.next_float(), z = rng.next_float();
  const Vec3f position = world.bounds().lo + Vec3f{size.x * x, size.y * y, size.z * z};
  const Vec3f normal = warp_sphere(rng.next_2d());
  return {position, normal, rng.next_below(4) == 0};
}

const emitters::AreaEmitter* lamp_of(const World& world, int emitter) {
  return std::get_if<emitters::AreaEmitter>(&world.emitters()[static_cast<std::size_t>(emitter)].kind);
}

// At the lamp, of the direction in which a sample found it.
double cosine_of(const World& world, const LightSampler::Sample& s) {
  return -dot(lamp_of(world, s.emitter)->triangles[s.direct.triangle].normal, s.direct.direction);
}

// Per area, of a place on a round lamp that is drawn for a point.
double density_of(const emitters::AreaEmitter& lamp, const emitters::RoundLamp& round, Vec3f point,
                  const LightSampler::Place& place) {
  const auto& triangle = lamp.triangles[place.triangle];
  const auto cone = round.cone(point);
  if (!cone) return lamp.by_power.pmf(place.triangle) / triangle.area;
  const Vec3f to = place.position - point;
  return cone->pdf() * -dot(triangle.normal, normalize(to)) / length_squared(to);
}

TEST(LightSampler, APlaceShinesAsASampleFromElsewhere) {
  // A place drawn for one point lights another as what is sampled there, with that density; and the density
  // of the place itself is the same asked of its light as of a ray that hits it.
  for (const char* name : {"lamps", "interior", "round lamps", ""}) {
    const World world = named(name);
    const LightSampler lights(world);
    std::vector<std::optional<emitters::RoundLamp>> rounds;
    for (int e = 0; e < static_cast<int>(world.emitters().size()); ++e)
      rounds.push_back(lamp_of(world, e) ? emitters::round_lamp(*lamp_of(world, e)) : std::nullopt);
    int hits = 0, points = 0;
    for (std::uint64_t i = 0; i < 4000; ++i) {
      Rng rng(4, Stage::test, i);
      const LitPoint chosen_for = random_point(world, rng), at = random_point(world, rng);
      const double u = rng.next_double();
      const auto place = lights.sample_place(chosen_for, u, rng.next_2d());
      if (!(place.choice > 0)) continue;
      const auto s = lights.from_place(at, place);
      if (!(s.pdf > 0)) continue;
      EXPECT_NEAR(length(at.position + s.direct.direction * s.direct.distance - place.position), 0,
                  1e-3 * length(world.bounds().diagonal()));
      // Of a round lamp's place the density depends on what it was drawn for.
      double expected = s.direct.pdf;
      if (const auto& round = rounds[static_cast<std::size_t>(s.emitter)])
        expected = density_of(*lamp_of(world, s.emitter), *round, chosen_for.position, place) *
                   square(s.direct.distance) / cosine_of(world, s);
      EXPECT_NEAR(lights.pdf_place(chosen_for, s) / (place.choice * expected), 1, 1e-3) << name << " " << i;
      if (s.direct.delta) {
        ++points;
        continue;
      }
      const auto hit = world.intersect({at.position, s.direct.direction});
      if (!hit || hit->emitter != s.emitter || hit->hit.triangle != s.direct.triangle) continue;
      ++hits;
      EXPECT_NEAR(lights.pdf_place(chosen_for, *hit, s.direct.direction, s.direct.distance) /
                      lights.pdf_place(chosen_for, s),
                  1, 1e-3)
          << name << " " << i;
      EXPECT_NEAR(lights.pdf_hit(at, *hit, s.direct.direction, s.direct.distance) / s.pdf, 1, 1e-4)
          << name << " " << i;
    }
    EXPECT_GT(hits, 10) << name;  // in the closed interior random points see few of the places
    EXPECT_TRUE(*name || points > 50);
  }
}

TEST(LightSampler, AHitHasTheDensityOfItsSample) {
  for (const char* name : {"lamps", "interior", "round lamps", ""}) {
    const World world = named(name);
    const LightSampler lights(world);
    int hits = 0, skies = 0;
    for (std::uint64_t i = 0; i < 4000; ++i) {
      Rng rng(1, Stage::test, i);
      const LitPoint at = random_point(world, rng);
      const double u = rng.next_double();
      const auto s = lights.sample(at, u, rng.next_2d());
      if (!(s.pdf > 0) || s.direct.delta) continue;
      if (!std::isfinite(s.direct.distance)) {
        ++skies;
        EXPECT_NEAR(lights.pdf_background(at, s.direct.direction) / s.pdf, 1, 1e-4) << name << " " << i;
        const auto seen = lights.background(at, s.direct.direction);
        EXPECT_EQ(seen.pdf, lights.pdf_background(at, s.direct.direction));
        EXPECT_EQ(seen.radiance, world.background(s.direct.direction));
        continue;
      }
      const auto hit = world.intersect({at.position, s.direct.direction});
      if (!hit || hit->emitter != s.emitter || hit->hit.triangle != s.direct.triangle) continue;
      // The sample's own direction and distance are exact; the ray's distance would differ by its rounding.
      EXPECT_NEAR(lights.pdf_hit(at, *hit, s.direct.direction, s.direct.distance) / s.pdf, 1, 1e-4)
          << name << " " << i;
      ++hits;
    }
    EXPECT_GT(hits, 100) << name;
    if (!*name) {
      EXPECT_GT(skies, 200);
    }
  }
}

TEST(LightSampler, ARoundLampIsDrawnByItsCone) {
  // From afar every direction of the cone meets the lamp, whatever hides it there, and all of them alike.
  const World world = round_lamps();
  const LightSampler lights(world);
  for (int e = 0; e < 4; ++e) EXPECT_TRUE(emitters::round_lamp(*lamp_of(world, e))) << e;
  const LitPoint at{{2.9f, 1, -1}, {-1, 0, 0}, false};
  int drawn = 0, found = 0;
  float low = kInfinity, high = 0;
  for (std::uint64_t i = 0; i < 4000; ++i) {
    Rng rng(6, Stage::test, i);
    const double u = rng.next_double();
    const auto s = lights.sample(at, u, rng.next_2d());
    if (s.emitter != 2) continue;
    ++drawn;
    if (!(s.pdf > 0)) continue;
    ++found;
    low = std::min(low, s.pdf), high = std::max(high, s.pdf);
  }
  EXPECT_GT(drawn, 100);
  EXPECT_GT(found, 0.98 * drawn);
  EXPECT_NEAR(low / high, 1, 1e-6);
}

// Light through a horizontal or vertical surface at a point, as one sample finds it.
double received(const World& world, const LitPoint& at, const emitters::DirectSample& s, double pdf) {
  const float cosine = dot(at.normal, s.direction);
  if (!(pdf > 0) || !(cosine > 0)) return 0;
  const Rgb visible = visible_fraction(world, at.position, at.normal, s.direction, s.distance, 0);
  return luminance(s.radiance * visible) * cosine / pdf;
}

// The sum over all emitters, each sampled on its own `each` times, against the sampler's choice: equal means
// at a confidence of 99.9 % for all points together. One emitter left out, or one probability wrong, is a
// bias here.
void expect_no_light_lost(const World& world, int each, int samples, const char* what) {
  const LightSampler lights(world);
  constexpr std::uint64_t kPoints = 8, kSeeds = 24;
  for (std::uint64_t p = 0; p < kPoints; ++p) {
    // A surface point seen from the middle of the scene.
    Rng where(2, Stage::test, p);
    const Vec3f middle = world.bounds().center();
    const Vec3f direction = warp_sphere(where.next_2d());
    const auto hit = world.intersect({middle, direction});
    if (!hit) continue;
    const Vec3f ng = dot(hit->point.ng, direction) < 0 ? hit->point.ng : -hit->point.ng;
    const LitPoint at{hit->point.position, ng, false};
    std::vector<double> all, chosen;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      Rng rng(3, Stage::test, p, seed);
      double sum = 0;
      for (int e = 0; e < static_cast<int>(world.emitters().size()); ++e) {
        for (int k = 0; k < each; ++k) {
          const float u1 = rng.next_float();
          const auto s = world.sample_direct(e, at.position, u1, rng.next_2d());
          sum += received(world, at, s, s.pdf) / each;
        }
      }
      all.push_back(sum);
      sum = 0;
      for (int k = 0; k < samples; ++k) {
        const double u = rng.next_double();
        const auto s = lights.sample(at, u, rng.next_2d());
        sum += received(world, at, s.direct, s.pdf);
      }
      chosen.push_back(sum / samples);
    }
    const auto a = mean_of(all), b = mean_of(chosen);
    const double allowed =
        student_quantile(1e-3, kPoints, kSeeds - 1) * std::hypot(a.standard_error, b.standard_error);
    EXPECT_NEAR(a.mean, b.mean, allowed + 1e-5 * a.mean) << what << ", point " << p;
    EXPECT_LE(allowed, 0.1 * a.mean) << what << ", point " << p << ": the test has lost its teeth";
  }
}

TEST(LightSampler, TheSumOverTwoThousandLamps) { expect_no_light_lost(example("lamps"), 1, 2000, "lamps"); }
TEST(LightSampler, TheSumOverLampsInRecesses) {
  expect_no_light_lost(example("recesses"), 1, 2000, "recesses");
}
TEST(LightSampler, TheSumOverEveryKindOfEmitter) {
  expect_no_light_lost(every_emitter(), 1000, 4000, "every kind");
}

TEST(LightSampler, TheSumOverRoundLampsThatAreHalfHidden) {
  expect_no_light_lost(round_lamps(), 4000, 8000, "round lamps");
}

TEST(LightSampler, LightMattersOnTheSideOfTheEyeOrOnBothIfASurfaceTransmits) {
  scatter::Closure closure;
  closure.frame = Frame::from_normal({0, 0, 1});
  scatter::Lobe lobe;
  lobe.color = Rgb(0.5f);
  closure.add(lobe);
  const Vec3f above = normalize(Vec3f{1, 0, 1}), below = normalize(Vec3f{1, 0, -1});
  EXPECT_EQ(lit_point({}, closure, above).normal, (Vec3f{0, 0, 1}));
  EXPECT_EQ(lit_point({}, closure, below).normal, (Vec3f{0, 0, -1}));
  EXPECT_FALSE(lit_point({}, closure, above).both_sides);
  lobe.kind = scatter::LobeKind::microfacet_transmit;
  closure.add(lobe);
  EXPECT_TRUE(lit_point({}, closure, above).both_sides);
}

TEST(LightSampler, NearAndFarLightsBothGetAQuarter) {
  // Whatever the powers, which for a sky are measured over the disc of the whole scene.
  const World world = every_emitter();
  const LightSampler lights(world);
  const LitPoint floor{{0, 0, 0}, {0, 1, 0}, false};
  int far = 0;
  constexpr int kCount = 1000;
  for (int k = 0; k < kCount; ++k)
    if (!std::isfinite(lights.sample(floor, (k + 0.5) / kCount, {0.3f, 0.6f}).direct.distance)) ++far;
  EXPECT_GE(far, kCount / 4 - 1);
  EXPECT_LE(far, 3 * kCount / 4 + 1);
  // Below the floor, facing down, no near light can matter: all samples go to the far ones.
  const LitPoint below{{0, -1, 0}, {0, -1, 0}, false};
  EXPECT_FALSE(std::isfinite(lights.sample(below, 0.01, {0.3f, 0.6f}).direct.distance));
}

}  // namespace
}  // namespace lumirank::world
