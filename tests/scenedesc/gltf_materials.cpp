// glTF materials, textures, lights and cameras, and what becomes of every extension.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gltf_maker.h"

namespace lumirank::scenedesc {
namespace {

using json = nlohmann::json;

// The square with one material.
GltfMaker with_material(const json& material) {
  GltfMaker m = square();
  m.root["materials"] = json::array({material});
  m.root["meshes"][0]["primitives"][0]["material"] = 0;
  return m;
}

// Textures 0 and 1 show images 0 and 1 of the file: a PNG and a JPEG by their first bytes; nothing here reads
// further.
void add_images(GltfMaker& m) {
  m.root["images"] = {{{"uri", "data:image/png;base64," + base64("\x89PNG\r\n\x1a\n....")}},
                      {{"uri", "data:image/jpeg;base64," + base64("\xff\xd8\xff....")}}};
  m.root["textures"] = {{{"source", 0}}, {{"source", 1}}};
}

// The BSDF below a chain of wrappers of one nested BSDF each; `Kind` ends the chain.
template <typename Kind>
const Kind* find_bsdf(const SceneDesc& scene) {
  for (const BsdfDesc& b : scene.bsdfs)
    if (const auto* found = std::get_if<Kind>(&b.kind)) return found;
  return nullptr;
}
template <typename Kind>
const Kind& top_bsdf(const SceneDesc& scene) {
  return std::get<Kind>(scene.bsdfs.at(static_cast<std::size_t>(scene.shapes.at(0).bsdf)).kind);
}

TEST(GltfMaterial, TheDefaultIsAWhiteRoughMetal) {
  const SceneDesc scene = parse(square());
  const auto& both = top_bsdf<TwoSidedDesc>(scene);
  EXPECT_EQ(both.front, both.back);
  const auto& metal = std::get<PrincipledDesc>(scene.bsdfs.at(static_cast<std::size_t>(both.front)).kind);
  EXPECT_EQ(metal.base_color.value, Rgb(1));
  EXPECT_EQ(metal.metallic.value, 1);
  EXPECT_EQ(metal.roughness.value, 1);
}

TEST(GltfMaterial, DielectricsAreRoughPlasticOfIndexOneAndAHalf) {
  const SceneDesc scene = parse(with_material(
      {{"pbrMetallicRoughness",
        {{"baseColorFactor", {0.25, 0.5, 1, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0.5}}}}));
  const auto* plastic = find_bsdf<PlasticDesc>(scene);
  ASSERT_NE(plastic, nullptr);
  EXPECT_EQ(plastic->eta, 1.5f);
  EXPECT_EQ(plastic->alpha.value, 0.25f) << "roughness squared";
  EXPECT_EQ(plastic->distribution, Distribution::ggx);
  EXPECT_EQ(plastic->diffuse_reflectance.value, Rgb(0.25f, 0.5f, 1));
  EXPECT_EQ(find_bsdf<PrincipledDesc>(scene), nullptr);
}

TEST(GltfMaterial, MetallicMixesTheTwo) {
  const SceneDesc scene = parse(with_material({{"pbrMetallicRoughness", {{"metallicFactor", 0.25}}}}));
  const auto* mixture = find_bsdf<MixtureDesc>(scene);
  ASSERT_NE(mixture, nullptr);
  ASSERT_EQ(mixture->parts.size(), 2u);
  EXPECT_EQ(mixture->parts[0].weight.value, 0.25f);
  EXPECT_FALSE(mixture->parts[0].complement);
  EXPECT_TRUE(mixture->parts[1].complement);
  const auto kind = [&](std::size_t k) {
    return scene.bsdfs.at(static_cast<std::size_t>(mixture->parts[k].bsdf)).kind.index();
  };
  EXPECT_EQ(kind(0), decltype(BsdfDesc::kind)(PrincipledDesc{}).index());
  EXPECT_EQ(kind(1), decltype(BsdfDesc::kind)(PlasticDesc{}).index());
}

TEST(GltfMaterial, TexturesWithTheirChannelsFactorsAndSamplers) {
  GltfMaker m = with_material({{"pbrMetallicRoughness",
                                {{"baseColorTexture", {{"index", 0}}},
                                 {"baseColorFactor", {0.5, 1, 1, 1}},
                                 {"metallicRoughnessTexture", {{"index", 1}}},
                                 {"roughnessFactor", 0.5}}}});
  add_images(m);
  m.root["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
  m.root["textures"][0]["sampler"] = 0;
  const SceneDesc scene = parse(m);
  const auto* metal = find_bsdf<PrincipledDesc>(scene);
  ASSERT_NE(metal, nullptr);
  const auto texture = [&](int k) { return scene.textures.at(static_cast<std::size_t>(k)).kind; };
  const auto base = std::get<ScaleTextureDesc>(texture(metal->base_color.texture));
  EXPECT_EQ(base.scale, Rgb(0.5f, 1, 1));
  const auto image = std::get<BitmapTextureDesc>(texture(base.input.texture));
  EXPECT_FALSE(image.raw);
  EXPECT_EQ(image.channel, TextureChannel::rgb);
  EXPECT_EQ(image.wrap_u, WrapMode::clamp);
  EXPECT_EQ(image.wrap_v, WrapMode::mirror);
  EXPECT_EQ(image.filter, FilterMode::nearest);
  ASSERT_TRUE(image.bytes);
  EXPECT_TRUE(image.bytes->starts_with("\x89PNG"));
  const auto rough = std::get<ScaleTextureDesc>(texture(metal->roughness.texture));
  EXPECT_EQ(rough.scale, Rgb(0.5f));
  const auto green = std::get<BitmapTextureDesc>(texture(rough.input.texture));
  EXPECT_TRUE(green.raw);
  EXPECT_EQ(green.channel, TextureChannel::green);
  const auto* mixture = find_bsdf<MixtureDesc>(scene);
  ASSERT_NE(mixture, nullptr);
  EXPECT_EQ(std::get<BitmapTextureDesc>(texture(mixture->parts[0].weight.texture)).channel,
            TextureChannel::blue);
  // Plastic wants the square.
  const auto* plastic = find_bsdf<PlasticDesc>(scene);
  const auto square_of = std::get<ProductTextureDesc>(texture(plastic->alpha.texture));
  EXPECT_EQ(square_of.a.texture, metal->roughness.texture);
  EXPECT_EQ(square_of.b.texture, metal->roughness.texture);
}

// uv (u, v) of glTF is the point (u, 1 - v) of Lumirank's picture; offset, then a quarter turn
// counter-clockwise (towards smaller v), then scale.
TEST(GltfMaterial, TextureTransforms) {
  const auto transform_of = [](const json& extension) {
    GltfMaker m = with_material(
        {{"pbrMetallicRoughness",
          {{"baseColorTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", extension}}}}}}}});
    add_images(m);
    const SceneDesc scene = parse(m);
    return std::get<BitmapTextureDesc>(scene.textures.at(0).kind).to_uv;
  };
  const auto at = [](const UvTransform& t, float u, float v) {
    return Vec2f{t.m[0] * u + t.m[1] * v + t.m[2], t.m[3] * u + t.m[4] * v + t.m[5]};
  };
  EXPECT_EQ(at(transform_of(json::object()), 0.25f, 0.75f), (Vec2f{0.25f, 0.25f}));
  const UvTransform t =
      transform_of({{"offset", {0.5, 0.25}}, {"rotation", std::acos(0.0)}, {"scale", {2, 4}}});
  // (1, 0) → (2, 0) → (0, -2) → (0.5, -1.75), upside down 2.75; (0, 1) → (0, 4) → (4, 0) → (4.5, 0.25), 0.75.
  EXPECT_NEAR(at(t, 1, 0).x, 0.5f, 1e-6f);
  EXPECT_NEAR(at(t, 1, 0).y, 2.75f, 1e-6f);
  EXPECT_NEAR(at(t, 0, 1).x, 4.5f, 1e-6f);
  EXPECT_NEAR(at(t, 0, 1).y, 0.75f, 1e-6f);
}

