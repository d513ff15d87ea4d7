// glTF materials at the point of a built world against the formulas of glTF 2.0, appendix B.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "scatter/closure.h"
#include "scatter/fresnel.h"
#include "scenedesc/readers.h"
#include "world/world.h"

namespace lumirank::world {
namespace {

// A triangle around the origin in z = 0 that faces +z, with uvs whose u runs along +x and v (downwards in
// glTF) along `v_along`·y.
std::string scene_of(const std::string& material, int v_along = -1) {
  // Three vertices: positions (36 bytes) and uvs (24 bytes).
  const float floats[] = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
  float uvs[6];
  for (int k = 0; k < 3; ++k) {
    uvs[2 * k] = floats[3 * k];
    uvs[2 * k + 1] = static_cast<float>(v_along) * floats[3 * k + 1];
  }
  std::string data;
  const auto add = [&](const void* from, std::size_t size) {
    constexpr char kHex[] = "0123456789ABCDEF";
    for (std::size_t k = 0; k < size; ++k) {
      const unsigned char c = static_cast<const unsigned char*>(from)[k];
      data += {'%', kHex[c >> 4], kHex[c & 15]};
    }
  };
  add(floats, sizeof floats);
  add(uvs, sizeof uvs);
  return R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":
    {"POSITION":0,"TEXCOORD_0":1},"material":0}]}],"materials":[)" +
         material + R"(],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
    {"bufferView":0,"byteOffset":36,"componentType":5126,"count":3,"type":"VEC2"}],
    "bufferViews":[{"buffer":0,"byteLength":60}],"buffers":[{"byteLength":60,"uri":"data:,)" +
         data + "\"}]}";
}

struct Point {
  World world;
  SurfaceHit hit;
};
Point built(const std::string& text) {
  scenedesc::SceneDesc desc = scenedesc::parse_gltf(text, "made.gltf");
  std::vector<scenedesc::Warning> warnings;
  World world = World::build(desc, {}, warnings);
  const auto hit = world.intersect({{0, 0, 1}, {0, 0, -1}});
  return {std::move(world), hit.value()};
}

Vec3f direction(float cosine, float angle) {
  const float s = std::sqrt(1 - cosine * cosine);
  return {s * std::cos(angle), s * std::sin(angle), cosine};
}

// D·V and the Schlick weight of appendix B.3.
struct Specular {
  double dv, weight;
};
Specular specular(double alpha, Vec3f wo, Vec3f wi) {
  const Vec3f h = normalize(wo + wi);
  const double a2 = alpha * alpha, nh = h.z, no = wo.z, ni = wi.z;
  const double d = a2 / (M_PI * std::pow(nh * nh * (a2 - 1) + 1, 2));
  const double g_o = 2 * no / (no + std::sqrt(a2 + (1 - a2) * no * no));
  const double g_i = 2 * ni / (ni + std::sqrt(a2 + (1 - a2) * ni * ni));
  return {d * g_o * g_i / (4 * no * ni), std::pow(1 - std::abs(dot(wo, h)), 5)};
}

template <typename Check>
void for_directions(float min_cosine, const Check& check) {
  for (const float co : {0.1f, 0.3f, 0.5f, 0.7f, 0.9f, 0.99f})
    for (const float ci : {0.1f, 0.3f, 0.5f, 0.7f, 0.9f, 0.99f})
      for (const float angle : {0.0f, 1.0f, 2.0f, 3.1f})
        if (std::min(co, ci) >= min_cosine) check(direction(co, 0), direction(ci, angle));
}

std::string material(double metallic, double roughness) {
  return R"({"pbrMetallicRoughness":{"baseColorFactor":[0.8,0.5,0.2,1],"metallicFactor":)" +
         std::to_string(metallic) + ",\"roughnessFactor\":" + std::to_string(roughness) + "}}";
}

// And what its example loses is given back.
TEST(GltfBrdf, MetalsFollowTheAppendix) {
  for (const double roughness : {0.1, 0.4, 1.0}) {
    const Point p = built(scene_of(material(1, roughness)));
    for_directions(0, [&](Vec3f wo, Vec3f wi) {
      scatter::Closure closure = p.world.materials().closure(p.hit.material, p.hit.point, wo);
      ASSERT_EQ(closure.count, roughness > 0.2 ? 2 : 1);
      EXPECT_EQ(closure.lobes[0].kind, scatter::LobeKind::microfacet_reflect);
      EXPECT_EQ(closure.lobes[closure.count - 1].kind,
                closure.count > 1 ? scatter::LobeKind::interfaced_diffuse : closure.lobes[0].kind);
      closure.count = 1;
      const Rgb f = scatter::eval_f(closure, wo, wi);
      const Specular s = specular(roughness * roughness, wo, wi);
      const Rgb base{0.8f, 0.5f, 0.2f};
      for (int k = 0; k < 3; ++k) {
        const double expected = (base[k] + (1 - base[k]) * s.weight) * s.dv;
        // The half vector's cosine is rounded to 6e-8, by which D changes by 4 · 6e-8 / alpha² of itself; a
        // dozen other roundings beside it.
        const double alpha = roughness * roughness;
        EXPECT_NEAR(f[k], expected, expected * (3e-6 + 5e-7 / (alpha * alpha)))
            << roughness << ' ' << wo.z << ' ' << wi.z;
      }
    });
  }
}

// The reflection is the appendix's with Fresnel's own factor in place of Schlick's approximation. The base
// gets (1 - R(wo))(1 - R(wi))/(1 - mean R), R being the layer's directional reflectance, instead of 1 - F(h):
// R lies between 0.02 and 0.09 up to 60 degrees, its mean between 0.02 and 0.092, F(h) between 0.04 and 0.07.
// So the quotient of the two lies within 0.91² / 0.98 / 0.96 = 0.88 and 0.98² / 0.908 / 0.93 = 1.14.
TEST(GltfBrdf, DielectricsStayNearTheAppendix) {
  for (const double roughness : {0.3, 0.6, 1.0}) {
    const Point p = built(scene_of(material(0, roughness)));
    for_directions(0.5f, [&](Vec3f wo, Vec3f wi) {
      const Rgb f = scatter::eval_f(p.world.materials().closure(p.hit.material, p.hit.point, wo), wo, wi);
      const Specular s = specular(roughness * roughness, wo, wi);
      const double reflected = scatter::fresnel_dielectric(dot(wo, normalize(wo + wi)), 1.5f) * s.dv;
      const Rgb base{0.8f, 0.5f, 0.2f};
      for (int k = 0; k < 3; ++k) {
        const double quotient = (f[k] - reflected) / (base[k] / M_PI * (1 - 0.04 - 0.96 * s.weight));
        EXPECT_GT(quotient, 0.88) << roughness << ' ' << wo.z << ' ' << wi.z;
        EXPECT_LT(quotient, 1.14) << roughness << ' ' << wo.z << ' ' << wi.z;
      }
    });
  }
}

// By the rule of the closure's own sampling, 4096 draws: white surfaces send back no more than they receive.
TEST(GltfBrdf, WhiteSurfacesMakeNoLight) {
  for (const double metallic : {0.0, 0.5, 1.0})
    for (const double roughness : {0.2, 0.5, 1.0}) {
      std::string white = material(metallic, roughness);
      white.replace(white.find("0.8,0.5,0.2"), 11, "1,1,1");
      const Point p = built(scene_of(white));
      for (const float cosine : {0.05f, 0.2f, 0.5f, 1.0f}) {
        const Vec3f wo = direction(cosine, 0);
        const scatter::Closure closure = p.world.materials().closure(p.hit.material, p.hit.point, wo);
        double sum = 0, squares = 0;
        const int side = 64;
        for (int i = 0; i < side * side; ++i) {
          const float u = (static_cast<float>(i % side) + 0.5f) / side,
                      v = (static_cast<float>(i / side) + 0.5f) / side;
          const float choice = std::fmod(0.5f + 0.61803399f * static_cast<float>(i), 1.0f);
          const auto s = scatter::sample(closure, wo, choice, {u, v}, scatter::Lobes::all);
          const double w = s ? s->weight.g : 0.0;
          sum += w, squares += w * w;
        }
        const double n = side * side, mean = sum / n;
        const double deviation = std::sqrt(std::max(0.0, squares / n - mean * mean) / n);
        EXPECT_LT(mean, 1.01 + 4 * deviation) << metallic << ' ' << roughness << ' ' << cosine;
        // A dielectric loses nothing: up to the fit of 1 - R, 0.01.
        if (metallic == 0) {
          EXPECT_NEAR(mean, 1, 0.01 + 4 * deviation) << roughness << ' ' << cosine;
        }
      }
    }
}

// KHR_materials_sheen with Ashikhmin's visibility, in double precision.
double sheen_dv(double alpha, Vec3f wo, Vec3f wi) {
  const double x = double{wo.x} + wi.x, y = double{wo.y} + wi.y, z = double{wo.z} + wi.z;
  const double sine = std::sqrt((x * x + y * y) / (x * x + y * y + z * z));
  return (2 + 1 / alpha) * std::pow(sine, 1 / alpha) / (2 * M_PI) /
         (4 * (double{wo.z} + wi.z - double{wo.z} * wi.z));
}
// Its directional albedo: midpoints in the azimuth and the square root of the cosine.
double sheen_e(double alpha, float cosine) {
  const int n = 200;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) {
      const double root = (i + 0.5) / n, c = root * root;
      const Vec3f wi = direction(static_cast<float>(c), static_cast<float>(M_PI * (k + 0.5) / n));
      sum += sheen_dv(alpha, direction(cosine, 0), wi) * c * 2 * root;
    }
  return sum * 2 * M_PI / (n * n);
}

