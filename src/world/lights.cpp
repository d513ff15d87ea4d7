#include "world/lights.h"

#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "base/parallel.h"
#include "emitters/area.h"
#include "world/emission_mesh.h"
#include "world/environment_builder.h"
#include "world/profile_builder.h"
#include "world/projection_builder.h"
#include "world/surface.h"

namespace lumirank::world {

namespace sd = scenedesc;
namespace em = emitters;

void EmitterNames::name(em::Emitter& emitter, const std::string& wanted, const SourceLocation& where) {
  if (++count_ > 0xffff)
    throw InputError(where, "the scene has more than 65,535 emitters", "join small lamps into fewer meshes");
  const std::string base = wanted.empty() ? std::string("emitter_").append(std::to_string(count_)) : wanted;
  emitter.group = groups_.try_emplace(base, static_cast<std::uint16_t>(groups_.size())).first->second;
  int& asked = asked_[base];
  do {
    ++asked;
    emitter.name = asked == 1 ? base : base + std::string("_").append(std::to_string(asked));
  } while (!taken_.insert(emitter.name).second);  // a made name may itself be an id of the scene
}

namespace {

// Of a triangle whose radiance is a texture: at least so many parts a side, and at most; and no more of all
// triangles than take a second of lookups.
constexpr float kMinParts = 4, kMaxParts = 64, kMaxPartsOfAll = 1 << 24;

// The mean over the centroids of equal parts of the triangle, so many a side.
Rgb mean_radiance(const geometry::TriangleMesh& mesh, std::uint32_t triangle, int texture,
                  const scatter::TextureSet& textures, int parts) {
  Rgb sum;
  for (int i = 0; i < parts; ++i) {
    Rgb of_strip;
    for (int j = 0; i + j < parts; ++j) {
      const auto add = [&](float du, float dv) {
        const Vec2f b{(static_cast<float>(i) + du) / static_cast<float>(parts),
                      (static_cast<float>(j) + dv) / static_cast<float>(parts)};
        of_strip += textures.lookup(texture, interpolate_uv(mesh, triangle, b));
      };
      add(1.0f / 3, 1.0f / 3);
      if (i + j < parts - 1) add(2.0f / 3, 2.0f / 3);
    }
    sum += of_strip;
  }
  return sum / static_cast<float>(parts * parts);
}

}  // namespace

em::AreaEmitter make_area_emitter(const geometry::TriangleMesh& mesh, std::uint32_t placement,
                                  const scatter::ColorInput& radiance, const scatter::TextureSet& textures) {
  em::AreaEmitter emitter;
  emitter.placement = placement;
  emitter.triangles.resize(mesh.triangle_count());
  const bool textured = radiance.texture >= 0;
  const auto triangles = static_cast<float>(std::max<std::size_t>(1, emitter.triangles.size()));
  const float max_parts = std::clamp(std::sqrt(kMaxPartsOfAll / triangles), kMinParts, kMaxParts);
  const Vec2f texels = textured ? textures.texels(radiance.texture) : Vec2f{};
  const auto fill = [&](std::uint32_t t) {
    auto& out = emitter.triangles[t];
    const Vec3f p0 = mesh.positions[mesh.indices[3 * t]];
    out.p0 = p0;
    out.e1 = mesh.positions[mesh.indices[3 * t + 1]] - p0;
    out.e2 = mesh.positions[mesh.indices[3 * t + 2]] - p0;
    out.area = 0.5f * length(mesh.area_vector(t));
    out.normal = outside_normal(mesh, t);
    if (out.normal == Vec3f{}) out.area = 0;
    out.mesh_triangle = t;
    out.mean_radiance = radiance.value;
    if (!textured) return;
    const float parts = std::clamp(texels_along(mesh, t, texels), kMinParts, max_parts);
    out.mean_radiance = mean_radiance(mesh, t, radiance.texture, textures, static_cast<int>(parts));
  };
  parallel_for(emitter.triangles.size(), textured ? 64 : 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) fill(static_cast<std::uint32_t>(t));
  });
  em::finish(emitter);
  return emitter;
}

void check_light(float value, const char* what, const SourceLocation& where) {
  if (value <= kMaxLight) return;
  char text[96];
  std::snprintf(text, sizeof text, " is %.3g; more than %.0e cannot be carried by 32-bit arithmetic",
                static_cast<double>(value), static_cast<double>(kMaxLight));
  throw InputError(where, what + std::string(text), "make all lights of the scene darker alike");
}

