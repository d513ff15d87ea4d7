#include "world/projection_builder.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "emitters/projected_picture.h"
#include "scenedesc/schema/film_size.h"
#include "world/lights.h"
#include "world/profile_builder.h"

namespace lumirank::world {
namespace sd = scenedesc;
namespace em = emitters;

namespace {

// Pixels along the longer side: finer ones than of small pictures, whose texels may have sharp edges.
constexpr int kMinPixels = 512, kMaxPixels = 2048;

struct PictureSize {
  int width = kMinPixels, height = kMinPixels;
  int own_width = 1, own_height = 1;  // the picture's, whose proportions are the frame's
};
// As many whole pixels to a texel as are needed, or as the largest size leaves. Of no bitmap: a square.
PictureSize size_of(const scatter::ColorInput& picture, const scatter::TextureSet& textures) {
  if (picture.texture < 0) return {};
  const auto* bitmap =
      std::get_if<scatter::BitmapTexture>(&textures.textures[static_cast<std::size_t>(picture.texture)]);
  if (!bitmap) return {};
  const int width = bitmap->pixels->width, height = bitmap->pixels->height, longer = std::max(width, height);
  if (longer <= kMaxPixels) {
    const int times = (kMinPixels + longer - 1) / longer;
    return {width * times, height * times, width, height};
  }
  const auto shrunk = [&](int side) {
    return std::max(1, static_cast<int>(std::lround(1.0 * side * kMaxPixels / longer)));
  };
  return {shrunk(width), shrunk(height), width, height};
}

// Half of the frame's width and height at distance 1.
Vec2f half_of(const sd::ProjectionLightDesc& light, const PictureSize& size) {
  const int width = light.square ? 1 : size.own_width, height = light.square ? 1 : size.own_height;
  const double across = sd::horizontal_fov(static_cast<double>(light.fov), light.axis, width, height);
  const auto half = static_cast<float>(std::tan(across * M_PI / 360));
  return {half, half * static_cast<float>(height) / static_cast<float>(width)};
}

class Projection {
 public:
  Projection(const sd::ProjectionLightDesc& light, const scatter::ColorInput& picture,
             const scatter::TextureSet& textures)
      : light_(light), picture_(picture), textures_(textures) {}

  // `part`: of the frame, from -1 to 1 along x and y; `place`: on the plane at distance 1.
  Rgb at(Vec2f part, Vec2f place) const {
    const auto& m = light_.to_uv.m;
    Rgb value = picture_.value;
    if (picture_.texture >= 0)
      value = textures_.lookup(
          picture_.texture, {{m[0] * part.x + m[1] * part.y + m[2], m[3] * part.x + m[4] * part.y + m[5]}});
    for (int c = 0; c < 3; ++c) value[c] = std::isfinite(value[c]) ? std::max(0.0f, value[c]) : 0.0f;
    const float far2 = 1 + square(place.x) + square(place.y);
    if (light_.means == sd::ProjectionLightDesc::Picture::irradiance)
      value *= kPi * far2 * std::sqrt(far2);  // E = I cos³θ
    return value * edge(std::acos(1 / std::sqrt(far2)) * (180 / kPi));
  }

 private:
  float edge(float angle) const {
    if (!(light_.cutoff_angle > 0) || angle <= light_.beam_width) return 1;
    if (angle >= light_.cutoff_angle) return 0;
    return (light_.cutoff_angle - angle) / (light_.cutoff_angle - light_.beam_width);
  }

  const sd::ProjectionLightDesc& light_;
  const scatter::ColorInput& picture_;
  const scatter::TextureSet& textures_;
};

}  // namespace

em::ProfileEmitter make_projection_light(const sd::ProjectionLightDesc& light, const SourceLocation& where,
                                         const scatter::ColorInput& picture,
                                         const scatter::TextureSet& textures) {
  if (!(light.fov > 0 && light.fov < 180))
    throw InputError(where, "the field of a projected picture is not between 0 and 180 degrees",
                     "give an angle in between");
  const PictureSize size = size_of(picture, textures);
  const Vec2f half = half_of(light, size);
  const Projection projection(light, picture, textures);
  std::vector<Rgb> values;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const Vec2f part{2 * (static_cast<float>(x) + 0.5f) / static_cast<float>(size.width) - 1,
                       2 * (static_cast<float>(y) + 0.5f) / static_cast<float>(size.height) - 1};
      values.push_back(projection.at(part, {part.x * half.x, part.y * half.y}));
      check_light(max_component(values.back() * light.intensity), "a projected picture", where);
    }
  em::ProfileEmitter out;
  out.position = light.to_world.point({0, 0, 0});
  out.frame = axes_of(light.to_world, where);
  out.scale = light.intensity;
  const auto made = std::make_shared<em::ProjectedPicture>(size.width, size.height, std::move(values), half);
  if (light.power) {
    const float emitted = luminance(made->total());
    if (!(emitted > 0))
      throw InputError(where, "a light of a stated power throws a black picture",
                       "give another picture, or no power");
    out.scale *= *light.power / emitted;
  }
  out.profile = made;
  return out;
}

}  // namespace lumirank::world
