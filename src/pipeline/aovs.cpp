#include "pipeline/aovs.h"

#include <functional>
#include <map>

#include "base/error.h"
#include "pipeline/illuminance.h"

namespace lumirank::pipeline {
namespace {

void add_plane(Picture& picture, const std::string& name, const image::Image& image) {
  picture.planes.push_back({name, to_picture(image).planes[0].rgb});
}

// The part of the estimate made of the columns that `keep` chooses: light is linear, and so is the estimate.
image::Image part_image(const Setup& setup, const methods::Estimate& estimate,
                        const std::function<bool(matrix::Index)>& keep, FilmParts parts, const Sinks& sinks) {
  std::vector<matrix::ScaledColumn> columns;
  for (const auto& c : estimate.combination)
    if (keep(c.column)) columns.push_back(c);
  std::vector<Rgb> sums(setup.receivers.size());
  setup.matrix->accumulate(columns, sums, sinks);
  return develop(setup, sample_values(setup, sums, parts));
}

template <typename T, typename F>
image::Image first_hit_image(const Setup& setup, const std::vector<T>& values, F&& to_rgb) {
  std::vector<Rgb> rgb;
  rgb.reserve(values.size());
  for (const T& v : values) rgb.push_back(to_rgb(v));
  return develop(setup, rgb);
}

// Names of the lights that `which` means ("*": all), one for each group: emitters that share an id are one
// light.
std::map<std::uint16_t, std::string> matching_groups(const world::World& world, const std::string& which) {
  std::map<std::uint16_t, std::string> groups;
  for (const auto& e : world.emitters())
    if (which == "*" || e.name == which) groups.try_emplace(e.group, e.name);
  return groups;
}

constexpr FilmParts kMatrixOnly{.emission = false, .traced_direct = false, .traced_indirect = false};

void add_lights(Picture& picture, const Setup& setup, const std::string& which,
                const methods::Estimate& estimate, const Sinks& sinks) {
  for (const auto& [group, name] : matching_groups(*setup.world, which)) {
    const std::uint16_t wanted = group;  // clang before 16 cannot capture a structured binding
    const auto from_it = [&](matrix::Index j) {
      return setup.world->emitters()[setup.lights.emitter[j]].group == wanted;
    };
    add_plane(picture, "light:" + name, part_image(setup, estimate, from_it, kMatrixOnly, sinks));
  }
}

void add_aov(Picture& picture, const std::string& aov, const Setup& setup, const methods::Estimate& estimate,
             const Sinks& sinks) {
  const auto& receivers = setup.receivers;
  const world::Units& units = setup.world->units();
  const auto depth_of = [&](float d) { return Rgb(std::isfinite(d) ? units.length_in_file(d) : 0.0f); };
  const auto vector_of = [](Vec3f v) { return Rgb(v.x, v.y, v.z); };
  if (aov == "direct") {
    add_plane(picture, aov,
              part_image(
                  setup, estimate, [&](matrix::Index j) { return setup.lights.depth[j] == 0; },
                  {.emission = false, .traced_indirect = false}, sinks));
  } else if (aov == "indirect") {
    add_plane(picture, aov,
              part_image(
                  setup, estimate, [&](matrix::Index j) { return setup.lights.depth[j] > 0; },
                  {.emission = false, .traced_direct = false}, sinks));
  } else if (aov.starts_with("light:")) {
    add_lights(picture, setup, aov.substr(6), estimate, sinks);
  } else if (aov == "emission") {
    add_plane(picture, aov, develop(setup, receivers.emission));
  } else if (aov == "albedo") {
    add_plane(picture, aov, develop(setup, receivers.first_albedo));
  } else if (aov == "normal") {
    add_plane(picture, aov, first_hit_image(setup, receivers.first_normal, vector_of));
  } else if (aov == "position") {
    std::vector<Vec3f> places(receivers.samples());
    for (std::size_t k = 0; k < places.size(); ++k)
      if (std::isfinite(receivers.first_distance[k]))
        places[k] = static_cast<Vec3f>(units.place_in_file(receivers.first_position[k]));
    add_plane(picture, aov, first_hit_image(setup, places, vector_of));
  } else if (aov == "depth") {
    add_plane(picture, aov, first_hit_image(setup, receivers.first_distance, depth_of));
  } else if (aov == "samples") {
    std::vector<Rgb> count(receivers.samples());
    for (std::size_t i = 0; i < receivers.size(); ++i) count[receivers.sample[i]] += Rgb(1);
    add_plane(picture, aov, develop(setup, count));
  }
}

}  // namespace

bool parts_light(const std::string& aov) {
  return aov == "direct" || aov == "indirect" || aov.starts_with("light:");
}

void check_layers(const methods::MethodInfo& method, const RenderSettings& settings) {
  if (method.contract.combination) return;
  for (const std::string& aov : settings.aovs) {
    if (!parts_light(aov)) continue;
    std::string able;
    for (const auto& other : methods::all_methods())
      if (other.contract.combination) able += (able.empty() ? "" : ", ") + other.name;
    throw InputError("the method '" + method.name + "' cannot give the layer '" + aov +
                         "': its columns differ from receiver to receiver",
                     "choose one of " + able + ", or leave '--method auto'");
  }
}

FilmParts wanted_parts(const RenderSettings& settings) {
  return {.emission = settings.only == "all",
          .traced_direct = settings.only != "indirect",
          .traced_indirect = settings.only != "direct"};
}

int passes_over_columns(const RenderSettings& settings) {
  bool bounces = false, lights = false;
  for (const std::string& aov : settings.aovs) {
    bounces = bounces || aov == "direct" || aov == "indirect";
    lights = lights || aov.starts_with("light:");
  }
  return 1 + (bounces ? 1 : 0) + (lights ? 1 : 0) + (wants_illuminance(settings) ? 1 : 0);
}

void check_aovs(const world::World& world, const RenderSettings& settings) {
  const auto& emitters = world.emitters();
  if (wants_illuminance(settings) && settings.compensate > 0)
    throw InputError("what --compensate traces is no part of 'illuminance'", "leave out one of them");
  for (const std::string& aov : settings.aovs) {
    if (!aov.starts_with("light:")) continue;
    if (traced_roughness(settings) > 0)
      throw InputError("'" + aov + "' needs all light in the matrix", "leave out --direct traced");
    if (settings.local_paths > 0)
      throw InputError("'" + aov + "' needs all light in the matrix", "leave out --local-paths");
    const std::string which = aov.substr(6);
    if (!matching_groups(world, which).empty()) continue;
    std::string known;
    for (std::size_t e = 0; e < emitters.size() && e < 20; ++e) known += (e ? ", " : "") + emitters[e].name;
    if (emitters.size() > 20) known += ", …";
    throw InputError("there is no light '" + which + "'", "the lights are " + known);
  }
}

bool add_aovs(Picture& picture, const Setup& setup, const RenderSettings& settings,
              const methods::Estimate& estimate, const Sinks& sinks) {
  std::string left_out;
  for (const std::string& aov : settings.aovs) {
    try {
      if (parts_light(aov) && sinks.cancelled()) throw Cancelled();
      add_aov(picture, aov, setup, estimate, sinks);
    } catch (const Cancelled&) {
      left_out += (left_out.empty() ? "" : ", ") + aov;
    }
  }
  if (left_out.empty()) return true;
  sinks.warn("interrupted: the picture has no layer " + left_out);
  return false;
}

}  // namespace lumirank::pipeline
