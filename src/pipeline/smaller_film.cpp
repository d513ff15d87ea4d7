#include "pipeline/smaller_film.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "pipeline/develop.h"
#include "scenedesc/schema/film_size.h"

namespace lumirank::pipeline {

bool is_whole_film(const View& view) {
  const auto& film = view.sensor.film;
  return view.crop_x == 0 && view.crop_y == 0 && view.width == film.width && view.height == film.height;
}

View smaller(const View& view, int divisor) {
  View less = view;
  const auto part = [divisor](int pixels) {
    return std::max(1, static_cast<int>(std::lround(static_cast<double>(pixels) / divisor)));
  };
  const auto& film = less.sensor.film;
  scenedesc::set_film_size(less.sensor, part(view.sensor.film.width), part(view.sensor.film.height));
  less.sensor.film.crop_width = 0;
  less.width = std::min(part(view.width), film.width), less.height = std::min(part(view.height), film.height);
  less.crop_x = std::min(view.crop_x / divisor, film.width - less.width);
  less.crop_y = std::min(view.crop_y / divisor, film.height - less.height);
  return less;
}

int trial_divisor(const View& view) {
  constexpr int kMin = 4;
  constexpr double kPixelsOfTrial = 32400;
  const double pixels = static_cast<double>(view.width) * static_cast<double>(view.height);
  return std::max(kMin, static_cast<int>(std::ceil(std::sqrt(pixels / kPixelsOfTrial))));
}

double paths_worth_a_pixel(const View& view, double light_paths) {
  constexpr double kPixelsOfPath = 60000, kMin = 1, kMax = 8, kWorthOfLightPath = 0.5;
  const double pixels = static_cast<double>(view.width) * static_cast<double>(view.height);
  return std::clamp(pixels / kPixelsOfPath / (1 + kWorthOfLightPath * light_paths), kMin, kMax);
}

Picture enlarged(const Picture& picture, int width, int height) {
  Picture larger;
  larger.width = width, larger.height = height;
  // The two pixels around a center of the larger picture, and how near it is to the second.
  struct Between {
    std::size_t first, second;
    float part;
  };
  const auto between = [](int at, int to, int from) {
    const double x = std::clamp((at + 0.5) * from / to - 0.5, 0.0, static_cast<double>(from - 1));
    const auto first = static_cast<std::size_t>(x);
    return Between{first, std::min(first + 1, static_cast<std::size_t>(from - 1)),
                   static_cast<float>(x - static_cast<double>(first))};
  };
  const auto row = static_cast<std::size_t>(picture.width);
  for (const Plane& plane : picture.planes) {
    Plane out{plane.name,
              std::vector<float>(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))};
    parallel_for(static_cast<std::size_t>(height), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t y = begin; y < end; ++y) {
        const Between v = between(static_cast<int>(y), height, picture.height);
        for (int x = 0; x < width; ++x) {
          const Between u = between(x, width, picture.width);
          for (std::size_t c = 0; c < 3; ++c) {
            const auto at = [&](std::size_t px, std::size_t py) {
              return plane.rgb[3 * (py * row + px) + c];
            };
            out.rgb[3 * (y * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) + c] =
                std::lerp(std::lerp(at(u.first, v.first), at(u.second, v.first), u.part),
                          std::lerp(at(u.first, v.second), at(u.second, v.second), u.part), v.part);
          }
        }
      }
    });
    larger.planes.push_back(std::move(out));
  }
  return larger;
}

Picture sized_for(const image::Image& image, const View& view) {
  Picture picture = to_picture(image);
  if (picture.width == view.width && picture.height == view.height) return picture;
  return enlarged(picture, view.width, view.height);
}

}  // namespace lumirank::pipeline
