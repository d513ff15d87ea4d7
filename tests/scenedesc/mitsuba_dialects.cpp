// One scene in both dialects gives one SceneDesc, value by value.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <string>

#include "scenedesc/readers.h"

namespace lumirank::scenedesc {
namespace {

// Exists only, since readers of scenes check no more.
std::string touch(const std::string& name) {
  std::ofstream(testing::TempDir() + name) << "x";
  return testing::TempDir();
}

// Every property in the spelling of 3.x. Defaults that differ between the dialects are stated.
const char* kScene3 = R"(<scene version="3.0.0">
  <default name="size" value="320"/>
  <integrator type="path"><integer name="max_depth" value="7"/></integrator>
  <sensor type="thinlens" id="camera">
    <float name="fov" value="45"/>
    <string name="fov_axis" value="smaller"/>
    <float name="near_clip" value="0.1"/>
    <float name="far_clip" value="100"/>
    <float name="focus_distance" value="3"/>
    <float name="aperture_radius" value="0.05"/>
    <transform name="to_world"><lookat origin="1, 2, 3" target="0 0 0" up="0, 1, 0"/></transform>
    <sampler type="independent"><integer name="sample_count" value="16"/></sampler>
    <film type="hdrfilm">
      <integer name="width" value="$size"/>
      <integer name="height" value="200"/>
      <integer name="crop_offset_x" value="10"/>
      <integer name="crop_offset_y" value="20"/>
      <integer name="crop_width" value="100"/>
      <integer name="crop_height" value="50"/>
      <string name="pixel_format" value="rgb"/>
      <rfilter type="mitchell"/>
    </film>
  </sensor>
  <texture type="bitmap" id="wood">
    <string name="filename" value="dialect.png"/>
    <string name="filter_type" value="nearest"/>
    <string name="wrap_mode" value="mirror"/>
    <transform name="to_uv"><scale x="2" y="3"/></transform>
  </texture>
  <bsdf type="twosided" id="floor"><bsdf type="diffuse"><ref name="reflectance" id="wood"/></bsdf></bsdf>
  <bsdf type="roughplastic" id="plastic">
    <string name="distribution" value="ggx"/>
    <float name="alpha" value="0.2"/>
    <float name="int_ior" value="1.5"/>
    <float name="ext_ior" value="1"/>
    <rgb name="diffuse_reflectance" value="0.1, 0.2, 0.3"/>
    <boolean name="nonlinear" value="true"/>
  </bsdf>
  <bsdf type="roughconductor" id="metal">
    <float name="alpha_u" value="0.1"/>
    <float name="alpha_v" value="0.3"/>
    <rgb name="eta" value="1, 2, 3"/>
    <rgb name="k" value="4, 5, 6"/>
    <float name="ext_eta" value="1"/>
    <rgb name="specular_reflectance" value="0.9"/>
  </bsdf>
  <bsdf type="dielectric" id="glass"><string name="int_ior" value="water"/><string name="ext_ior" value="air"/></bsdf>
  <shape type="obj" id="mesh">
    <string name="filename" value="dialect.obj"/>
    <boolean name="face_normals" value="true"/>
    <boolean name="flip_normals" value="true"/>
    <transform name="to_world"><rotate y="1" angle="90"/><translate x="1"/></transform>
    <ref id="later"/>
  </shape>
  <shape type="serialized">
    <string name="filename" value="dialect.serialized"/>
    <integer name="shape_index" value="2"/>
    <float name="max_smooth_angle" value="30"/>
    <ref id="glass"/>
  </shape>
  <shape type="shapegroup" id="group"><shape type="cube"><ref id="metal"/></shape></shape>
  <shape type="instance"><ref id="group"/><transform name="to_world"><scale value="2"/></transform></shape>
  <shape type="rectangle">
    <ref id="plastic"/>
    <emitter type="area" id="lamp"><rgb name="radiance" value="12"/></emitter>
  </shape>
  <emitter type="spot">
    <float name="cutoff_angle" value="30"/>
    <float name="beam_width" value="10"/>
    <rgb name="intensity" value="1 2 3"/>
  </emitter>
  <bsdf type="null" id="later"/>
</scene>
)";

std::string in_06(std::string text) {
  const std::map<std::string, std::string> spelling = {{"3.0.0", "0.6.0"},
                                                       {"max_depth", "maxDepth"},
                                                       {"fov_axis", "fovAxis"},
                                                       {"near_clip", "nearClip"},
                                                       {"far_clip", "farClip"},
                                                       {"focus_distance", "focusDistance"},
                                                       {"aperture_radius", "apertureRadius"},
                                                       {"to_world", "toWorld"},
                                                       {"sample_count", "sampleCount"},
                                                       {"crop_offset_x", "cropOffsetX"},
                                                       {"crop_offset_y", "cropOffsetY"},
                                                       {"crop_width", "cropWidth"},
                                                       {"crop_height", "cropHeight"},
                                                       {"pixel_format", "pixelFormat"},
                                                       {"filter_type", "filterType"},
                                                       {"wrap_mode", "wrapMode"},
                                                       {"to_uv", "toUV"},
                                                       {"int_ior", "intIOR"},
                                                       {"ext_ior", "extIOR"},
                                                       {"diffuse_reflectance", "diffuseReflectance"},
                                                       {"alpha_u", "alphaU"},
                                                       {"alpha_v", "alphaV"},
                                                       {"ext_eta", "extEta"},
                                                       {"specular_reflectance", "specularReflectance"},
                                                       {"face_normals", "faceNormals"},
                                                       {"flip_normals", "flipNormals"},
                                                       {"shape_index", "shapeIndex"},
                                                       {"max_smooth_angle", "maxSmoothAngle"},
                                                       {"cutoff_angle", "cutoffAngle"},
                                                       {"beam_width", "beamWidth"}};
  for (const auto& [snake, camel] : spelling) {
    std::size_t at = text.find(snake);
    EXPECT_NE(at, std::string::npos) << snake;
    for (; at != std::string::npos; at = text.find(snake, at)) text.replace(at, snake.size(), camel);
  }
  return text;
}

// All but the line that names the file and its format.
std::string body(const SceneDesc& scene) {
  const std::string text = describe(scene);
  return text.substr(text.find('\n') + 1);
}

struct Both {
  SceneDesc v3, v06;
};
Both read_both() {
  touch("dialect.png"), touch("dialect.obj");
  const std::string file = touch("dialect.serialized") + "dialect.xml";
  return {parse_mitsuba(kScene3, file), parse_mitsuba(in_06(kScene3), file)};
}

TEST(MitsubaDialects, GiveTheSameScene) {
  Both both = read_both();
  // The one model in which the programs themselves differ.
  for (BsdfDesc& bsdf : both.v3.bsdfs)
    if (auto* const plastic = std::get_if<PlasticDesc>(&bsdf.kind); plastic && plastic->alpha.value > 0) {
      EXPECT_TRUE(plastic->as_mitsuba_3);
      plastic->as_mitsuba_3 = false;
    }
  EXPECT_EQ(body(both.v3), body(both.v06));
  EXPECT_EQ(both.v3.format, "mitsuba 3.0");
  EXPECT_EQ(both.v06.format, "mitsuba 0.6");
  EXPECT_TRUE(both.v3.warnings.empty()) << body(both.v3);
}

TEST(MitsubaDialects, ValuesAreThoseOfTheFile) {
  const SceneDesc scene = read_both().v3;
  EXPECT_EQ(scene.max_depth, 7);
  ASSERT_EQ(scene.sensors.size(), 1u);
  const SensorDesc& sensor = scene.sensors[0];
  EXPECT_EQ(sensor.kind, SensorKind::thinlens);
  // 320 × 200: the smaller axis is y, and tan(fov_x/2) = tan(22.5°) · 320/200.
  EXPECT_NEAR(sensor.fov_x, 2 * std::atan(std::tan(22.5 * M_PI / 180) * 1.6) * 180 / M_PI, 1e-4);
  EXPECT_EQ(sensor.film.width, 320);
  EXPECT_EQ(sensor.film.crop_x, 10);
  EXPECT_EQ(sensor.film.crop_y, 20);
  EXPECT_EQ(sensor.film.crop_width, 100);
  EXPECT_EQ(sensor.film.crop_height, 50);
  EXPECT_EQ(sensor.film.filter.kind, FilterKind::mitchell);
  EXPECT_EQ(sensor.samples_per_pixel, 16);
  EXPECT_EQ(sensor.to_world.point({0, 0, 0}), (Vec3f{1, 2, 3}));

  ASSERT_EQ(scene.textures.size(), 1u);
  const auto& wood = std::get<BitmapTextureDesc>(scene.textures[0].kind);
  EXPECT_FALSE(wood.raw);
  EXPECT_EQ(wood.wrap_v, WrapMode::mirror);
  // u' = 2u; Mitsuba's v' = 3v runs down, so the picture's is 1 - 3v.
  EXPECT_EQ(wood.to_uv, (UvTransform{{2, 0, 0, 0, -3, 1}}));

  ASSERT_EQ(scene.shapes.size(), 6u);
  const auto& obj = std::get<MeshFileDesc>(scene.shapes[0].kind);
  EXPECT_TRUE(obj.flip_tex_coords);
  EXPECT_TRUE(obj.face_normals);
  EXPECT_TRUE(scene.shapes[0].flip_normals);
  // First turned by 90° about y (z becomes x, x becomes -z), then moved.
  const Vec3f moved = scene.shapes[0].to_world.point({0, 0, 2});
  EXPECT_NEAR(moved.x, 3, 1e-6);
  EXPECT_NEAR(moved.z, 0, 1e-6);
  EXPECT_EQ(scene.bsdfs[static_cast<std::size_t>(scene.shapes[0].bsdf)].id, "later");
  const auto& serialized = std::get<MeshFileDesc>(scene.shapes[1].kind);
  EXPECT_FALSE(serialized.flip_tex_coords);
  EXPECT_EQ(serialized.shape_index, 2);
  EXPECT_EQ(serialized.max_smooth_angle, 30.0f);
  EXPECT_TRUE(scene.shapes[2].in_group);
  EXPECT_EQ(std::get<ShapeGroupDesc>(scene.shapes[3].kind).shapes, std::vector<int>{2});
  EXPECT_EQ(std::get<InstanceDesc>(scene.shapes[4].kind).group, 3);
  ASSERT_TRUE(scene.shapes[5].emitter.has_value());
  EXPECT_EQ(scene.shapes[5].emitter->radiance.value, Rgb(12));
  EXPECT_EQ(scene.shapes[5].emitter->id, "lamp");

  for (const BsdfDesc& bsdf : scene.bsdfs) {
    if (bsdf.id == "glass") {
      EXPECT_FLOAT_EQ(std::get<DielectricDesc>(bsdf.kind).eta, 1.333f / 1.000277f);
    } else if (bsdf.id == "metal") {
      const auto& metal = std::get<ConductorDesc>(bsdf.kind);
      EXPECT_EQ(metal.eta, Rgb(1, 2, 3));
      EXPECT_EQ(metal.k, Rgb(4, 5, 6));
      EXPECT_EQ(metal.alpha_u.value, 0.1f);
      EXPECT_EQ(metal.alpha_v.value, 0.3f);
      EXPECT_EQ(metal.specular_reflectance.value, Rgb(0.9f));
    } else if (bsdf.id == "plastic") {
      const auto& plastic = std::get<PlasticDesc>(bsdf.kind);
      EXPECT_EQ(plastic.distribution, Distribution::ggx);
      EXPECT_EQ(plastic.eta, 1.5f);
      EXPECT_TRUE(plastic.nonlinear);
    }
  }
}

}  // namespace
}  // namespace lumirank::scenedesc
