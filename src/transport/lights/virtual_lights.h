// Columns: virtual lights that stand for every emitter and every bounce.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/frame.h"
#include "base/rgb.h"
#include "base/sinks.h"
#include "base/vec.h"
#include "emitters/intensity_profile.h"
#include "scatter/closure.h"
#include "scatter/closure_pool.h"
#include "transport/lights/shining_lobes.h"
#include "world/world.h"

namespace lumirank::transport {

struct GatherPlan;
struct Receivers;
struct LightSurvey;

enum class LightKind : std::uint8_t {
  omni,      // power: intensity (W/sr), point emitters
  oriented,  // power: emitted radiance × area share; cosine emission about `normal`; emitter samples
  surface,   // power: incident flux Φ; scatters with the closure at the hit; particle-traced
            // (Where the shading normal n is not the geometric one ng, power is Φ·|incoming·n|/|incoming·ng|,
            // and cosθy of the entry is taken with ng: then the entry is what an eye path would find there.)
  directional,  // power: irradiance; `normal` is the direction in which the light travels
  spot,  // point with a direction. power: intensity on the axis (W/sr where the profile is 1, if it has one);
         // `normal` is the axis; `closure` is an index into `spots`
};

// Fall-off of a spot light: 1 within the beam, 0 outside the cutoff, linear in the angle between (as in
// Mitsuba).
struct SpotShape {
  float cos_cutoff = 0, cos_beam = 1;
  float cutoff = 0, beam = 0;  // radians
  // If given, it is the fall-off, and the angles only bound it.
  std::shared_ptr<const emitters::IntensityProfile> profile;
  Frame frame;  // the profile's axes in the world
};

struct LightSettings {
  std::uint64_t seed = 1;
  std::size_t count = 100000;  // target over all kinds
  int max_depth = -1;          // Mitsuba's count
  bool direct = true, indirect = true;
  ShiningLobes lobes = {};
  // If given, particles are aimed so that their light reaches these receivers (an interior behind windows),
  // and lights are kept or left out at random so that all are of about equal use to them: see light_plan.h.
  // The result is unbiased for every receiver either way. Read during the call only.
  const Receivers* receivers = nullptr;
  bool brief_survey = false;  // by half of the paths
  // Lobes of receivers with a roughness below this get their direct light elsewhere: emitters then get fewer
  // of the lights (if receivers are given; above 1: all lobes).
  float traced_direct_below = 0;
  // If given, that of the same settings but for count and seed (light_plan.h); else it is made in the call.
  // Read during the call only.
  const LightSurvey* survey = nullptr;
  // Indirect light from gather samples instead of particles (gather_lights.h); `gather`, if given, is what
  // several moments of the scene share, else it is made in the call. Read during the call only.
  bool on_gather_samples = false;
  const GatherPlan* gather = nullptr;
};

// Sorted by kind (in the order of LightKind), lambertian surface lights before others, then along a Morton
// curve (directional lights by direction, all others by position), so that kernels meet long runs of one
// sort.
struct VirtualLights {
  std::vector<LightKind> kind;
  std::vector<Vec3f> position;  // directional: where its ray to the scene's center enters the bounding sphere
  std::vector<Vec3f> normal;    // unit; zero for omni. Surface: shading normal on the side of `incoming`
  // Geometric normal, in the hemisphere of `normal`; equals `normal` for other kinds; zero on a fiber.
  std::vector<Vec3f> ng;
  std::vector<Rgb> power;   // by kind, see above
  std::vector<float> area;  // a_j: the area that the light stands for (clamping); 0: never clamped
  // Spherical lights (sphere_lights.h), else empty. Radius of the sphere, 0 for lights that stay points; and
  // which part of the disc of that radius in the surface's tangent plane other surfaces hide from the light.
  std::vector<float> radius, hidden;
  // Points: distance within which receivers get nothing from a surface light, because what comes from there
  // is traced (LightReach); 0 for other kinds; empty: none has any.
  std::vector<float> reach;
  std::vector<std::uint16_t> emitter;  // first emitter of the path
  std::vector<std::uint16_t> depth;    // path segments from the emitter to here (0: on the emitter)
  // Who it is, by what made it: an emitter's sample by its number, a particle's light by its path and the
  // vertices and splits up to it. The same wherever it stands among others, and whatever others there are.
  std::vector<std::uint64_t> id;
  // Surface lights: the particle that left them (lights of one are not independent of each other); else
  // kNoPath.
  std::vector<std::uint32_t> path;
  std::vector<std::uint8_t> half;      // 1 or 2: the independent half that it belongs to; 0: exact (halves.h)
  std::vector<std::uint32_t> closure;  // surface lights that are not lambertian: index into closures; spot:
                                       // into spots; else kLambertian
  std::vector<Rgb> albedo;             // lambertian surface lights
  std::vector<Vec3f> incoming;         // surface lights: unit, back towards where the light came from
  scatter::ClosurePool closures;       // non-delta lobes only
  std::vector<SpotShape> spots;
  // The closure of any surface light, lambertian or not. Evaluate it with wo = incoming.
  scatter::Closure closure_at(std::size_t j) const;

  static constexpr std::uint32_t kLambertian = 0xffffffffu, kNoPath = 0xffffffffu;

  std::size_t paths = 0;         // particles emitted: powers are divided by it
  std::size_t direct_count = 0;  // columns that stand for emitters

  // Whose random numbers a light uses: its id in 32 bits.
  std::uint32_t key(std::size_t j) const;
  std::size_t size() const { return kind.size(); }
  bool spherical() const { return !radius.empty(); }
  std::size_t memory_bytes() const;
};

// What pilots tell of the light with these settings, whatever their count.
std::shared_ptr<const LightSurvey> survey_lights(const world::World& world, const LightSettings& settings);

// Deterministic in the seed; the number of particle paths is fixed by a pilot before tracing, so the true
// count is near, not exactly, the target.
VirtualLights trace_virtual_lights(const world::World& world, const LightSettings& settings,
                                   const Sinks& sinks = {});

}  // namespace lumirank::transport