TEST(GltfMaterial, UvSetsAndVertexColors) {
  GltfMaker m =
      with_material({{"pbrMetallicRoughness",
                      {{"baseColorTexture", {{"index", 0}, {"texCoord", 1}}}, {"metallicFactor", 0}}}});
  add_images(m);
  auto& attributes = m.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["TEXCOORD_0"] = m.accessor("VEC2", std::vector<float>{0, 0, 0, 0, 0, 0, 0, 0});
  attributes["TEXCOORD_1"] = m.accessor("VEC2", std::vector<float>{7, 8, 0, 0, 0, 0, 0, 0});
  attributes["COLOR_0"] = m.accessor("VEC3", std::vector<float>{1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0});
  const SceneDesc scene = parse(m);
  EXPECT_EQ(mesh_of(scene).uvs[0], (Vec2f{7, 8}));
  EXPECT_EQ(mesh_of(scene).colors[0], Rgb(1, 0, 0));
  const auto* plastic = find_bsdf<PlasticDesc>(scene);
  ASSERT_NE(plastic, nullptr);
  const auto& kind = scene.textures.at(static_cast<std::size_t>(plastic->diffuse_reflectance.texture)).kind;
  EXPECT_TRUE(std::holds_alternative<ProductTextureDesc>(kind));
}