namespace {

void check_color(Rgb c, const char* what, const SourceLocation& where) {
  if (!is_finite(c)) throw InputError(where, std::string(what) + " is not finite", "give finite numbers");
  if (c.r < 0 || c.g < 0 || c.b < 0)
    throw InputError(where, std::string(what) + " has a negative component", "give numbers of 0 or more");
  check_light(max_component(c), what, where);
}

Vec3f checked_direction(Vec3f v, const SourceLocation& where) {
  const float len = length(v);
  if (!(len > 0) || !std::isfinite(len))
    throw InputError(where, "a direction is zero or not finite", "give a direction that is neither");
  return v / len;
}

em::SpotEmitter make_spot(const sd::SpotLightDesc& d, const Units& units, const SourceLocation& where) {
  if (!d.to_world.is_finite()) throw InputError(where, "to_world is not finite", "give finite numbers");
  if (!(d.cutoff_angle > 0 && d.cutoff_angle < 180))
    throw InputError(where, "the cut-off angle is not between 0 and 180 degrees", "give an angle in between");
  if (!(d.beam_width >= 0 && d.beam_width <= d.cutoff_angle))
    throw InputError(where, "the beam is wider than the cut-off angle, or negative",
                     "give a beam width between 0 and the cut-off angle");
  em::SpotEmitter spot;
  spot.position = units.to_world(d.to_world.origin());
  spot.frame = Frame::from_normal(checked_direction(d.to_world.vector({0, 0, 1}), where));
  spot.intensity = units.power_to_world(d.intensity);
  spot.cutoff = d.cutoff_angle * (kPi / 180), spot.beam = d.beam_width * (kPi / 180);
  spot.cos_cutoff = std::cos(spot.cutoff), spot.cos_beam = std::cos(spot.beam);
  return spot;
}

// Of the way from the cut-off to the beam.
float risen(float share, sd::SpotLightDesc::Edge edge) {
  using Edge = sd::SpotLightDesc::Edge;
  switch (edge) {
    case Edge::squared_cosine:
      return share * share;
    case Edge::fourth_power:
      return square(share * share);
    case Edge::smooth_cosine:
      return share * share * (3 - 2 * share);
    case Edge::angle:
      break;
  }
  return share;
}

// A spot light whose edge is not linear in the angle, as a table of 256 steps over the edge: within 10⁻⁴ of
// the axial intensity (the second derivative over the edge is at most some 30).
em::ProfileEmitter with_edge(const em::SpotEmitter& spot, sd::SpotLightDesc::Edge edge) {
  constexpr int kSteps = 256;
  std::vector<float> theta, values;
  if (spot.beam > 0) theta.push_back(0), values.push_back(1);
  for (int k = 0; k <= kSteps; ++k) {
    const float t = static_cast<float>(k) / kSteps;
    theta.push_back(k == kSteps ? spot.cutoff : spot.beam + t * (spot.cutoff - spot.beam));
    const float share = std::clamp(
        (std::cos(theta.back()) - spot.cos_cutoff) / (spot.cos_beam - spot.cos_cutoff), 0.0f, 1.0f);
    values.push_back(risen(share, edge));
  }
  std::vector<float> both;
  for (const float v : values) both.insert(both.end(), {v, v});
  em::ProfileEmitter out;
  out.position = spot.position, out.frame = spot.frame, out.scale = spot.intensity;
  out.profile =
      std::make_shared<em::AngularProfile>(std::move(theta), std::vector<float>{0, 2 * kPi}, std::move(both));
  return out;
}

}  // namespace

int add_lights(const sd::SceneDesc& desc, const std::vector<scatter::ColorInput>& pictures,
               const scatter::TextureSet& textures, EmitterNames& names, const Units& units, Notes& notes,
               std::vector<em::Emitter>& out) {
  EnvironmentBuilder environment(notes);
  const auto push = [&](auto kind, const sd::EmitterDesc& from) {
    em::Emitter emitter;
    emitter.kind = std::move(kind);
    names.name(emitter, from.id, from.where);
    out.push_back(std::move(emitter));
  };
  for (std::size_t k = 0; k < desc.emitters.size(); ++k) {
    const sd::EmitterDesc& e = desc.emitters[k];
    if (const auto* point = std::get_if<sd::PointLightDesc>(&e.kind)) {
      const Rgb intensity = units.power_to_world(point->intensity);
      check_color(intensity, "the intensity", e.where);
      if (!is_finite(point->position))
        throw InputError(e.where, "the position is not finite", "give finite numbers");
      push(em::PointEmitter{units.to_world(point->position), intensity}, e);
    } else if (const auto* spot = std::get_if<sd::SpotLightDesc>(&e.kind)) {
      const em::SpotEmitter made = make_spot(*spot, units, e.where);
      check_color(made.intensity, "the intensity", e.where);
      if (spot->edge == sd::SpotLightDesc::Edge::angle || !(made.cos_beam > made.cos_cutoff))
        push(made, e);
      else
        push(with_edge(made, spot->edge), e);
    } else if (const auto* profile = std::get_if<sd::ProfileLightDesc>(&e.kind)) {
      sd::ProfileLightDesc moved = *profile;
      moved.to_world = units.to_world(profile->to_world);
      moved.intensity = units.power_to_world(profile->intensity);
      check_color(moved.intensity, "the intensity", e.where);
      push(make_profile_light(moved, e.where, desc.lumens_per_unit, notes), e);
    } else if (const auto* projection = std::get_if<sd::ProjectionLightDesc>(&e.kind)) {
      sd::ProjectionLightDesc moved = *projection;
      moved.to_world = units.to_world(projection->to_world);
      moved.intensity = units.power_to_world(projection->intensity);
      check_color(moved.intensity, "the intensity", e.where);
      push(make_projection_light(moved, e.where, pictures[k], textures), e);
    } else if (const auto* sun = std::get_if<sd::DirectionalLightDesc>(&e.kind)) {
      check_color(sun->irradiance, "the irradiance", e.where);
      push(em::DirectionalEmitter{checked_direction(sun->direction, e.where), sun->irradiance, 1}, e);
    } else if (const auto* constant = std::get_if<sd::ConstantEnvironmentDesc>(&e.kind)) {
      check_color(constant->radiance, "the radiance", e.where);
      environment.add_constant(constant->radiance, e);
    } else if (const auto* map = std::get_if<sd::EnvironmentMapDesc>(&e.kind)) {
      environment.add_map(*map, e);
    } else if (const auto* day = std::get_if<sd::SunSkyDesc>(&e.kind)) {
      if (auto disc = environment.add_sun_sky(*day, e)) push(*disc, e);
    }
  }
  if (environment.empty()) return -1;
  em::Emitter emitter;
  emitter.kind = environment.build();
  names.name(emitter, environment.first().id, environment.first().where);
  out.push_back(std::move(emitter));
  return static_cast<int>(out.size()) - 1;
}

}  // namespace lumirank::world
