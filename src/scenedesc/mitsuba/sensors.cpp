#include <cmath>
#include <tuple>

#include "scenedesc/mitsuba/plugin.h"
#include "scenedesc/schema/film_size.h"

namespace lumirank::scenedesc::mitsuba {

namespace {

constexpr int kMaxFilm = 65536;

FilterDesc filter(Reader& reader, const Element& element) {
  Plugin p(reader, element);
  FilterDesc out;
  if (p.type() == "box") {
    out.kind = FilterKind::box;
  } else if (p.type() == "tent") {
    out.kind = FilterKind::tent;
  } else if (p.type() == "gaussian") {
    out.kind = FilterKind::gaussian;
    out.stddev = p.positive("stddev", 0.5f);
  } else if (p.type() == "mitchell") {
    out.kind = FilterKind::mitchell;
    const bool old = reader.dialect().camel_case();  // 0.6 says B and C, 3.x says A and B
    out.b = p.number(old ? "b" : "A", 1.0f / 3);
    out.c = p.number(old ? "c" : "B", 1.0f / 3);
  } else if (p.type() == "catmullrom") {
    out.kind = FilterKind::catmullrom;
  } else if (p.type() == "lanczos") {
    out.kind = FilterKind::lanczos;
    out.lobes = p.integer("lobes", 3);
    if (out.lobes < 1 || out.lobes > 16)
      throw InputError(p.where_of("lobes"), "\"lobes\" of " + p.title() + " is not between 1 and 16");
  } else {
    reader.warn(p.where(), "the reconstruction filter \"" + p.type() + "\"", "gaussian");
    p.ignore_all();
    out.kind = FilterKind::gaussian;
  }
  if (p.has("radius")) out.radius = p.positive("radius", 1);
  if (out.radius > 32 || out.stddev > 8)
    throw InputError(p.where(), "the filter of " + p.title() + " is wider than 32 pixels");
  p.finish();
  return out;
}

int film_size(Plugin& p, const std::string& name, int fallback) {
  const int value = p.integer(name, fallback);
  if (value <= 0)
    throw InputError(p.where_of(name), "\"" + name + "\" of " + p.title() + " is " + std::to_string(value),
                     "give a number of pixels above 0");
  if (value > kMaxFilm)
    throw InputError(p.where_of(name), "\"" + name + "\" of " + p.title() + " is " + std::to_string(value),
                     "65536 pixels is the most");
  return value;
}

FilmDesc film(Reader& reader, const Element* element) {
  FilmDesc out;
  out.filter.kind = FilterKind::gaussian;  // Mitsuba's default
  if (!element) return out;
  Plugin p(reader, *element);
  if (p.type() != "hdrfilm" && p.type() != "ldrfilm" && p.type() != "mfilm")
    reader.warn(p.where(), "the film \"" + p.type() + "\"", "hdrfilm");
  out.width = film_size(p, "width", out.width);
  out.height = film_size(p, "height", out.height);
  const bool crop =
      p.has("crop_width") || p.has("crop_height") || p.has("crop_offset_x") || p.has("crop_offset_y");
  if (crop) {
    out.crop_x = p.integer("crop_offset_x", 0), out.crop_y = p.integer("crop_offset_y", 0);
    out.crop_width = film_size(p, "crop_width", out.width);
    out.crop_height = film_size(p, "crop_height", out.height);
    if (out.crop_x < 0 || out.crop_y < 0 || out.crop_width > out.width - out.crop_x ||
        out.crop_height > out.height - out.crop_y)
      throw InputError(
          p.where_of(p.has("crop_width") ? "crop_width" : "crop_offset_x"),
          "the crop window of " + p.title() + " reaches beyond the film",
          "the film has " + std::to_string(out.width) + " × " + std::to_string(out.height) + " pixels");
    if (out.crop_width == out.width && out.crop_height == out.height)
      out.crop_width = out.crop_height = 0;  // all of it
  }
  if (const Element* f = p.take_one("rfilter")) out.filter = filter(reader, *f);
  p.ignore({"file_format", "pixel_format", "component_format", "banner", "attach_log", "high_quality_edges",
            "sample_border", "tonemap_method", "gamma", "exposure", "key", "burn", "digits", "variable",
            "compensate"});
  p.finish();
  return out;
}

// Across the width, in degrees, and which axis it belongs to.
std::pair<float, FieldAxis> field_of_view(Plugin& p, const FilmDesc& film) {
  const auto fov = p.number("fov");
  const std::string axis = p.text("fov_axis").value_or("x");
  if (fov) {
    if (p.has("focal_length"))
      throw InputError(p.where_of("focal_length"), p.title() + " has both \"fov\" and \"focal_length\"",
                       "keep one of them");
    if (!(*fov > 0 && *fov < 180))
      throw InputError(p.where_of("fov"), "\"fov\" of " + p.title() + " is not between 0 and 180",
                       "give it in degrees");
    const FieldAxis kept = field_axis(p, axis);
    return {horizontal_fov(*fov, kept, film.width, film.height), kept};
  }
  // The focal length of a 35 mm camera, whose picture is 36 × 24 mm: the diagonals are made the same.
  float millimeters = 50;
  if (p.has("focal_length")) {
    const auto value = p.text_or_number("focal_length");
    if (const float* number = std::get_if<float>(&value)) {
      millimeters = *number;
    } else {
      std::string text = std::get<std::string>(value);
      if (const auto unit = text.find("mm"); unit != std::string::npos) text = text.substr(0, unit);
      millimeters = parse_float(text, p.where_of("focal_length"), "\"focal_length\" of " + p.title());
    }
  }
  if (!(millimeters > 0))
    throw InputError(p.where_of("focal_length"), "\"focal_length\" of " + p.title() + " is not positive",
                     "50mm, say");
  const double across = 2 * std::atan(std::hypot(36.0, 24.0) / (2 * millimeters)) * 180 / M_PI;
  return {horizontal_fov(across, FieldAxis::diagonal, film.width, film.height), FieldAxis::diagonal};
}

int sample_count(Reader& reader, const Element* element) {
  if (!element) return 0;
  Plugin p(reader, *element);
  const int count = p.integer("sample_count", 0);
  if (count < 0 || (count == 0 && p.has("sample_count")))
    throw InputError(p.where_of("sample_count"), "\"sample_count\" of " + p.title() + " is not positive");
  p.ignore_all();  // which sampler it is does not matter here
  return count;
}

}  // namespace

FieldAxis field_axis(const Plugin& p, const std::string& name) {
  for (const FieldAxis axis :
       {FieldAxis::x, FieldAxis::y, FieldAxis::diagonal, FieldAxis::smaller, FieldAxis::larger})
    if (name == name_of(axis)) return axis;
  throw InputError(p.where_of("fov_axis"), "\"fov_axis\" of " + p.title() + " is \"" + name + "\"",
                   "x, y, diagonal, smaller and larger are known");
}

void Reader::build_sensor(const Element& element) {
  Plugin p(*this, element);
  SensorDesc out;
  out.id = p.id();
  out.where = p.where();
  if (p.type() == "perspective" || p.type() == "perspective_rdist") {
    out.kind = SensorKind::perspective;
  } else if (p.type() == "thinlens") {
    out.kind = SensorKind::thinlens;
  } else if (p.type() == "orthographic" || p.type() == "telecentric") {
    out.kind = SensorKind::orthographic;
  } else {
    throw InputError(p.where(), "the sensor \"" + p.type() + "\" is not known",
                     "perspective, thinlens and orthographic are");
  }
  if (p.type() == "perspective_rdist" || p.type() == "telecentric") {
    warn(p.where(), "the sensor \"" + p.type() + "\"",
         p.type() == "telecentric" ? "orthographic" : "perspective");
    p.ignore({"kc", "aperture_radius"});
  }
  out.film = film(*this, p.take_one("film"));
  out.samples_per_pixel = sample_count(*this, p.take_one("sampler"));
  out.to_world = p.regular_transform();
  out.near_clip = p.positive("near_clip", 1e-2f);
  out.far_clip = p.positive("far_clip", 1e4f);
  if (!(out.far_clip > out.near_clip))
    throw InputError(p.where_of(p.has("far_clip") ? "far_clip" : "near_clip"),
                     "\"far_clip\" of " + p.title() + " is not above its \"near_clip\"");
  out.focus_distance = p.positive("focus_distance", out.far_clip);
  if (out.kind == SensorKind::orthographic) {
    p.ignore({"fov", "fov_axis", "focal_length"});
  } else {
    std::tie(out.fov_x, out.kept_axis) = field_of_view(p, out.film);
    out.principal_point_offset = {p.number("principal_point_offset_x", 0),
                                  p.number("principal_point_offset_y", 0)};
  }
  if (out.kind == SensorKind::thinlens) {
    if (!p.has("aperture_radius"))
      throw InputError(p.where(), p.title() + " has no \"aperture_radius\"",
                       "add <float name=\"aperture_radius\" value=\"…\"/>");
    out.aperture_radius = p.number("aperture_radius", 0);
    if (!(out.aperture_radius >= 0))
      throw InputError(p.where_of("aperture_radius"), "\"aperture_radius\" of " + p.title() + " is negative");
  }
  const float open = p.number("shutter_open", 0), close = p.number("shutter_close", 0);
  if (close != open) warn(p.where_of("shutter_close"), "a shutter that is open for a while", "one instant");
  if (const Element* medium = p.take_one("medium")) out.medium = build_medium(*medium);
  p.ignore({"srf"});
  p.finish();
  scene_.sensors.push_back(std::move(out));
}

void Reader::build_integrator(const Element& element) {
  Plugin p(*this, element);
  // Wrappers such as "aov" and "moment": what they wrap counts.
  if (const auto nested = p.take_all("integrator"); !nested.empty()) {
    const OpenGuard guard(*this, element);
    build_integrator(*nested[0]);
    return;
  }
  static const std::set<std::string> known = {"path",
                                              "volpath",
                                              "volpath_simple",
                                              "volpathmis",
                                              "bdpt",
                                              "ptracer",
                                              "pssmlt",
                                              "mlt",
                                              "erpt",
                                              "photonmapper",
                                              "ppm",
                                              "sppm",
                                              "vpl",
                                              "direct",
                                              "prb",
                                              "prbvolpath",
                                              "prb_basic",
                                              "direct_projective",
                                              "prb_projective",
                                              "direct_reparam",
                                              "prb_reparam"};
  scene_.integrator = p.type();
  if (!known.count(p.type())) warn(p.where(), "the integrator \"" + p.type() + "\"", "global illumination");
  scene_.max_depth = p.type() == "direct" ? 2 : p.integer("max_depth", -1);
  if (scene_.max_depth < -1)
    throw InputError(p.where_of("max_depth"),
                     "\"max_depth\" of " + p.title() + " is " + std::to_string(scene_.max_depth),
                     "-1 means without limit");
  scene_.hide_emitters = p.flag("hide_emitters", false);
  // The rest tunes Mitsuba's own algorithm.
}

}  // namespace lumirank::scenedesc::mitsuba
