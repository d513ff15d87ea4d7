// KHR_materials_volume: what is inside solids.
#include <algorithm>
#include <cmath>

#include "scenedesc/gltf/reader.h"

namespace lumirank::scenedesc::gltf {

// Without a thickness the surface is a thin wall, whatever else the extension says.
std::optional<Element> Reader::volume_of(const Element& material) {
  const auto volume = material.extension("KHR_materials_volume");
  return volume && volume->real("thicknessFactor", 0, 0) > 0 ? volume : std::nullopt;
}

// Beer's law: of white light `attenuationColor` is left after `attenuationDistance`, which is in the world.
int Reader::medium_of(const Element& material) {
  const auto volume = volume_of(material);
  const auto transmission = material.extension("KHR_materials_transmission");
  if (!volume || !transmission || transmission->real("transmissionFactor", 0, 0, 1) == 0) return kNone;
  const auto given = volume->find("attenuationDistance");
  if (!given) return kNone;  // infinitely far
  const float distance = given->real();
  if (!(distance > 0)) given->fail("is not positive", "leave it out where nothing is absorbed");
  MediumDesc out;
  out.extinction.value = Rgb(0), out.albedo.value = Rgb(0);
  if (const auto color = volume->find("attenuationColor")) {
    const std::vector<double> left = color->numbers(3);
    if (*std::max_element(left.begin(), left.end()) > 1) warn(*color, "an attenuation color above 1", "1");
    for (std::size_t c = 0; c < 3; ++c) {
      if (left[c] < 0) color->item(c).fail("is negative", "give a share of the light, from 0 to 1");
      // Of 0 nothing is left anywhere, which would be an infinite extinction.
      constexpr double kLeast = 1e-30;
      const double extinction = std::log(1 / std::clamp(left[c], kLeast, 1.0)) / distance;
      out.extinction.value[static_cast<int>(c)] = static_cast<float>(std::min(extinction, 3e38));
    }
  }
  const Rgb& value = out.extinction.value;
  if (is_black(value)) return kNone;
  // Media that are alike are one.
  const auto [at, fresh] =
      built_media_.try_emplace({value.r, value.g, value.b}, static_cast<int>(scene_.media.size()));
  if (!fresh) return at->second;
  out.id = material.text("name", material.path()), out.where = volume->where();
  scene_.media.push_back(std::move(out));
  return at->second;
}

}  // namespace lumirank::scenedesc::gltf
