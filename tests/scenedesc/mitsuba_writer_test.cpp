// Read, written, read again: the same description, for every variant that Mitsuba 3 has, and a stand-in with
// a warning for every other.
#include "scenedesc/writer/mitsuba_writer.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "round_trip.h"
#include "scenedesc/schema/hair.h"

namespace lumirank::scenedesc {
namespace {

TEST(MitsubaWriter, ExamplesComeBackAsTheyWere) {
  for (const char* name : {"box", "courtyard", "interior", "lamps", "recesses"}) {
    const test::TemporaryFolder folder;
    const SceneDesc scene = read_mitsuba(std::string(LUMIRANK_EXAMPLES) + "/" + name + ".xml");
    const RoundTrip trip(scene, folder);
    if (std::string(name) == "courtyard") {  // its sky is turned by 90° and back, which rounds
      const auto& a = std::get<SunSkyDesc>(scene.emitters.at(0).kind);
      const auto& b = std::get<SunSkyDesc>(trip.again.emitters.at(0).kind);
      EXPECT_LT(length(a.to_world.vector(a.sun_direction) - b.to_world.vector(b.sun_direction)), 1e-6f);
      EXPECT_EQ(a.sun_scale, b.sun_scale);
      EXPECT_EQ(a.sky_scale, b.sky_scale);
    } else {
      EXPECT_TRUE(listing(scene) == listing(trip.again)) << name;
      // The listing rounds numbers; what is written has all their digits.
      EXPECT_TRUE(trip.first.xml == trip.second.xml) << name;
    }
    for (std::size_t k = 0; k < scene.shapes.size(); ++k) {
      EXPECT_EQ(scene.shapes[k].to_world, trip.again.shapes[k].to_world);
      if (!scene.shapes[k].id.empty() && scene.shapes[k].id.find('.') == std::string::npos) {
        EXPECT_EQ(scene.shapes[k].id, trip.again.shapes[k].id) << name;
      }
    }
  }
}

MeshData triangle() {
  MeshData m;
  m.positions = {{0, 0, 0}, {1, 0, 0.1f}, {0, 1, 0}};
  m.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  m.uvs = {{0, 0.25f}, {1, 0}, {0, 1}};
  m.colors = {{1, 0, 0}, {0, 0.3f, 0}, {0, 0, 1}};
  m.indices = {0, 1, 2};
  return m;
}

TEST(MitsubaWriter, AMeshInMemoryBecomesAPlyFileWithAllItHas) {
  const MeshData m = triangle(), back = parse_ply(ply_bytes(m), "m.ply");
  EXPECT_EQ(back.positions, m.positions);
  EXPECT_EQ(back.normals, m.normals);
  EXPECT_EQ(back.uvs, m.uvs);
  EXPECT_EQ(back.colors, m.colors);
  EXPECT_EQ(back.indices, m.indices);
}

// One of each that Mitsuba 3 can say.
SceneDesc everything_it_has(const test::TemporaryFolder& folder) {
  std::ofstream(folder / "a picture & more.png") << "";
  SceneDesc scene;
  scene.sensors.emplace_back();
  scene.sensors[0].film.filter.kind = FilterKind::gaussian;
  SensorDesc lens;
  lens.id = "lens";
  lens.kind = SensorKind::thinlens;
  lens.aperture_radius = 0.1f, lens.focus_distance = 3, lens.fov_x = 33.3f;
  lens.film.filter.kind = FilterKind::mitchell;
  lens.film.crop_x = 3, lens.film.crop_y = 4, lens.film.crop_width = 100, lens.film.crop_height = 50;
  lens.to_world = Transform::look_at({1, 2, 3}, {0, 0, 0.1f}, {0, 1, 0});
  lens.samples_per_pixel = 8;
  scene.sensors.push_back(lens);
  SensorDesc flat;
  flat.id = "flat", flat.kind = SensorKind::orthographic;
  flat.film.filter.kind = FilterKind::lanczos;
  scene.sensors.push_back(flat);
  const auto texture = [&](auto kind) {
    TextureDesc t;
    t.kind = std::move(kind);
    scene.textures.push_back(std::move(t));
    return static_cast<int>(scene.textures.size()) - 1;
  };
  BitmapTextureDesc picture;
  picture.filename = folder / "a picture & more.png";
  picture.filter = FilterMode::nearest, picture.wrap_u = picture.wrap_v = WrapMode::mirror;
  picture.to_uv.m[0] = 2, picture.to_uv.m[2] = 0.25f, picture.to_uv.m[4] = -3;
  const int bitmap = texture(picture), board = texture(CheckerboardTextureDesc{});
  const int colors = texture(VertexColorTextureDesc{});
  const auto bsdf = [&](auto kind) {
    BsdfDesc b;
    b.kind = std::move(kind);
    scene.bsdfs.push_back(std::move(b));
    return static_cast<int>(scene.bsdfs.size()) - 1;
  };
  const int matt = bsdf(DiffuseDesc{{Rgb(0), bitmap}});
  bsdf(NullBsdfDesc{});
  bsdf(ConductorDesc{});
  const int metal = bsdf(
      ConductorDesc{Rgb(0.2f, 0.9f, 1.1f), Rgb(3, 2, 2), {Rgb(0.9f)}, Distribution::ggx, {0.1f}, {0.3f}});
  bsdf(DielectricDesc{});
  bsdf(DielectricDesc{1.3f, {Rgb(1)}, {Rgb(0.5f)}, Distribution::beckmann, {0, board}, {0, board}});
  bsdf(ThinDielectricDesc{});
  bsdf(PlasticDesc{});
  PlasticDesc rough{1.7f, {Rgb(0), colors}, {Rgb(1)}, true, Distribution::ggx, {0.2f}};
  rough.as_mitsuba_3 = true;  // as what is written is read
  bsdf(rough);
  PrincipledDesc p;
  p.metallic.value = 0.3f, p.clearcoat.texture = board;
  bsdf(p);
  PrincipledThinDesc sheet;
  sheet.base_color.texture = bitmap;
  sheet.roughness.value = 0.3f, sheet.anisotropic.value = 0.4f, sheet.spec_trans.texture = board;
  sheet.spec_tint.value = 0.6f, sheet.sheen.value = 0.7f, sheet.sheen_tint.value = 0.8f;
  sheet.flatness.value = 0.9f, sheet.diff_trans.value = 1.1f, sheet.eta = 1.6f;
  bsdf(sheet);
  bsdf(PrincipledThinDesc{});
  bsdf(MaskDesc{{0, board}, matt});
  bsdf(TwoSidedDesc{matt, matt});
  bsdf(TwoSidedDesc{matt, metal});
  bsdf(BumpMapDesc{bitmap, 0.5f, matt});
  NormalMapDesc normal;
  normal.texture = bitmap, normal.nested = metal;
  bsdf(normal);
  bsdf(MixtureDesc{{{{0.3f}, true, matt}, {{0.3f}, false, metal}}});
  const auto shape = [&](auto kind) -> ShapeDesc& {
    ShapeDesc s;
    s.kind = std::move(kind);
    s.bsdf = matt;
    s.to_world = Transform::rotate(1, 2, 3, 40) * Transform::scale(0.3, 2, -1);
    scene.shapes.push_back(std::move(s));
    return scene.shapes.back();
  };
  shape(RectangleDesc{}).emitter.emplace().radiance.texture = board;
  shape(CubeDesc{}).flip_normals = true;
  shape(SphereDesc{{1, 2, 3}, 0.7f});
  shape(DiskDesc{});
  shape(CylinderDesc{{0, 1, 0}, {3, 0, 0}, 0.2f});
  std::ofstream(folder / "m.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  shape(MeshFileDesc{MeshFormat::obj, folder / "m.obj", 0, true, false, {}});
  shape(CubeDesc{}).in_group = true;
  shape(ShapeGroupDesc{{static_cast<int>(scene.shapes.size()) - 1}});
  scene.shapes.back().bsdf = kNone, scene.shapes.back().to_world = {};
  shape(InstanceDesc{static_cast<int>(scene.shapes.size()) - 1}).bsdf = kNone;
  const auto light = [&](auto kind, const char* id = "") {
    EmitterDesc e;
    e.kind = std::move(kind);
    e.id = id;
    scene.emitters.push_back(std::move(e));
  };
  light(PointLightDesc{{1, 2, 3}, Rgb(4, 5, 6)}, "bulb");
  light(SpotLightDesc{Transform::rotate(1, 0, 0, 90), Rgb(2), 30, 10});
  ProjectionLightDesc projector;
  projector.intensity = Rgb(3), projector.picture.texture = bitmap, projector.fov = 50;
  projector.means = ProjectionLightDesc::Picture::irradiance, projector.axis = FieldAxis::diagonal;
  projector.to_uv = {{-0.5f, 0, 0.5f, 0, -0.5f, 0.5f}};
  light(projector);
  ProjectionLightDesc spot;
  spot.to_world = Transform::translate(1, 2, 3), spot.intensity = Rgb(1, 2, 3), spot.picture.texture = bitmap;
  spot.fov = 80, spot.square = true, spot.cutoff_angle = 40, spot.beam_width = 10;
  light(spot);
  light(DirectionalLightDesc{{0, 0, -1}, Rgb(2)});
  light(ConstantEnvironmentDesc{Rgb(0.1f, 0.2f, 0.3f)});
  std::ofstream(folder / "sky.exr") << "";
  light(EnvironmentMapDesc{folder / "sky.exr", 2.5f, Transform::rotate(0, 1, 0, 30)});
  return scene;
}

TEST(MitsubaWriter, EveryVariantThatMitsubaHasComesBack) {
  const test::TemporaryFolder folder;
  const SceneDesc scene = everything_it_has(folder);
  const RoundTrip trip(scene, folder);
  EXPECT_EQ(listing(scene), listing(trip.again));
  EXPECT_EQ(trip.first.xml, trip.second.xml);
  EXPECT_TRUE(trip.first.warnings.empty()) << trip.first.warnings[0].what;
  EXPECT_TRUE(trip.again.warnings.empty()) << trip.again.warnings[0].what;
  EXPECT_EQ(trip.again.emitters[0].id, "bulb");
  EXPECT_EQ(trip.first.xml.find(folder / ""), std::string::npos) << "names are relative";
}

// What Mitsuba 3 lacks: a warning that names it, and a file that is read without any.
TEST(MitsubaWriter, WhatMitsubaLacksIsNamedAndReplaced) {
  const auto expect = [](const char* what, auto&& change) {
    const test::TemporaryFolder folder;
    SceneDesc scene;
    scene.sensors.emplace_back();
    scene.bsdfs.emplace_back().kind = DiffuseDesc{};
    scene.textures.emplace_back().kind = CheckerboardTextureDesc{};
    ShapeDesc& s = scene.shapes.emplace_back();
    s.kind = CubeDesc{};
    s.bsdf = 0;
    change(scene);
    s.bsdf = static_cast<int>(scene.bsdfs.size()) - 1;
    const RoundTrip trip(scene, folder);
    ASSERT_FALSE(trip.first.warnings.empty()) << what;
    EXPECT_NE(trip.first.warnings[0].what.find(what), std::string::npos) << trip.first.warnings[0].what;
    EXPECT_TRUE(trip.again.warnings.empty()) << what << ": " << trip.again.warnings[0].what;
    EXPECT_EQ(trip.again.shapes.size(), 1u);
  };
  const auto bsdf = [](auto kind) {
    return [kind](SceneDesc& scene) { scene.bsdfs.emplace_back().kind = kind; };
  };
  expect("Oren-Nayar", bsdf(RoughDiffuseDesc{}));
  expect("Phong", bsdf(PhongDesc{}));
  expect("Ward", bsdf(WardDesc{}));
  expect("hair, textured", bsdf(HairDesc{{Rgb(0), 0}}));
  expect("diffuse transmission", bsdf(DiffuseTransmitterDesc{}));
  PlasticDesc rough;
  rough.alpha.value = 0.25f, rough.lossless = true;
  expect("loses nothing", bsdf(rough));
  PrincipledDesc metal;
  metal.lossless = true;
  expect("gives back", bsdf(metal));
  CoatingDesc coat;
  coat.nested = 0;
  expect("coating", bsdf(coat));
  SheenDesc cloth;
  cloth.nested = 0;
  expect("sheen", bsdf(cloth));
  expect("textured weights", bsdf(MixtureDesc{{{{0, 0}, false, 0}, {{0.2f}, false, 0}, {{0.2f}, false, 0}}}));
  expect("scaled", [](SceneDesc& scene) {
    scene.textures.emplace_back().kind = ScaleTextureDesc{{Rgb(0), 0}, Rgb(2)};
    scene.bsdfs.emplace_back().kind = DiffuseDesc{{Rgb(0), 1}};
  });
  expect("product", [](SceneDesc& scene) {
    scene.textures.emplace_back().kind = ProductTextureDesc{{Rgb(0), 0}, {Rgb(0), 0}};
    scene.bsdfs.emplace_back().kind = DiffuseDesc{{Rgb(0), 1}};
  });
  expect("threshold", [](SceneDesc& scene) {
    scene.textures.emplace_back().kind = ThresholdTextureDesc{{Rgb(0), 0}};
    scene.bsdfs.emplace_back().kind = DiffuseDesc{{Rgb(0), 1}};
  });
  expect("cannot be seen", [](SceneDesc& scene) {
    scene.bsdfs.emplace_back().kind = NullBsdfDesc{};
    scene.shapes[0].emitter = AreaEmitterDesc{};
    scene.shapes[0].emitter->seen = false;
  });
  expect("edge of a spot", [](SceneDesc& scene) {
    SpotLightDesc light;
    light.edge = SpotLightDesc::Edge::smooth_cosine;
    scene.emitters.emplace_back().kind = light;
  });
  expect("projection light", [](SceneDesc& scene) {
    ProjectionLightDesc light;
    light.picture.texture = 0;
    scene.emitters.emplace_back().kind = light;
  });
  expect("IES", [](SceneDesc& scene) {
    ProfileLightDesc light;
    light.filename = std::string(LUMIRANK_TEST_DATA) + "/ies/even.ies";
    scene.emitters.emplace_back().kind = light;
  });
  expect("photometric", [](SceneDesc& scene) { scene.lumens_per_unit = 1; });
}

// Kelemen and Szirmay-Kalos' base under a smooth layer is Mitsuba's linear plastic: color/π · (1 - F(i))(1 -
// F(o)) / (1 - F̄), for (1 - F̄ from inside) · η² = 1 - F̄. A rough one becomes principled, whose roughness is
// √α.
TEST(MitsubaWriter, PlasticThatLosesNothing) {
  SceneDesc scene;
  scene.sensors.emplace_back();
  PlasticDesc smooth;
  smooth.lossless = true, smooth.nonlinear = true;
  scene.bsdfs.emplace_back().kind = smooth;
  PlasticDesc rough = smooth;
  rough.alpha.value = 0.36f, rough.eta = 1.4f;
  scene.bsdfs.emplace_back().kind = rough;
  scene.textures.emplace_back().kind = CheckerboardTextureDesc{};
  scene.textures.emplace_back().kind = ProductTextureDesc{{Rgb(0), 0}, {Rgb(0), 0}};
  rough.alpha.texture = 1;
  scene.bsdfs.emplace_back().kind = rough;
  for (int k = 0; k < 3; ++k) {
    scene.shapes.emplace_back().kind = CubeDesc{};
    scene.shapes.back().bsdf = k;
  }
  const WrittenScene out = write_mitsuba(scene, "out.xml");
  const SceneDesc again = parse_mitsuba(out.xml, "out.xml");
  const auto kind = [&](int shape) {
    return again.bsdfs[static_cast<std::size_t>(again.shapes.at(static_cast<std::size_t>(shape)).bsdf)].kind;
  };
  EXPECT_FALSE(std::get<PlasticDesc>(kind(0)).nonlinear);
  const auto a = std::get<PrincipledDesc>(kind(1)), b = std::get<PrincipledDesc>(kind(2));
  EXPECT_FLOAT_EQ(a.roughness.value, 0.6f);
  EXPECT_FLOAT_EQ(a.eta, 1.4f);
  // The root of a square is what was squared, and the square itself is not written.
  ASSERT_EQ(again.textures.size(), 1u);
  EXPECT_EQ(b.roughness.texture, 0);
  ASSERT_EQ(out.warnings.size(), 1u);  // both are of the same place
  EXPECT_NE(out.warnings[0].what.find("loses nothing"), std::string::npos);
}

TEST(MitsubaWriter, TexturesThatCanBePaintedAre) {
  const test::TemporaryFolder folder;
  SceneDesc scene;
  scene.sensors.emplace_back();
  BitmapTextureDesc gray;
  gray.filename = folder / "a.png", gray.channel = TextureChannel::green;
  scene.textures.emplace_back().kind = gray;
  scene.textures.emplace_back().kind = ScaleTextureDesc{{Rgb(0), 0}, Rgb(2)};
  scene.textures.emplace_back().kind = CheckerboardTextureDesc{{Rgb(0), 1}, {Rgb(0.5f)}, {}};
  scene.textures.emplace_back().kind = ScaleTextureDesc{{Rgb(0), 2}, Rgb(2)};
  scene.bsdfs.emplace_back().kind = DiffuseDesc{{Rgb(0), 0}};
  scene.bsdfs.emplace_back().kind = DiffuseDesc{{Rgb(0), 2}};
  scene.bsdfs.emplace_back().kind = DiffuseDesc{{Rgb(0), 3}};
  std::vector<int> wanted;
  Painter painter;
  painter.texture = [&](int texture) {
    wanted.push_back(texture);
    BitmapTextureDesc made;
    made.bytes = std::make_shared<const std::string>("\x76\x2f\x31\x01 number " + std::to_string(texture));
    made.to_uv.m[0] = 3;
    return texture < 2 ? std::optional(made) : std::nullopt;
  };
  const WrittenScene out = write_mitsuba(scene, folder / "out.xml", painter);
  EXPECT_EQ(std::multiset<int>(wanted.begin(), wanted.end()), (std::multiset<int>{0, 1, 3}));
  ASSERT_EQ(out.warnings.size(), 1u);
  EXPECT_NE(out.warnings[0].what.find("scaled"), std::string::npos);
  ASSERT_EQ(out.files.size(), 2u);
  for (const WrittenFile& file : out.files) {
    EXPECT_TRUE(file.name.ends_with(".exr")) << file.name;
    std::ofstream(folder / file.name, std::ios::binary) << file.bytes;
  }
  const SceneDesc again = parse_mitsuba(out.xml, folder / "out.xml");
  ASSERT_EQ(again.textures.size(), 3u);
  EXPECT_TRUE(again.warnings.empty());
  int pictures = 0;
  for (const TextureDesc& t : again.textures)
    if (const auto* b = std::get_if<BitmapTextureDesc>(&t.kind)) {
      ++pictures;
      EXPECT_EQ(b->to_uv.m[0], 3);
    } else {
      EXPECT_NE(std::get<CheckerboardTextureDesc>(t.kind).color0.texture, kNone);
    }
  EXPECT_EQ(pictures, 2);
}

// pbrt's cameras see from their very place; Mitsuba wants a distance above 0.
TEST(MitsubaWriter, ANearClipOfNothingIsNearlyNothing) {
  SceneDesc scene;
  scene.sensors.emplace_back().near_clip = 0;
  const SceneDesc again = parse_mitsuba(write_mitsuba(scene, "out.xml").xml, "out.xml");
  EXPECT_GT(again.sensors.at(0).near_clip, 0);
  EXPECT_LE(again.sensors.at(0).near_clip, 1e-4f);
}

TEST(MitsubaWriter, AnIesProfileBecomesAPointLightOfItsPower) {
  SceneDesc scene;
  scene.sensors.emplace_back();
  ProfileLightDesc light;  // 1000 cd over a half sphere: a mean of 500 cd
  light.filename = std::string(LUMIRANK_TEST_DATA) + "/ies/even.ies";
  light.to_world = Transform::translate(1, 2, 3);
  scene.emitters.emplace_back().kind = light;
  const SceneDesc again = parse_mitsuba(write_mitsuba(scene, "out.xml").xml, "out.xml");
  const auto& point = std::get<PointLightDesc>(again.emitters.at(0).kind);
  EXPECT_NEAR(point.intensity.g * kLumensPerUnit, 500, 0.01);
  EXPECT_EQ(point.position, (Vec3f{1, 2, 3}));
}

TEST(MitsubaWriter, MeshesAndPicturesInMemoryAreWrittenOnce) {
  const test::TemporaryFolder folder;
  SceneDesc scene;
  scene.sensors.emplace_back();
  const auto mesh = std::make_shared<const MeshData>(triangle());
  for (int k = 0; k < 2; ++k) scene.shapes.emplace_back().kind = InlineMeshDesc{mesh, "both"};
  BitmapTextureDesc picture;
  picture.bytes = std::make_shared<const std::string>("\x89PNG and so on");
  for (int k = 0; k < 2; ++k) {
    scene.textures.emplace_back().kind = picture;
    scene.bsdfs.emplace_back().kind = DiffuseDesc{{Rgb(0), k}};
  }
  const RoundTrip trip(scene, folder);
  ASSERT_EQ(trip.first.files.size(), 2u);
  EXPECT_EQ(trip.first.files[1].bytes, *picture.bytes);
  const auto& file = std::get<MeshFileDesc>(trip.again.shapes.at(1).kind);
  EXPECT_EQ(read_mesh(file).positions, mesh->positions);
  EXPECT_EQ(read_mesh(file).uvs, mesh->uvs);
}

// Mitsuba has no Kajiya-Kay hair; what is written has the same energy.
TEST(MitsubaWriter, HairAndItsCurvesComeBack) {
  const test::TemporaryFolder folder;
  SceneDesc scene;
  scene.sensors.emplace_back();
  HairDesc hair;
  hair.diffuse_reflectance.value = {0.6f, 0.3f, 0.05f};
  hair.specular_reflectance.value = Rgb(0.08f);
  hair.exponent.value = 30;
  scene.bsdfs.emplace_back().kind = hair;
  const HairFiberDesc fiber{{0.1f, 0.3f, 0.7f}, 1.5f, 0.2f, 0.6f, 3};
  scene.bsdfs.emplace_back().kind = fiber;
  CurvesDesc c;
  c.basis = CurvesDesc::Basis::linear;
  c.points = {{0, 0, 0}, {1, 2, 0}, {2, -1, 1}, {0, 0.1f, 0}, {4, 0, 0}};
  c.radii = {0.1f, 0.1f, 0, 0.3f, 0.2f};
  c.first = {0, 3, 5};
  for (const auto basis : {CurvesDesc::Basis::linear, CurvesDesc::Basis::bspline}) {
    c.basis = basis;
    if (basis == CurvesDesc::Basis::bspline) c.first = {0, 5};
    scene.shapes.emplace_back().kind = c;
    scene.shapes.back().bsdf = basis == CurvesDesc::Basis::linear ? 0 : 1;
  }
  const RoundTrip trip(scene, folder);
  ASSERT_EQ(trip.first.warnings.size(), 1u);
  EXPECT_NE(trip.first.warnings[0].what.find("hair"), std::string::npos);
  const auto written = [&](std::size_t shape) {
    return std::get<HairFiberDesc>(
        trip.again.bsdfs.at(static_cast<std::size_t>(trip.again.shapes.at(shape).bsdf)).kind);
  };
  const HairFiberDesc near = written(0), same = written(1);
  const HairDesc back = hair_from_absorption(near.sigma_a, near.eta, near.beta_m);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(back.diffuse_reflectance.value[i], hair.diffuse_reflectance.value[i], 1e-4f);
  EXPECT_NEAR(back.specular_reflectance.value.g, 0.08f, 1e-4f);
  EXPECT_NEAR(back.exponent.value, 30, 1e-2f);
  EXPECT_EQ(same.sigma_a, fiber.sigma_a);
  EXPECT_EQ(same.eta, fiber.eta);
  EXPECT_EQ(same.beta_m, fiber.beta_m);
  EXPECT_EQ(same.beta_n, fiber.beta_n);
  EXPECT_EQ(same.tilt, fiber.tilt);
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& wanted = std::get<CurvesDesc>(scene.shapes[k].kind);
    const CurvesDesc read = read_curves(std::get<CurvesDesc>(trip.again.shapes.at(k).kind));
    EXPECT_EQ(read.basis, wanted.basis);
    EXPECT_EQ(read.points, wanted.points);
    EXPECT_EQ(read.radii, wanted.radii);
    EXPECT_EQ(read.first, wanted.first);
  }
}

// A Bézier piece and its b-spline are one curve: equal at both ends and in the middle.
TEST(MitsubaWriter, BezierCurvesBecomeTheSameBSplines) {
  SceneDesc scene;
  scene.sensors.emplace_back();
  CurvesDesc c;
  c.basis = CurvesDesc::Basis::bezier;
  c.points = {{0, 0, 0}, {1, 2, 0}, {2, -1, 1}, {4, 0, 0}};
  c.radii = {0.1f, 0.1f, 0.1f, 0.1f};
  c.first = {0, 4};
  scene.shapes.emplace_back().kind = c;
  const WrittenScene out = write_mitsuba(scene, "out.xml");
  ASSERT_EQ(out.files.size(), 1u);
  std::istringstream in(out.files[0].bytes);
  double s[4][4];
  for (auto& p : s)
    for (double& x : p) ASSERT_TRUE(in >> x);
  for (int a = 0; a < 3; ++a) {
    const auto b = [&](std::size_t k) { return double{c.points[k][a]}; };
    EXPECT_NEAR((s[0][a] + 4 * s[1][a] + s[2][a]) / 6, b(0), 1e-5);
    EXPECT_NEAR((s[1][a] + 4 * s[2][a] + s[3][a]) / 6, b(3), 1e-5);
    EXPECT_NEAR((s[0][a] + 23 * s[1][a] + 23 * s[2][a] + s[3][a]) / 48,
                (b(0) + 3 * b(1) + 3 * b(2) + b(3)) / 8, 1e-5);
  }
  EXPECT_NEAR(s[2][3], 0.1, 1e-6);
}

}  // namespace
}  // namespace lumirank::scenedesc
