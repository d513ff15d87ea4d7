#include <cmath>

#include "scenedesc/mitsuba/plugin.h"
#include "scenedesc/mitsuba/solar.h"
#include "scenedesc/schema/warnings.h"

namespace lumirank::scenedesc::mitsuba {

namespace {

Rgb emission(Plugin& p, const std::string& name) {
  const Rgb value = p.constant_color(name, Rgb(1), Intent::emission);
  if (value.r < 0 || value.g < 0 || value.b < 0)
    throw InputError(p.where_of(name), "\"" + name + "\" of " + p.title() + " is negative",
                     "use values of 0 or more");
  return value;
}

float not_negative(Plugin& p, const std::string& name, float fallback) {
  const float value = p.number(name, fallback);
  if (!(value >= 0))
    throw InputError(p.where_of(name), "\"" + name + "\" of " + p.title() + " is negative",
                     "use a value of 0 or more");
  return value;
}

PointLightDesc point_light(Plugin& p) {
  PointLightDesc out;
  const auto position = p.vec3("position");
  if (position && p.has("to_world"))
    throw InputError(p.where_of("to_world"), p.title() + " has both \"position\" and \"to_world\"",
                     "keep one of them");
  out.position = position ? *position : p.transform().origin();
  out.intensity = emission(p, "intensity");
  return out;
}

SpotLightDesc spot_light(Plugin& p) {
  SpotLightDesc out;
  out.to_world = p.regular_transform();
  out.intensity = emission(p, "intensity");
  out.cutoff_angle = p.positive("cutoff_angle", 20);
  out.beam_width = not_negative(p, "beam_width", out.cutoff_angle * 0.75f);
  if (out.cutoff_angle > 180)
    throw InputError(p.where_of("cutoff_angle"), "\"cutoff_angle\" of " + p.title() + " is above 180");
  if (out.beam_width > out.cutoff_angle)
    throw InputError(p.where_of("beam_width"),
                     "\"beam_width\" of " + p.title() + " is above its \"cutoff_angle\"");
  return out;
}

// A spot light with a texture throws it: on the square around its cone.
decltype(EmitterDesc::kind) with_texture(Reader& reader, Plugin& p, const SpotLightDesc& spot) {
  constexpr float kWidest = 89;  // degrees
  if (spot.cutoff_angle > kWidest) {
    reader.warn(p.where_of("texture"), "a texture of a spot light wider than a half-space", "no texture");
    p.ignore({"texture"});
    return spot;
  }
  ProjectionLightDesc out;
  out.to_world = spot.to_world, out.intensity = spot.intensity;
  out.picture = p.color("texture", Rgb(1), Intent::emission);
  out.fov = 2 * spot.cutoff_angle, out.square = true;
  out.cutoff_angle = spot.cutoff_angle, out.beam_width = spot.beam_width;
  return out;
}

ProjectionLightDesc projector(Plugin& p) {
  ProjectionLightDesc out;
  out.to_world = p.regular_transform();
  out.picture = p.color("irradiance", Rgb(1), Intent::emission);
  out.means = ProjectionLightDesc::Picture::irradiance;
  out.intensity = Rgb(not_negative(p, "scale", 1));
  out.fov = p.positive("fov", 45);
  if (!(out.fov < 180))
    throw InputError(p.where_of("fov"), "\"fov\" of " + p.title() + " is not between 0 and 180",
                     "give it in degrees");
  out.axis = field_axis(p, p.text("fov_axis").value_or("x"));
  out.to_uv = {{-0.5f, 0, 0.5f, 0, -0.5f, 0.5f}};  // as its cameras: +x left, +y up
  return out;
}

// Lumirank's own: <emitter type="ies"> with "filename", "to_world", "scale", "color" and "tilt". Colors are
// taken relative to their luminance, so that they leave the illuminance as it is.
// Empty if the profile is missing: nothing tells how bright the light is.
std::optional<ProfileLightDesc> ies_light(Reader& reader, Plugin& p) {
  ProfileLightDesc out;
  const auto file = reader.file(p.required_text("filename"), p.where_of("filename"), "IES profile", "");
  out.filename = file.name;
  out.to_world = p.regular_transform();
  Rgb color(1);
  if (p.has("color")) {
    color = emission(p, "color");
    if (!(luminance(color) > 0))
      throw InputError(p.where_of("color"), "\"color\" of " + p.title() + " is black");
    color *= 1 / luminance(color);
  }
  out.intensity = color * not_negative(p, "scale", 1);
  out.tilt_angle = p.number("tilt", 0);
  if (file.missing) return std::nullopt;
  return out;
}

DirectionalLightDesc directional_light(Plugin& p) {
  DirectionalLightDesc out;
  const auto direction = p.vec3("direction");
  if (direction && p.has("to_world"))
    throw InputError(p.where_of("to_world"), p.title() + " has both \"direction\" and \"to_world\"",
                     "keep one of them");
  const Vec3f d = direction ? static_cast<Vec3f>(*direction) : p.regular_transform().vector({0, 0, 1});
  if (!(length(d) > 0))
    throw InputError(p.where_of("direction"), "the direction of " + p.title() + " is zero");
  out.direction = normalize(d);
  out.irradiance = emission(p, "irradiance");
  return out;
}

decltype(EmitterDesc::kind) environment_map(Reader& reader, Plugin& p) {
  EnvironmentMapDesc out;
  const std::string name = p.required_text("filename");
  const auto file = reader.file(name, p.where_of("filename"), "environment map", "a gray sky");
  out.filename = file.name;
  out.scale = not_negative(p, "scale", 1);
  out.to_world = p.regular_transform();
  if (p.number("gamma", -1) != -1)
    reader.warn(p.where_of("gamma"), "an environment map gamma of its own", "the sRGB curve for 8-bit files");
  p.ignore({"cache", "mis_compensation"});
  if (file.missing) return ConstantEnvironmentDesc{Rgb(kMissingSky * out.scale)};
  return out;
}

PlaceAndTime place_and_time(Plugin& p) {
  PlaceAndTime t;
  t.latitude = p.number("latitude", static_cast<float>(t.latitude));
  t.longitude = p.number("longitude", static_cast<float>(t.longitude));
  t.timezone = p.number("timezone", static_cast<float>(t.timezone));
  t.year = p.integer("year", t.year), t.month = p.integer("month", t.month), t.day = p.integer("day", t.day);
  t.hour = p.number("hour", static_cast<float>(t.hour));
  t.minute = p.number("minute", static_cast<float>(t.minute));
  t.second = p.number("second", static_cast<float>(t.second));
  const auto check = [&](const char* name, double value, double low, double high) {
    if (!(value >= low && value <= high))
      throw InputError(p.where_of(name),
                       std::string("\"") + name + "\" of " + p.title() + " is out of range");
  };
  check("latitude", t.latitude, -90, 90), check("longitude", t.longitude, -360, 360),
      check("timezone", t.timezone, -24, 24);
  check("year", t.year, 1, 9999), check("month", t.month, 1, 12), check("day", t.day, 1, 31);
  check("hour", t.hour, 0, 24), check("minute", t.minute, 0, 60), check("second", t.second, 0, 60);
  return t;
}

SunSkyDesc sun_sky(Reader& reader, Plugin& p) {
  const bool z_up =
      !reader.dialect().camel_case();  // 3.x: +x south, +y west, +z up; 0.6: +x east, +y up, +z south
  SunSkyDesc out;
  out.sun = p.type() != "sky", out.sky = p.type() != "sun";
  out.sun_model = z_up ? SunModel::hosek_wilkie : SunModel::preetham;
  out.turbidity = p.number("turbidity", 3);
  if (!(out.turbidity >= 1 && out.turbidity <= 10))
    throw InputError(p.where_of("turbidity"), "\"turbidity\" of " + p.title() + " is not between 1 and 10");
  out.to_world = p.regular_transform();
  Vec3f towards;  // in the dialect's local frame
  std::string source = "sun_direction";
  if (const auto direction = p.vec3("sun_direction")) {
    for (const char* name : {"latitude", "longitude", "timezone", "day", "hour"})
      if (p.has(name))
        throw InputError(p.where_of(name), p.title() + " has both a sun direction and a place and time",
                         "keep one of them");
    towards = out.to_world.inverse()->vector(static_cast<Vec3f>(*direction));  // stated in the world's frame
    if (!(length(towards) > 0))
      throw InputError(p.where_of("sun_direction"), "\"sun_direction\" of " + p.title() + " is zero");
    towards = normalize(towards);
  } else {
    source = "hour";
    const Vec3f d = sun_direction(sun_position(place_and_time(p)));
    towards = z_up ? Vec3f{d.z, -d.x, d.y} : d;
  }
  out.sun_direction = towards;
  if (z_up) {
    // The local frame of SunSkyDesc has +y up: turn it about x, and the direction back.
    out.sun_direction = {towards.x, towards.z, -towards.y};
    out.to_world = out.to_world * Transform::rotate(1, 0, 0, 90);
  }
  if (!(out.sun_direction.y > 0))
    throw InputError(p.where_of(source), "the sun of " + p.title() + " is below the horizon",
                     "choose another time or direction");
  const float scale = not_negative(p, "scale", 1);
  out.sun_scale = scale * not_negative(p, "sun_scale", 1);
  out.sky_scale = scale * not_negative(p, "sky_scale", 1);
  out.sun_radius_scale = p.positive("sun_radius_scale", 1);
  if (p.has("sun_aperture")) out.sun_radius_scale = p.positive("sun_aperture", 0.5358f) / 0.5358f;
  out.albedo = p.constant_color("albedo", Rgb(z_up ? 0.3f : 0.2f), Intent::reflectance);
  for (int i = 0; i < 3; ++i)
    if (!(out.albedo[i] >= 0 && out.albedo[i] <= 1))
      throw InputError(p.where_of("albedo"), "\"albedo\" of " + p.title() + " is not between 0 and 1");
  if (p.number("stretch", 1) != 1)
    reader.warn(p.where_of("stretch"), "a sky that is stretched below the horizon", "stretch 1");
  p.ignore({"resolution", "complex_sun"});
  return out;
}

}  // namespace

void Reader::build_emitter(const Element& element) {
  Plugin p(*this, element);
  EmitterDesc out;
  out.id = p.id();
  out.where = p.where();
  if (p.type() == "area") return;  // built with the shape that refers to it
  if (p.type() == "point") {
    out.kind = point_light(p);
  } else if (p.type() == "spot") {
    const SpotLightDesc spot = spot_light(p);
    out.kind = p.has("texture") ? with_texture(*this, p, spot) : spot;
  } else if (p.type() == "projector") {
    out.kind = projector(p);
  } else if (p.type() == "ies") {
    const auto light = ies_light(*this, p);
    if (!light) return p.finish();
    out.kind = *light;
  } else if (p.type() == "directional") {
    out.kind = directional_light(p);
  } else if (p.type() == "constant") {
    out.kind = ConstantEnvironmentDesc{emission(p, "radiance")};
  } else if (p.type() == "envmap") {
    out.kind = environment_map(*this, p);
  } else if (p.type() == "sun" || p.type() == "sky" || p.type() == "sunsky") {
    out.kind = sun_sky(*this, p);
  } else {
    warn(p.where(), "the emitter \"" + p.type() + "\"", "");
    return;
  }
  p.ignore({"sampling_weight"});
  p.take_all("medium");  // the surfaces around a light say in what it is
  p.finish();
  scene_.emitters.push_back(std::move(out));
}

}  // namespace lumirank::scenedesc::mitsuba
