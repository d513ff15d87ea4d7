#include "pipeline/develop.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/parallel.h"
#include "film/filter.h"
#include "film/refilter.h"
#include "film/tiled_splat.h"
#include "pipeline/sound_pixels.h"
#include "pipeline/traced_indirect.h"
#include "transport/rows/film_samples.h"

namespace lumirank::pipeline {
namespace {

using transport::FilmEye;
using transport::FilmFit;
using transport::ReceiverFinder;

// Light towards the eye of each receiver that the eye finds. Rows of the matrix are these, or those of them
// that have something left for it, in the same order.
std::vector<Rgb> light_of_receivers(const FilmInput& film, std::span<const Rgb> sums, FilmParts parts) {
  const TracedLight& traced = film.traced;
  const transport::Receivers& seen = seen_rows(film.rows, traced);
  std::vector<Rgb> light(seen.size());
  if (parts.traced_direct && !traced.direct.empty()) light = traced.direct;
  if (parts.traced_indirect)
    for (std::size_t i = 0; i < traced.sharp.size(); ++i) light[i] += traced.sharp[i];
  std::size_t i = 0;
  for (std::size_t j = 0; j < film.rows.size(); ++j, ++i) {
    while (seen.id[i] != film.rows.id[j]) ++i;
    if (parts.matrix) light[i] += sums[j];
    if (parts.traced_indirect && !traced.near.empty()) light[i] += traced.near[j];
  }
  return light;
}

// Goes over all film samples of the window and as far around it as its filter reaches; `value` is called with
// the number of the tile for each, from many threads, after FilmEye::begin() for its pixel.
using SampleValue = std::function<Rgb(std::size_t tile, FilmEye& eye, Vec2i pixel,
                                      const transport::FilmSample&, const transport::FirstHit&)>;
image::Image develop_samples(const FilmInput& film, film::TiledSplat& splat, bool first_hits,
                             const SampleValue& value) {
  const world::Camera camera(film.view.sensor, film.world.units());
  const transport::ReceiverSettings settings = receiver_settings(film.recipe, film.view);
  parallel_for(splat.tiles(), 1, [&](std::size_t tile, std::size_t) {
    FilmEye eye(film.world, camera, settings);
    const auto box = splat.pixels(tile);
    for (int y = std::max(0, box.y0); y < std::min(camera.height(), box.y1); ++y)
      for (int x = std::max(0, box.x0); x < std::min(camera.width(), box.x1); ++x) {
        eye.begin({x, y});
        for (int k = 0; k < settings.film_samples; ++k) {
          transport::FirstHit first;
          const auto sample = eye.trace(k, first_hits ? &first : nullptr);
          splat.add(tile, sample.film, value(tile, eye, {x, y}, sample, first));
        }
      }
  });
  return splat.image();
}

film::TiledSplat tiled_splat(const View& view) {
  return {view.width, view.height, world::make_filter(view.sensor.film.filter), {view.crop_x, view.crop_y}};
}

}  // namespace

double FilmFits::share(FilmFit fit) const {
  double all = 0;
  for (const std::uint64_t n : count) all += static_cast<double>(n);
  return all > 0 ? static_cast<double>(count[static_cast<std::size_t>(fit)]) / all : 0;
}

FilmFits FilmFits::operator+(const FilmFits& other) const {
  FilmFits sum = *this;
  for (std::size_t k = 0; k < count.size(); ++k) sum.count[k] += other.count[k];
  return sum;
}

FilmParts wanted_parts(LightPart only) {
  return {.emission = only == LightPart::all,
          .traced_direct = only != LightPart::indirect,
          .traced_indirect = only != LightPart::direct};
}

FilmInput film_input(const Prepared& prepared) {
  return {*prepared.world, prepared.view, prepared.recipe, prepared.receivers(), prepared.traced};
}

image::Image develop(const FilmInput& film, std::span<const Rgb> sums, FilmParts parts, FilmFits* fits) {
  if (film.recipe.film_samples == 0)
    return develop(film.view, film.rows, sample_values(film.rows, film.traced, sums, parts));
  const bool lit = parts.matrix || parts.traced_direct || parts.traced_indirect;
  std::vector<Rgb> light;
  std::optional<ReceiverFinder> finder;
  if (lit) {
    light = light_of_receivers(film, sums, parts);
    const auto window = receiver_settings(film.recipe, film.view);
    finder.emplace(seen_rows(film.rows, film.traced), Vec2i{window.crop_x, window.crop_y});
  }
  film::TiledSplat splat = tiled_splat(film.view);
  struct OfTile {
    FilmFits fits;
    std::vector<ReceiverFinder::Near> near;
  };
  std::vector<OfTile> of_tile(splat.tiles());
  image::Image image = develop_samples(
      film, splat, false,
      [&](std::size_t tile, FilmEye& eye, Vec2i pixel, const transport::FilmSample& sample, const auto&) {
        Rgb value = parts.emission ? sample.emission : Rgb(0);
        if (!lit) return value;
        auto& [counted, near] = of_tile[tile];
        for (const transport::EyeVertex& v : eye.vertices()) {
          if (is_black(v.weight * v.albedo)) continue;
          const FilmFit fit = finder->find(pixel, sample.film, v, eye.footprint(v), near);
          ++counted.count[static_cast<std::size_t>(fit)];
          value += v.weight * finder->light(v, near, light);
        }
        return value;
      });
  if (fits)
    for (const OfTile& tile : of_tile) *fits = *fits + tile.fits;
  return image;
}

image::Image develop_first_hits(const FilmInput& film,
                                const std::function<Rgb(const transport::FirstHit&)>& value) {
  if (film.recipe.film_samples > 0) {
    film::TiledSplat splat = tiled_splat(film.view);
    return develop_samples(film, splat, true,
                           [&](std::size_t, FilmEye&, Vec2i, const transport::FilmSample&,
                               const transport::FirstHit& first) { return value(first); });
  }
  std::vector<Rgb> values(film.rows.samples());
  for (std::size_t k = 0; k < values.size(); ++k)
    values[k] = value({film.rows.first_albedo[k], film.rows.first_normal[k], film.rows.first_ng[k],
                       film.rows.first_position[k], film.rows.first_distance[k]});
  return develop(film.view, film.rows, values);
}

std::vector<Rgb> sample_values(const transport::Receivers& rows, const TracedLight& traced,
                               std::span<const Rgb> sums, FilmParts parts) {
  std::vector<Rgb> values(rows.samples());
  if (parts.emission) values = rows.emission;
  if (parts.matrix)
    for (std::size_t i = 0; i < rows.size(); ++i) values[rows.sample[i]] += rows.weight[i] * sums[i];
  const auto add = [&](const transport::Receivers& at, const std::vector<Rgb>& light) {
    if (light.empty()) return;
    const std::vector<Rgb> by_sample = per_sample(at, light);
    for (std::size_t k = 0; k < by_sample.size(); ++k) values[k] += by_sample[k];
  };
  if (parts.traced_direct) add(seen_rows(rows, traced), traced.direct);
  if (parts.traced_indirect) add(seen_rows(rows, traced), traced.sharp), add(rows, traced.near);
  return values;
}

image::Image develop(const View& view, const transport::Receivers& rows, std::span<const Rgb> values) {
  const std::size_t grid = rows.grid_samples();
  return film::splat(view.width, view.height, world::make_filter(view.sensor.film.filter),
                     std::span(rows.film).first(grid), values.first(grid), {view.crop_x, view.crop_y});
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

image::Image image_of(const Picture& picture) {
  image::Image image(picture.width, picture.height);
  const auto& rgb = picture.planes[0].rgb;
  for (std::size_t p = 0; p < image.pixels.size(); ++p)
    image.pixels[p] = {rgb[3 * p], rgb[3 * p + 1], rgb[3 * p + 2]};
  return image;
}

void refilter(Picture& picture, const std::optional<film::Filter>& filter) {
  if (!filter) return;
  Picture wider = to_picture(film::refiltered(image_of(picture), *filter));
  picture.planes[0] = std::move(wider.planes[0]);
}

}  // namespace lumirank::pipeline
