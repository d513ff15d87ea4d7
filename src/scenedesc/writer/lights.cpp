// Emitters besides shapes, and the camera.
#include <algorithm>
#include <cmath>

#include "scenedesc/ies/ies.h"
#include "scenedesc/schema/film_size.h"
#include "scenedesc/writer/writer.h"

namespace lumirank::scenedesc {
namespace {

constexpr float kNearest = 1e-4f;  // Mitsuba's cameras do not see from their very place

// Mean over the sphere of a table that is bilinear in the angles, by the trapezoidal rule in each cell.
double mean_of(const PolarTable& t) {
  double sum = 0;
  const std::size_t n = t.phi.size();
  for (std::size_t r = 0; r + 1 < t.theta.size(); ++r)
    for (std::size_t c = 0; c + 1 < n; ++c) {
      const double mean = 0.25 * (double{t.values[r * n + c]} + t.values[r * n + c + 1] +
                                  t.values[(r + 1) * n + c] + t.values[(r + 1) * n + c + 1]);
      sum += mean * (std::cos(double{t.theta[r]}) - std::cos(double{t.theta[r + 1]})) *
             (double{t.phi[c + 1]} - t.phi[c]);
    }
  return sum / (4 * 3.14159265358979323846);
}

float own_radius(const FilterDesc& f) {
  switch (f.kind) {
    case FilterKind::box:
      return 0.5f;
    case FilterKind::gaussian:
      return 4 * f.stddev;
    case FilterKind::lanczos:
      return static_cast<float>(f.lobes);
    default:
      return f.kind == FilterKind::tent ? 1.0f : 2.0f;
  }
}

}  // namespace

bool MitsubaWriter::is_map(const EmitterDesc& e) {
  return std::holds_alternative<ConstantEnvironmentDesc>(e.kind) ||
         std::holds_alternative<EnvironmentMapDesc>(e.kind);
}

// Mitsuba has latitudes and longitudes only, and one environment.
bool MitsubaWriter::environment() {
  int maps = 0, skies = 0;
  bool other = false;
  for (const EmitterDesc& e : scene_.emitters) {
    maps += is_map(e);
    if (const auto* map = std::get_if<EnvironmentMapDesc>(&e.kind))
      other = other || map->projection != EnvironmentProjection::latitude_longitude;
    if (!std::holds_alternative<SunSkyDesc>(e.kind)) continue;
    if (skies++ > 0 || maps > 0) warn(e.where, "a sky besides another environment", "both, which it refuses");
  }
  if (!painter_.environment || !(other || maps > 1)) return false;
  const Painter::Environment made = painter_.environment();
  xml_.open("emitter", {{"type", "envmap"}});
  xml_.string("filename", add_file("environment", ".exr", made.exr));
  xml_.transform("to_world", made.to_world);
  xml_.close();
  return true;
}

void MitsubaWriter::emitter(const EmitterDesc& e) {
  const std::string id = e.id.empty() ? "" : unique_id(e.id, "");
  const auto open = [&](const char* type) {
    if (id.empty())
      xml_.open("emitter", {{"type", type}});
    else
      xml_.open("emitter", {{"type", type}, {"id", id}});
  };
  if (const auto* point = std::get_if<PointLightDesc>(&e.kind)) {
    open("point");
    xml_.place("point", "position", point->position);
    xml_.color("intensity", point->intensity);
  } else if (const auto* spot = std::get_if<SpotLightDesc>(&e.kind)) {
    if (spot->edge != SpotLightDesc::Edge::angle && spot->beam_width < spot->cutoff_angle)
      warn(e.where, "the smooth edge of a spot light", "an edge that falls off with the angle");
    open("spot");
    xml_.color("intensity", spot->intensity);
    xml_.number("cutoff_angle", spot->cutoff_angle), xml_.number("beam_width", spot->beam_width);
    xml_.transform("to_world", spot->to_world);
  } else if (const auto* profile = std::get_if<ProfileLightDesc>(&e.kind)) {
    const bool picture = profile->kind == ProfileLightDesc::Kind::image;
    if (picture && !painter_.mean) return warn(e.where, "a goniometric light", "");
    warn(e.where, picture ? "a goniometric light" : "an IES profile", "a point light of the same power");
    double mean = 0;
    if (picture) {
      mean = painter_.mean(e);
    } else {
      IesData data = read_ies(profile->filename);
      mean = mean_of(to_polar(data, profile->filename)) * data.tilt_factor(profile->tilt_angle) /
             scene_.lumens_per_unit;
    }
    open("point");
    xml_.place("point", "position", profile->to_world.origin());
    xml_.color("intensity", profile->intensity * static_cast<float>(mean));
  } else if (const auto* projection = std::get_if<ProjectionLightDesc>(&e.kind)) {
    const bool as_spot = projection->cutoff_angle > 0,
               as_irradiance = projection->means == ProjectionLightDesc::Picture::irradiance;
    if (!as_spot && !as_irradiance) return warn(e.where, "a projection light of pbrt", "");
    open(as_spot ? "spot" : "projector");
    if (as_spot) {
      color("texture", projection->picture);
      xml_.color("intensity", projection->intensity);
      xml_.number("cutoff_angle", projection->cutoff_angle),
          xml_.number("beam_width", projection->beam_width);
    } else {
      color("irradiance", projection->picture);
      xml_.number("scale", mean(projection->intensity));
      xml_.number("fov", projection->fov);
      if (projection->axis != FieldAxis::x) xml_.string("fov_axis", name_of(projection->axis));
    }
    xml_.transform("to_world", projection->to_world);
  } else if (const auto* sun = std::get_if<DirectionalLightDesc>(&e.kind)) {
    open("directional");
    xml_.place("vector", "direction", sun->direction);
    xml_.color("irradiance", sun->irradiance);
  } else if (const auto* constant = std::get_if<ConstantEnvironmentDesc>(&e.kind)) {
    open("constant");
    xml_.color("radiance", constant->radiance);
  } else if (const auto* map = std::get_if<EnvironmentMapDesc>(&e.kind)) {
    if (map->projection != EnvironmentProjection::latitude_longitude)
      return warn(e.where, "an environment in the equal-area projection", "");
    open("envmap");
    xml_.string("filename", relative(map->filename));
    xml_.number("scale", map->scale);
    xml_.transform("to_world", map->to_world);
  } else if (const auto* day = std::get_if<SunSkyDesc>(&e.kind)) {
    return sky(*day, e, id);
  }
  xml_.close();
}

// Mitsuba 3's sky has +z up and the sun's direction in the frame of the world.
void MitsubaWriter::sky(const SunSkyDesc& d, const EmitterDesc& from, const std::string& id) {
  if (d.sun && d.sun_model == SunModel::preetham)
    warn(from.where, "the sun of Mitsuba 0.6 (Preetham's)", "that of Mitsuba 3");

  xml_.open("emitter", id.empty() ? Xml::Attributes{{"type", "sunsky"}}
                                  : Xml::Attributes{{"type", "sunsky"}, {"id", id}});
  xml_.number("turbidity", d.turbidity);
  xml_.place("vector", "sun_direction", d.to_world.vector(d.sun_direction));
  xml_.number("sun_scale", d.sun ? d.sun_scale : 0), xml_.number("sky_scale", d.sky ? d.sky_scale : 0);
  xml_.number("sun_aperture", 0.5358f * d.sun_radius_scale);
  xml_.color("albedo", d.albedo);
  xml_.transform("to_world", d.to_world * Transform::rotate(1, 0, 0, -90));
  xml_.close();
}

void MitsubaWriter::filter(const FilterDesc& f, const SourceLocation& where) {
  const char* types[] = {"box", "tent", "gaussian", "mitchell", "catmullrom", "lanczos"};
  xml_.open("rfilter", {{"type", types[static_cast<int>(f.kind)]}});
  if (f.kind == FilterKind::gaussian) xml_.number("stddev", f.stddev);
  if (f.kind == FilterKind::mitchell) xml_.number("A", f.b), xml_.number("B", f.c);
  if (f.kind == FilterKind::lanczos) xml_.integer("lobes", f.lobes);
  if (f.kind == FilterKind::tent && f.radius > 0)
    xml_.number("radius", f.radius);
  else if (f.radius > 0 && f.radius != own_radius(f))
    warn(where, "a radius of this reconstruction filter", "its own");
  xml_.close();
}

void MitsubaWriter::sensor(const SensorDesc& s) {
  const char* types[] = {"perspective", "thinlens", "orthographic"};
  const char* type = types[static_cast<int>(s.kind)];
  xml_.open("sensor", s.id.empty() ? Xml::Attributes{{"type", type}}
                                   : Xml::Attributes{{"type", type}, {"id", unique_id(s.id, "")}});
  if (s.kind != SensorKind::orthographic) {
    xml_.string("fov_axis", "x");
    xml_.number("fov", s.fov_x);
    if (s.principal_point_offset.x != 0) xml_.number("principal_point_offset_x", s.principal_point_offset.x);
    if (s.principal_point_offset.y != 0) xml_.number("principal_point_offset_y", s.principal_point_offset.y);
  }
  if (s.kind == SensorKind::thinlens) {
    xml_.number("aperture_radius", s.aperture_radius);
    xml_.number("focus_distance", s.focus_distance);
  }
  xml_.number("near_clip", std::max(s.near_clip, kNearest)), xml_.number("far_clip", s.far_clip);
  xml_.transform("to_world", s.to_world);
  if (s.medium != kNone) xml_.reference(medium_ids_[static_cast<std::size_t>(s.medium)]);
  xml_.open("film", {{"type", "hdrfilm"}});
  xml_.integer("width", s.film.width), xml_.integer("height", s.film.height);
  if (s.film.crop_width > 0) {
    xml_.integer("crop_offset_x", s.film.crop_x), xml_.integer("crop_offset_y", s.film.crop_y);
    xml_.integer("crop_width", s.film.crop_width), xml_.integer("crop_height", s.film.crop_height);
  }
  filter(s.film.filter, s.where);
  xml_.close();
  if (s.samples_per_pixel > 0) {
    xml_.open("sampler", {{"type", "independent"}});
    xml_.integer("sample_count", s.samples_per_pixel);
    xml_.close();
  }
  xml_.close();
}

}  // namespace lumirank::scenedesc
