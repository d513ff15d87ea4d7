// Settings of a render: plain values with their defaults. Each field's help, range and unit are listed once,
// in render_fields(), from which the command line, JSON and the documentation are made.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lumirank/export.h"

namespace lumirank {

struct LoadOptions {
  std::map<std::string, std::string> defines;  // values for the scene's $parameters
  bool strict = false;                         // warnings about the scene are errors
  std::string environment = {};                // an image that replaces the scene's own environment
  bool allow_missing = false;                  // files that do not exist get a stand-in, with a warning
  // The moment, in seconds, of a scene that moves; before its first key or after its last one is an
  // InputError. Unset: glTF's nodes as they stand, the first keys of a Mitsuba scene, pbrt's start of the
  // shutter.
  std::optional<double> time = {};
  double frames_per_second = 24;  // of meshes in numbered files (cloth.####.ply), and of the shutter
  std::string clip = {};  // glTF: the animation, by name or number; "": the first; "*": all of them at once
};

// Which of the light is wanted: what reaches a surface straight from an emitter, or all else.
enum class LightPart { all, direct, indirect };
// Virtual lights of indirect light: points; points that send on by the diffuse lobes of their surface alone
// (2009, section 2); spheres (2009, section 4).
enum class LightType { point, diffuse_point, sphere };
// Where indirect virtual lights stand: where particles from the emitters land; on gather samples, which are
// tied to the surfaces (2008, section 5); automatic: the first, for tensor clustering the second.
enum class LightPlacement { automatic, particles, gather };
enum class SphereIndicator { disc, cosine };  // what is taken for the lit surface close by; cosine: 2009
enum class SphereStrategies { all, cone };    // sample cone and both BSDFs, or the cone alone
enum class SphereSamples { overlap, cone };   // by the overlap of lobes and cone, or the cone alone: 2009
// Direct light at receivers: by columns; traced with multiple importance sampling; automatic: traced where a
// lobe is sharper than a measured roughness.
enum class DirectLight { automatic, matrix, traced };
// Paths that columns cannot carry; automatic: traced where a pilot finds that they matter.
enum class RestOfPaths { automatic, skip, trace };
// Flat, thin sheets of smooth glass: light goes straight on through them, also to what is lit; or as the
// interfaces bend it.
enum class Panes { straight, exact };
// Which paths a reference has: all, those that columns carry, or the others.
enum class ReferencePaths { all, columns, rest };
// automatic: where the library is found.
enum class Denoise { automatic, on, off };
// What a target for the error is of, as in PictureError (lumirank/info.h).
enum class ErrorMetric { l1, relmse, flip };
enum class ToneMap { none, reinhard, agx };

// What is rendered, and how finely.
struct ViewSettings {
  std::string camera = {};       // id; "": the scene's first
  int width = 0, height = 0;     // pixels; 0: as the scene says
  std::array<int, 4> crop = {};  // x, y, width, height in pixels; width 0: none
  std::optional<int> spp = {};   // receivers per pixel; unset: 4, or what a time budget holds
  // Film samples per pixel: eye rays with emission and textures of their own, which take their light from the
  // receivers near them. 0: receivers are the film samples. Unset: 16, or none where there are as many
  // receivers, or what a time budget holds.
  std::optional<int> film_samples = {};
  int max_depth = 0;  // bounces as Mitsuba counts them; 0: as the scene says; -1: unlimited
  LightPart only = LightPart::all;
  // Motion blur: the shutter opens and closes so many frames after the scene's moment; equal: one moment. The
  // picture is the mean of that many instants between, evenly spread; unset: 16, a reference 64.
  double shutter_open = 0, shutter_close = 0;
  std::optional<int> shutter_samples = {};

  bool is_open() const { return shutter_close > shutter_open; }
  static constexpr int kDefaultInstants = 16, kReferenceInstants = 64;
  static constexpr int kDefaultSpp = 4, kDefaultFilmSamples = 16;
  int spp_or_default() const { return spp.value_or(kDefaultSpp); }
  int film_samples_or_default() const {
    return film_samples.value_or(spp_or_default() < kDefaultFilmSamples ? kDefaultFilmSamples : 0);
  }
};

// The columns of the matrix.
struct VirtualLightSettings {
  std::optional<std::uint64_t> count = {};  // unset: 100,000, or what a time budget holds
  LightType type = LightType::point;
  LightPlacement placement = LightPlacement::automatic;
  double clamp = 0.03;  // X of docs/conventions.md; 0: off
  // Of point lights: sharper lobes shine as if they had it; 0: as they are; unset: 0.1, on gather samples
  // 0.3.
  std::optional<double> roughness = {};
  double radius_scale = 0;  // spheres: radius over the distance to the 10th nearest; 0: automatic
  SphereIndicator sphere_indicator = SphereIndicator::disc;
  SphereStrategies sphere_strategies = SphereStrategies::all;
  SphereSamples sphere_samples = SphereSamples::overlap;

