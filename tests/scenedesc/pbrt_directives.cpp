// Blocks, transforms, names, includes, options and the camera of pbrt scenes.
#include <cmath>
#include <filesystem>
#include <fstream>

#include "scenedesc/pbrt_scene.h"

namespace lumirank::scenedesc {
namespace {

Vec3f center(const SceneDesc& scene, std::size_t index = 0) {
  return scene.shapes.at(index).to_world.point({0, 0, 0});
}

TEST(PbrtTokens, CommentsEscapesAndListsOfOne) {
  const SceneDesc scene =
      pbrt_world("# nothing\nShape\"sphere\"#here \"float radius\" 3\n\"float radius\"[2]# there\n");
  EXPECT_EQ(shape<SphereDesc>(scene).radius, 2);
  const SceneDesc named = pbrt_world(
      "MakeNamedMaterial \"a \\\"b\\\"\" \"string type\" \"diffuse\"\nNamedMaterial \"a \\\"b\\\"\"\n" +
      kSphere);
  EXPECT_EQ(named.bsdfs.at(static_cast<std::size_t>(named.shapes.at(0).bsdf)).id, "a \"b\"");
}

TEST(PbrtTransforms, EachStepActsOnThePointsOfWhatFollows) {
  EXPECT_EQ(center(pbrt_world("Translate 1 2 3 " + kSphere)), (Vec3f{1, 2, 3}));
  EXPECT_EQ(center(pbrt_world("Scale 2 3 4 Translate 1 1 1 " + kSphere)), (Vec3f{2, 3, 4}));
  EXPECT_EQ(center(pbrt_world("Translate 1 2 3 Identity " + kSphere)), (Vec3f{0, 0, 0}));
  const Vec3f turned = center(pbrt_world("Rotate 90 0 0 1 Translate 1 0 0 " + kSphere));
  EXPECT_NEAR(turned.x, 0, 1e-6f);
  EXPECT_NEAR(turned.y, 1, 1e-6f);
  // Matrices are written column by column: the last four numbers move.
  const std::string matrix = "[ 1 0 0 0  0 1 0 0  0 0 1 0  5 6 7 1 ] ";
  EXPECT_EQ(center(pbrt_world("Translate 1 1 1 ConcatTransform " + matrix + kSphere)), (Vec3f{6, 7, 8}));
  EXPECT_EQ(center(pbrt_world("Translate 1 1 1 Transform " + matrix + kSphere)), (Vec3f{5, 6, 7}));
  // LookAt takes the world to the camera: the eye goes to the origin, the target onto +z.
  const Vec3f seen = center(pbrt_world("LookAt 0 0 5  0 0 0  0 1 0 " + kSphere));
  EXPECT_NEAR(length(seen - Vec3f{0, 0, 5}), 0, 1e-6f);
}

TEST(PbrtTransforms, NamedSystems) {
  EXPECT_EQ(
      center(pbrt_world("Translate 1 2 3 CoordinateSystem \"here\" Scale 9 9 9 CoordSysTransform \"here\" " +
                        kSphere)),
      (Vec3f{1, 2, 3}));
  EXPECT_EQ(
      center(pbrt_world("CoordSysTransform \"camera\" " + kSphere, "Translate 0 0 4 Camera \"perspective\"")),
      (Vec3f{0, 0, -4}));
}

TEST(PbrtTransforms, MovingThingsStayWhereTheyStart) {
  const SceneDesc scene =
      pbrt_world("ActiveTransform EndTime Translate 5 0 0 ActiveTransform All Translate 1 0 0 " + kSphere);
  EXPECT_EQ(center(scene), (Vec3f{1, 0, 0}));
  EXPECT_EQ(only_warning(scene).where.line, 3);
}

TEST(PbrtBlocks, AttributeEndRestoresEverything) {
  const SceneDesc scene = pbrt_world(
      "AttributeBegin\nTranslate 1 0 0\nReverseOrientation\nMaterial \"dielectric\"\n"
      "AreaLightSource \"diffuse\"\nShape \"sphere\"\nAttributeEnd\n" +
      kSphere);
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_TRUE(scene.shapes[0].flip_normals);
  EXPECT_TRUE(scene.shapes[0].emitter.has_value());
  EXPECT_NO_THROW(inner<DielectricDesc>(scene, 0));
  EXPECT_FALSE(scene.shapes[1].flip_normals);
  EXPECT_FALSE(scene.shapes[1].emitter.has_value());
  EXPECT_EQ(inner<DiffuseDesc>(scene, 1).reflectance.value, Rgb(0.5f));  // pbrt's default
  EXPECT_EQ(center(scene, 1), (Vec3f{}));
}

TEST(PbrtBlocks, TransformEndRestoresTheTransformAlone) {
  const SceneDesc scene =
      pbrt_world("TransformBegin Translate 1 0 0 Material \"dielectric\" TransformEnd " + kSphere);
  EXPECT_EQ(center(scene), (Vec3f{}));
  EXPECT_NO_THROW(inner<DielectricDesc>(scene));
}

TEST(PbrtBlocks, AttributeGivesParametersToWhatFollows) {
  const SceneDesc scene =
      pbrt_world("AttributeBegin Attribute \"shape\" \"float radius\" 2 \"float unused\" 1\n" + kSphere +
                 "Shape \"sphere\" \"float radius\" 3\nAttribute \"shape\" \"float radius\" 4\n" + kSphere +
                 "AttributeEnd " + kSphere);
  const float want[] = {2, 3, 4, 1};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(shape<SphereDesc>(scene, i).radius, want[i]) << i;
  EXPECT_TRUE(scene.warnings.empty());  // what is for all need not suit each
}

TEST(PbrtObjects, InstancesReferToTheirGroupWhereverItIs) {
  const SceneDesc scene = pbrt_world(
      "ObjectInstance \"later\"\nObjectBegin \"later\"\nTranslate 1 0 0\nShape \"sphere\"\nShape "
      "\"disk\"\nObjectEnd\n"
      "Scale 2 2 2\nObjectInstance \"later\"\n");
  ASSERT_EQ(scene.shapes.size(), 5u);
  EXPECT_EQ(shape<InstanceDesc>(scene, 0).group, 1);
  EXPECT_EQ(shape<ShapeGroupDesc>(scene, 1).shapes, (std::vector<int>{2, 3}));
  EXPECT_TRUE(scene.shapes[2].in_group);
  EXPECT_EQ(center(scene, 2), (Vec3f{1, 0, 0}));
  EXPECT_EQ(shape<InstanceDesc>(scene, 4).group, 1);
  EXPECT_EQ(scene.shapes[4].to_world.point({1, 0, 0}), (Vec3f{2, 0, 0}));
}

TEST(PbrtObjects, LampsInObjectsAreDark) {
  const SceneDesc scene =
      pbrt_world("ObjectBegin \"a\"\nAreaLightSource \"diffuse\"\nShape \"sphere\"\nObjectEnd\n");
  EXPECT_FALSE(scene.shapes.at(1).emitter.has_value());
  EXPECT_EQ(only_warning(scene).where.line, 5);
}

TEST(PbrtIncludes, NamesAreSharedAndLinesAreThoseOfTheOtherFile) {
  std::ofstream(testing::TempDir() + "part.pbrt")
      << "\n\nTranslate 1 0 0\nShape \"sphere\" \"float raduis\" 2\n";
  const SceneDesc scene =
      pbrt_world("Include \"part.pbrt\"\n" + kSphere + "Import \"part.pbrt\"\n" + kSphere);
  ASSERT_EQ(scene.shapes.size(), 4u);
  EXPECT_EQ(center(scene, 1), (Vec3f{1, 0, 0}));  // Include goes on with the same state
  EXPECT_EQ(center(scene, 2), (Vec3f{2, 0, 0}));
  EXPECT_EQ(center(scene, 3), (Vec3f{1, 0, 0}));  // Import has one of its own
  ASSERT_EQ(scene.warnings.size(), 2u);
  EXPECT_EQ(scene.warnings[0].where.line, 4);
  EXPECT_EQ(scene.warnings[0].where.file, testing::TempDir() + "part.pbrt");
  EXPECT_NE(scene.warnings[0].what.find("did you mean \"radius\"?"), std::string::npos)
      << scene.warnings[0].what;
}

TEST(PbrtIncludes, NamesAreRelativeToTheMainFileOrTheIncluding) {
  const std::string folder = testing::TempDir() + "pbrt_sub";
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "/outer.pbrt") << "Include \"pbrt_sub/inner.pbrt\"\nInclude \"inner.pbrt\"\n";
  std::ofstream(folder + "/inner.pbrt") << kSphere;
  EXPECT_EQ(pbrt_world("Include \"pbrt_sub/outer.pbrt\"").shapes.size(), 2u);
}

TEST(PbrtWarnings, AreErrorsUnderStrictAndNameLineAndParameter) {
  const std::string world = "Shape \"sphere\"\n  \"float radius\" 2\n  \"string name\" \"ball\"\n";
  const Warning warning = only_warning(pbrt_world(world));
  EXPECT_EQ(warning.where.line, 5);
  EXPECT_NE(warning.what.find("\"name\" of Shape \"sphere\""), std::string::npos) << warning.what;
  EXPECT_THROW(pbrt_world(world, "", {{}, true}), InputError);
  EXPECT_NE(only_warning(pbrt_world("Shape \"sphere\" \"float radius\" 1 \"float radius\" 2\n"))
                .what.find("given twice"),
            std::string::npos);
}

TEST(PbrtWarnings, WhatThereIsNot) {
  for (const char* world :
       {"MakeNamedMedium \"fog\" \"string type\" \"cloud\" \"float frequency\" 1 MediumInterface \"fog\" "
        "\"\"\n",
        "Material \"subsurface\" \"rgb mfp\" [ 1 1 1 ]\n",
        "Texture \"t\" \"float\" \"wrinkled\" \"float roughness\" 1\n",
        "Shape \"loopsubdiv\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0 ] \"integer indices\" [ 0 1 2 ] \"integer "
        "levels\" 40\n",
        "LightSource \"infinite\" \"point3 portal\" [ 0 0 0  1 0 0  1 1 0  0 1 0 ]\n"})
    EXPECT_EQ(only_warning(pbrt_world(world)).where.line, 3) << world;
  // A name and a value (parse() in pbrt-v4's parser.cpp).
  EXPECT_EQ(only_warning(pbrt_world("", "Option \"forcediffuse\" true")).where.line, 1);
  only_warning(pbrt_world("", "Option \"mse-reference-image\" \"a.exr\""));
  only_warning(pbrt_world("", "Option \"no such option\" 3"));
  EXPECT_TRUE(pbrt_world("", "Option \"disablepixeljitter\" false Option \"Seed\" 3").warnings.empty());
  EXPECT_THROW(pbrt_world("", "Option \"seed\""), InputError);
  EXPECT_TRUE(pbrt_world("", "Option \"rendercoordsys\" \"world\" Accelerator \"bvh\"").warnings.empty());
}

SensorDesc sensor(const std::string& head) {
  const SceneDesc scene = pbrt_world("", head);
  return scene.sensors.at(0);
}

TEST(PbrtCamera, DefaultsArePbrts) {
  const SceneDesc scene = pbrt_world("");
  const SensorDesc& s = scene.sensors.at(0);
  EXPECT_EQ(s.film.width, 1280);
  EXPECT_EQ(s.film.height, 720);
  // 90° up and down: the half width is 16/9 of the half height 1.
  EXPECT_NEAR(s.fov_x, 2 * std::atan(16.0 / 9) * 180 / M_PI, 1e-4);
  EXPECT_EQ(s.samples_per_pixel, 16);
  EXPECT_EQ(scene.max_depth, 6);  // five bounces
  EXPECT_EQ(s.film.filter.kind, FilterKind::gaussian);
  EXPECT_EQ(s.film.filter.radius, 1.5f);
}

// pbrt's local x points to the right of the picture and Lumirank's to the left.
TEST(PbrtCamera, IsMirrored) {
  const SensorDesc s = sensor("LookAt 1 2 3  1 2 0  0 1 0 Camera \"perspective\"");
  EXPECT_EQ(s.to_world.point({0, 0, 0}), (Vec3f{1, 2, 3}));
  EXPECT_EQ(s.to_world.vector({0, 0, 1}), (Vec3f{0, 0, -1}));
  EXPECT_EQ(s.to_world.vector({0, 1, 0}), (Vec3f{0, 1, 0}));
  // Looking along -z with y up, pbrt's right is cross(up, forward) = -x, so its picture is the mirror image.
  EXPECT_EQ(s.to_world.vector({-1, 0, 0}), (Vec3f{-1, 0, 0}));
  const SensorDesc usual = sensor("Scale -1 1 1 LookAt 1 2 3  1 2 0  0 1 0 Camera \"perspective\"");
  EXPECT_EQ(usual.to_world.vector({-1, 0, 0}), (Vec3f{1, 0, 0}));
}

TEST(PbrtCamera, FieldOfViewIsThatOfTheShorterSide) {
  const std::string tall =
      "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 200 Camera \"perspective\" \"float "
      "fov\" 60";
  EXPECT_NEAR(sensor(tall).fov_x, 60, 1e-4);
  const std::string wide =
      "Film \"rgb\" \"integer xresolution\" 200 \"integer yresolution\" 100 Camera \"perspective\" \"float "
      "fov\" 60";
  EXPECT_NEAR(sensor(wide).fov_x, 2 * std::atan(2 * std::tan(M_PI / 6)) * 180 / M_PI, 1e-4);
}

TEST(PbrtCamera, ScreenWindowShiftsAndScales) {
  const SensorDesc s = sensor(
      "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 100 Camera \"perspective\" \"float "
      "fov\" 90 "
      "\"float screenwindow\" [ 0 0.5 -0.5 0 ]");
  EXPECT_NEAR(s.fov_x, 2 * std::atan(0.25) * 180 / M_PI, 1e-4);
  // Film position f looks at (f + offset - ½) · ½ of the plane: 0 at the left edge; and upwards likewise, 0
  // at the top.
  EXPECT_FLOAT_EQ(s.principal_point_offset.x, 0.5f);
  EXPECT_FLOAT_EQ(s.principal_point_offset.y, 0.5f);
}

TEST(PbrtCamera, LensAndOrthographic) {
  const SensorDesc lens = sensor("Camera \"perspective\" \"float lensradius\" 0.2 \"float focaldistance\" 7");
  EXPECT_EQ(lens.kind, SensorKind::thinlens);
  EXPECT_EQ(lens.aperture_radius, 0.2f);
  EXPECT_EQ(lens.focus_distance, 7);
  const SensorDesc flat = sensor("Camera \"orthographic\" \"float screenwindow\" [ -4 4 -2.25 2.25 ]");
  EXPECT_EQ(flat.kind, SensorKind::orthographic);
  EXPECT_EQ(flat.to_world.vector({1, 0, 0}), (Vec3f{-4, 0, 0}));  // half the width
}

TEST(PbrtFilm, CropAndPixelBounds) {
  const std::string film = "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 50 ";
  const FilmDesc crop = sensor(film + "\"float cropwindow\" [ 0.5 1 0 0.5 ]").film;
  EXPECT_EQ(crop.crop_x, 50);
  EXPECT_EQ(crop.crop_width, 50);
  EXPECT_EQ(crop.crop_y, 0);
  EXPECT_EQ(crop.crop_height, 25);
  const FilmDesc bounds = sensor(film + "\"integer pixelbounds\" [ 10 30 20 25 ]").film;
  EXPECT_EQ(bounds.crop_x, 10);
  EXPECT_EQ(bounds.crop_width, 20);
  EXPECT_EQ(bounds.crop_y, 20);
  EXPECT_EQ(bounds.crop_height, 5);
}

TEST(PbrtFilm, Filters) {
  const auto filter = [](const std::string& text) { return sensor("PixelFilter " + text).film.filter; };
  EXPECT_EQ(filter("\"box\"").kind, FilterKind::box);
  EXPECT_EQ(filter("\"box\"").radius, 0.5f);
  EXPECT_EQ(filter("\"triangle\"").radius, 2);
  EXPECT_EQ(filter("\"triangle\" \"float xradius\" 1 \"float yradius\" 1").radius, 1);
  EXPECT_EQ(filter("\"gaussian\" \"float sigma\" 0.7").stddev, 0.7f);
  EXPECT_EQ(filter("\"mitchell\" \"float B\" 0 \"float C\" 0.5").c, 0.5f);
  EXPECT_EQ(filter("\"sinc\"").kind, FilterKind::lanczos);
  EXPECT_EQ(filter("\"sinc\"").radius, 4);
  EXPECT_EQ(filter("\"sinc\"").lobes, 3);
  EXPECT_EQ(
      only_warning(pbrt_world("", "PixelFilter \"box\" \"float xradius\" 1 \"float yradius\" 2")).where.line,
      1);
}

TEST(PbrtIntegrator, CountsBouncesAndSamples) {
  const SceneDesc scene =
      pbrt_world("",
                 "Integrator \"path\" \"integer maxdepth\" 12 \"float regularize\" 1\nSampler \"stratified\" "
                 "\"integer xsamples\" 3 \"integer ysamples\" 5");
  EXPECT_EQ(scene.max_depth, 13);
  EXPECT_EQ(scene.integrator, "path");
  EXPECT_EQ(scene.sensors.at(0).samples_per_pixel, 15);
}

}  // namespace
}  // namespace lumirank::scenedesc
