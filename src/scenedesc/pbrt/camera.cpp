// Camera, film, filter, sampler and integrator.
#include <algorithm>
#include <cmath>

#include "scenedesc/data/named_spectra.h"
#include "scenedesc/pbrt/reader.h"
#include "scenedesc/pbrt/version3.h"

namespace lumirank::scenedesc::pbrt {

namespace {

constexpr int kMaxFilm = 65536;

int film_size(Params& p, const char* name, int fallback) {
  const int value = p.integer(name, fallback);
  if (value < 1 || value > kMaxFilm)
    p.fail(name, "is " + std::to_string(value), "give a number of pixels from 1 to 65536");
  return value;
}

// [x0 x1 y0 y1] in pixels.
void crop(Params& p, FilmDesc& film, const char* name, const int v[4]) {
  if (!(v[0] >= 0 && v[0] < v[1] && v[1] <= film.width && v[2] >= 0 && v[2] < v[3] && v[3] <= film.height))
    p.fail(name, "is no window of the film", "give x0 x1 y0 y1 with x0 < x1 and y0 < y1");
  film.crop_x = v[0], film.crop_y = v[2];
  film.crop_width = v[1] - v[0], film.crop_height = v[3] - v[2];
  if (film.crop_width == film.width && film.crop_height == film.height)
    film.crop_width = film.crop_height = 0;
}

// What makes CIE daylight of a temperature white (1, 1, 1) and leaves its luminance (CIE 15:2004,
// section 3.1).
Rgb white_balance_of(float kelvin) {
  const double t = static_cast<double>(kelvin) * 1.4388 / 1.438;
  const double x = t <= 7000 ? -4.607e9 / (t * t * t) + 2.9678e6 / (t * t) + 0.09911e3 / t + 0.244063
                             : -2.0064e9 / (t * t * t) + 1.9018e6 / (t * t) + 0.24748e3 / t + 0.23704;
  const double y = -3 * x * x + 2.87 * x - 0.275;
  const Rgb white = from_chromaticity(x, y);
  Rgb out;
  for (int c = 0; c < 3; ++c) out[c] = 1 / std::max(0.05f, white[c]);
  return out;
}

}  // namespace

void Reader::read_camera(Params& p, const std::string& given) {
  std::string type = given;
  if (version3_) upgrade_camera(p, type);
  if (type != "perspective" && type != "orthographic" && type != "realistic" && type != "spherical")
    throw InputError(p.where(), "the camera " + in_quotes(type) + " is not known",
                     "perspective, orthographic, realistic and spherical are");
  camera_ = {};
  has_camera_ = true;
  camera_.type = type;
  camera_.where = p.where();
  camera_.medium = use_medium(state_.outside);
  const auto inverse = state_.at_start.inverse(), inverse_at_end = state_.at_end.inverse();
  if (!inverse || !inverse_at_end)
    throw InputError(p.where(), "the camera's transform is singular", "a Scale by 0 perhaps");
  camera_.to_world = between(*inverse, *inverse_at_end, p.where());
  coordinate_systems_["camera"] = {*inverse, *inverse_at_end};
  if (type == "spherical") {
    warn(p.where(), "the camera \"" + type + "\"", "a perspective camera");
    p.ignore({"mapping"});
    camera_.type = "perspective";
  }
  if (type == "realistic") read_lens(p);
  camera_.fov = p.number("fov", type == "realistic" ? 40 : 90);
  if (!(camera_.fov > 0 && camera_.fov < 180))
    p.fail("fov", "is not between 0 and 180", "give it in degrees");
  if (p.has("frameaspectratio")) camera_.aspect = p.positive("frameaspectratio", 1);
  p.ignore({"frameaspectratio"});
  for (const double v : p.numbers("screenwindow", ParamType::number))
    camera_.window.push_back(static_cast<float>(v));
  const auto& w = camera_.window;
  if (!w.empty() && (w.size() != 4 || !(w[0] < w[1]) || !(w[2] < w[3])))
    p.fail("screenwindow", "is no window", "give x0 x1 y0 y1 with x0 < x1 and y0 < y1");
  camera_.lens_radius = p.number("lensradius", 0);
  if (!(camera_.lens_radius >= 0)) p.fail("lensradius", "is negative");
  camera_.focal_distance = p.positive("focaldistance", 1e6f);
  camera_.exposure_time = p.number("shutterclose", 1) - p.number("shutteropen", 0);
  if (!(camera_.exposure_time > 0)) p.fail("shutterclose", "is not after \"shutteropen\"");
  if (camera_.type == "orthographic" && camera_.lens_radius > 0)
    warn(p.where_of("lensradius"), "depth of field of orthographic cameras", "a sharp picture");
}

void Reader::read_lens(Params& p) {
  camera_.type = "perspective";
  camera_.focus_from_film = p.positive("focusdistance", 10);
  const double aperture = static_cast<double>(p.positive("aperturediameter", 1));
  const Place at = p.where_of("lensfile");
  const auto lens = file(p.required_text("lensfile"), at, "lens file", "a perspective camera of 40 degrees");
  p.ignore({"aperture"});
  if (!lens.missing) {
    camera_.lens = parse_lens(file_text(lens.name, at), lens.name, aperture, at);
    warn(p.where(), "the lenses of the camera \"realistic\"", "a thin lens of the same view");
  }
}

void Reader::read_film(Params& p, const std::string& given) {
  std::string type = given;
  if (version3_) upgrade_film(p, type);
  if (type != "rgb" && type != "gbuffer" && type != "spectral")
    throw InputError(p.where(), "the film " + in_quotes(type) + " is not known",
                     "rgb, gbuffer and spectral are");
  FilterDesc filter = film_.filter;
  film_ = {};
  film_.filter = filter;
  film_.width = film_size(p, "xresolution", 1280);
  film_.height = film_size(p, "yresolution", 720);
  if (const auto& v = p.numbers("pixelbounds", ParamType::integer); !v.empty()) {
    if (v.size() != 4) p.fail("pixelbounds", "has " + std::to_string(v.size()) + " numbers; 4 are needed");
    const int bounds[4] = {static_cast<int>(v[0]), static_cast<int>(v[1]), static_cast<int>(v[2]),
                           static_cast<int>(v[3])};
    crop(p, film_, "pixelbounds", bounds);
  }
  if (const auto& v = p.numbers("cropwindow", ParamType::number); !v.empty()) {
    if (v.size() != 4) p.fail("cropwindow", "has " + std::to_string(v.size()) + " numbers; 4 are needed");
    int bounds[4];
    for (int k = 0; k < 4; ++k) {
      if (!(v[static_cast<std::size_t>(k)] >= 0 && v[static_cast<std::size_t>(k)] <= 1))
        p.fail("cropwindow", "is not in fractions of the film", "give numbers from 0 to 1");
      bounds[k] =
          static_cast<int>(std::ceil(v[static_cast<std::size_t>(k)] * (k < 2 ? film_.width : film_.height)));
    }
    crop(p, film_, "cropwindow", bounds);
  }
  iso_ = p.positive("iso", 100);
  film_scale_ = version3_ ? p.positive("scale", 1) : 1;
  const std::string sensor = p.text("sensor", "cie1931");
  if (sensor != "cie1931")
    warn(p.where_of("sensor"), "the colors of the sensor \"" + sensor + "\"", "the CIE 1931 observer");
  white_balance_ = Rgb(1);
  if (const float kelvin = p.number("whitebalance", 0); kelvin != 0) {
    if (!(kelvin >= 1000 && kelvin <= 25000))
      p.fail("whitebalance", "is not between 1000 and 25000 kelvins", "6500 is the daylight that is white");
    white_balance_ = white_balance_of(kelvin);
  }
  if (p.has("maxcomponentvalue"))
    warn(p.where_of("maxcomponentvalue"), "a limit of the values of samples", "no limit");
  film_diagonal_ = p.positive("diagonal", 35);
  p.ignore({"filename", "savefp16", "maxcomponentvalue", "coordinatesystem", "nbuckets", "lambdamin",
            "lambdamax"});
  if (state_.space != ColorSpace::srgb)
    warn(p.where(), "pictures in another color space than sRGB's", "linear Rec. 709");
}

void Reader::read_filter(Params& p, const std::string& type) {
  if (version3_) upgrade_filter(p, type);
  FilterDesc out;
  const auto radius = [&](float fallback) {
    const float x = p.positive("xradius", fallback), y = p.positive("yradius", fallback);
    if (x != y) warn(p.where_of("yradius"), "filters of different radii in x and y", "the radius in x");
    if (x > 32) p.fail("xradius", "is wider than 32 pixels");
    return x;
  };
  if (type == "box") {
    out.kind = FilterKind::box, out.radius = radius(0.5f);
  } else if (type == "triangle") {
    out.kind = FilterKind::tent, out.radius = radius(2);
  } else if (type == "gaussian") {
    out.kind = FilterKind::gaussian, out.radius = radius(1.5f), out.stddev = p.positive("sigma", 0.5f);
  } else if (type == "mitchell") {
    out.kind = FilterKind::mitchell, out.radius = radius(2);
    out.b = p.number("B", 1.0f / 3), out.c = p.number("C", 1.0f / 3);
    if (out.radius != 2) {
      warn(p.where_of("xradius"), "Mitchell filters of another radius than 2", "the radius 2");
      out.radius = 2;
    }
  } else if (type == "sinc") {
    out.kind = FilterKind::lanczos, out.radius = radius(4);
    const float tau = p.positive("tau", 3);
    out.lobes = static_cast<int>(std::clamp(std::round(tau), 1.0f, 16.0f));
    if (static_cast<float>(out.lobes) != tau)
      warn(p.where_of("tau"), "sinc filters with a window of a fraction of lobes",
           std::to_string(out.lobes) + " lobes");
  } else {
    throw InputError(p.where(), "the filter " + in_quotes(type) + " is not known",
                     "box, triangle, gaussian, mitchell and sinc are");
  }
  film_.filter = out;
}

void Reader::read_sampler(Params& p, const std::string& type) {
  constexpr std::string_view kSamplers[] = {"halton",     "independent", "paddedsobol",   "pmj02bn",
                                            "sobol",      "stratified",  "zsobol",        "02sequence",
                                            "maxmindist", "random",      "lowdiscrepancy"};
  if (std::find(std::begin(kSamplers), std::end(kSamplers), type) == std::end(kSamplers))
    warn(p.where(), "the sampler " + in_quotes(type), "its number of samples");
  const int x = p.integer("xsamples", 4), y = p.integer("ysamples", 4);
  samples_ = type == "stratified" && x > 0 && x < 65536 && y > 0 && y < 32768 ? x * y
                                                                              : p.integer("pixelsamples", 16);
  if (samples_ < 1) p.fail("pixelsamples", "is not positive");
  p.ignore_all();  // which points it takes does not matter here
}

void Reader::read_integrator(Params& p, const std::string& type) {
  constexpr std::string_view kPaths[] = {"path",      "volpath",    "bdpt",          "mlt",       "sppm",
                                         "lightpath", "simplepath", "simplevolpath", "randomwalk"};
  if (std::find(std::begin(kPaths), std::end(kPaths), type) == std::end(kPaths))
    warn(p.where(), "the integrator " + in_quotes(type), "global illumination");
  has_integrator_ = true;
  scene_.integrator = type;
  const int depth = p.integer("maxdepth", 5);
  if (depth < 0) p.fail("maxdepth", "is negative");
  // pbrt counts bounces, Mitsuba what lies between them.
  scene_.max_depth = depth == 2147483647 ? -1 : depth + 1;
  p.ignore_all();  // the rest tunes pbrt's own algorithm
}

void Reader::finish_camera() {
  if (!has_camera_) camera_.where = {&main_file_, 1};
  if (!has_integrator_) scene_.integrator = "volpath", scene_.max_depth = 6;  // pbrt's defaults
  if (film_.filter.radius == 0) {
    film_.filter.kind = version3_ ? FilterKind::box : FilterKind::gaussian;
    film_.filter.radius = version3_ ? 0.5f : 1.5f;
  }
  imaging_ratio_ = version3_ ? film_scale_ : camera_.exposure_time * iso_ / 100;
  // Half the width of what the film sees, in what is 1 before the lens.
  std::optional<double> half_width;
  if (camera_.lens) {
    // The lens file is in millimeters, the scene in meters.
    constexpr double kMillimeter = 1e-3;
    const Lens& lens = *camera_.lens;
    const double to_object = static_cast<double>(camera_.focus_from_film) / kMillimeter;
    const double image = lens.image_distance(to_object);
    if (!(image > 0))
      throw InputError(camera_.where, "nothing so near can be in focus", "give a greater \"focusdistance\"");
    const double object = to_object - image - (lens.rear_principal - lens.front_principal);
    // What is in focus is object/image times as large as its picture, and seen from the entrance pupil.
    const double seen = object + lens.entrance_pupil - lens.front_principal;
    const double aspect = static_cast<double>(film_.height) / static_cast<double>(film_.width);
    const double width = static_cast<double>(film_diagonal_) / std::sqrt(1 + aspect * aspect);
    half_width = 0.5 * width * object / image / seen;
    camera_.lens_radius = static_cast<float>(lens.entrance_radius * kMillimeter);
    camera_.focal_distance = static_cast<float>(seen * kMillimeter);
    // The film is at the camera's place.
    const double pupil = image + lens.rear_principal - lens.entrance_pupil;
    camera_.to_world = camera_.to_world * Transform::translate(0, 0, pupil * kMillimeter);
    // But for pbrt-v3, which divides by it, the film gets the light of the solid angle of the exit pupil, as
    // on the axis.
    const double behind = image + lens.rear_principal - lens.exit_pupil;
    if (!version3_)
      imaging_ratio_ *= static_cast<float>(M_PI * lens.exit_radius * lens.exit_radius / (behind * behind));
  }
  scene_.lumens_per_unit = 1 / imaging_ratio_;  // pbrt's lights are of 1 nit, 1 lux or 1 candela

  SensorDesc out;
  out.where = camera_.where;
  out.medium = camera_.medium;
  out.film = film_;
  out.samples_per_pixel = samples_;
  if (!camera_.aspect && camera_.window.empty()) out.kept_axis = FieldAxis::smaller;
  out.near_clip = 0;
  out.far_clip = 1e30f;
  // The film shows x0 to x1 and y0 to y1 of a plane where the shorter side of the frame runs from -1 to 1.
  const float pixels = static_cast<float>(film_.width) / static_cast<float>(film_.height);
  const float frame = camera_.aspect.value_or(pixels);
  const std::vector<float> plain =
      frame > 1 ? std::vector<float>{-frame, frame, -1, 1} : std::vector<float>{-1, 1, -1 / frame, 1 / frame};
  const std::vector<float>& w = camera_.window.empty() ? plain : camera_.window;
  const float width = w[1] - w[0], height = w[3] - w[2];
  if (std::abs(width / height / pixels - 1) > 1e-3f)
    warn(camera_.where, "pixels that are not square (the frame and the film have different proportions)",
         "the frame's width with square pixels");
  out.principal_point_offset = {w[0] / width + 0.5f, 0.5f - w[3] / height};
  // The local x axis of pbrt's cameras points to the right, that of Lumirank's to the left.
  out.to_world = camera_.to_world * Transform::scale(-1, 1, 1);
  if (camera_.type == "orthographic") {
    out.kind = SensorKind::orthographic;
    out.to_world = out.to_world * Transform::scale(0.5 * width, 0.5 * width, 1);
  } else {
    out.kind = camera_.lens_radius > 0 ? SensorKind::thinlens : SensorKind::perspective;
    out.aperture_radius = camera_.lens_radius;
    out.focus_distance = camera_.focal_distance;
    const double half = half_width.value_or(std::tan(camera_.fov * M_PI / 360) * 0.5 * width);
    out.fov_x = static_cast<float>(std::atan(half) * 360 / M_PI);
  }
  scene_.sensors.push_back(std::move(out));
}

}  // namespace lumirank::scenedesc::pbrt