TEST(GltfMaterial, NormalMapsCutOutsAndBlending) {
  GltfMaker m = with_material({{"normalTexture", {{"index", 0}, {"scale", 0.5}}},
                               {"alphaMode", "MASK"},
                               {"alphaCutoff", 0.25},
                               {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  add_images(m);
  SceneDesc scene = parse(m);
  const auto* map = find_bsdf<NormalMapDesc>(scene);
  ASSERT_NE(map, nullptr);
  EXPECT_EQ(map->scale, 0.5f);
  EXPECT_TRUE(map->follow_uv);
  const auto texture = [&](int k) { return scene.textures.at(static_cast<std::size_t>(k)).kind; };
  const auto cut = std::get<ThresholdTextureDesc>(texture(top_bsdf<MaskDesc>(scene).opacity.texture));
  EXPECT_EQ(cut.threshold, 0.25f);
  const auto alpha = std::get<BitmapTextureDesc>(texture(cut.input.texture));
  EXPECT_EQ(alpha.channel, TextureChannel::alpha);
  EXPECT_TRUE(alpha.alpha_may_lack);

  m.root["materials"][0]["alphaMode"] = "BLEND";
  m.root["materials"][0]["pbrMetallicRoughness"] = {{"baseColorFactor", {1, 1, 1, 0.5}}};
  scene = parse(m);
  EXPECT_EQ(top_bsdf<MaskDesc>(scene).opacity.value, 0.5f);
  // A JPEG file has no alpha.
  m.root["materials"][0]["pbrMetallicRoughness"] = {{"baseColorTexture", {{"index", 1}}}};
  scene = parse(m);
  EXPECT_EQ(find_bsdf<MaskDesc>(scene), nullptr);
}

TEST(GltfMaterial, EmissionHasItsStrength) {
  GltfMaker m =
      with_material({{"emissiveFactor", {1, 0.5, 0}},
                     {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}}});
  SceneDesc scene = parse(m);
  ASSERT_TRUE(scene.shapes[0].emitter);
  EXPECT_EQ(scene.shapes[0].emitter->radiance.value, Rgb(8, 4, 0));
  m.root["materials"][0]["emissiveTexture"]["index"] = 0;
  add_images(m);
  scene = parse(m);
  EXPECT_NE(scene.shapes[0].emitter->radiance.texture, kNone);
  m.root["materials"][0]["emissiveFactor"] = {0, 0, 0};
  scene = parse(m);
  EXPECT_FALSE(scene.shapes[0].emitter);
}

TEST(GltfMaterial, Transmission) {
  const json glass = {{"baseColorFactor", {0.5, 1, 1, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0}};
  GltfMaker m = with_material({{"pbrMetallicRoughness", glass},
                               {"extensions",
                                {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                                 {"KHR_materials_ior", {{"ior", 1.25}}}}}});
  SceneDesc scene = parse(m);
  const auto& thin = top_bsdf<ThinDielectricDesc>(scene);
  EXPECT_EQ(thin.eta, 1.25f);
  EXPECT_EQ(thin.specular_transmittance.value, Rgb(0.5f, 1, 1));
  m.root["materials"][0]["extensions"]["KHR_materials_volume"]["thicknessFactor"] = 1;
  scene = parse(m);
  EXPECT_EQ(top_bsdf<DielectricDesc>(scene).eta, 1.25f);
  m.root["materials"][0]["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.75;
  scene = parse(m);
  const auto& mixture = top_bsdf<MixtureDesc>(scene);
  EXPECT_EQ(mixture.parts[0].weight.value, 0.75f);
  EXPECT_EQ(find_bsdf<PlasticDesc>(scene)->eta, 1.25f);
}

// Of white light the color is left after the distance, in solids alone.
TEST(GltfMaterial, VolumesAbsorb) {
  GltfMaker m = with_material(
      {{"name", "wine"},
       {"extensions",
        {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
         {"KHR_materials_volume",
          {{"thicknessFactor", 1}, {"attenuationDistance", 0.5}, {"attenuationColor", {1, 0.25, 0.5}}}}}}});
  json& extensions = m.root["materials"][0]["extensions"];
  const SceneDesc scene = parse(m);
  ASSERT_EQ(scene.media.size(), 1u);
  const MediumDesc& wine = scene.media[0];
  EXPECT_EQ(wine.id, "wine");
  EXPECT_EQ(wine.form, MediumDesc::Form::extinction_and_albedo);
  EXPECT_TRUE(wine.homogeneous());
  EXPECT_EQ(wine.extinction.value.r, 0);
  EXPECT_NEAR(wine.extinction.value.g, 2 * std::log(4.0), 1e-5);
  EXPECT_NEAR(wine.extinction.value.b, 2 * std::log(2.0), 1e-5);
  EXPECT_EQ(wine.albedo.value, Rgb(0));
  const MediumInterfaceDesc& media = scene.shapes[0].media;
  EXPECT_TRUE(media.divides);
  EXPECT_EQ(media.inside, 0);
  EXPECT_EQ(media.outside, kNone);
  EXPECT_EQ(warning_about(scene, ""), nullptr);
  const auto is_clear = [&] {
    const SceneDesc clear = parse(m);
    return clear.media.empty() && !clear.shapes[0].media.divides;
  };
  json& volume = extensions["KHR_materials_volume"];
  for (const char* key : {"thicknessFactor", "attenuationDistance", "attenuationColor"}) {
    const json kept = volume[key];
    volume.erase(key);
    EXPECT_TRUE(is_clear()) << key;
    volume[key] = kept;
  }
  // Nothing is left of a channel of 0; above 1 would be light from nowhere.
  volume["attenuationColor"] = {0, 1, 2};
  const SceneDesc odd = parse(m);
  EXPECT_GT(odd.media.at(0).extinction.value.r, 100);
  EXPECT_TRUE(std::isfinite(odd.media.at(0).extinction.value.r));
  EXPECT_EQ(odd.media.at(0).extinction.value.b, 0);
  EXPECT_NE(warning_about(odd, "attenuation color above 1"), nullptr);
  extensions["KHR_materials_transmission"]["transmissionFactor"] = 0;
  EXPECT_TRUE(is_clear());
}

TEST(GltfMaterial, AlikeVolumesAreOneMedium) {
  const auto glass = [](double blue) {
    return json{
        {"extensions",
         {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
          {"KHR_materials_volume",
           {{"thicknessFactor", 1}, {"attenuationDistance", 2}, {"attenuationColor", {1, 1, blue}}}}}}};
  };
  GltfMaker m = square();
  m.root["materials"] = {glass(0.5), glass(0.25), glass(0.5)};
  json& primitives = m.root["meshes"][0]["primitives"];
  for (int k = 0; k < 3; ++k) {
    primitives[static_cast<std::size_t>(k)] = primitives[0];
    primitives[static_cast<std::size_t>(k)]["material"] = k;
  }
  const SceneDesc scene = parse(m);
  EXPECT_EQ(scene.media.size(), 2u);
  EXPECT_EQ(scene.shapes.at(0).media.inside, 0);
  EXPECT_EQ(scene.shapes.at(1).media.inside, 1);
  EXPECT_EQ(scene.shapes.at(2).media.inside, 0);
}

TEST(GltfMaterial, SpecularClearCoatSheenUnlit) {
  const json matt = {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}, {"metallicFactor", 0}};
  GltfMaker m = with_material({{"pbrMetallicRoughness", matt},
                               {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}});
  SceneDesc scene = parse(m);
  EXPECT_NE(find_bsdf<DiffuseDesc>(scene), nullptr) << "no reflection, so Lambert's law alone";
  EXPECT_EQ(find_bsdf<PlasticDesc>(scene), nullptr);
  m.root["materials"][0]["extensions"] = {
      {"KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorFactor", {1, 0.5, 0}}}}};
  scene = parse(m);
  EXPECT_EQ(find_bsdf<PlasticDesc>(scene)->specular_reflectance.value, Rgb(1, 0.5f, 0));
  EXPECT_EQ(find_bsdf<MixtureDesc>(scene)->parts[0].weight.value, 0.5f);

  // Twice the 0.04 of an index of 1.5 in red, half of it in blue.
  auto& specular = m.root["materials"][0]["extensions"]["KHR_materials_specular"];
  specular = {{"specularColorFactor", {2, 1, 0.5}}};
  scene = parse(m);
  const auto* shiny = find_bsdf<PlasticDesc>(scene);
  EXPECT_NEAR(std::pow((shiny->eta - 1) / (shiny->eta + 1), 2), 0.08, 1e-5);
  EXPECT_NEAR(shiny->specular_reflectance.value.r, 1, 1e-5);
  EXPECT_NEAR(shiny->specular_reflectance.value.b, 0.25, 1e-5);
  EXPECT_EQ(warning_about(scene, "specular"), nullptr);
  specular = {{"specularColorFactor", {100, 10, 1}}};
  scene = parse(m);
  EXPECT_NEAR(find_bsdf<PlasticDesc>(scene)->specular_reflectance.value.g, 0.4 / 0.9, 1e-5);
  EXPECT_NE(warning_about(scene, "reflects more than 0.9"), nullptr);

  m.root["materials"][0]["extensions"] = {
      {"KHR_materials_clearcoat", {{"clearcoatFactor", 0.5}, {"clearcoatRoughnessFactor", 0.5}}}};
  scene = parse(m);
  const auto* coat = find_bsdf<CoatingDesc>(scene);
  ASSERT_NE(coat, nullptr);
  EXPECT_EQ(coat->weight.value, 0.5f);
  EXPECT_EQ(coat->alpha_u.value, 0.25f);
  EXPECT_EQ(coat->eta, 1.5f);

  m.root["materials"][0]["extensions"] = {{"KHR_materials_sheen", {{"sheenColorFactor", {0.5, 0.25, 0}}}}};
  scene = parse(m);
  const auto* cloth = find_bsdf<SheenDesc>(scene);
  ASSERT_NE(cloth, nullptr);
  EXPECT_EQ(cloth->color.value, Rgb(0.5f, 0.25f, 0));
  EXPECT_EQ(cloth->roughness.value, 0.07f);
  EXPECT_NE(warning_about(scene, "sheen of a roughness"), nullptr) << "the extension's default is 0";
  EXPECT_TRUE(std::holds_alternative<PlasticDesc>(scene.bsdfs[static_cast<std::size_t>(cloth->nested)].kind));
  m.root["materials"][0]["extensions"]["KHR_materials_sheen"]["sheenRoughnessFactor"] = 0.5;
  scene = parse(m);
  EXPECT_EQ(find_bsdf<SheenDesc>(scene)->roughness.value, 0.5f);
  EXPECT_EQ(warning_about(scene, "sheen"), nullptr);
  EXPECT_NE(describe(scene).find("sheen "), std::string::npos);

  m.root["materials"][0]["extensions"] = {{"KHR_materials_unlit", json::object()}};
  scene = parse(m);
  EXPECT_EQ(scene.shapes[0].emitter->radiance.value, Rgb(0.5f));
  EXPECT_EQ(find_bsdf<DiffuseDesc>(scene)->reflectance.value, Rgb(0));
  EXPECT_NE(warning_about(scene, "unlit"), nullptr);
}

// Exporters write nearly everything double-sided: a lamp that faces away shines all the same, and the inside
// of a bulb is nobody's light.
TEST(GltfMaterial, Anisotropy) {
  GltfMaker m = with_material({{"pbrMetallicRoughness", {{"metallicFactor", 0.5}, {"roughnessFactor", 0}}},
                               {"normalTexture", {{"index", 0}}},
                               {"extensions",
                                {{"KHR_materials_anisotropy",
                                  {{"anisotropyStrength", 0.75},
                                   {"anisotropyRotation", 0.5},
                                   {"anisotropyTexture", {{"index", 0}}}}}}}});
  add_images(m);
  SceneDesc scene = parse(m);
  EXPECT_EQ(warning_about(scene, "nisotropy"), nullptr);
  const auto* turned = find_bsdf<TurnedTangentDesc>(scene);
  ASSERT_NE(turned, nullptr);
  EXPECT_EQ(turned->angle, 0.5f);
  const auto bitmap = [&](int k) {
    return std::get<BitmapTextureDesc>(scene.textures.at(static_cast<std::size_t>(k)).kind);
  };
  EXPECT_EQ(bitmap(turned->direction.texture).channel, TextureChannel::rgb);
  // The tangent is turned within the surface that the normal map has bent.
  const auto& map = *find_bsdf<NormalMapDesc>(scene);
  EXPECT_TRUE(
      std::holds_alternative<TurnedTangentDesc>(scene.bsdfs[static_cast<std::size_t>(map.nested)].kind));
  const auto* plastic = find_bsdf<PlasticDesc>(scene);
  const auto* metal = find_bsdf<PrincipledDesc>(scene);
  ASSERT_TRUE(plastic && metal);
  EXPECT_EQ(plastic->stretch.texture, metal->stretch.texture);
  ASSERT_NE(plastic->stretch.texture, kNone);
  EXPECT_GT(plastic->alpha.value, 0) << "a mirror along one direction alone is no mirror";

  // Without strength there is no direction.
  auto& anisotropy = m.root["materials"][0]["extensions"]["KHR_materials_anisotropy"];
  anisotropy["anisotropyStrength"] = 0;
  anisotropy.erase("anisotropyTexture");
  scene = parse(m);
  EXPECT_EQ(find_bsdf<TurnedTangentDesc>(scene), nullptr);
  EXPECT_EQ(find_bsdf<PlasticDesc>(scene)->alpha.value, 0);
  // Along the tangent as it is.
  anisotropy = {{"anisotropyStrength", 0.5}};
  scene = parse(m);
  EXPECT_EQ(find_bsdf<TurnedTangentDesc>(scene), nullptr);
  EXPECT_EQ(find_bsdf<PlasticDesc>(scene)->stretch.value, 0.5f);
}

TEST(GltfMaterial, DoubleSidedLampsShineBothWays) {
  GltfMaker m = with_material({{"emissiveFactor", {1, 1, 1}}, {"doubleSided", true}});
  SceneDesc scene = parse(m);
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_TRUE(scene.shapes[1].emitter);
  EXPECT_NE(scene.shapes[0].flip_normals, scene.shapes[1].flip_normals);
  EXPECT_LT(std::get<InlineMeshDesc>(scene.shapes[1].kind).mesh->positions[0].z,
            mesh_of(scene).positions[0].z);

  // Its corners meet in place, not by number.
  const std::vector<float> corner[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<float> positions;
  for (const int k : {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3})
    positions.insert(positions.end(), corner[k].begin(), corner[k].end());
  json& primitive = m.root["meshes"][0]["primitives"][0];
  primitive.erase("indices");
  primitive["attributes"] = {{"POSITION", m.accessor("VEC3", positions)}};
  EXPECT_EQ(parse(m).shapes.size(), 1u) << "closed";
  std::swap_ranges(positions.begin() + 3, positions.begin() + 6, positions.begin() + 6);
  primitive["attributes"] = {{"POSITION", m.accessor("VEC3", positions)}};
  EXPECT_EQ(parse(m).shapes.size(), 2u) << "one triangle is turned round";

  m.root["materials"][0]["alphaMode"] = "BLEND";
  scene = parse(m);
  EXPECT_EQ(scene.shapes.size(), 1u);
  EXPECT_NE(warning_about(scene, "blended double-sided"), nullptr);
}

TEST(GltfExtensions, SpecularAndGlossiness) {
  GltfMaker m = with_material({{"extensions",
                                {{"KHR_materials_pbrSpecularGlossiness",
                                  {{"diffuseFactor", {0.5, 0.25, 0, 0.75}},
                                   {"specularFactor", {0.5, 0.25, 0.125}},
                                   {"glossinessFactor", 0.75}}}}},
                               {"alphaMode", "BLEND"}});
  SceneDesc scene = parse(m);
  const auto* plastic = find_bsdf<PlasticDesc>(scene);
  ASSERT_NE(plastic, nullptr);
  EXPECT_TRUE(plastic->schlick && plastic->lossless);
  EXPECT_EQ(plastic->diffuse_reflectance.value, Rgb(0.5f, 0.25f, 0));
  EXPECT_EQ(plastic->specular_reflectance.value, Rgb(0.5f, 0.25f, 0.125f));
  EXPECT_EQ(plastic->alpha.value, 0.0625f) << "(1 - glossiness)²";
  EXPECT_EQ(top_bsdf<MaskDesc>(scene).opacity.value, 0.75f);
  EXPECT_EQ(find_bsdf<PrincipledDesc>(scene), nullptr);

  json& glossy = m.root["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"];
  glossy["specularGlossinessTexture"]["index"] = 0;
  add_images(m);
  scene = parse(m);
  plastic = find_bsdf<PlasticDesc>(scene);
  const auto kind = [&](int k) { return scene.textures.at(static_cast<std::size_t>(k)).kind; };
  const auto square_of = std::get<ProductTextureDesc>(kind(plastic->alpha.texture));
  const auto rough = std::get<MixTextureDesc>(kind(square_of.a.texture));
  EXPECT_EQ(rough.a.value, Rgb(1));
  EXPECT_EQ(rough.b.value, Rgb(0));
  const auto scale = std::get<ScaleTextureDesc>(kind(rough.amount.texture));
  EXPECT_EQ(std::get<BitmapTextureDesc>(kind(scale.input.texture)).channel, TextureChannel::alpha);
}

TEST(GltfExtensions, RoughSheetsAreFrosted) {
  GltfMaker m =
      with_material({{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.5}}},
                     {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}});
  SceneDesc scene = parse(m);
  const auto* frosted = find_bsdf<PrincipledThinDesc>(scene);
  ASSERT_NE(frosted, nullptr);
  EXPECT_EQ(frosted->roughness.value, 0.5f);
  EXPECT_EQ(frosted->spec_trans.value, 1);
  EXPECT_EQ(frosted->diff_trans.value, 0);
  m.root["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 0.1;
  scene = parse(m);
  EXPECT_EQ(find_bsdf<PrincipledThinDesc>(scene), nullptr);
  EXPECT_NE(find_bsdf<ThinDielectricDesc>(scene), nullptr);
}

TEST(GltfExtensions, LeavesLetLightThrough) {
  GltfMaker m = with_material(
      {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
       {"extensions",
        {{"KHR_materials_diffuse_transmission",
          {{"diffuseTransmissionFactor", 0.25}, {"diffuseTransmissionColorFactor", {0.5, 1, 0}}}}}}});
  SceneDesc scene = parse(m);
  const auto& mixture = top_bsdf<MixtureDesc>(scene);
  EXPECT_EQ(mixture.parts.at(0).weight.value, 0.25f);
  const auto* leaf = find_bsdf<DiffuseTransmitterDesc>(scene);
  ASSERT_NE(leaf, nullptr);
  EXPECT_EQ(leaf->transmittance.value, Rgb(0.5f, 1, 0));
  EXPECT_EQ(leaf->reflectance.value, Rgb(0));
}

TEST(GltfExtensions, WebPIsTakenBeforeItsStandIn) {
  GltfMaker m = with_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  add_images(m);
  m.root["textures"][0] = {{"source", 0}, {"extensions", {{"EXT_texture_webp", {{"source", 1}}}}}};
  const SceneDesc scene = parse(m);
  const auto& metal = *find_bsdf<PrincipledDesc>(scene);
  const auto& texture = scene.textures.at(static_cast<std::size_t>(metal.base_color.texture));
  EXPECT_TRUE(std::get<BitmapTextureDesc>(texture.kind).bytes->starts_with("\xff\xd8\xff"));
}

TEST(GltfExtensions, UnknownOnesWarnAndRequiredOnesFail) {
  GltfMaker m = square();
  m.root["extensionsUsed"] = {"EXT_nobody_has_this", "KHR_materials_ior"};
  SceneDesc scene = parse(m);
  EXPECT_NE(warning_about(scene, "EXT_nobody_has_this"), nullptr);
  EXPECT_EQ(warning_about(scene, "KHR_materials_ior"), nullptr);
  m.root["extensionsRequired"] = {"EXT_nobody_has_this"};
  EXPECT_NE(failure(m.gltf()).find("extensionsRequired[0]"), std::string::npos) << failure(m.gltf());
}

TEST(GltfLights, PointSpotAndDirectional) {
  GltfMaker m = square();
  m.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 4}, {"color", {1, 0.5, 0.25}}},
      {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.5}}}},
      {{"type", "directional"}, {"intensity", 3}, {"name", "sun"}}};
  // A quarter turn about x takes -z to +y … and a light that shone along -z shines along +y.
  const double s = std::sqrt(0.5);
  m.root["nodes"] = {{{"mesh", 0}, {"children", {1, 2, 3}}}};
  for (int k = 0; k < 3; ++k)
    m.root["nodes"].push_back({{"translation", {1, 2, 3}},
                               {"rotation", {s, 0, 0, s}},
                               {"extensions", {{"KHR_lights_punctual", {{"light", k}}}}}});
  const SceneDesc scene = parse(m);
  ASSERT_EQ(scene.emitters.size(), 3u);
  const auto& point = std::get<PointLightDesc>(scene.emitters[0].kind);
  EXPECT_EQ(point.position, (Vec3f{1, 2, 3}));
  EXPECT_EQ(point.intensity, Rgb(4, 2, 1));
  const auto& spot = std::get<SpotLightDesc>(scene.emitters[1].kind);
  EXPECT_NEAR(spot.cutoff_angle, 0.5 * 180 / M_PI, 1e-4);
  EXPECT_NEAR(spot.beam_width, 0.1 * 180 / M_PI, 1e-4);
  EXPECT_EQ(spot.edge, SpotLightDesc::Edge::squared_cosine);
  EXPECT_NEAR(spot.to_world.vector({0, 0, 1}).y, 1, 1e-6f);
  const auto& sun = std::get<DirectionalLightDesc>(scene.emitters[2].kind);
  EXPECT_NEAR(sun.direction.y, 1, 1e-6f);
  EXPECT_EQ(sun.irradiance, Rgb(3));
  EXPECT_EQ(scene.emitters[2].id, "sun");
}

