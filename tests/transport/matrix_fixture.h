// Worlds, receivers and lights made by hand, for the tests of the lighting matrix.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "base/random.h"
#include "base/warp.h"
#include "emitters/profile.h"
#include "scenedesc/schema/scene_desc.h"
#include "transport/cpu/scene_matrix.h"
#include "transport/lights/virtual_lights.h"
#include "transport/rows/receivers.h"
#include "world/world.h"

namespace lumirank::transport::testing {

// `before`: the same scene at another moment.
inline world::World build_world(scenedesc::SceneDesc desc, const world::World* before = nullptr) {
  desc.sensors.resize(1);
  std::vector<scenedesc::Warning> warnings;
  world::BuildOptions options;
  options.before = before;
  return world::World::build(desc, options, warnings);
}

template <typename Kind>
void add_shape(scenedesc::SceneDesc& desc, const Kind& kind, const Transform& to_world,
               int bsdf = scenedesc::kNone) {
  scenedesc::ShapeDesc shape;
  shape.id = "shape" + std::to_string(desc.shapes.size());
  shape.to_world = to_world;
  shape.bsdf = bsdf;
  shape.kind = kind;
  desc.shapes.push_back(shape);
}

template <typename Kind>
int add_bsdf(scenedesc::SceneDesc& desc, const Kind& kind) {
  scenedesc::BsdfDesc bsdf;
  bsdf.id = "bsdf" + std::to_string(desc.bsdfs.size());
  bsdf.kind = kind;
  desc.bsdfs.push_back(bsdf);
  return static_cast<int>(desc.bsdfs.size()) - 1;
}

// One small rectangle far from everything that the tests evaluate.
inline scenedesc::SceneDesc empty_space() {
  scenedesc::SceneDesc desc;
  add_shape(desc, scenedesc::RectangleDesc{}, Transform::translate(1000, 1000, 1000));
  return desc;
}

// A closed cube of side 4 around the origin with three blocks in it.
inline scenedesc::SceneDesc room_with_blocks() {
  scenedesc::SceneDesc desc;
  add_shape(desc, scenedesc::CubeDesc{}, Transform::scale(2, 2, 2));
  add_shape(desc, scenedesc::CubeDesc{},
            Transform::translate(0.7, -1.2, 0.4) * Transform::rotate(0, 1, 0, 31) *
                Transform::scale(0.4, 0.7, 0.4));
  add_shape(desc, scenedesc::CubeDesc{},
            Transform::translate(-0.8, 0.1, -0.5) * Transform::rotate(1, 2, 0, 50) *
                Transform::scale(0.5, 0.3, 0.6));
  add_shape(desc, scenedesc::SphereDesc{},
            Transform::translate(-0.2, 1.0, 0.9) * Transform::scale(0.4, 0.4, 0.4));
  return desc;
}

inline void add_receiver(Receivers& receivers, Vec3f p, Vec3f n, Vec3f wo, Rgb albedo) {
  receivers.position.push_back(p);
  receivers.normal.push_back(n);
  receivers.ng.push_back(n);
  receivers.wo.push_back(wo);
  receivers.weight.push_back(Rgb(1));
  receivers.sample.push_back(static_cast<std::uint32_t>(receivers.film.size()));
  receivers.film.push_back({static_cast<float>(receivers.film.size()) + 0.5f, 0.5f});
  receivers.depth.push_back(1);
  receivers.id.push_back(receivers.id.size());
  receivers.closure.push_back(Receivers::kLambertian);
  receivers.albedo.push_back(albedo);
}

// The last receiver becomes one that scatters by `closure`.
inline void set_closure(Receivers& receivers, const scatter::Closure& closure) {
  const float side = dot(closure.frame.n, receivers.wo.back()) < 0 ? -1.0f : 1.0f;
  receivers.normal.back() = closure.frame.n * side;
  receivers.ng.back() = closure.ng * side;
  receivers.closure.back() = receivers.closures.add(closure, receivers.normal.back());
}

inline void add_light(VirtualLights& lights, LightKind kind, Vec3f p, Vec3f n, Rgb power) {
  lights.id.push_back(lights.id.size());
  lights.kind.push_back(kind);
  lights.position.push_back(p);
  lights.normal.push_back(n);
  lights.ng.push_back(n);
  lights.power.push_back(power);
  lights.area.push_back(0);
  lights.emitter.push_back(0);
  lights.depth.push_back(kind == LightKind::surface ? 1 : 0);
  lights.closure.push_back(VirtualLights::kLambertian);
  lights.albedo.push_back(Rgb(0.5f));
  lights.incoming.push_back(n);
}

inline void set_closure(VirtualLights& lights, const scatter::Closure& closure) {
  const float side = dot(closure.frame.n, lights.incoming.back()) < 0 ? -1.0f : 1.0f;
  lights.normal.back() = closure.frame.n * side;
  lights.ng.back() = closure.ng * side;
  lights.closure.back() = lights.closures.add(closure, lights.normal.back());
}

inline Vec3f random_direction(Rng& rng) { return warp_sphere(rng.next_2d()); }

// The materials that the world's shapes wear.
inline std::vector<int> worn_materials(const world::World& world) {
  std::vector<int> materials;
  for (const geometry::Placement& p : world.rays().placements()) {
    const int material = static_cast<int>(p.material);
    if (std::find(materials.begin(), materials.end(), material) == materials.end())
      materials.push_back(material);
  }
  return materials;
}

// Shapes out of the way that wear BSDFs of every kind whose closures have non-delta lobes.
inline void add_all_bsdfs(scenedesc::SceneDesc& desc) {
  using namespace scenedesc;
  const auto color = [](float r, float g, float b) {
    ColorInput input;
    input.value = Rgb(r, g, b);
    return input;
  };
  const auto value = [](float v) {
    FloatInput input;
    input.value = v;
    return input;
  };
  std::vector<int> all;
  all.push_back(add_bsdf(desc, DiffuseDesc{color(0.7f, 0.5f, 0.3f)}));
  all.push_back(add_bsdf(desc, RoughDiffuseDesc{color(0.6f, 0.5f, 0.4f), value(0.3f)}));
  for (const Distribution d : {Distribution::beckmann, Distribution::ggx}) {
    PlasticDesc plastic;
    plastic.diffuse_reflectance = color(0.2f, 0.4f, 0.6f);
    plastic.distribution = d;
    plastic.nonlinear = d == Distribution::ggx;
    plastic.alpha = value(0.15f);
    all.push_back(add_bsdf(desc, plastic));
    ConductorDesc metal;
    metal.eta = color(0.2f, 0.92f, 1.1f).value;
    metal.k = color(3.9f, 2.4f, 2.2f).value;
    metal.distribution = d;
    metal.alpha_u = metal.alpha_v = value(0.2f);
    all.push_back(add_bsdf(desc, metal));
    metal.alpha_v = value(0.4f);
    all.push_back(add_bsdf(desc, metal));
    DielectricDesc glass;
    glass.distribution = d;
    glass.alpha_u = glass.alpha_v = value(0.3f);
    all.push_back(add_bsdf(desc, glass));
  }
  PlasticDesc coated;  // the diffuse base under a smooth coating
  coated.diffuse_reflectance = color(0.5f, 0.3f, 0.1f);
  all.push_back(add_bsdf(desc, coated));
  all.push_back(add_bsdf(desc, PhongDesc{}));
  all.push_back(add_bsdf(desc, WardDesc{}));
  for (const auto variant :
       {WardDesc::Variant::ward, WardDesc::Variant::ward_duer, WardDesc::Variant::balanced}) {
    WardDesc brushed;
    brushed.variant = variant;
    brushed.diffuse_reflectance = color(0.1f, 0.2f, 0.05f);
    brushed.specular_reflectance = color(0.5f, 0.3f, 0.7f);
    brushed.alpha_u = value(0.12f), brushed.alpha_v = value(0.35f);
    all.push_back(add_bsdf(desc, brushed));
  }
  PrincipledDesc principled;
  principled.sheen = value(0.5f), principled.clearcoat = value(0.7f), principled.metallic = value(0.3f);
  all.push_back(add_bsdf(desc, principled));
  principled.flatness = value(0.6f), principled.anisotropic = value(0.7f), principled.spec_tint = value(0.4f);
  principled.roughness = value(0.3f), principled.sheen_tint = value(0.5f),
  principled.clearcoat_gloss = value(0.9f);
  all.push_back(add_bsdf(desc, principled));
  PrincipledThinDesc sheet;
  sheet.spec_trans = value(0.4f), sheet.diff_trans = value(0.9f), sheet.anisotropic = value(0.5f);
  sheet.sheen = value(0.3f), sheet.spec_tint = value(0.5f);
  all.push_back(add_bsdf(desc, sheet));
  all.push_back(add_bsdf(desc, DiffuseTransmitterDesc{color(0.2f, 0.3f, 0.1f), color(0.5f, 0.2f, 0.4f)}));
  for (const float alpha : {0.0f, 0.2f}) {  // metal and matt color under varnish
    CoatingDesc coating;
    coating.alpha_u = coating.alpha_v = value(alpha);
    coating.absorption = color(0.1f, 0.2f, 0.4f);
    ConductorDesc metal;
    metal.eta = Rgb(0.2f, 0.92f, 1.1f), metal.k = Rgb(3.9f, 2.4f, 2.2f);
    metal.alpha_u = value(0.1f), metal.alpha_v = value(0.3f);
    coating.nested = add_bsdf(desc, metal);
    all.push_back(add_bsdf(desc, coating));
    coating.nested = add_bsdf(desc, DiffuseDesc{color(0.7f, 0.5f, 0.3f)});
    all.push_back(add_bsdf(desc, coating));
    coating.nested = add_bsdf(desc, WardDesc{});
    all.push_back(add_bsdf(desc, coating));
    coating.nested = add_bsdf(desc, RoughDiffuseDesc{color(0.6f, 0.5f, 0.4f), value(0.3f)});
    all.push_back(add_bsdf(desc, coating));
  }
  SheenDesc cloth;
  cloth.color = color(0.5f, 0.7f, 0.3f), cloth.roughness = value(0.5f);
  for (const int below : {all.front(), all[1], all[2]}) {
    cloth.nested = below;
    all.push_back(add_bsdf(desc, cloth));
  }
  for (const float exponent : {8.0f, 60.0f}) {
    HairDesc hair;
    hair.exponent = value(exponent);
    CurvesDesc fiber;
    fiber.basis = CurvesDesc::Basis::linear;
    fiber.points = {{1000, 1010, 1000}, {1001, 1010, 1000}};
    fiber.radii = {0.1f, 0.1f};
    fiber.first = {0, 2};
    add_shape(desc, fiber, {}, add_bsdf(desc, hair));
  }
  for (std::size_t k = 0; k < all.size(); ++k)
    add_shape(desc, RectangleDesc{}, Transform::translate(1000 + 3.0 * static_cast<double>(k), 1000, 1000),
              all[k]);
}

// Receivers and lights at random places of a world's surfaces, with every kind of closure and of light.
struct RandomEnds {
  Receivers receivers;
  VirtualLights lights;
};
inline scatter::SurfacePoint random_surface(const world::World& world, Rng& rng, Vec3f& wo) {
  for (;;) {
    const Vec3f from{1.9f * (2 * rng.next_float() - 1), 1.9f * (2 * rng.next_float() - 1),
                     1.9f * (2 * rng.next_float() - 1)};
    const Vec3f direction = random_direction(rng);
    const auto hit = world.intersect({from, direction});
    if (!hit || dot(hit->point.ng, direction) == 0) continue;
    wo = -direction;
    return hit->point;
  }
}
inline RandomEnds random_ends(const world::World& world, std::size_t rows, std::size_t columns,
                              std::uint64_t seed) {
  RandomEnds ends;
  Rng rng(seed, Stage::test);
  const std::vector<int> materials = worn_materials(world);
  const auto pick = [&] { return materials[rng.next_below(materials.size())]; };
  for (std::size_t i = 0; i < rows; ++i) {
    Vec3f wo;
    const scatter::SurfacePoint at = random_surface(world, rng, wo);
    const float side = dot(at.shading.n, wo) < 0 ? -1.0f : 1.0f;
    add_receiver(ends.receivers, at.position, at.shading.n * side, wo,
                 Rgb(rng.next_float(), rng.next_float(), rng.next_float()));
    ends.receivers.ng.back() = at.ng * side;
    if (rng.next_float() < 0.5f) set_closure(ends.receivers, world.materials().closure(pick(), at, wo));
  }
  const LightKind kinds[] = {LightKind::omni,    LightKind::oriented, LightKind::surface,
                             LightKind::surface, LightKind::surface,  LightKind::directional,
                             LightKind::spot};
  for (std::size_t j = 0; j < columns; ++j) {
    Vec3f wo;
    const scatter::SurfacePoint at = random_surface(world, rng, wo);
    const LightKind kind = kinds[rng.next_below(7)];
    const float side = dot(at.shading.n, wo) < 0 ? -1.0f : 1.0f;
    const bool on_surface = kind == LightKind::oriented || kind == LightKind::surface;
    const Vec3f inside = at.position + wo * 0.3f;
    add_light(ends.lights, kind, on_surface ? at.position : inside,
              kind == LightKind::omni ? Vec3f{} : (on_surface ? at.shading.n * side : random_direction(rng)),
              Rgb(rng.next_float(), rng.next_float(), rng.next_float()));
    ends.lights.incoming.back() = wo;
    ends.lights.depth.back() =
        static_cast<std::uint16_t>(kind == LightKind::surface ? 1 + rng.next_below(4) : 0);
    if (on_surface) {
      ends.lights.ng.back() = kind == LightKind::surface ? at.ng * side : ends.lights.normal.back();
      ends.lights.area.back() = 0.02f * rng.next_float();
    }
    if (kind == LightKind::surface && rng.next_float() < 0.6f)
      set_closure(ends.lights, world.materials().closure(pick(), at, wo));
    if (kind == LightKind::spot) {
      ends.lights.closure.back() = static_cast<std::uint32_t>(ends.lights.spots.size());
      const float cutoff = 0.5f + rng.next_float(), beam = 0.7f * cutoff;
      ends.lights.spots.push_back({std::cos(cutoff), std::cos(beam), cutoff, beam, nullptr, {}});
      if (rng.next_float() < 0.5f) {
        // A table: 1 in the middle, falling to half at the cutoff and turning with the azimuth.
        SpotShape& shape = ends.lights.spots.back();
        shape.profile = std::make_shared<emitters::AngularProfile>(
            std::vector<float>{0, cutoff}, std::vector<float>{0, 2, 2 * kPi},
            std::vector<float>{1, 1, 1, 0.5f, 2, 0.5f});
        shape.frame = Frame::from_normal(ends.lights.normal.back());
      }
    }
  }
  return ends;
}

}  // namespace lumirank::transport::testing
