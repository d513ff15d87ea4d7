#include "scatter/bsdf_list.h"

#include <cmath>

#include "scatter/fiber_table.h"
#include "scatter/merl_table.h"
#include "scatter/microfacet.h"

namespace lumirank::scatter {
namespace {

constexpr auto kGgx = NormalDistribution::ggx;
constexpr auto kBeckmann = NormalDistribution::beckmann;

ColorInput color(float r, float g, float b) { return {{r, g, b}, -1}; }

BsdfCase single(std::string name, Material m) {
  BsdfCase c;
  c.name = std::move(name);
  c.set.materials.push_back(std::move(m));
  return c;
}

// `outer` refers to `inner` by index 0.
BsdfCase nested(std::string name, Material inner, Material outer) {
  BsdfCase c = single(std::move(name), std::move(inner));
  c.set.materials.push_back(std::move(outer));
  c.material = 1;
  return c;
}

const Rgb kGoldEta{0.143f, 0.375f, 1.442f}, kGoldK{3.983f, 2.386f, 1.603f};

ConductorMaterial conductor(NormalDistribution d, float au, float av) {
  return {kGoldEta, kGoldK, gray(1), d, number(au), number(av), au == 0};
}
ConductorMaterial perfect_mirror(NormalDistribution d, float a) {
  return {Rgb(0), Rgb(1), gray(1), d, number(a), number(a), a == 0};
}
DielectricMaterial dielectric(NormalDistribution d, float eta, float au, float av) {
  return {eta, gray(1), gray(1), d, number(au), number(av), au == 0};
}
PlasticMaterial plastic(NormalDistribution d, float alpha, bool nonlinear) {
  return {1.49f,     color(0.8f, 0.4f, 0.1f),
          gray(1),   nonlinear,
          d,         number(alpha),
          false,     false,
          false,     number(0),
          alpha == 0};
}

BsdfCase glass(std::string name, DielectricMaterial m) {
  BsdfCase c = single(std::move(name), m);
  c.inside_too = true;
  c.eta = m.eta;
  c.lossless = m.smooth;
  return c;
}

BsdfCase principled(std::string name, float metallic, float spec_trans, float roughness, float extras) {
  PrincipledMaterial m;
  m.base_color = color(0.8f, 0.5f, 0.2f);
  m.roughness = number(roughness);
  m.metallic = number(metallic);
  m.spec_trans = number(spec_trans);
  m.anisotropic = m.spec_tint = m.sheen = m.sheen_tint = m.clearcoat = m.flatness = number(extras);
  m.clearcoat_gloss = number(0.3f * extras);
  BsdfCase c = single("principled_" + name, m);
  c.inside_too = spec_trans > 0;
  c.eta = m.eta;
  c.energy_exempt =
      "the diffuse base is not dimmed by what the specular layer reflects, and sheen is added on top";
  return c;
}

BsdfCase thin(std::string name, float spec_trans, float diff_trans, float roughness, float extras) {
  PrincipledThinMaterial m;
  m.base_color = color(0.8f, 0.5f, 0.2f);
  m.roughness = number(roughness), m.spec_trans = number(spec_trans), m.diff_trans = number(diff_trans);
  m.anisotropic = m.spec_tint = m.sheen = m.sheen_tint = m.flatness = number(extras);
  BsdfCase c = single("principledthin_" + name, m);
  c.inside_too = true;
  return c;
}

BsdfCase ward(std::string name, int variant, float au, float av) {
  BsdfCase c = single("ward_" + name, WardMaterial{variant, gray(0.3f), gray(0.6f), number(au), number(av)});
  if (variant < 2)
    c.energy_exempt =
        "the normalization of both older Ward models grows without bound towards grazing angles";
  return c;
}

BsdfCase oren_nayar(std::string name, float rho, float alpha) {
  return single("roughdiffuse_" + name, RoughDiffuseMaterial{gray(rho), number(alpha)});
}

CoatingMaterial layer(NormalDistribution d, float alpha, float eta, float depth, float weight) {
  return {eta,
          gray(1),
          color(depth, 0.5f * depth, 2 * depth),
          number(weight),
          d,
          number(alpha),
          number(alpha),
          false,
          0,
          alpha == 0};
}
CoatingMaterial clear_coat(float alpha, float weight) {
  CoatingMaterial m = layer(kGgx, alpha, 1.5f, 0, weight);
  m.straight = true;
  return m;
}

BitmapTexture bitmap(int width, int height, Rgb (*value)(int, int)) {
  auto pixels = std::make_shared<TexturePixels>();
  pixels->width = width, pixels->height = height;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) pixels->rgb.push_back(value(x, y));
  BitmapTexture t;
  t.pixels = pixels;
  return t;
}

BsdfCase hair(std::string name, float diffuse, float specular, float exponent) {
  BsdfCase c = single("hair_" + name, HairMaterial{gray(diffuse), gray(specular), number(exponent)});
  c.inside_too = c.fiber = true;
  return c;
}

BsdfCase hair_fiber(std::string name, const FiberOptics& fiber) {
  BsdfCase c = single("hair_fiber_" + name, HairFiberMaterial{make_fiber_table(fiber)});
  c.inside_too = c.fiber = true;
  return c;
}

// A table of a microfacet conductor, and of Lambert's law, which may be brighter than white.
std::string merl_of_conductor(float alpha) {
  return merl_bytes(24, 20, 16, [&](Vec3f o, Vec3f i) {
    const Vec3f m = normalize(o + i);
    return Rgb(0.9f, 0.6f, 0.3f) *
           (ggx_d(m, alpha, alpha) * ggx_g1(o, alpha, alpha) * ggx_g1(i, alpha, alpha) / (4 * o.z * i.z));
  });
}
std::string merl_of_diffuse(float reflectance) {
  return merl_bytes(4, 4, 4, [&](Vec3f, Vec3f) { return Rgb(1, 0.7f, 0.4f) * (reflectance * kInvPi); });
}
BsdfCase measured(std::string name, const std::string& bytes) {
  return single("measured_" + name, MeasuredMaterial{parse_measured(bytes, name, {})});
}

std::vector<BsdfCase> build() {
  std::vector<BsdfCase> list;
  list.push_back(single("diffuse", DiffuseMaterial{color(0.8f, 0.5f, 0.2f)}));
  list.push_back(single("diffuse_white", DiffuseMaterial{gray(1)}));
  list.back().lossless = true;
  list.push_back(single("null", NullMaterial{}));
  list.back().lossless = list.back().inside_too = true;
  list.push_back(oren_nayar("smoothish", 0.8f, 0.1f));
  list.push_back(oren_nayar("rough", 0.8f, 0.6f));
  list.push_back(single("conductor_smooth", conductor(kGgx, 0, 0)));
  list.push_back(single("conductor_ggx_0.01", conductor(kGgx, 0.01f, 0.01f)));
  list.push_back(single("conductor_ggx_0.3", conductor(kGgx, 0.3f, 0.3f)));
  list.push_back(single("conductor_ggx_0.9", conductor(kGgx, 0.9f, 0.9f)));
  list.push_back(single("conductor_ggx_anisotropic", conductor(kGgx, 0.08f, 0.4f)));
  list.push_back(single("conductor_ggx_brushed", conductor(kGgx, 0.03f, 0.6f)));
  list.push_back(single("conductor_beckmann_brushed", conductor(kBeckmann, 0.6f, 0.04f)));
  list.push_back(single("conductor_beckmann_0.02", conductor(kBeckmann, 0.02f, 0.02f)));
  list.push_back(single("conductor_beckmann_0.3", conductor(kBeckmann, 0.3f, 0.3f)));
  list.push_back(single("conductor_beckmann_0.9", conductor(kBeckmann, 0.9f, 0.9f)));
  list.push_back(single("conductor_beckmann_anisotropic", conductor(kBeckmann, 0.5f, 0.1f)));
  list.push_back(single("mirror_smooth", perfect_mirror(kGgx, 0)));
  list.back().lossless = true;
  list.push_back(single("mirror_ggx_0.2", perfect_mirror(kGgx, 0.2f)));
  list.push_back(single("mirror_beckmann_0.2", perfect_mirror(kBeckmann, 0.2f)));
  list.push_back(glass("dielectric_smooth", dielectric(kGgx, 1.5f, 0, 0)));
  list.push_back(glass("dielectric_diamond", dielectric(kGgx, 2.4f, 0, 0)));
  list.push_back(glass("dielectric_ggx_0.1", dielectric(kGgx, 1.5f, 0.1f, 0.1f)));
  list.push_back(glass("dielectric_ggx_0.5", dielectric(kGgx, 1.33f, 0.5f, 0.5f)));
  list.push_back(glass("dielectric_beckmann_0.3", dielectric(kBeckmann, 1.5f, 0.3f, 0.3f)));
  list.push_back(glass("dielectric_beckmann_anisotropic", dielectric(kBeckmann, 1.8f, 0.1f, 0.3f)));
  list.push_back(glass("dielectric_inverted", dielectric(kGgx, 0.75f, 0.2f, 0.2f)));
  list.push_back(single("thindielectric", ThinDielectricMaterial{1.5f, gray(1), gray(1)}));
  list.back().lossless = list.back().inside_too = true;
  list.push_back(single("slab_face", SlabFaceMaterial{1.5f, gray(1), gray(1)}));
  list.back().lossless = list.back().inside_too = true;
  list.push_back(single("plastic_smooth", plastic(kGgx, 0, false)));
  list.push_back(single("plastic_smooth_nonlinear", plastic(kGgx, 0, true)));
  list.push_back(single("plastic_beckmann_0.1", plastic(kBeckmann, 0.1f, false)));
  list.push_back(single("plastic_ggx_0.4_nonlinear", plastic(kGgx, 0.4f, true)));
  list.push_back(single("plastic_ggx_0.05", plastic(kGgx, 0.05f, false)));
  for (const float alpha : {0.16f, 1.0f}) {
    PlasticMaterial all = plastic(kGgx, alpha, false);
    all.lossless = true;
    list.push_back(single(alpha < 1 ? "plastic_ggx_0.16_lossless" : "plastic_ggx_1_lossless", all));
  }
  list.push_back(single("phong_30", PhongMaterial{gray(0.5f), gray(0.3f), number(30)}));
  list.push_back(single("phong_1000", PhongMaterial{gray(0.1f), gray(0.9f), number(1000)}));
  list.push_back(single("phong_0", PhongMaterial{gray(0), gray(1), number(0)}));
  list.push_back(ward("original", 0, 0.1f, 0.1f));
  list.push_back(ward("duer", 1, 0.15f, 0.3f));
  list.push_back(ward("balanced", 2, 0.15f, 0.3f));
  list.push_back(ward("balanced_brushed", 2, 0.04f, 0.4f));
  list.push_back(ward("balanced_sharp", 2, 0.02f, 0.02f));
  list.push_back(principled("plain", 0, 0, 0.5f, 0));
  list.push_back(principled("metal", 1, 0, 0.3f, 0));
  for (const float roughness : {0.5f, 1.0f}) {
    list.push_back(principled(roughness < 1 ? "metal_lossless" : "metal_rough_lossless", 1, 0, roughness, 0));
    std::get<PrincipledMaterial>(list.back().set.materials[0]).lossless = true;
    list.back().energy_exempt.clear();
  }
  list.push_back(principled("glass", 0, 1, 0.3f, 0));
  list.back().energy_exempt.clear();
  list.push_back(principled("everything", 0.3f, 0.4f, 0.4f, 0.5f));
  list.push_back(principled("opaque_extras", 0.2f, 0, 0.6f, 1));

  list.push_back(thin("leaf", 0, 0.8f, 0.5f, 0));
  list.push_back(thin("window", 1, 0, 0.3f, 0));
  list.push_back(thin("everything", 0.5f, 1.2f, 0.4f, 0.6f));
  list.back().energy_exempt = "sheen is added on top";
  list.push_back(
      single("diffuse_transmitter", DiffuseTransmitterMaterial{gray(0.4f), color(0.6f, 0.5f, 0.1f)}));
  list.back().inside_too = true;

  list.push_back(nested("coating_smooth_diffuse", DiffuseMaterial{gray(1)}, layer(kGgx, 0, 1.5f, 0, 1)));
  list.push_back(nested("coating_smooth_absorbing", DiffuseMaterial{color(0.8f, 0.5f, 0.2f)},
                        layer(kGgx, 0, 1.5f, 0.3f, 1)));
  list.push_back(nested("coating_rough_diffuse", DiffuseMaterial{gray(1)}, layer(kGgx, 0.3f, 1.5f, 0, 1)));
  list.push_back(nested("coating_smooth_mirror", perfect_mirror(kGgx, 0), layer(kGgx, 0, 1.5f, 0, 1)));
  list.back().lossless = true;
  list.push_back(nested("coating_smooth_metal", perfect_mirror(kGgx, 0.2f), layer(kGgx, 0, 1.5f, 0, 1)));
  list.push_back(
      nested("coating_rough_smooth_metal", conductor(kGgx, 0, 0), layer(kGgx, 0.3f, 1.5f, 0.1f, 1)));
  list.push_back(
      nested("coating_rough_metal", perfect_mirror(kBeckmann, 0.5f), layer(kBeckmann, 0.2f, 1.7f, 0, 1)));
  list.push_back(
      nested("coating_anisotropic_metal", conductor(kGgx, 0.08f, 0.4f), layer(kGgx, 0.05f, 1.33f, 0, 1)));
  list.push_back(
      nested("coating_half_metal", conductor(kGgx, 0.3f, 0.3f), layer(kGgx, 0.05f, 1.5f, 0.2f, 0.5f)));
  list.push_back(nested("clear_coat_diffuse", DiffuseMaterial{gray(1)}, clear_coat(0, 1)));
  list.push_back(nested("clear_coat_rough_half_metal", perfect_mirror(kGgx, 0.3f), clear_coat(0.2f, 0.5f)));
  list.push_back(nested("clear_coat_plastic", plastic(kGgx, 0.2f, false), clear_coat(0.1f, 1)));
  list.push_back(nested("coating_plastic", plastic(kGgx, 0.2f, true), layer(kGgx, 0, 1.6f, 0, 1)));
  list.push_back(nested("coating_sharp_mirror", perfect_mirror(kGgx, 0.05f), layer(kGgx, 0, 2, 0, 1)));
  list.push_back(
      nested("coating_sharp_beckmann_mirror", perfect_mirror(kBeckmann, 0.1f), layer(kGgx, 0, 1.2f, 0, 1)));
  list.push_back(nested("coating_phong", PhongMaterial{gray(0.5f), gray(0.3f), number(30)},
                        layer(kGgx, 0.2f, 1.5f, 0, 1)));
  list.push_back(nested("coating_ward", WardMaterial{2, gray(0.3f), gray(0.6f), number(0.15f), number(0.3f)},
                        layer(kBeckmann, 0, 1.5f, 0.1f, 1)));
  list.push_back(nested("coating_thinner_than_air", conductor(kGgx, 0.3f, 0.3f), layer(kGgx, 0, 0.8f, 0, 1)));
  list.push_back(
      nested("coating_glass", dielectric(kGgx, 1.5f, 0.1f, 0.1f), layer(kGgx, 0.2f, 1.4f, 0.1f, 1)));
  list.back().inside_too = true, list.back().eta = 1.5f;
  list.push_back(nested("coating_diffuse_transmitter", DiffuseTransmitterMaterial{gray(0.4f), gray(0.6f)},
                        layer(kGgx, 0.2f, 1.4f, 0, 1)));
  list.back().inside_too = true;
  BsdfCase coated_principled = principled("coated", 0.3f, 0.4f, 0.4f, 0.5f);
  coated_principled.set.materials.push_back(layer(kGgx, 0.1f, 1.5f, 0.1f, 0.8f));
  coated_principled.material = 1;
  list.push_back(coated_principled);

  for (const float roughness : {0.07f, 0.25f, 0.5f, 1.0f})
    list.push_back(nested("sheen_white_" + std::to_string(static_cast<int>(100 * roughness)),
                          DiffuseMaterial{gray(1)}, SheenMaterial{gray(1), number(roughness), 0}));
  list.push_back(nested("sheen_alone", DiffuseMaterial{gray(0)},
                        SheenMaterial{color(0.9f, 0.5f, 0.1f), number(0.3f), 0}));
  list.push_back(nested("sheen_plastic", plastic(kGgx, 0.3f, true),
                        SheenMaterial{color(0.2f, 0.8f, 0.4f), number(0.4f), 0}));
  list.push_back(
      nested("sheen_metal", conductor(kGgx, 0.08f, 0.4f), SheenMaterial{gray(0.7f), number(0.6f), 0}));
  list.push_back(nested("sheen_mirror", perfect_mirror(kGgx, 0), SheenMaterial{gray(0.7f), number(0.6f), 0}));
  for (const float alpha : {0.0f, 0.3f}) {
    BsdfCase coated_sheen = nested(alpha == 0 ? "sheen_coated" : "sheen_coated_rough",
                                   plastic(kGgx, 0.2f, true), SheenMaterial{gray(1), number(0.8f), 0});
    coated_sheen.set.materials.push_back(layer(kGgx, alpha, 1.5f, 0.1f * alpha, 1));
    std::get<CoatingMaterial>(coated_sheen.set.materials.back()).nested = 1;
    coated_sheen.material = 2;
    list.push_back(coated_sheen);
  }
  list.push_back(measured("diffuse", merl_of_diffuse(0.8f)));
  list.push_back(measured("too_bright", merl_of_diffuse(2)));
  list.push_back(measured("conductor_0.1", merl_of_conductor(0.1f)));
  list.push_back(measured("conductor_0.5", merl_of_conductor(0.5f)));
  list.push_back(nested("coating_measured", MeasuredMaterial{parse_measured(merl_of_conductor(0.3f), "", {})},
                        layer(kGgx, 0.1f, 1.5f, 0.1f, 1)));
  list.push_back(hair("diffuse", 1, 0, 0));
  list.push_back(hair("specular_0", 0, 1, 0));
  list.push_back(hair("specular_3", 0, 1, 3));
  list.push_back(hair("specular_2000", 0, 1, 2000));
  list.push_back(hair("brown", 0.4f, 0.2f, 40));
  list.push_back(hair_fiber("clear", {Rgb(0), 1.55f, 0.3f, 0.3f, 0}));
  list.push_back(hair_fiber("brown", {Rgb(0.4f, 0.7f, 1.6f), 1.55f, 0.25f, 0.4f, 0.05f}));
  list.push_back(hair_fiber("dark_smooth", {Rgb(3, 5, 8), 1.4f, 0.08f, 0.05f, 0.1f}));
  list.push_back(hair_fiber("rough", {Rgb(0.1f), 1.6f, 0.9f, 0.9f, -0.3f}));
  list.push_back(hair_fiber("sharpest", {Rgb(0.5f), 1.5f, 0, 0, 0}));
  list.push_back(hair_fiber("roughest_thin", {Rgb(0), 0.8f, 1, 1, 0}));
  list.push_back(
      nested("mask_hair", HairMaterial{gray(0.3f), gray(0.5f), number(20)}, MaskMaterial{number(0.6f), 0}));
  list.back().inside_too = list.back().fiber = true;

  list.push_back(nested("mask_half", DiffuseMaterial{gray(0.5f)}, MaskMaterial{number(0.5f), 0}));
  list.push_back(nested("mask_plastic", plastic(kGgx, 0.2f, false), MaskMaterial{number(0.7f), 0}));
  list.push_back(
      nested("twosided_diffuse", DiffuseMaterial{color(0.8f, 0.5f, 0.2f)}, TwoSidedMaterial{0, 0}));
  list.back().inside_too = true;
  list.push_back(nested("twosided_conductor", conductor(kBeckmann, 0.2f, 0.4f), TwoSidedMaterial{0, 0}));
  list.back().inside_too = true;

  BsdfCase two = nested("twosided_different", DiffuseMaterial{gray(0.8f)}, plastic(kGgx, 0.1f, false));
  two.set.materials.push_back(TwoSidedMaterial{0, 1});
  two.material = 2;
  two.inside_too = true;
  list.push_back(two);

  BsdfCase mix = nested("mixture", plastic(kGgx, 0.3f, false), conductor(kGgx, 0.1f, 0.1f));
  mix.set.materials.push_back(MixtureMaterial{{{number(0.4f), false, 0}, {number(0.4f), true, 1}}});
  mix.material = 2;
  list.push_back(mix);

  BsdfCase bump = nested("bumpmap", plastic(kGgx, 0.3f, false), BumpMaterial{0, 0.5f, 0});
  bump.set.textures.textures.push_back(bitmap(
      4, 4, [](int x, int y) { return Rgb(0.1f * static_cast<float>(x) + 0.05f * static_cast<float>(y)); }));
  list.push_back(bump);

  BsdfCase normal = nested("normalmap", DiffuseMaterial{gray(0.7f)}, NormalMapMaterial{0, 1, false, 0});
  normal.set.textures.textures.push_back(ConstantTexture{{0.7f, 0.4f, 0.9f}});
  list.push_back(normal);

  BsdfCase textured = single("diffuse_textured", DiffuseMaterial{ColorInput{Rgb(0), 0}});
  textured.set.textures.textures.push_back(bitmap(2, 2, [](int x, int y) {
    return Rgb(0.2f + 0.3f * static_cast<float>(x), 0.5f, 0.4f * static_cast<float>(y));
  }));
  list.push_back(textured);
  list.push_back(single("conductor_ggx_brushed_less", conductor(kGgx, 0.05f, 0.33f)));
  list.push_back(glass("dielectric_ggx_0.33", dielectric(kGgx, 1.5f, 0.33f, 0.33f)));
  PlasticMaterial brushed = plastic(kGgx, 0.1f, false);
  brushed.lossless = true, brushed.stretch = number(0.7f);
  list.push_back(nested("turned_plastic", brushed, TurnedTangentMaterial{{Rgb(0.9f, 0.8f, 0), -1}, 1, 0}));
  BsdfCase stretched = principled("metal_stretched", 1, 0, 0.5f, 0);
  std::get<PrincipledMaterial>(stretched.set.materials[0]).stretch = number(0.6f);
  list.push_back(stretched);
  return list;
}

}  // namespace

const std::vector<BsdfCase>& bsdf_list() {
  static const std::vector<BsdfCase> list = build();
  return list;
}

SurfacePoint point_with_normal(Vec3f n) {
  SurfacePoint p;
  p.ng = n;
  p.shading = Frame::from_normal(n);
  p.dpdu = p.shading.s;
  p.dpdv = p.shading.t;
  p.uv.uv = {0.375f, 0.625f};
  return p;
}

Vec3f at_angle(float cos_theta, float phi) {
  const float s = std::sqrt(std::max(0.0f, 1 - cos_theta * cos_theta));
  return {s * std::cos(phi), s * std::sin(phi), cos_theta};
}

}  // namespace lumirank::scatter
