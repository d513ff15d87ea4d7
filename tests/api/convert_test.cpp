// A converted scene renders to the same bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "image/image_io.h"
#include "lumirank/convert.h"
#include "support/scene_file.h"

namespace lumirank {
namespace {

TEST(Convert, TheConvertedSceneHasTheSamePicture) {
  for (const char* name : {"box", "interior", "lamps"}) {
    const test::TemporaryFolder folder;
    const Scene scene = Scene::load(std::string(LUMIRANK_EXAMPLES) + "/" + name + ".xml");
    convert(scene, folder / "out.xml");
    const Scene again = Scene::load(folder / "out.xml", {.defines = {}, .strict = true});
    RenderSettings settings;
    settings.traced.rest = RestOfPaths::skip;
    settings.view.width = 24, settings.view.height = 16, settings.view.spp = 1;
    settings.lights.count = 300;
    settings.method.name = "brute-force";
    EXPECT_EQ(render(scene, settings).picture.planes[0].rgb, render(again, settings).picture.planes[0].rgb)
        << name;
  }
}

// A scaled picture, a product and a mixture of pictures and a single channel become pictures of their values
// in 16-bit floats. With direct light alone the picture is linear in them, so that rounding changes it by at
// most 2^-11 of itself; a unit in the last place of each float step is left to the rest.
TEST(Convert, PaintsTexturesThatAreMadeOfPictures) {
  const test::TemporaryFolder folder;
  const auto write = [&](const char* name, int width, auto&& value) {
    image::LayeredImage image;
    image.color = image::Image(width, 2);
    for (int k = 0; k < 2 * width; ++k) image.color.pixels[static_cast<std::size_t>(k)] = value(k);
    image::write_image(folder / name, image);
  };
  write("a.exr", 2, [](int k) { return Rgb(0.1f + 0.2f * static_cast<float>(k), 0.5f, 0.3f); });
  write("b.exr", 4, [](int k) { return Rgb(0.9f, 0.1f * static_cast<float>(k), 0.7f); });
  std::ofstream(folder / "scene.pbrt") << R"(
Camera "perspective" "float fov" 60
Film "rgb" "integer xresolution" 24 "integer yresolution" 16
PixelFilter "box"
WorldBegin
LightSource "point" "point3 from" [ 0 0 1 ] "rgb I" [ 4 3 2 ]
Texture "a" "spectrum" "imagemap" "string filename" "a.exr" "string filter" "point"
Texture "b" "spectrum" "imagemap" "string filename" "b.exr" "string filter" "point"
Texture "gray" "float" "imagemap" "string filename" "b.exr" "string filter" "point"
Texture "twice" "spectrum" "scale" "texture tex" "a" "rgb scale" [ 0.5 0.7 1.1 ]
Texture "both" "spectrum" "scale" "texture tex" "twice" "texture scale" "b"
Texture "mixed" "spectrum" "mix" "texture tex1" "a" "rgb tex2" [ 0.2 0.3 0.4 ] "texture amount" "gray"
Material "diffuse" "texture reflectance" "both"
Shape "bilinearmesh" "point3 P" [ -2 -2 3  0 -2 3  -2 2 3  0 2 3 ]
Material "diffuse" "texture reflectance" "mixed"
Shape "bilinearmesh" "point3 P" [ 0 -2 3  2 -2 3  0 2 3  2 2 3 ]
)";
  const Scene scene = Scene::load(folder / "scene.pbrt");
  std::vector<std::string> warnings;
  Sinks sinks;
  sinks.warning = [&](const std::string& text) { warnings.push_back(text); };
  EXPECT_EQ(convert(scene, folder / "out.xml", sinks).size(),
            1u + 2 + 2);  // the scene, two meshes, two pictures
  ASSERT_EQ(warnings.size(), 1u) << warnings.back();
  EXPECT_NE(warnings[0].find("photometric"), std::string::npos) << warnings[0];
  RenderSettings settings;
  settings.traced.rest = RestOfPaths::skip;
  settings.view.spp = 1, settings.method.name = "brute-force", settings.view.max_depth = 2;
  const auto a = render(scene, settings).picture.planes[0].rgb;
  const auto b = render(Scene::load(folder / "out.xml"), settings).picture.planes[0].rgb;
  ASSERT_EQ(a.size(), b.size());
  float max_value = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_NEAR(a[k], b[k], std::abs(a[k]) * (std::ldexp(1.0f, -11) + std::ldexp(16.0f, -23))) << k;
    max_value = std::max(max_value, a[k]);
  }
  EXPECT_GT(max_value, 0);
}