// Its exporter takes 683 lm for a watt of a lamp, and none for what is emissive.
TEST(GltfLights, BlendersAreOfWattsAgain) {
  GltfMaker m = with_material({{"emissiveFactor", {1, 1, 1}}});
  m.root["asset"]["generator"] = "Khronos glTF Blender I/O v4.5.48";
  m.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 683}},
                                                           {{"type", "directional"}, {"intensity", 68.3}}};
  m.root["nodes"] = {{{"mesh", 0}, {"children", {1, 2}}}};
  for (int k = 0; k < 2; ++k)
    m.root["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", k}}}}}});
  SceneDesc scene = parse(m);
  EXPECT_EQ(std::get<PointLightDesc>(scene.emitters[0].kind).intensity, Rgb(1));
  EXPECT_NEAR(std::get<DirectionalLightDesc>(scene.emitters[1].kind).irradiance.g, 0.1f, 1e-6f);
  EXPECT_EQ(scene.shapes[0].emitter->radiance.value, Rgb(1));
  EXPECT_EQ(scene.lumens_per_unit, 683);
  // "Unitless", or by another program.
  m.root["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"] = 80;
  EXPECT_EQ(std::get<PointLightDesc>(parse(m).emitters[0].kind).intensity, Rgb(80));
  m.root["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"] = 683;
  m.root["asset"].erase("generator");
  scene = parse(m);
  EXPECT_EQ(std::get<PointLightDesc>(scene.emitters[0].kind).intensity, Rgb(683));
  EXPECT_EQ(scene.lumens_per_unit, 1);
}