// A base of white without reflection sends 1/π of what the sheen leaves of it; a black one nothing. E comes
// from a table whose steps are 0.03 in √cosine, over which E bends by less than 20 per unit squared: linear
// interpolation is off by 20/8 · 0.03² = 0.0023 at most.
TEST(GltfBrdf, SheenFollowsTheExtension) {
  for (const double roughness : {0.3, 0.6, 1.0}) {
    const double alpha = roughness * roughness;
    for (const int white : {0, 1}) {
      const std::string base = white ? "1,1,1,1" : "0,0,0,1";
      const Point p = built(
          scene_of(R"({"pbrMetallicRoughness":{"metallicFactor":0,"baseColorFactor":[)" + base +
                   R"(]},"extensions":{"KHR_materials_specular":{"specularFactor":0},"KHR_materials_sheen":{
          "sheenColorFactor":[0.9,0.5,0.1],"sheenRoughnessFactor":)" +
                   std::to_string(roughness) + "}}}"));
      const Rgb color{0.9f, 0.5f, 0.1f};
      for_directions(0.3f, [&](Vec3f wo, Vec3f wi) {
        const Rgb f = scatter::eval_f(p.world.materials().closure(p.hit.material, p.hit.point, wo), wo, wi);
        const double e = std::max(sheen_e(alpha, wo.z), sheen_e(alpha, wi.z));
        ASSERT_LT(e, 1);
        for (int k = 0; k < 3; ++k) {
          const double expected = color[k] * sheen_dv(alpha, wo, wi) + white * (1 - 0.9 * e) / M_PI;
          EXPECT_NEAR(f[k], expected, 1e-4 * expected + 1e-6 + white * 0.0023 / M_PI)
              << roughness << ' ' << wo.z << ' ' << wi.z;
        }
      });
      if (white) continue;
      for (const float cosine : {0.1f, 0.3f, 0.5f, 0.8f, 1.0f}) {
        const Vec3f wo = direction(cosine, 0);
        const double e = sheen_e(alpha, cosine);
        const Rgb albedo = scatter::albedo(p.world.materials().closure(p.hit.material, p.hit.point, wo), wo);
        // At roughness 0.3 E exceeds 1 for wi below a cosine of 0.05, and the value there is held.
        for (int k = 0; k < 3; ++k)
          EXPECT_NEAR(albedo[k], color[k] * e, color[k] * (roughness < 0.5 ? 0.01 : 0.0023))
              << roughness << ' ' << cosine;
      }
    }
  }
}

