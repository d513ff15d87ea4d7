#include "pipeline/develop.h"

#include "film/filter.h"
#include "pipeline/sound_pixels.h"

namespace lumirank::pipeline {

FilmParts wanted_parts(LightPart only) {
  return {.emission = only == LightPart::all,
          .traced_direct = only != LightPart::indirect,
          .traced_indirect = only != LightPart::direct};
}

std::vector<Rgb> sample_values(const transport::Receivers& rows, const TracedLight& traced,
                               std::span<const Rgb> sums, FilmParts parts) {
  std::vector<Rgb> values(rows.samples());
  if (parts.emission) values = rows.emission;
  if (parts.matrix)
    for (std::size_t i = 0; i < rows.size(); ++i) values[rows.sample[i]] += rows.weight[i] * sums[i];
  const auto add = [&](const std::vector<Rgb>& light) {
    for (std::size_t k = 0; k < light.size(); ++k) values[k] += light[k];
  };
  if (parts.traced_direct) add(traced.direct);
  if (parts.traced_indirect) add(traced.sharp), add(traced.near);
  return values;
}

image::Image develop(const View& view, const transport::Receivers& rows, std::span<const Rgb> values) {
  return film::splat(view.width, view.height, world::make_filter(view.sensor.film.filter), rows.film, values,
                     {view.crop_x, view.crop_y});
}

Picture to_picture(const image::Image& image) {
  check_pixels(image);
  Picture picture;
  picture.width = image.width, picture.height = image.height;
  picture.planes.emplace_back();
  auto& rgb = picture.planes[0].rgb;
  rgb.reserve(image.pixels.size() * 3);
  for (const Rgb& p : image.pixels) rgb.insert(rgb.end(), {p.r, p.g, p.b});
  return picture;
}

}  // namespace lumirank::pipeline