// An equal-area map, a constant and a goniometric light of pbrt: one map of latitudes and longitudes with the
// same numbers as in the built world, and a point light. Direct light from all columns, so the same bits.
TEST(Convert, PaintsEnvironments) {
  const test::TemporaryFolder folder;
  image::LayeredImage sky;
  sky.color = image::Image(8, 8, Rgb(0.5f, 1, 2));
  sky.color.at(3, 4) = Rgb(70000, 3, 1);  // more than 16 bits hold
  image::write_image(folder / "sky.exr", sky);
  image::write_image(folder / "lamp.exr", {image::Image(4, 4, Rgb(3)), {}});
  std::ofstream(folder / "scene.pbrt") << R"(
Camera "perspective" "float fov" 100
Film "rgb" "integer xresolution" 24 "integer yresolution" 16
PixelFilter "box"
WorldBegin
Rotate 30 1 2 3
LightSource "infinite" "string filename" "sky.exr" "float scale" 2
LightSource "infinite" "rgb L" [ 1 2 3 ]
LightSource "goniometric" "string filename" "lamp.exr" "rgb I" [ 1 2 4 ]
Identity
Shape "bilinearmesh" "point3 P" [ -2 -2 3  2 -2 3  -2 2 3  2 2 3 ]
)";
  const Scene scene = Scene::load(folder / "scene.pbrt");
  std::vector<std::string> warnings;
  Sinks sinks;
  sinks.warning = [&](const std::string& text) { warnings.push_back(text); };
  EXPECT_EQ(convert(scene, folder / "out.xml", sinks).size(), 3u);  // the scene, a mesh, a map
  ASSERT_EQ(warnings.size(), 2u) << warnings.back();
  EXPECT_NE(warnings[1].find("goniometric"), std::string::npos) << warnings[1];
  RenderSettings settings;
  settings.traced.rest = RestOfPaths::skip;
  settings.view.spp = 1, settings.method.name = "brute-force", settings.view.max_depth = 2,
  settings.lights.count = 500;
  const auto a = render(scene, settings).picture.planes[0].rgb;
  const auto b = render(Scene::load(folder / "out.xml"), settings).picture.planes[0].rgb;
  ASSERT_EQ(a.size(), b.size());
  // The frame of the map is made of rounded axes, which move look-ups by some 10⁻⁷ of the map.
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], b[k], 1e-4 * std::abs(a[k])) << k;
}

TEST(Convert, MediaGoAlong) {
  const test::TemporaryFolder folder;
  std::string grid("VOL\3\1\0\0\0\2\0\0\0\1\0\0\0\1\0\0\0\1\0\0\0", 24);
  for (const float x : {-1.0f, -1.0f, -1.0f, 1.0f, 1.0f, 1.0f, 0.5f, 3.0f})
    grid.append(reinterpret_cast<const char*>(&x), sizeof x);
  std::ofstream(folder / "smoke.vol", std::ios::binary) << grid;
  std::ofstream(folder / "scene.xml") << R"(<scene version="3.0.0">
<medium type="homogeneous" id="fog"><rgb name="sigma_t" value="0.05, 0.1, 1.5"/><phase type="hg"/></medium>
<sensor type="perspective"><transform name="to_world"><lookat origin="0,1,5" target="0,0,0" up="0,1,0"/></transform>
<film type="hdrfilm"><integer name="width" value="12"/><integer name="height" value="8"/></film><ref id="fog"/></sensor>
<emitter type="point"><point name="position" x="1" y="3" z="2"/><rgb name="intensity" value="9"/></emitter>
<shape type="rectangle"><transform name="to_world"><scale value="3"/><translate z="-2"/></transform></shape>
<shape type="cube"><bsdf type="null"/><ref name="exterior" id="fog"/><medium name="interior" type="heterogeneous">
<volume name="sigma_t" type="gridvolume"><string name="filename" value="smoke.vol"/>
<boolean name="use_grid_bbox" value="true"/></volume><rgb name="albedo" value="0.9, 0.8, 0.7"/>
<float name="scale" value="1.5"/></medium></shape>
</scene>)";
  const Scene scene = Scene::load(folder / "scene.xml");
  Sinks sinks;
  sinks.warning = [](const std::string& text) { ADD_FAILURE() << text; };
  EXPECT_EQ(convert(scene, folder / "out.xml", sinks).size(), 1u);
  const Scene again = Scene::load(folder / "out.xml", {.defines = {}, .strict = true});
  ReferenceSettings how;
  how.spp = 4;
  const auto a = reference(scene, {}, how).picture.planes[0].rgb;
  EXPECT_EQ(a, reference(again, {}, how).picture.planes[0].rgb);
  EXPECT_GT(*std::max_element(a.begin(), a.end()), 0);
  // What it reads of them is not written over.
  const std::vector<std::string> files = again.files();
  EXPECT_EQ(std::ranges::count(files, folder / "smoke.vol"), 1);
}

TEST(Convert, DoesNotOverwriteWhatItReads) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "room.xml";
  std::filesystem::copy_file(std::string(LUMIRANK_EXAMPLES) + "/box.xml", file);
  const Scene scene = Scene::load(file);
  EXPECT_THROW(convert(scene, file), InputError);
  EXPECT_THROW(convert(scene, folder / "room.obj"), InputError);
  EXPECT_THROW(convert(scene, folder / "nowhere/room.xml"), InputError);
  EXPECT_EQ(convert(scene, folder / "other.xml").size(), 1u);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / ""), {}), 2);
}

}  // namespace
}  // namespace lumirank