// KHR_materials_anisotropy: alpha_t = mix(alpha, 1, strength²) along the tangent, alpha_b = alpha across it;
// D as that extension writes it, and V with the masking of either direction by itself, as in appendix B.3 of
// glTF. The tangent is turned from +u towards the picture's top, so towards
// -v, whichever way the uvs run.
TEST(GltfBrdf, AnisotropyStretchesAlongTheTurnedTangent) {
  for (const int v_along : {-1, 1})
    for (const double turn : {0.0, 0.7}) {
      const double strength = 0.6, roughness = 0.5, alpha = roughness * roughness;
      const Point p = built(scene_of(
          R"({"pbrMetallicRoughness":{"baseColorFactor":[1,1,1,1],"metallicFactor":1,"roughnessFactor":0.5},
              "extensions":{"KHR_materials_anisotropy":{"anisotropyStrength":0.6,"anisotropyRotation":)" +
              std::to_string(turn) + "}}}",
          v_along));
      const double at = alpha + (1 - alpha) * strength * strength, ab = alpha;
      const double up = -v_along;
      const Vec3f t{static_cast<float>(std::cos(turn)), static_cast<float>(up * std::sin(turn)), 0};
      const Vec3f b{static_cast<float>(-std::sin(turn)), static_cast<float>(up * std::cos(turn)), 0};
      for_directions(0.1f, [&](Vec3f wo, Vec3f wi) {
        const Vec3f h = normalize(wo + wi);
        const double th = dot(t, h), bh = dot(b, h), nh = h.z;
        const double x = ab * th, y = at * bh, z = at * ab * nh, a2 = at * ab;
        const double w2 = a2 / (x * x + y * y + z * z), d = a2 * w2 * w2 / M_PI;
        const auto stretched = [&](Vec3f w) {
          return std::sqrt(std::pow(at * dot(t, w), 2) + std::pow(ab * dot(b, w), 2) + std::pow(w.z, 2));
        };
        const auto g = [&](Vec3f w) { return 2 * w.z / (w.z + stretched(w)); };
        const double v = g(wo) * g(wi) / (4 * wo.z * wi.z);
        const auto closure = p.world.materials().closure(p.hit.material, p.hit.point, wo);
        const double f = scatter::eval_f(closure, wo, wi).g;
        // What the facets mask comes back besides: a smooth, small part.
        const double ratio = f / (d * v);
        EXPECT_GT(f, 0.98 * d * v) << v_along << ' ' << turn << ' ' << ratio;
        EXPECT_LT(f, 1.02 * d * v + 0.1) << v_along << ' ' << turn << ' ' << ratio;
      });
    }
}

// A normal map that leans towards green, "up in the picture": smaller v of glTF, whichever way the uvs turn
// it.
TEST(GltfBrdf, NormalMapsFollowMirroredUvs) {
  for (const int v_along : {-1, 1}) {
    scatter::MaterialSet set;
    const Point p = built(scene_of(material(0, 1), v_along));
    set.textures.textures.push_back(scatter::ConstantTexture{{0.5f, 0.75f, 0.933f}});
    set.materials.push_back(scatter::DiffuseMaterial{{Rgb(0.5f), -1}});
    set.materials.push_back(scatter::NormalMapMaterial{0, 1, true, 0});
    const Vec3f n = set.closure(1, p.hit.point, {0, 0, 1}).frame.n;
    EXPECT_NEAR(n.x, 0, 1e-5f);
    // v runs along v_along · y, so up is -v_along · y: (0.5, 0.866) by the color.
    EXPECT_NEAR(n.y, -0.5f * static_cast<float>(v_along), 1e-3f);
    // Flattened to half: tan is half of 0.5 / 0.866.
    set.materials.push_back(scatter::NormalMapMaterial{0, 0.5f, true, 0});
    const Vec3f half = set.closure(2, p.hit.point, {0, 0, 1}).frame.n;
    EXPECT_NEAR(std::abs(half.y) / half.z, 0.25 / 0.866, 1e-3);
  }
}

}  // namespace
}  // namespace lumirank::world
