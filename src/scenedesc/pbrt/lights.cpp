// Lights, with the units that spectra.h tells of.
#include <cmath>

#include "scenedesc/pbrt/reader.h"
#include "scenedesc/pbrt/version3.h"
#include "scenedesc/schema/warnings.h"

namespace lumirank::scenedesc::pbrt {

namespace {

// "scale", and what the film makes of radiance.
Rgb scale_of(Params& p) {
  if (p.reader().version3()) {  // a color
    const auto given = constant_color(p, "scale", Intent::unbounded);
    return p.reader().film_response() * given.value_or(Rgb(1));
  }
  const float scale = p.number("scale", 1);
  if (!(scale >= 0)) p.fail("scale", "is negative", "give 0 or more");
  return p.reader().film_response() * scale;
}

Rgb spectrum(Params& p, const char* name) {
  return constant_color(p, name, Intent::illuminant)
      .value_or(from_space(Rgb(1), p.reader().state().space, Intent::illuminant));
}

// `emitted`: lumens of a light of intensity or radiance 1.
float power_scale(Params& p, float emitted) {
  const float power = p.number("power", -1);
  // The film's ratio stays, "scale" is replaced by what meets the power together with it, as in pbrt.
  return power > 0 ? power / emitted : 1;
}

Vec3d end_of(Params& p, Vec3d from) {
  const Vec3d to = p.point3("to", {0, 0, 1});
  if (to == from) p.fail("to", "is the same point as \"from\"");
  return to;
}

PointLightDesc point(Params& p, const Transform& to_world) {
  PointLightDesc out;
  out.position = to_world.place(p.point3("from", {0, 0, 0}));
  out.intensity = spectrum(p, "I") * scale_of(p) * power_scale(p, 4 * kPi);
  return out;
}

SpotLightDesc spot(Params& p, const Transform& to_world) {
  SpotLightDesc out;
  const Vec3d from = p.point3("from", {0, 0, 0}), to = end_of(p, from);
  const Vec3d position = to_world.place(from);
  const Vec3f axis = normalize(to_world.vector(static_cast<Vec3f>(to - from)));
  const Vec3f up = std::abs(axis.y) < 0.9f ? Vec3f{0, 1, 0} : Vec3f{1, 0, 0};
  out.to_world = Transform::aimed(position, axis, up);
  const float cone = p.number("coneangle", 30), delta = p.number("conedeltaangle", 5);
  if (!(cone > 0 && cone <= 180)) p.fail("coneangle", "is not between 0 and 180");
  if (!(delta >= 0 && delta <= cone)) p.fail("conedeltaangle", "is not between 0 and \"coneangle\"");
  out.cutoff_angle = std::min(cone, 179.9f);
  out.beam_width = std::max(out.cutoff_angle - delta, 0.0f);
  const float end = std::cos(cone * (kPi / 180)), start = std::cos((cone - delta) * (kPi / 180));
  out.intensity =
      spectrum(p, "I") * scale_of(p) * power_scale(p, 2 * kPi * ((1 - start) + (start - end) / 2));
  out.edge = p.reader().version3() ? SpotLightDesc::Edge::fourth_power : SpotLightDesc::Edge::smooth_cosine;
  return out;
}

decltype(EmitterDesc::kind) goniometric(Reader& reader, Params& p, const Transform& to_world) {
  ProfileLightDesc out;
  out.kind = ProfileLightDesc::Kind::image;
  // pbrt swaps y and z of these lights.
  Transform swap;
  swap.m = {1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1};
  out.to_world = to_world * swap;
  const auto file = reader.file(p.required_text("filename"), p.where_of("filename"), "picture",
                                "the same intensity in all directions");
  out.filename = file.name;
  out.intensity = spectrum(p, "I") * scale_of(p);
  if (const float power = p.number("power", -1); power > 0) out.power = power;
  if (file.missing)
    return PointLightDesc{to_world.point({0, 0, 0}),
                          out.intensity * (out.power ? *out.power / (4 * kPi) : 1.0f)};
  return out;
}

decltype(EmitterDesc::kind) projection(Reader& reader, Params& p, const Transform& to_world) {
  const bool old = reader.version3();
  ProjectionLightDesc out;
  out.to_world = to_world;
  out.intensity = old ? spectrum(p, "I") * scale_of(p) : scale_of(p);
  out.fov = p.number("fov", old ? 45 : 90);
  if (!(out.fov > 0 && out.fov < 180)) p.fail("fov", "is not between 0 and 180", "give it in degrees");
  out.axis = FieldAxis::smaller;
  if (old) out.to_uv.m[4] = -0.5f;  // upside down
  if (const float power = p.number("power", -1); power > 0) out.power = power;
  BitmapTextureDesc picture;
  const auto file =
      reader.file(p.required_text("filename"), p.where_of("filename"), "picture", kMissingPicture);
  picture.filename = file.name, picture.missing = file.missing;
  picture.filter = old ? FilterMode::bilinear : FilterMode::nearest;
  picture.wrap_u = picture.wrap_v = WrapMode::clamp;
  out.picture.texture = reader.add_texture("", p.where(), std::move(picture));
  return out;
}

DirectionalLightDesc distant(Params& p, const Transform& to_world) {
  DirectionalLightDesc out;
  const Vec3d from = p.point3("from", {0, 0, 0});
  out.direction = normalize(to_world.vector(static_cast<Vec3f>(end_of(p, from) - from)));
  out.irradiance = spectrum(p, "L") * scale_of(p);
  const float illuminance = p.number("illuminance", -1);
  if (illuminance > 0) out.irradiance *= illuminance;
  return out;
}

// Maps of latitudes and longitudes have their pole at +y and longitude 0 at -z, those of pbrt-v3 at +z and
// +x.
Transform from_pole_y() {
  Transform out;
  out.m = {0, 0, -1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1};
  return out;
}

decltype(EmitterDesc::kind) infinite(Reader& reader, Params& p, const Transform& to_world) {
  const Rgb scale = scale_of(p);
  const float illuminance = p.number("illuminance", -1);
  if (p.has("portal")) {
    p.ignore({"portal"});
    reader.warn(p.where_of("portal"), "portals of environments", "the whole environment");
  }
  if (!p.has("filename")) {
    // A uniform sky of radiance L has the illuminance πL.
    return ConstantEnvironmentDesc{spectrum(p, "L") * (scale * (illuminance > 0 ? illuminance / kPi : 1))};
  }
  const bool old = reader.version3();
  if (!old && p.has("L")) p.fail("L", "is given beside \"filename\"", "keep one of them");
  EnvironmentMapDesc out;
  const auto file =
      reader.file(p.text("filename", ""), p.where_of("filename"), "environment map", "a gray sky");
  out.filename = file.name;
  out.scale = old ? 1 : reader.imaging_ratio() * p.number("scale", 1);
  out.tint = old ? scale * spectrum(p, "L") : reader.white_balance();
  if (file.missing)
    return ConstantEnvironmentDesc{scale * (illuminance > 0 ? illuminance / kPi : kMissingSky)};
  if (illuminance > 0) out.illuminance = illuminance;
  out.projection = old ? EnvironmentProjection::latitude_longitude : EnvironmentProjection::equal_area;
  out.to_world = old ? to_world * from_pole_y() : to_world;
  return out;
}

}  // namespace

void Reader::read_light(Params& p, const std::string& given) {
  const std::string type = version3_ && given == "exinfinite" ? "infinite" : given;
  if (version3_) upgrade_light(p, type);
  if (in_object_) {
    warn_once(p.where(), "light sources in objects", "");
    p.ignore_all();
    return;
  }
  EmitterDesc out;
  out.where = p.where();
  const Transform to_world = this->to_world(p.where());
  if (type == "point") {
    out.kind = point(p, to_world);
  } else if (type == "spot") {
    out.kind = spot(p, to_world);
  } else if (type == "distant") {
    out.kind = distant(p, to_world);
  } else if (type == "infinite") {
    out.kind = infinite(*this, p, to_world);
  } else if (type == "goniometric") {
    out.kind = goniometric(*this, p, to_world);
  } else if (type == "projection") {
    out.kind = projection(*this, p, to_world);
  } else {
    throw InputError(p.where(), "the light " + in_quotes(type) + " is not known",
                     "point, spot, distant, infinite, goniometric and projection are");
  }
  scene_.emitters.push_back(std::move(out));
}

void Reader::read_area_light(Params& p, const std::string& given) {
  std::string type = given;
  if (version3_) upgrade_area_light(p, type);
  if (type != "diffuse")
    throw InputError(p.where(), "the area light " + in_quotes(type) + " is not known", "diffuse is");
  auto light = std::make_shared<AreaLight>();
  light->where = p.where();
  light->two_sided = p.flag("twosided", false);
  light->power = p.number("power", -1);
  const Rgb scale = scale_of(p);
  light->radiance = {Rgb(0), kNone};
  if (p.has("filename")) {
    if (p.has("L")) p.fail("L", "is given beside \"filename\"", "keep one of them");
    BitmapTextureDesc picture;
    const auto found = file(p.text("filename", ""), p.where_of("filename"), "picture", kMissingPicture);
    picture.filename = found.name, picture.missing = found.missing;
    picture.wrap_u = picture.wrap_v = WrapMode::clamp;
    const int texture = add_texture("", p.where(), std::move(picture));
    light->radiance.texture = add_texture("", p.where(), ScaleTextureDesc{{Rgb(0), texture}, scale});
    if (light->power > 0) {
      warn(p.where_of("power"), "the power of a lamp with a picture", "\"scale\" alone");
      light->power = -1;
    }
  } else {
    light->radiance.value = spectrum(p, "L") * scale;
  }
  state_.light = std::move(light);
}

}  // namespace lumirank::scenedesc::pbrt
