#include "world/profile_builder.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "image/image_io.h"
#include "scenedesc/ies/ies.h"

namespace lumirank::world {

namespace sd = scenedesc;
namespace em = emitters;

namespace {

// The table keeps the picture's details up to here.
constexpr int kFinestTable = 1024;

// P. Clarberg, "Fast equal-area mapping of the (hemi)sphere using SIMD", 2008: a direction's place in the
// unit square. Its distance from the square's center along the diagonals tells the polar angle.
Vec2f octahedral_place(double theta, double phi) {
  const double quarter = 0.5 * 3.14159265358979323846;
  const double z = std::cos(theta);
  const double turn = phi / quarter;
  const auto quadrant = static_cast<int>(turn) & 3;
  const double part = turn - std::floor(turn);  // of the quadrant
  const double r = std::sqrt(std::max(0.0, 1 - std::abs(z)));
  // Within the first quadrant the azimuth grows from the x axis to the y axis.
  double v = r * part, u = r - v;
  if (quadrant == 1 || quadrant == 3) std::swap(u, v);
  if (z < 0) {
    const double folded = 1 - v;
    v = 1 - u, u = folded;
  }
  if (quadrant == 1 || quadrant == 2) u = -u;
  if (quadrant == 2 || quadrant == 3) v = -v;
  return {static_cast<float>(0.5 * (u + 1)), static_cast<float>(0.5 * (v + 1))};
}

// Beyond an edge the map goes on at the mirrored place of the same edge.
float texel(int size, const std::vector<float>& picture, int x, int y) {
  if (x < 0) x = -1 - x, y = size - 1 - y;
  if (x >= size) x = 2 * size - 1 - x, y = size - 1 - y;
  if (y < 0) y = -1 - y, x = size - 1 - x;
  if (y >= size) y = 2 * size - 1 - y, x = size - 1 - x;
  return picture[static_cast<std::size_t>(y) * static_cast<std::size_t>(size) + static_cast<std::size_t>(x)];
}

em::AngularProfile from_ies(const sd::ProfileLightDesc& light, const SourceLocation& where, double scale,
                            Notes& notes) {
  sd::PolarTable table;
  sd::IesData data;
  try {
    data = sd::read_ies(light.filename);
    table = sd::to_polar(data, light.filename);
  } catch (const InputError& e) {
    throw InputError(where, e.what());
  }
  for (const sd::Warning& w : data.warnings)
    w.harmless ? notes.note(w.where, w.what) : notes.warn(w.where, w.what, w.used_instead);
  const float factor = static_cast<float>(scale) * data.tilt_factor(light.tilt_angle);
  for (float& v : table.values) v *= factor;
  return {std::move(table.theta), std::move(table.phi), std::move(table.values)};
}

em::AngularProfile from_picture(const sd::ProfileLightDesc& light, const SourceLocation& where,
                                Notes& notes) {
  image::Image image;
  try {
    image = image::read_image(light.filename).color;
  } catch (const InputError& e) {
    throw InputError(where, e.what());
  }
  if (image.width != image.height)
    throw InputError(where, light.filename + " is not square",
                     "give an equal-area octahedral map of the directions, which is");
  std::vector<float> values;
  std::size_t mended = 0;
  for (const Rgb& c : image.pixels) {
    values.push_back((c.r + c.g + c.b) / 3);
    if (!(std::isfinite(values.back()) && values.back() >= 0)) values.back() = 0, ++mended;
  }
  if (mended > 0)
    notes.warn(where, std::to_string(mended) + " values of " + light.filename + " are negative or not finite",
               "0 in their place");
  if (light.power) {
    // All texels have the same solid angle.
    const double mean =
        std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    if (!(mean > 0))
      throw InputError(where, "a light of a stated power has the black picture " + light.filename,
                       "give another picture, or no power");
    for (float& v : values) v *= static_cast<float>(*light.power / (4 * kPi * mean));
  }
  return profile_from_octahedral(image.width, values);
}

}  // namespace

Frame axes_of(const Transform& to_world, const SourceLocation& where) {
  const Vec3f x = to_world.vector({1, 0, 0}), y = to_world.vector({0, 1, 0}), z = to_world.vector({0, 0, 1});
  const double volume = to_world.determinant3();
  const double size = double{length(x)} * length(y) * length(z);
  if (!to_world.is_finite() || !(size > 0) || !(std::abs(volume) > 1e-6 * size))
    throw InputError(where, "to_world is singular or not finite",
                     "use rotations, translations and mirrorings");
  Frame frame = Frame::from_normal_tangent(normalize(z), normalize(x));
  if (volume < 0) frame.t = -frame.t;
  return frame;
}

em::AngularProfile profile_from_octahedral(int size, const std::vector<float>& picture) {
  const int rows = std::clamp(size, 16, kFinestTable), columns = 2 * rows;
  std::vector<float> theta, phi, values;
  for (int r = 0; r <= rows; ++r) theta.push_back(kPi * static_cast<float>(r) / static_cast<float>(rows));
  for (int c = 0; c <= columns; ++c) phi.push_back(kPi * static_cast<float>(c) / static_cast<float>(rows));
  theta.back() = kPi, phi.back() = 2 * kPi;
  for (const float t : theta)
    for (const float p : phi) {
      const Vec2f at = octahedral_place(t, p) * static_cast<float>(size);
      const float x = std::floor(at.x - 0.5f), y = std::floor(at.y - 0.5f);
      const float fx = at.x - 0.5f - x, fy = at.y - 0.5f - y;
      const int ix = static_cast<int>(x), iy = static_cast<int>(y);
      values.push_back(
          (texel(size, picture, ix, iy) * (1 - fx) + texel(size, picture, ix + 1, iy) * fx) * (1 - fy) +
          (texel(size, picture, ix, iy + 1) * (1 - fx) + texel(size, picture, ix + 1, iy + 1) * fx) * fy);
    }
  return {std::move(theta), std::move(phi), std::move(values)};
}

em::ProfileEmitter make_profile_light(const sd::ProfileLightDesc& light, const SourceLocation& where,
                                      double lumens_per_unit, Notes& notes) {
  if (!std::isfinite(light.tilt_angle))
    throw InputError(where, "the tilt angle is not finite", "give degrees from -180 to 180");
  const bool ies = light.kind == sd::ProfileLightDesc::Kind::ies;
  em::ProfileEmitter out;
  out.position = light.to_world.point({0, 0, 0});
  out.frame = axes_of(light.to_world, where);
  out.scale = light.intensity;
  out.profile = std::make_shared<em::AngularProfile>(ies ? from_ies(light, where, 1 / lumens_per_unit, notes)
                                                         : from_picture(light, where, notes));
  return out;
}

}  // namespace lumirank::world
