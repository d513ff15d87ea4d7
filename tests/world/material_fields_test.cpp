// The material of a description has each field in the member of the same name.
#include <gtest/gtest.h>

#include "world/scene_maker.h"

namespace lumirank::world {
namespace {

using namespace test;
namespace sc = scatter;

// Gives every field a value that no other one has; those of the fields that are indices stay.
class DistinctValues {
 public:
  template <typename Desc>
  Desc of() {
    Desc desc;
    sd::for_each_field(desc, [&](const auto&, auto& value) { set(value); });
    return desc;
  }

 private:
  // Within [1/2, 1), where every field may lie.
  float next() { return 0.5f + static_cast<float>(++count_) / 64; }
  void set(float& v) { v = next(); }
  void set(Rgb& v) {
    const float r = next(), g = next();
    v = Rgb(r, g, next());
  }
  void set(sd::ColorInput& v) { set(v.value); }
  void set(sd::FloatInput& v) { v.value = next(); }
  void set(bool& v) { v = !v; }
  void set(sd::Distribution& v) { v = sd::Distribution::ggx; }  // not the default
  void set(sd::WardDesc::Variant& v) { v = sd::WardDesc::Variant::ward_duer; }
  void set(int&) {}
  void set(sd::FileInput&) {}

  int count_ = 0;
};

void expect_same(const char* name, float made, float described) { EXPECT_EQ(made, described) << name; }
void expect_same(const char* name, bool made, bool described) { EXPECT_EQ(made, described) << name; }
void expect_same(const char* name, Rgb made, Rgb described) { EXPECT_EQ(made, described) << name; }
template <typename Made, typename Described>
void expect_same(const char* name, const Made& made, const Described& described) {
  if constexpr (requires { made.texture; }) {
    EXPECT_EQ(made.value, described.value) << name;
    EXPECT_EQ(made.texture, -1) << name;
  } else {
    const bool ggx = described == Described::ggx;
    EXPECT_EQ(made, ggx ? sc::NormalDistribution::ggx : sc::NormalDistribution::beckmann) << name;
  }
}

// The material that the world makes of it: `below` is nested in it.
template <typename Material, typename Desc>
Material material_of(Desc d, int* below = nullptr) {
  auto desc = empty_scene();
  add_emitter(desc, sd::PointLightDesc{});
  // Behind others, so that its index is not 0.
  for (int i = 0; i < 3; ++i) {
    const int shape = add_shape(desc, sd::RectangleDesc{});
    desc.shapes[static_cast<std::size_t>(shape)].bsdf = add_bsdf(desc, sd::DiffuseDesc{});
  }
  if constexpr (requires { d.nested; }) d.nested = add_bsdf(desc, sd::DiffuseDesc{});
  if constexpr (requires { d.texture; }) d.texture = add_texture(desc, sd::VertexColorTextureDesc{});
  const int shape = add_shape(desc, sd::RectangleDesc{});
  desc.shapes[static_cast<std::size_t>(shape)].bsdf = add_bsdf(desc, std::move(d));
  const World w = build(desc);
  if (below) *below = 3;
  return std::get<Material>(w.materials().materials[w.rays().placements()[3].material]);
}

#define SAME(member) expect_same(#member, m.member, d.member)

TEST(MaterialFields, OfDiffuseKinds) {
  {
    const auto d = DistinctValues().of<sd::DiffuseDesc>();
    const auto m = material_of<sc::DiffuseMaterial>(d);
    SAME(reflectance);
  }
  {
    const auto d = DistinctValues().of<sd::RoughDiffuseDesc>();
    const auto m = material_of<sc::RoughDiffuseMaterial>(d);
    SAME(reflectance), SAME(alpha);
  }
  {
    const auto d = DistinctValues().of<sd::DiffuseTransmitterDesc>();
    const auto m = material_of<sc::DiffuseTransmitterMaterial>(d);
    SAME(reflectance), SAME(transmittance);
  }
}

TEST(MaterialFields, OfMicrofacetKinds) {
  {
    const auto d = DistinctValues().of<sd::ConductorDesc>();
    const auto m = material_of<sc::ConductorMaterial>(d);
    SAME(eta), SAME(k), SAME(specular_reflectance), SAME(distribution), SAME(alpha_u), SAME(alpha_v);
    EXPECT_FALSE(m.smooth);
  }
  {
    const auto d = DistinctValues().of<sd::DielectricDesc>();
    const auto m = material_of<sc::DielectricMaterial>(d);
    SAME(eta), SAME(specular_reflectance), SAME(specular_transmittance);
    SAME(distribution), SAME(alpha_u), SAME(alpha_v);
    EXPECT_FALSE(m.smooth);
  }
  {
    const auto d = DistinctValues().of<sd::ThinDielectricDesc>();
    const auto m = material_of<sc::ThinDielectricMaterial>(d);
    SAME(eta), SAME(specular_reflectance), SAME(specular_transmittance);
  }
  // Four flags: each by itself.
  for (const int flag : {0, 1, 2, 3}) {
    auto d = DistinctValues().of<sd::PlasticDesc>();
    d.nonlinear = flag == 0, d.lossless = flag == 1, d.schlick = flag == 2, d.as_mitsuba_3 = flag == 3;
    const auto m = material_of<sc::PlasticMaterial>(d);
    SAME(eta), SAME(diffuse_reflectance), SAME(specular_reflectance);
    SAME(nonlinear), SAME(distribution), SAME(alpha), SAME(lossless), SAME(schlick), SAME(as_mitsuba_3),
        SAME(stretch);
    EXPECT_FALSE(m.smooth);
  }
}

// Their constant roughness is 0 without being told.
TEST(MaterialFields, SmoothIsWhatHasNoRoughness) {
  EXPECT_TRUE(material_of<sc::ConductorMaterial>(sd::ConductorDesc{}).smooth);
  EXPECT_TRUE(material_of<sc::DielectricMaterial>(sd::DielectricDesc{}).smooth);
  EXPECT_TRUE(material_of<sc::PlasticMaterial>(sd::PlasticDesc{}).smooth);
  EXPECT_TRUE(material_of<sc::CoatingMaterial>(sd::CoatingDesc{}).smooth);
  sd::ConductorDesc brushed;
  brushed.alpha_v.value = 0.1f;
  EXPECT_FALSE(material_of<sc::ConductorMaterial>(brushed).smooth);
}

TEST(MaterialFields, OfPhenomenologicalKinds) {
  {
    const auto d = DistinctValues().of<sd::PhongDesc>();
    const auto m = material_of<sc::PhongMaterial>(d);
    SAME(diffuse_reflectance), SAME(specular_reflectance), SAME(exponent);
  }
  {
    const auto d = DistinctValues().of<sd::WardDesc>();
    const auto m = material_of<sc::WardMaterial>(d);
    EXPECT_EQ(m.variant, 1);
    SAME(diffuse_reflectance), SAME(specular_reflectance), SAME(alpha_u), SAME(alpha_v);
  }
}

TEST(MaterialFields, OfPrincipledKinds) {
  {
    const auto d = DistinctValues().of<sd::PrincipledDesc>();
    const auto m = material_of<sc::PrincipledMaterial>(d);
    SAME(base_color), SAME(roughness), SAME(anisotropic), SAME(metallic), SAME(spec_trans), SAME(spec_tint);
    SAME(sheen), SAME(sheen_tint), SAME(clearcoat), SAME(clearcoat_gloss), SAME(flatness), SAME(eta);
    SAME(lossless), SAME(stretch);
  }
  {
    const auto d = DistinctValues().of<sd::PrincipledThinDesc>();
    const auto m = material_of<sc::PrincipledThinMaterial>(d);
    SAME(base_color), SAME(roughness), SAME(anisotropic), SAME(spec_trans), SAME(spec_tint);
    SAME(sheen), SAME(sheen_tint), SAME(flatness), SAME(diff_trans), SAME(eta);
  }
}

TEST(MaterialFields, OfKindsOverOthers) {
  int below = -1;
  {
    const auto d = DistinctValues().of<sd::CoatingDesc>();
    const auto m = material_of<sc::CoatingMaterial>(d, &below);
    SAME(eta), SAME(specular_reflectance), SAME(absorption), SAME(weight);
    SAME(distribution), SAME(alpha_u), SAME(alpha_v), SAME(straight);
    EXPECT_FALSE(m.smooth);
    EXPECT_EQ(m.nested, below);
  }
  {
    const auto d = DistinctValues().of<sd::SheenDesc>();
    const auto m = material_of<sc::SheenMaterial>(d, &below);
    SAME(color), SAME(roughness);
    EXPECT_EQ(m.nested, below);
  }
  {
    const auto d = DistinctValues().of<sd::MaskDesc>();
    const auto m = material_of<sc::MaskMaterial>(d, &below);
    SAME(opacity);
    EXPECT_EQ(m.nested, below);
  }
  {
    const auto d = DistinctValues().of<sd::BumpMapDesc>();
    const auto m = material_of<sc::BumpMaterial>(d, &below);
    SAME(scale);
    EXPECT_EQ(m.texture, 0);
    EXPECT_EQ(m.nested, below);
  }
  {
    const auto d = DistinctValues().of<sd::TurnedTangentDesc>();
    const auto m = material_of<sc::TurnedTangentMaterial>(d, &below);
    SAME(direction), SAME(angle);
    EXPECT_EQ(m.nested, below);
  }
  {
    const auto d = DistinctValues().of<sd::NormalMapDesc>();
    const auto m = material_of<sc::NormalMapMaterial>(d, &below);
    SAME(scale), SAME(follow_uv);
    EXPECT_EQ(m.texture, 0);
    EXPECT_EQ(m.nested, below);
  }
}

TEST(MaterialFields, OfTwoSides) {
  auto desc = empty_scene();
  add_emitter(desc, sd::PointLightDesc{});
  const int front = add_bsdf(desc, sd::DiffuseDesc{}), back = add_bsdf(desc, sd::PhongDesc{});
  const int shape = add_shape(desc, sd::RectangleDesc{});
  desc.shapes[static_cast<std::size_t>(shape)].bsdf = add_bsdf(desc, sd::TwoSidedDesc{front, back});
  const World w = build(desc);
  const auto& all = w.materials().materials;
  const auto& m = std::get<sc::TwoSidedMaterial>(all[w.rays().placements()[0].material]);
  EXPECT_TRUE(std::holds_alternative<sc::DiffuseMaterial>(all[static_cast<std::size_t>(m.front)]));
  EXPECT_TRUE(std::holds_alternative<sc::PhongMaterial>(all[static_cast<std::size_t>(m.back)]));
}

TEST(MaterialFields, OfHair) {
  const auto d = DistinctValues().of<sd::HairDesc>();
  auto desc = empty_scene();
  add_emitter(desc, sd::PointLightDesc{});
  sd::CurvesDesc rod;
  rod.basis = sd::CurvesDesc::Basis::linear;
  rod.points = {{0, 0, 0}, {1, 0, 0}};
  rod.radii = {0.1f, 0.1f};
  rod.first = {0, 2};
  const int shape = add_shape(desc, std::move(rod));
  desc.shapes[static_cast<std::size_t>(shape)].bsdf = add_bsdf(desc, d);
  const World w = build(desc);
  const auto m = std::get<sc::HairMaterial>(w.materials().materials[w.rays().placements()[0].material]);
  SAME(diffuse_reflectance), SAME(specular_reflectance), SAME(exponent);
}

TEST(MaterialFields, HairOfTheSameOpticsHasOneTable) {
  auto desc = empty_scene();
  add_emitter(desc, sd::PointLightDesc{});
  for (const float tilt : {2.0f, 2.0f, 3.0f}) {
    sd::CurvesDesc rod;
    rod.basis = sd::CurvesDesc::Basis::linear;
    rod.points = {{0, 0, 0}, {1, 0, 0}}, rod.radii = {0.1f, 0.1f}, rod.first = {0, 2};
    const int shape = add_shape(desc, std::move(rod));
    sd::HairFiberDesc hair;
    hair.tilt = tilt;
    desc.shapes[static_cast<std::size_t>(shape)].bsdf = add_bsdf(desc, hair);
  }
  // On what is no fiber it is the color of what has been inside.
  const int ball = add_shape(desc, sd::SphereDesc{});
  desc.shapes[static_cast<std::size_t>(ball)].bsdf = 0;
  const World w = build(desc);
  const auto& all = w.materials().materials;
  const auto table = [&](std::size_t placement) {
    return std::get<sc::HairFiberMaterial>(all[w.rays().placements()[placement].material]).table;
  };
  EXPECT_EQ(table(0), table(1));
  EXPECT_NE(table(0), table(2));
  EXPECT_TRUE(std::holds_alternative<sc::DiffuseMaterial>(all[w.rays().placements()[3].material]));
}

#undef SAME

}  // namespace
}  // namespace lumirank::world
