#include "scenedesc/pbrt/media_parts.h"

#include <algorithm>
#include <optional>

#include "scenedesc/data/media.h"

namespace lumirank::scenedesc::pbrt {
namespace {

// "preset": coefficients and the mean cosine that goes with them.
struct Preset {
  Rgb absorption{1}, scattering{1};
  std::optional<Rgb> mean_cosine;
};

// Jensen et al. 2001, table 2: what pbrt-v3 takes for a medium of which nothing is stated.
const Preset kUnstated{Rgb(0.0011f, 0.0024f, 0.014f), Rgb(2.55f, 3.21f, 3.77f), std::nullopt};

Preset preset(Reader& reader, Params& p) {
  const std::string name = p.text("preset", "");
  if (name.empty() && p.reader().version3()) return kUnstated;
  if (name.empty()) return {};
  if (const auto known = named_medium(name)) {
    // As in pbrt, a preset comes before what is stated.
    p.ignore({"sigma_a", "sigma_s"});
    return {known->absorption, known->scattering, known->mean_cosine};
  }
  const bool stated = p.has("sigma_a") && p.has("sigma_s");
  reader.warn(p.where_of("preset"), "the preset " + in_quotes(name) + " of media",
              stated ? "\"sigma_a\" and \"sigma_s\"" : "whole milk");
  return kUnstated;
}

}  // namespace

float not_negative(Params& p, const char* name, float fallback) {
  const float value = p.number(name, fallback);
  if (!(value >= 0)) p.fail(name, "is negative", "give 0 or more");
  return value;
}

Rgb constant(Params& p, const char* name, Rgb fallback, Intent intent) {
  if (p.is_texture(name)) p.fail(name, "is a texture", "give a color or a spectrum");
  return constant_color(p, name, intent).value_or(fallback);
}

void coefficients(Reader& reader, Params& p, MediumDesc& out) {
  const Preset start = preset(reader, p);
  const float scale = not_negative(p, "scale", 1);
  const auto coefficient = [&](const char* name, Rgb value) -> VolumeInput {
    return {(start.mean_cosine ? value : constant(p, name, value, Intent::unbounded)) * scale, kNone};
  };
  out.absorption = coefficient("sigma_a", start.absorption);
  out.scattering = coefficient("sigma_s", start.scattering);
  if (start.mean_cosine && !p.has("g"))
    out.phase = {{PhaseLobeDesc::Kind::henyey_greenstein, *start.mean_cosine, 1}};
}

Box read_box(Params& p) {
  const Vec3d a = p.point3("p0", {0, 0, 0}), b = p.point3("p1", {1, 1, 1});
  const Box out{{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
                {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}};
  if (!(out.lo.x < out.hi.x && out.lo.y < out.hi.y && out.lo.z < out.hi.z))
    p.fail("p1", "leaves no room above \"p0\"", "they are opposite corners of a box");
  return out;
}

Transform Box::to_world(const Params& p, const Transform& medium_to_world) const {
  // In double precision: the box may be small, and far away.
  const Transform out =
      medium_to_world * Transform::translate(lo) * Transform::scale(hi.x - lo.x, hi.y - lo.y, hi.z - lo.z);
  if (!out.is_finite() || !out.inverse())
    throw InputError(p.where(), "the transform of " + p.title() + " is singular", "a Scale by 0 perhaps");
  return out;
}

}  // namespace lumirank::scenedesc::pbrt