TEST(GltfCameras, PerspectiveLooksAlongMinusZ) {
  GltfMaker m = square();
  m.root["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"aspectRatio", 2.0}, {"znear", 0.5}}}}};
  m.root["nodes"] = {{{"mesh", 0}}, {{"camera", 0}, {"translation", {0, 0, 5}}, {"scale", {3, 3, 3}}}};
  m.root["scenes"][0]["nodes"] = {0, 1};
  const SceneDesc scene = parse(m);
  ASSERT_EQ(scene.sensors.size(), 1u);
  const SensorDesc& s = scene.sensors[0];
  EXPECT_EQ(s.film.width, 768);
  EXPECT_EQ(s.film.height, 384);
  EXPECT_NEAR(s.fov_x, 2 * std::atan(2 * std::tan(0.25)) * 180 / M_PI, 1e-4);
  EXPECT_EQ(s.near_clip, 0.5f);
  EXPECT_GT(s.far_clip, 1e20f);
  EXPECT_EQ(s.to_world.point({0, 0, 0}), (Vec3f{0, 0, 5}));
  EXPECT_EQ(s.to_world.vector({0, 0, 1}), (Vec3f{0, 0, -1}));
  EXPECT_EQ(s.to_world.vector({1, 0, 0}), (Vec3f{-1, 0, 0})) << "+x is left";
  EXPECT_EQ(s.to_world.vector({0, 1, 0}), (Vec3f{0, 1, 0}));
}

TEST(GltfCameras, OrthographicShowsItsMagnification) {
  GltfMaker m = square();
  m.root["cameras"] = {{{"type", "orthographic"},
                        {"orthographic", {{"xmag", 4.0}, {"ymag", 2.0}, {"znear", 0.0}, {"zfar", 10.0}}}}};
  m.root["nodes"][0]["camera"] = 0;
  const SensorDesc s = parse(m).sensors.at(0);
  EXPECT_EQ(s.kind, SensorKind::orthographic);
  EXPECT_EQ(s.to_world.vector({1, 0, 0}), (Vec3f{-4, 0, 0}));
  EXPECT_EQ(s.film.width, 2 * s.film.height);
}

// Every corner of the scene is inside the picture, and one of them almost at its edge.
TEST(GltfCameras, TheDefaultOneFramesTheScene) {
  for (const float depth : {0.0f, 0.5f, 30.0f}) {
    GltfMaker m;
    const int positions =
        m.accessor("VEC3", std::vector<float>{-3, 1, 0, 5, 1, depth, 5, 2, -depth, -3, 2, depth});
    m.root["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", positions}}}, {"mode", 5}}}}}};
    const SceneDesc scene = parse(m);
    ASSERT_EQ(scene.sensors.size(), 1u);
    const SensorDesc& s = scene.sensors[0];
    const Transform to_camera = s.to_world.inverse().value();
    const double tan_x = std::tan(s.fov_x * M_PI / 360), tan_y = tan_x * s.film.height / s.film.width;
    double max_value = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3f p =
          to_camera.point({corner & 1 ? 5.0f : -3.0f, corner & 2 ? 2.0f : 1.0f, corner & 4 ? depth : -depth});
      EXPECT_GT(p.z, s.near_clip);
      max_value = std::max({max_value, std::abs(p.x) / p.z / tan_x, std::abs(p.y) / p.z / tan_y});
    }
    EXPECT_LT(max_value, 1);
    EXPECT_GT(max_value, 0.9);
  }
}

