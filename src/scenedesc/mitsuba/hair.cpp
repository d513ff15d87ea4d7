// Curves and hair: Mitsuba 3's curve shapes and its "hair" BSDF, and 0.6's "hair" shape.
#include "scenedesc/schema/hair.h"

#include <cmath>

#include "scenedesc/data/ior.h"
#include "scenedesc/mitsuba/bsdf_kinds.h"
#include "scenedesc/mitsuba/curves.h"

namespace lumirank::scenedesc::mitsuba {

namespace {

float share(Plugin& p, const std::string& name, float fallback) {
  const float value = p.number(name, fallback);
  if (!(value >= 0 && value <= 1))
    throw InputError(p.where_of(name), "\"" + name + "\" of " + p.title() + " is not between 0 and 1");
  return value;
}

float amount(Plugin& p, const std::string& name, float fallback) {
  const float value = p.number(name, fallback);
  if (!(value >= 0)) throw InputError(p.where_of(name), "\"" + name + "\" of " + p.title() + " is negative");
  return value;
}

}  // namespace

BsdfKind hair(Reader&, Plugin& p) {
  const bool pigments = p.has("eumelanin") || p.has("pheomelanin");
  if (p.has("sigma_a") && pigments)
    throw InputError(p.where_of("sigma_a"), p.title() + " has both \"sigma_a\" and pigments",
                     "keep one of them");
  Rgb sigma_a = hair_absorption(amount(p, "eumelanin", 1.3f), amount(p, "pheomelanin", 0.2f));
  if (p.has("sigma_a")) {
    sigma_a = p.constant_color("sigma_a", Rgb(0), Intent::emission) * amount(p, "scale", 1);
    if (sigma_a.r < 0 || sigma_a.g < 0 || sigma_a.b < 0)
      throw InputError(p.where_of("sigma_a"), "\"sigma_a\" of " + p.title() + " is negative");
  }
  HairFiberDesc out;
  out.sigma_a = sigma_a, out.eta = relative_index(p, "amber");
  out.beta_m = share(p, "longitudinal_roughness", 0.3f);
  out.beta_n = share(p, "azimuthal_roughness", 0.3f);
  out.tilt = p.number("scale_tilt", 2);
  if (!(std::abs(out.tilt) <= kMaxHairTilt))
    throw InputError(p.where_of("scale_tilt"), "\"scale_tilt\" of " + p.title() + " is beyond 20 degrees");
  p.ignore({"scale"});
  return out;
}

decltype(ShapeDesc::kind) curves(Reader& reader, Plugin& p, const Transform& to_world) {
  CurvesDesc out;
  out.basis = p.type() == "bsplinecurve" ? CurvesDesc::Basis::bspline : CurvesDesc::Basis::linear;
  const auto file = reader.file(p.required_text("filename"), p.where_of("filename"), "curve file", "");
  out.filename = file.name;
  const auto known = [&]() -> decltype(ShapeDesc::kind) {
    if (file.missing) return InlineMeshDesc{nullptr, file.name};
    return out;
  };
  if (p.type() != "hair") return known();
  // World units, whatever to_world does to the file's points.
  out.file_radius = p.positive("radius", 0.025f) /
                    static_cast<float>(std::cbrt(std::max(1e-300, std::abs(to_world.determinant3()))));
  // Segments that hardly bend are merged there: no picture shows it.
  p.ignore({"angle_threshold"});
  if (const float reduction = share(p, "reduction", 0); reduction > 0)
    reader.warn(p.where_of("reduction"), "the \"reduction\" of hair", "all of it");
  return known();
}

}  // namespace lumirank::scenedesc::mitsuba
