// What a render is asked for: plain values with their defaults. Each field's help, range and unit are listed
// once, in render_fields(), from which the command line, JSON and the documentation are made.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace lumirank {

struct LoadOptions {
  std::map<std::string, std::string> defines;  // values for the scene's $parameters
  bool strict = false;                         // warnings about the scene are errors
  std::string environment = {};                // an image that replaces the scene's own environment
  bool allow_missing = false;                  // files that do not exist get a stand-in, with a warning
};

struct RenderSettings {
  std::string method = "auto";
  std::map<std::string, std::string> method_settings;  // --set KEY=VALUE
  std::uint64_t lights = 100000;
  bool lights_given = false;  // asked for by hand: a time budget does not lower them, nor any other value
                              // than the default
  std::string light_type = "point";  // point, sphere
  double radius_scale = 0;  // spherical lights: radius over the distance to the 10th nearest; 0: automatic
  std::string sphere_indicator = "disc";   // disc, cosine
  std::string sphere_strategies = "all";   // all, cone
  std::string sphere_samples = "overlap";  // overlap, cone
  int width = 0, height = 0;               // pixels; 0: as the scene says
  int spp = 4;                             // receivers per pixel
  bool spp_given = false;                  // as lights_given
  int max_depth = 0;         // bounces as Mitsuba counts them; 0: as the scene says; -1: unlimited
  double clamp = 0.03;       // X of docs/conventions; 0: off
  std::string only = "all";  // all, direct, indirect
  std::uint64_t seed = 1;
  std::uint64_t method_seed = 0;  // other choices of the method on the same lights and receivers; 0: the seed
  int threads = 0;                // 0: all
  double time = 0;                // seconds; 0: no limit
  double error = 0;               // estimated relative error to stop at; 0: the method's default
  std::string backend = "cpu";
  std::string direct =
      "auto";  // matrix, traced, auto: traced where the receiver is glossier than a measured roughness
  // Local compensation: paths per receiver for the light that virtual lights would blur or lose; 0: none. It
  // takes all light of lobes with a roughness below local_sharp and, where lights are spherical, what comes
  // from closer than local_near of their radii; columns then have none of it.
  int local_paths = 0;
  double local_sharp = 0.3;
  double local_near = 4;
  std::string rest = "auto";  // auto: where a pilot finds that it matters; skip, trace
  int compensate = 0;  // paths per pixel that give back what clamping took from indirect light; 0: none
  std::string visibility = "exact";
  std::string camera;          // "": the scene's first
  int crop[4] = {0, 0, 0, 0};  // x, y, width, height; width 0: none
  std::vector<std::string> aovs;
  // What the clock decided in an earlier run under `time`, from its report: repeated instead of timed anew,
  // so that the picture has the same bits. Empty: the clock decides.
  std::map<std::string, std::vector<std::int64_t>> choices;
};

struct ReferenceSettings {
  int spp = 0;                // 0: until time or error, or 64 if neither is given
  double time = 0;            // seconds
  double error = 0;           // stop when the stated relative L1 error is below
  std::string paths = "all";  // all, columns, rest
};

struct DisplaySettings {
  double exposure = 0;           // stops
  std::string tonemap = "none";  // none, reinhard, agx
  // Ends of the scale of false-colour pictures of the illuminance, in lux; high 0: from 0 to a round number.
  double lux_low = 0, lux_high = 0;
};

// One row of the table of settings.
struct Field {
  std::string key, type, default_text, range, unit, help;
};
const std::vector<Field>& render_fields();

// Reads and writes one field by its key. Throws InputError that lists the valid keys or values.
void set_field(RenderSettings& settings, const std::string& key, const std::string& value);
std::string get_field(const RenderSettings& settings, const std::string& key);

// All fields as a JSON object and back, without `choices`; an unknown key is an InputError.
std::string to_json(const RenderSettings& settings);
RenderSettings render_settings_from_json(const std::string& text);

// The settings of an earlier render and its choices, from its report. Throws InputError if it is none, or was
// made under a time budget and lacks its choices because it was interrupted.
RenderSettings render_settings_from_report(const std::string& report);

// Throws InputError for values that contradict each other or lie out of range.
void validate(const RenderSettings& settings);

}  // namespace lumirank
