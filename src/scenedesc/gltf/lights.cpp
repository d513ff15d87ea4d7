// KHR_lights_punctual. One candela is 1 W/sr here and one lux 1 W/m² (SceneDesc::lumens_per_unit is 1):
// pictures are as bright as the numbers say, and emissive strengths (nits), environments and lamps keep their
// proportions.
//
// Blender's exporter breaks them: it takes 683 lm for each watt of a lamp, but writes the strength of what is
// emissive, in W/(m² sr), as it is. Its files are read back in watts. They are told from those exported
// "unitless" by their brightest lamp: in watts 300 would be a lamp of 3,770 W, in candela all lamps would be
// below 5.6 W.
#include <algorithm>
#include <cmath>

#include "scenedesc/gltf/reader.h"

namespace lumirank::scenedesc::gltf {
namespace {

constexpr float kDegrees = 57.29577951308232f;

constexpr float kLumensPerWatt = 683, kMaxUnitless = 300;

}  // namespace

float lumens_per_unit_of(const Element& root) {
  const auto punctual = root.extension("KHR_lights_punctual");
  if (!punctual || root.at("asset").text("generator", "").find("Blender") == std::string::npos) return 1;
  float max_intensity = 0;
  for (const Element& light : punctual->list("lights"))
    max_intensity = std::max(max_intensity, light.real("intensity", 1, 0));
  return max_intensity > kMaxUnitless ? kLumensPerWatt : 1.0f;
}

void Reader::build_light(const Node& node, const Element& light_index) {
  const Element& light = lights_[index_of(light_index, lights_.size(), "light")];
  Rgb color = color_input(light, "color", Rgb(1), "").value;
  color *= light.real("intensity", 1, 0) / lumens_per_unit_;
  if (lumens_per_unit_ != 1)
    note(light, "lamps by Blender: 683 of their lumens are one watt, the unit of emissive strength there");
  const Element type = light.at("type");
  const std::string id = light.text("name", name_of(node));
  // Lights shine along -z; nothing but the direction of the axes counts.
  const Vec3f along = node.world.vector({0, 0, -1});
  const Vec3d at = node.world.origin();
  EmitterDesc emitter{id, light.where(), PointLightDesc{at, color}};
  if (type.text() == "directional") {
    if (!(length(along) > 0)) node.element.fail("flattens its light", "give it a scale without zeros");
    emitter.kind = DirectionalLightDesc{normalize(along), color};
  } else if (type.text() == "spot") {
    const Json nothing{Json::Kind::object, false, light.where().line, 0, {}, {}, {}};
    const auto given = light.find("spot");
    const Element cone = given ? *given : Element(nothing, light.path(), light.file());
    SpotLightDesc spot;
    const float inner = cone.real("innerConeAngle", 0, 0, 1.5707964f);
    const float outer = cone.real("outerConeAngle", 0.7853982f, 0, 1.5707964f);
    if (!(inner < outer))
      cone.fail("has an innerConeAngle that is not below its outerConeAngle", "make innerConeAngle smaller");
    if (!(length(along) > 0)) node.element.fail("flattens its light", "give it a scale without zeros");
    spot.to_world = Transform::aimed(
        at, along, std::abs(along.y) > 0.9f * length(along) ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0});
    spot.intensity = color;
    spot.cutoff_angle = outer * kDegrees;
    spot.beam_width = inner * kDegrees;
    spot.edge = SpotLightDesc::Edge::squared_cosine;
    emitter.kind = spot;
  } else if (type.text() != "point") {
    type.fail("is \"" + type.text() + "\"", "point, spot and directional are known");
  }
  if (light.has("range")) warn_once(light, "a range of lights", "light without an end");
  scene_.emitters.push_back(std::move(emitter));
}

}  // namespace lumirank::scenedesc::gltf