// Notes are no warnings: one-sided materials, baked occlusion and a missing camera pass --strict, what is
// replaced does not.
TEST(ReadScene, StrictLetsNotesPass) {
  ReadOptions strict;
  strict.strict = true;
  GltfMaker m = square();
  m.root["materials"] = {
      {{"pbrMetallicRoughness", {{"metallicFactor", 0}}}, {"occlusionTexture", {{"index", 0}}}}};
  m.root["meshes"][0]["primitives"][0]["material"] = 0;
  const SceneDesc scene = parse(m, strict);
  EXPECT_EQ(std::count_if(scene.warnings.begin(), scene.warnings.end(),
                          [](const Warning& w) { return w.harmless; }),
            3);
  EXPECT_EQ(scene.warnings.size(), 3u);
  m.root["materials"][0]["extensions"] = {{"KHR_materials_unlit", GltfMaker::json::object()}};
  EXPECT_THROW(parse(m, strict), InputError);
}

TEST(ReadScene, EnvironmentsAndScenesInTheDark) {
  SceneDesc scene = parse(square());
  light_if_dark(scene);
  ASSERT_EQ(scene.emitters.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<ConstantEnvironmentDesc>(scene.emitters[0].kind));
  EXPECT_NE(warning_about(scene, "no light"), nullptr);
  light_if_dark(scene);
  EXPECT_EQ(scene.emitters.size(), 1u);
  SceneDesc dark = parse(square());
  ReadOptions strict;
  strict.strict = true;
  EXPECT_THROW(light_if_dark(dark, strict), InputError);
  light_if_dark(scene, strict);
  EXPECT_THROW(replace_environment(scene, "/nowhere/sky.exr"), InputError);
  const std::string any_file = std::string(LUMIRANK_TEST_DATA) + "/bad/blank.xml";
  replace_environment(scene, any_file);
  ASSERT_EQ(scene.emitters.size(), 1u);
  EXPECT_EQ(std::get<EnvironmentMapDesc>(scene.emitters[0].kind).filename, any_file);
}

}  // namespace
}  // namespace lumirank::scenedesc