  static constexpr std::uint64_t kDefaultCount = 100000;
  std::uint64_t count_or_default() const { return count.value_or(kDefaultCount); }
  friend bool operator==(const VirtualLightSettings&, const VirtualLightSettings&) = default;
};

// How row sums are estimated.
struct MethodSettings {
  std::string name = "auto";
  std::map<std::string, std::string> parameters = {};  // by key; list_methods() has them
  std::uint64_t seed = 0;   // other choices on the same lights and receivers; 0: the render's seed
  double target_error = 0;  // estimated error to stop at; 0: the method's default
  // Of pictures of passes or paths any, by the noise of all of them; else relative L1 alone.
  ErrorMetric error_metric = ErrorMetric::l1;
};

// Light that is traced beside the matrix.
struct TracedLightSettings {
  DirectLight direct = DirectLight::automatic;
  RestOfPaths rest = RestOfPaths::automatic;
  Panes panes = Panes::straight;  // of a single picture
  int compensate = 0;  // paths per pixel that give back what clamping took from indirect light; 0: none
  // Local compensation: paths per receiver for the light that virtual lights would blur or lose; 0: none. It
  // takes all light of lobes with a roughness below local_sharp and, where lights are spherical, what comes
  // from closer than local_near of their radii; columns then have none of it.
  int local_paths = 0;
  double local_sharp = 0.3;
  double local_near = 4;
};

struct RenderSettings {
  ViewSettings view = {};
  VirtualLightSettings lights = {};
  MethodSettings method = {};
  TracedLightSettings traced = {};
  std::vector<std::string> layers = {};  // further layers of the picture by name: see render_fields(), "aov"
  std::uint64_t seed = 1;
  int threads = 0;  // 0: all
  double time = 0;  // seconds from the loaded scene on; 0: no limit
  // Pictures with receivers and lights of their own, whose mean is shown. 0: as time or error allow where the
  // method is made for passes, else one picture without them.
  int passes = 0;
  Denoise denoise = Denoise::automatic;  // of what is rendered in passes
  // What the clock decided in an earlier run under `time`, from its report: repeated instead of timed anew,
  // so that the picture has the same bits. Empty: the clock decides.
  std::map<std::string, std::vector<std::int64_t>> choices = {};
  // Seconds of `time` that are gone before render() begins, as by reading the scene; they count in the
  // report's total.
  double time_spent = 0;
};

struct ReferenceSettings {
  int spp = 0;       // paths per pixel; 0: until time or error, or 64 if neither is given
  double time = 0;   // seconds
  double error = 0;  // stop when the stated relative L1 error is below
  ReferencePaths paths = ReferencePaths::all;
};

struct DisplaySettings {
  std::optional<double> exposure = {};  // stops; if not given, exposure_for()
  ToneMap tonemap = ToneMap::none;
  // Ends of the scale of false-color pictures of the illuminance, in lux; high 0: from 0 to a round number.
  double lux_low = 0, lux_high = 0;
};

// The names that the command line uses. Throw InputError that lists the valid ones.
LUMIRANK_API ReferencePaths reference_paths(const std::string& name);
LUMIRANK_API std::string to_text(ReferencePaths paths);
LUMIRANK_API ToneMap tone_map(const std::string& name);

// One row of the table of settings.
struct Field {
  std::string key, type, default_text, range, unit, help;
};
LUMIRANK_API const std::vector<Field>& render_fields();

// Reads and writes one field by its key. Throws InputError that lists the valid keys or values.
LUMIRANK_API void set_field(RenderSettings& settings, const std::string& key, const std::string& value);
LUMIRANK_API std::string get_field(const RenderSettings& settings, const std::string& key);

// All fields as a JSON object and back, without `choices`; an unknown key is an InputError.
LUMIRANK_API std::string to_json(const RenderSettings& settings);
LUMIRANK_API RenderSettings render_settings_from_json(const std::string& text);

// The settings of an earlier render and its choices, from its report. Throws InputError if it is none, or was
// made under a time budget and lacks its choices because it was interrupted.
LUMIRANK_API RenderSettings render_settings_from_report(const std::string& report);

// Throws InputError for values that contradict each other or lie out of range.
LUMIRANK_API void validate(const RenderSettings& settings);

}  // namespace lumirank
