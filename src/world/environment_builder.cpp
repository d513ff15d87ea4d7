#include "world/environment_builder.h"

#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "emitters/daylight.h"
#include "emitters/environment.h"
#include "emitters/hosek_wilkie.h"
#include "image/image_io.h"
#include "world/equal_area.h"
#include "world/lights.h"

namespace lumirank::world {

namespace sd = scenedesc;
namespace em = emitters;

namespace {

// Rotation and mirroring of a transform; a uniform scale means nothing at infinity, anything else is refused.
Frame orientation(const Transform& to_world, const SourceLocation& where) {
  const auto refuse = [&](const char* what) {
    throw InputError(where, std::string("the environment's to_world ") + what,
                     "use rotations and mirrorings only");
  };
  if (!to_world.is_finite()) refuse("is not finite");
  Frame f{to_world.vector({1, 0, 0}), to_world.vector({0, 1, 0}), to_world.vector({0, 0, 1})};
  const float size = length(f.s);
  if (!(size > 0)) refuse("is singular");
  for (Vec3f* axis : {&f.s, &f.t, &f.n}) {
    if (std::abs(length(*axis) / size - 1) > 1e-3f) refuse("scales the axes differently");
    *axis = normalize(*axis);
  }
  if (std::abs(dot(f.s, f.t)) + std::abs(dot(f.t, f.n)) + std::abs(dot(f.n, f.s)) > 1e-3f) refuse("shears");
  return f;
}

}  // namespace

void EnvironmentBuilder::add(em::EnvironmentEmitter part, const sd::EmitterDesc& from) {
  for (const Rgb& c : part.radiance) check_light(max_component(c), "the radiance", from.where);
  if (!first_) first_ = &from;
  parts_.push_back(std::move(part));
}

void EnvironmentBuilder::add_constant(Rgb radiance, const sd::EmitterDesc& from) {
  add(em::make_environment(1, 1, {radiance}, Frame{}), from);
}

namespace {
void tint(image::Image& image, Rgb by) {
  if (by == Rgb(1)) return;
  for (Rgb& c : image.pixels) c *= by;
}
}  // namespace

void EnvironmentBuilder::add_map(const sd::EnvironmentMapDesc& map, const sd::EmitterDesc& from) {
  if (!std::isfinite(map.scale) || map.scale < 0)
    throw InputError(from.where, "the environment map's scale is negative or not finite", "give 0 or more");
  const Frame frame = orientation(map.to_world, from.where);
  image::Image image;
  try {
    image = image::read_image(map.filename).color;
  } catch (const InputError& e) {
    throw InputError(from.where, e.what());
  }
  std::size_t mended = 0;
  for (Rgb& c : image.pixels)
    for (int k = 0; k < 3; ++k) {
      const bool stated = std::isfinite(c[k]);
      c[k] *= map.scale;
      if (stated) check_light(c[k], "the radiance of the environment map", from.where);
      if (!(std::isfinite(c[k]) && c[k] >= 0)) c[k] = 0, ++mended;
    }
  if (mended > 0)
    notes_.warn(from.where,
                std::to_string(mended) + " values of " + map.filename + " are negative or not finite",
                "0 in their place");
  if (map.projection == sd::EnvironmentProjection::equal_area)
    add_equal_area(map, std::move(image), from);
  else
    tint(image, map.tint),
        add(em::make_environment(image.width, image.height, std::move(image.pixels), frame), from);
}

void EnvironmentBuilder::add_equal_area(const sd::EnvironmentMapDesc& map, image::Image image,
                                        const sd::EmitterDesc& from) {
  // The latitude-longitude map has its pole at +y, that of pbrt at +z, and longitude 0 at -z and at +x.
  Transform to_pole;
  to_pole.m = {0, 0, -1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1};
  const Frame frame = orientation(map.to_world * to_pole, from.where);
  if (image.width != image.height)
    notes_.warn(from.where, map.filename + " is not square, so no equal-area map (pbrt refuses it)",
                "as a map of latitudes and longitudes with +z up, as in pbrt-v3");
  else
    image = to_latitude_longitude(image);
  if (map.illuminance) {
    // pbrt-v4 weighs each texel by 2π over the number of all of them, which is half of its solid angle.
    const double lux = 0.5 * illuminance_of_pole(image);
    if (!(lux > 0))
      throw InputError(from.where, map.filename + " is black above the horizon, so it has no illuminance",
                       "leave \"illuminance\" out");
    for (Rgb& c : image.pixels) c *= static_cast<float>(*map.illuminance / lux);
  }
  tint(image, map.tint);
  add(em::make_environment(image.width, image.height, std::move(image.pixels), frame), from);
}

std::optional<em::DirectionalEmitter> EnvironmentBuilder::add_sun_sky(const sd::SunSkyDesc& d,
                                                                      const sd::EmitterDesc& from) {
  const auto bad = [&](const char* message, const char* remedy) {
    throw InputError(from.where, message, remedy);
  };
  if (!(d.turbidity >= em::HosekWilkieSky::kMinTurbidity && d.turbidity <= em::HosekWilkieSky::kMaxTurbidity))
    bad("the turbidity is not between 1 and 10", "give a number in between");
  if (!(d.sun_scale >= 0 && d.sky_scale >= 0 && std::isfinite(d.sun_scale) && std::isfinite(d.sky_scale)))
    bad("a scale of the sun or the sky is negative or not finite", "give 0 or more");
  if (!(d.sun_radius_scale >= 0 && d.sun_radius_scale <= 100))
    bad("the sun's radius is scaled by less than 0 or more than 100", "give a number in between");
  const float len = length(d.sun_direction);
  if (!(len > 0) || !std::isfinite(len)) bad("the sun's direction is zero or not finite", "give a direction");
  const Vec3f to_sun = d.sun_direction / len;
  if (!(to_sun.y > 0))
    bad("the sun is below the horizon", "give a direction above it (+y is up before to_world)");
  const Frame frame = orientation(d.to_world, from.where);

  if (d.sky) {
    constexpr int kWidth = 512, kHeight = 256;
    const em::HosekWilkieSky sky(d.turbidity, d.albedo, to_sun);
    std::vector<Rgb> radiance(static_cast<std::size_t>(kWidth) * kHeight);
    parallel_for(kHeight, 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t y = begin; y < end; ++y)
        for (std::size_t x = 0; x < kWidth; ++x) {
          const Vec2f at{static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f};
          radiance[y * kWidth + x] = sky.radiance(em::map_direction(at, kWidth, kHeight)) * d.sky_scale;
        }
    });
    add(em::make_environment(kWidth, kHeight, std::move(radiance), frame), from);
  }

  if (!d.sun || d.sun_scale == 0) return std::nullopt;
  em::DirectionalEmitter sun;
  sun.direction = -frame.to_world(to_sun);
  // The power does not change with the radius: a larger disc is dimmer.
  const float s = std::sin(em::kSunHalfAngle);
  const float theta = std::acos(std::min(to_sun.y, 1.0f));
  const Rgb disc = d.sun_model == sd::SunModel::preetham ? em::sun_radiance(d.turbidity, theta)
                                                         : em::hosek_wilkie_sun(d.turbidity, kPi / 2 - theta);
  sun.irradiance = disc * (kPi * s * s * d.sun_scale);
  sun.cos_half_angle = std::cos(em::kSunHalfAngle * d.sun_radius_scale);
  return sun;
}

em::EnvironmentEmitter EnvironmentBuilder::build() {
  if (parts_.size() == 1) return std::move(parts_.front());
  std::size_t finest = 0;
  for (std::size_t i = 1; i < parts_.size(); ++i)
    if (parts_[i].radiance.size() > parts_[finest].radiance.size()) finest = i;
  const em::EnvironmentEmitter& grid = parts_[finest];
  std::vector<Rgb> sum(grid.radiance.size());
  parallel_for(static_cast<std::size_t>(grid.height), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y)
      for (int x = 0; x < grid.width; ++x) {
        const Vec2f at{static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f};
        const Vec3f direction = grid.to_world.to_world(em::map_direction(at, grid.width, grid.height));
        for (const auto& part : parts_)
          sum[y * static_cast<std::size_t>(grid.width) + x] += part.eval(direction);
      }
  });
  return em::make_environment(grid.width, grid.height, std::move(sum), grid.to_world);
}

}  // namespace lumirank::world
