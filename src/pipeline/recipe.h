// Recipe of a picture, worked out from settings once: which camera, which rows, which columns, what is traced
// beside them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "film/pixel_lattice.h"
#include "lumirank/settings.h"
#include "methods/method.h"
#include "pathtrace/reference.h"
#include "transport/cpu/scene_matrix.h"
#include "transport/lights/virtual_lights.h"
#include "transport/rows/receivers.h"
#include "world/view.h"

namespace lumirank::pipeline {

using world::View;
struct ShotLights;

// The view that settings ask for. Throws InputError for an unknown camera or a crop outside the film.
View make_view(const scenedesc::SceneDesc& desc, const ViewSettings& settings);

// The reference with these paths; `only` as in the settings.
pathtrace::ReferenceOptions reference_options(LightPart only, std::uint64_t seed, ReferencePaths paths);

// How the matrix of a picture is made.
struct Recipe {
  std::uint64_t seed = 1;        // of rows, and of what is traced for them
  std::uint64_t light_seed = 1;  // of columns
  std::uint64_t pass = 0;        // of several with the same seed of rows (transport::ReceiverSettings)
  int spp = 4;
  int film_samples = 0;  // per pixel, apart from receivers; 0: these are the film samples
  int max_depth = -1;    // of the view: -1: unlimited
  LightPart only = LightPart::all;
  VirtualLightSettings lights;  // their number is given where they are made
  // Direct light of lobes with a roughness below this is traced (traced_direct.h); 0: none, 2: of all lobes.
  float traced_below = 0;
  // Local compensation (TracedLightSettings): roughness below which lobes are traced, radii within which
  // places are, paths per receiver; 0: none.
  float sharp_below = 0, near_radii = 0;
  float near_lights = 0;  // of points: places are near that fewer lights than these lie about
  int local_paths = 0;
  bool gathered = false;    // indirect light in sharp lobes by receivers of their own (gathered_receivers.h)
  bool first_hits = false;  // what the eye's first hits know is kept, for layers
  bool group_by_emitter = false;  // clusters may not cross emitters, for layers by light
  bool row_albedo = false;        // rows know their albedo, for methods that carry light between frames
  bool brief_survey = false;      // of lights, by half of the paths
  bool compensated = false;       // what clamping takes is given back by tracing
  int instants = 1, instant = 0;  // of an open shutter: rows are those of one instant of so many
  film::PixelLattice pixels;      // rows are those of these pixels
  // Of a shot whose frames have the same lights (shot.h); nullptr: each picture has lights of its own.
  std::shared_ptr<const ShotLights> shot_lights;

  friend bool operator==(const Recipe&, const Recipe&) = default;
};
Recipe make_recipe(const RenderSettings& settings, const View& view);

// What the recipe says to those who make rows, columns and matrix.
transport::ReceiverSettings receiver_settings(const Recipe& recipe, const View& view);
transport::LightSettings light_settings(const Recipe& recipe);
transport::SceneMatrixSettings matrix_settings(const Recipe& recipe);

// The method that settings name and how many lights it wants. "auto" is slice-cuts; where layers part the
// light by its source, which takes one combination of columns for all receivers, or where --set names
// parameters of row-column-sampling, it is that; with an open shutter it is multidimensional-lightcuts. `why`
// (may be nullptr) says so.
const methods::MethodInfo& chosen_method(const RenderSettings& settings, std::string* why = nullptr);
// Whether the method has parameters of all these names.
bool takes_settings(const methods::MethodInfo& info, const std::map<std::string, std::string>& settings);
std::size_t lights_for(const methods::MethodInfo& method, const RenderSettings& settings);

}  // namespace lumirank::pipeline
