// From a scene description to a picture: the one way through, in stages that compare can also run one by one.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "film/filter.h"
#include "lumirank/lumirank.h"
#include "lumirank/settings.h"
#include "methods/method.h"
#include "pathtrace/reference.h"
#include "pipeline/traced_direct.h"
#include "scenedesc/schema/scene_desc.h"
#include "transport/cpu/scene_matrix.h"
#include "transport/lights/virtual_lights.h"
#include "transport/rows/receivers.h"
#include "world/view.h"
#include "world/world.h"

namespace lumirank::pipeline {

using world::make_filter;
using world::View;
using world::whole_film;
// The view that settings ask for. Throws InputError for an unknown camera or a crop outside the film.
View make_view(const scenedesc::SceneDesc& desc, const RenderSettings& settings);

// The reference that settings ask for; paths: "all", "columns", "rest".
pathtrace::ReferenceOptions reference_options(const RenderSettings& settings, const std::string& paths);

// Everything up to the matrix. Lights can be made again (for instant radiosity, or a sweep of --lights) while
// the rest stays.
struct Setup {
  const world::World* world = nullptr;
  View view;
  transport::Receivers receivers;
  transport::VirtualLights lights;
  std::unique_ptr<transport::SceneMatrix> matrix;
  // Direct light that is traced instead of going through the matrix, one per film sample; empty if none is.
  std::vector<Rgb> traced_direct;
  double traced_below = 0;  // roughness under which receivers are traced
  int direct_samples = 0;   // of traced direct light, per receiver
  // What pilots told of the light, where it is known already (survey_lights() below); the next matrix takes
  // it.
  std::shared_ptr<const transport::LightSurvey> survey;
  // Indirect light of sharp lobes, one per film sample; such lobes have left the receivers then.
  std::vector<Rgb> traced_indirect;
  // Indirect light from close by, one per film sample (RenderSettings::local_near).
  std::vector<Rgb> traced_near;
  double radius_scale = 0;                // of spherical lights; 0: points
  pathtrace::CarriedByColumns carried;    // where the rest is to be traced; bound 0: it is not
  std::map<std::string, double> seconds;  // per phase
};

// How receivers are traced directly, see traced_direct.h; the roughness below which `--direct auto` traces.
double traced_roughness(const RenderSettings& settings);

// Whether some receiver has a lobe with a roughness below this.
bool some_traced(const transport::Receivers& receivers, float below);
// The window of the film for which receivers are traced, as ReceiverSettings' crop.
transport::ReceiverSettings receiver_settings(const View& view, const RenderSettings& settings);

// Receivers with their directly traced light. The first and the last step are also there one by one, for
// whoever traces that light under a clock.
void make_receivers(Setup& setup, const RenderSettings& settings, const Sinks& sinks);
void make_eye_receivers(Setup& setup, const RenderSettings& settings, const Sinks& sinks);
// Nothing if no direct light is traced.
std::unique_ptr<DirectTracing> start_direct(Setup& setup, const RenderSettings& settings);
void keep_direct(Setup& setup, const DirectTracing& tracing);
void trace_sharp_lobes(Setup& setup, const RenderSettings& settings, const Sinks& sinks);

// What lights are aimed at: some 16,000 receivers spread over the whole film. Lights thus depend on the view,
// but neither on the crop nor on the number of pixels and samples.
transport::Receivers aim_at(const Setup& setup, std::uint64_t seed, const Sinks& sinks);
transport::SceneMatrixSettings matrix_settings(const Setup& setup, const RenderSettings& settings);
// Setup::survey for lights that are aimed at these receivers.
void survey_lights(Setup& setup, const RenderSettings& settings, const transport::Receivers& aim);
// `count` virtual lights and the matrix over them.
void make_matrix(Setup& setup, const RenderSettings& settings, std::size_t count, const Sinks& sinks);

// The method named by the settings and how many lights it wants. "auto" is slice-cuts; where layers part the
// light by its source, which takes one combination of columns for all receivers, or where --set names
// parameters of row-column-sampling, it is that. `why` (may be nullptr) says so.
const methods::MethodInfo& chosen_method(const RenderSettings& settings, std::string* why = nullptr);
std::size_t lights_for(const methods::MethodInfo& method, const RenderSettings& settings);

// The picture for given row sums: chain weights, directly traced light, emission, reconstruction filter.
struct FilmParts {
  bool emission = true, matrix = true, traced_direct = true, traced_indirect = true;
};
std::vector<Rgb> sample_values(const Setup& setup, std::span<const Rgb> sums, FilmParts parts);
image::Image develop(const Setup& setup, std::span<const Rgb> values);
// InputError if a value is infinite or not a number (sound_pixels.h).
Picture to_picture(const image::Image& image);

}  // namespace lumirank::pipeline
