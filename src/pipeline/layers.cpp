#include "pipeline/layers.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "base/error.h"

namespace lumirank::pipeline {
namespace {

// Names of the lights that `which` means ("*": all), one for each group: emitters that share an id are one
// light.
std::map<std::uint16_t, std::string> matching_groups(const world::World& world, const std::string& which) {
  std::map<std::uint16_t, std::string> groups;
  for (const auto& e : world.emitters())
    if (which == "*" || e.name == which) groups.try_emplace(e.group, e.name);
  return groups;
}

constexpr FilmParts kMatrixOnly{.emission = false, .traced_direct = false, .traced_indirect = false};

class LayerMaker {
 public:
  LayerMaker(Picture& picture, const Prepared& prepared, const TracedLight& traced,
             const methods::Estimate& estimate, const Sinks& sinks)
      : picture_(picture),
        prepared_(prepared),
        film_{*prepared.world, prepared.view, prepared.recipe, prepared.receivers(), traced},
        estimate_(estimate),
        sinks_(sinks) {}

  void add(const std::string& layer) {
    if (layer == "direct")
      add_bounces(layer, true, {.emission = false, .traced_indirect = false});
    else if (layer == "indirect")
      add_bounces(layer, false, {.emission = false, .traced_direct = false});
    else if (layer.starts_with("light:"))
      add_lights(layer.substr(6));
    else
      add_first_hits(layer);
  }

 private:
  void plane(const std::string& name, const image::Image& image) {
    picture_.planes.push_back({name, to_picture(image).planes[0].rgb});
  }

  // The part of the estimate made of the columns that `keep` chooses: light is linear, and so is the
  // estimate.
  void part(const std::string& name, const std::function<bool(matrix::Index)>& keep, FilmParts parts) {
    std::vector<matrix::ScaledColumn> columns;
    for (const auto& c : estimate_.combination)
      if (keep(c.column)) columns.push_back(c);
    std::vector<Rgb> sums(rows_.size());
    prepared_.matrix->accumulate(columns, sums, sinks_);
    plane(name, develop(film_, sums, parts));
  }

  void add_bounces(const std::string& name, bool direct, FilmParts parts) {
    part(
        name, [&](matrix::Index j) { return (prepared_.lights().depth[j] == 0) == direct; }, parts);
  }

  void add_lights(const std::string& which) {
    for (const auto& [group, name] : matching_groups(*prepared_.world, which)) {
      const std::uint16_t wanted = group;  // clang before 16 cannot capture a structured binding
      const auto from_it = [&](matrix::Index j) {
        return prepared_.world->emitters()[prepared_.lights().emitter[j]].group == wanted;
      };
      part("light:" + name, from_it, kMatrixOnly);
    }
  }

  template <typename Value>
  void plane_of(const std::string& name, Value&& value) {
    plane(name, develop_first_hits(film_, value));
  }

  void add_first_hits(const std::string& layer) {
    using transport::FirstHit;
    const world::Units& units = prepared_.world->units();
    const auto vector_of = [](Vec3f v) { return Rgb(v.x, v.y, v.z); };
    if (layer == "emission")
      plane(layer, develop(film_, {}, {.matrix = false, .traced_direct = false, .traced_indirect = false}));
    if (layer == "albedo") plane_of(layer, [](const FirstHit& f) { return f.albedo; });
    if (layer == "normal") plane_of(layer, [&](const FirstHit& f) { return vector_of(f.normal); });
    if (layer == "depth")
      plane_of(layer, [&](const FirstHit& f) {
        return Rgb(std::isfinite(f.distance) ? units.length_in_file(f.distance) : 0.0f);
      });
    if (layer == "position")
      plane_of(layer, [&](const FirstHit& f) {
        return std::isfinite(f.distance) ? vector_of(static_cast<Vec3f>(units.place_in_file(f.position)))
                                         : Rgb(0);
      });
    if (layer == "samples") {
      std::vector<Rgb> count(rows_.samples());
      for (std::size_t i = 0; i < rows_.size(); ++i) count[rows_.sample[i]] += Rgb(1);
      plane(layer, develop(prepared_.view, rows_, count));
    }
  }

  Picture& picture_;
  const Prepared& prepared_;
  const transport::Receivers& rows_ = prepared_.receivers();
  FilmInput film_;
  const methods::Estimate& estimate_;
  const Sinks& sinks_;
};

}  // namespace

bool parts_light(const std::string& layer) {
  return layer == "direct" || layer == "indirect" || layer.starts_with("light:");
}

bool wants_illuminance(const RenderSettings& settings) {
  return std::find(settings.layers.begin(), settings.layers.end(), "illuminance") != settings.layers.end();
}

void check_layers(const methods::MethodInfo& method, const RenderSettings& settings) {
  if (method.contract.combination) return;
  for (const std::string& layer : settings.layers) {
    if (!parts_light(layer)) continue;
    std::string able;
    for (const auto& other : methods::all_methods())
      if (other.contract.combination) able += (able.empty() ? "" : ", ") + other.name;
    throw InputError("the method '" + method.name + "' cannot give the layer '" + layer +
                         "': its columns differ from receiver to receiver",
                     "choose one of " + able + ", or leave '--method auto'");
  }
}

int passes_over_columns(const RenderSettings& settings) {
  bool bounces = false, lights = false;
  for (const std::string& layer : settings.layers) {
    bounces = bounces || layer == "direct" || layer == "indirect";
    lights = lights || layer.starts_with("light:");
  }
  return 1 + (bounces ? 1 : 0) + (lights ? 1 : 0) + (wants_illuminance(settings) ? 1 : 0);
}

void check_lights(const world::World& world, const RenderSettings& settings, const Recipe& recipe) {
  const auto& emitters = world.emitters();
  if (wants_illuminance(settings) && settings.traced.compensate > 0)
    throw InputError("what --compensate traces is no part of 'illuminance'", "leave out one of them");
  for (const std::string& layer : settings.layers) {
    if (!layer.starts_with("light:")) continue;
    if (recipe.traced_below > 0)
      throw InputError("'" + layer + "' needs all light in the matrix", "leave out --direct traced");
    if (recipe.local_paths > 0)
      throw InputError("'" + layer + "' needs all light in the matrix", "leave out --local-paths");
    const std::string which = layer.substr(6);
    if (!matching_groups(world, which).empty()) continue;
    std::string known;
    for (std::size_t e = 0; e < emitters.size() && e < 20; ++e) known += (e ? ", " : "") + emitters[e].name;
    if (emitters.size() > 20) known += ", …";
    throw InputError("there is no light '" + which + "'", "the lights are " + known);
  }
}

bool add_layers(Picture& picture, const Prepared& prepared, const TracedLight& traced,
                const methods::Estimate& estimate, const std::vector<std::string>& layers,
                const Sinks& sinks) {
  LayerMaker maker(picture, prepared, traced, estimate, sinks);
  std::string left_out;
  for (const std::string& layer : layers) {
    try {
      if (parts_light(layer) && sinks.cancelled()) throw Cancelled();
      maker.add(layer);
    } catch (const Cancelled&) {
      left_out += (left_out.empty() ? "" : ", ") + layer;
    }
  }
  if (left_out.empty()) return true;
  sinks.warn("interrupted: the picture has no layer " + left_out);
  return false;
}

}  // namespace lumirank::pipeline
