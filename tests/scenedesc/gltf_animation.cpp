// glTF scenes at a moment: interpolation of keys (glTF 2.0, appendix C), clips, what can move, bad
// animations.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scenedesc/gltf_maker.h"
#include "scenedesc/moment.h"
#include "scenedesc/schema/mesh_cache.h"

namespace lumirank::scenedesc {
namespace {

using Floats = std::vector<float>;
using json = nlohmann::json;

struct Channel {
  std::string path = "translation";
  Floats times = {0, 1};
  Floats values;
  std::string interpolation = "LINEAR";
  std::string type = "VEC3";
  int node = 0;
};

GltfMaker animated(const std::vector<Channel>& channels, const std::string& clip = "move") {
  GltfMaker m = square();
  json animation = {{"name", clip}, {"samplers", json::array()}, {"channels", json::array()}};
  for (const Channel& c : channels) {
    const int input = m.accessor("SCALAR", c.times), output = m.accessor(c.type, c.values);
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size()}, {"target", {{"node", c.node}, {"path", c.path}}}});
    animation["samplers"].push_back(
        {{"input", input}, {"output", output}, {"interpolation", c.interpolation}});
  }
  m.root["animations"] = json::array({animation});  // compilers differ on {animation}
  return m;
}
Vec3d place_at(const GltfMaker& m, double seconds, Vec3d of = {}) {
  return parse(m, moment(seconds)).shapes.at(0).to_world.place(of);
}
void expect_place(Vec3d have, Vec3d want, double tolerance = 1e-6) {
  EXPECT_NEAR(have.x, want.x, tolerance);
  EXPECT_NEAR(have.y, want.y, tolerance);
  EXPECT_NEAR(have.z, want.z, tolerance);
}

// The example of Khronos' tutorial: between (10, 5, -5) at 0.8 s and (14, 3, -2) at 1.6 s lies (12, 4, -3.5).
TEST(GltfAnimation, LinearAsInTheTutorial) {
  const GltfMaker m = animated({{.times = {0, 0.8f, 1.6f}, .values = {0, 0, 0, 10, 5, -5, 14, 3, -2}}});
  expect_place(place_at(m, 1.2), {12, 4, -3.5});
  expect_place(place_at(m, 0.2), {2.5, 1.25, -1.25});
  expect_place(place_at(m, -3), {0, 0, 0});
  expect_place(place_at(m, 100), {14, 3, -2});
  const Motion motion = parse(m, moment(0)).motion;
  EXPECT_EQ(motion.begin, 0);
  EXPECT_NEAR(motion.end, 1.6, 1e-6);
  EXPECT_EQ(motion.moving, std::vector<std::string>{"nodes[0]: translation"});
  EXPECT_EQ(motion.clips, std::vector<std::string>{"move"});
}

TEST(GltfAnimation, StepsHoldTheirKey) {
  const GltfMaker m =
      animated({{.times = {1, 2, 3}, .values = {1, 0, 0, 2, 0, 0, 3, 0, 0}, .interpolation = "STEP"}});
  for (const auto& [seconds, x] :
       {std::pair{0.0, 1}, {1.0, 1}, {1.999, 1}, {2.0, 2}, {2.5, 2}, {3.0, 3}, {9.0, 3}})
    expect_place(place_at(m, seconds), {static_cast<double>(x), 0, 0});
}

// A cubic spline is the polynomial of third degree through its values with its tangents: x(t) = t³ - 2t² + 5
// has x' = 3t² - 4t, and is met everywhere, over keys of uneven spacing.
TEST(GltfAnimation, CubicSplinesMeetACubic) {
  const auto x = [](double t) { return t * t * t - 2 * t * t + 5; };
  Channel c;
  c.times = {0, 0.5f, 2}, c.interpolation = "CUBICSPLINE";
  for (const float t : c.times) {
    const float slope = 3 * t * t - 4 * t, value = static_cast<float>(x(static_cast<double>(t)));
    for (const float v : {slope, 0.0f, 0.0f, value, 0.0f, 0.0f, slope, 0.0f, 0.0f}) c.values.push_back(v);
  }
  const GltfMaker m = animated({c});
  for (const double t : {0.0, 0.1, 0.25, 0.5, 0.9, 1.5, 2.0})
    expect_place(place_at(m, t), {x(t), 0, 0}, 1e-5);
}

// A quarter turn about z in equal parts, by the shorter way although the second quaternion has the other
// sign.
TEST(GltfAnimation, RotationsAreSpherical) {
  const float s = std::sqrt(0.5f);
  const GltfMaker m = animated({{.path = "rotation", .values = {0, 0, 0, 1, 0, 0, -s, -s}, .type = "VEC4"}});
  for (const double t : {0.0, 0.2, 0.5, 0.9, 1.0}) {
    const double angle = t * M_PI / 2;
    expect_place(place_at(m, t, {1, 0, 0}), {std::cos(angle), std::sin(angle), 0});
  }
}

// Appendix C.5 for rotations: the spline of each component, its tangents scaled by the time between the keys,
// which is then made a unit quaternion.
TEST(GltfAnimation, CubicRotationsAreUnitQuaternions) {
  using Quaternion = std::array<double, 4>;
  const auto turn = [](double angle) {
    return Quaternion{0, std::sin(angle / 2) * 0.6, std::sin(angle / 2) * 0.8, std::cos(angle / 2)};
  };
  const double times[3] = {0.5, 1, 3};
  const Quaternion values[3] = {turn(0.3), turn(1.9), turn(-0.7)};
  const Quaternion arriving[3] = {{9, 9, 9, 9}, {0.5, -0.2, 0.3, 0.1}, {0.1, 0.4, -0.3, 0.2}},
                   leaving[3] = {{-0.4, 0.6, 0.2, -1}, {0.3, 0.1, -0.6, 0.5}, {9, 9, 9, 9}};
  Channel c{.path = "rotation", .times = {}, .values = {}, .interpolation = "CUBICSPLINE", .type = "VEC4"};
  for (std::size_t k = 0; k < 3; ++k) {
    c.times.push_back(static_cast<float>(times[k]));
    for (const Quaternion& q : {arriving[k], values[k], leaving[k]})
      for (const double number : q) c.values.push_back(static_cast<float>(number));
  }
  const GltfMaker m = animated({c});
  for (const double seconds : {0.5, 0.6, 0.75, 1.0, 1.3, 2.0, 2.9, 3.0}) {
    const std::size_t k = seconds < 1 ? 0 : 1;
    const double apart = times[k + 1] - times[k], t = (seconds - times[k]) / apart, t2 = t * t, t3 = t2 * t;
    Quaternion q{};
    double size = 0;
    for (std::size_t n = 0; n < 4; ++n) {
      q[n] = (2 * t3 - 3 * t2 + 1) * values[k][n] + apart * (t3 - 2 * t2 + t) * leaving[k][n] +
             (-2 * t3 + 3 * t2) * values[k + 1][n] + apart * (t3 - t2) * arriving[k + 1][n];
      size += q[n] * q[n];
    }
    for (double& number : q) number /= std::sqrt(size);
    const auto [x, y, z, w] = q;
    expect_place(place_at(m, seconds, {1, 0, 0}),
                 {1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)});
    expect_place(place_at(m, seconds, {0, 0, 1}),
                 {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)});
    if (t > 0.1 && t < 0.9) {  // else the test would not see it
      EXPECT_GT(std::abs(size - 1), 0.01) << seconds;
    }
  }
}

TEST(GltfAnimation, NormalizedIntegersAreRotationsToo) {
  GltfMaker m = square();
  const int input = m.accessor("SCALAR", Floats{0, 1});
  const int output = m.accessor("VEC4", std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, 32767, 0}, true);
  m.root["animations"] = {
      {{"samplers", {{{"input", input}, {"output", output}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}}}}}};
  expect_place(place_at(m, 0.5, {1, 0, 0}), {0, 1, 0}, 1e-6);
  EXPECT_EQ(parse(m, moment(0)).motion.clips, std::vector<std::string>{"0"});
}

TEST(GltfAnimation, WeightsOfMorphTargetsMove) {
  GltfMaker m = animated({{.path = "weights", .values = {0, 1, 2, 0}, .type = "SCALAR"}});
  const int up = m.accessor("VEC3", Floats{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  const int right = m.accessor("VEC3", Floats{1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0});
  m.root["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", up}}, {{"POSITION", right}}};
  EXPECT_EQ(mesh_of(parse(m, moment(0.25))).positions[0], (Vec3f{0.75f, 0, 0.5f}));
}

// An arm of two joints: vertices 0 and 1 hang on a shoulder that stands, 2 on an elbow at (0, 0.5, 0) that
// turns by a quarter, and 3 on both alike.
TEST(GltfAnimation, SkinsFollowJointsThatTurn) {
  const float s = std::sqrt(0.5f);
  GltfMaker m =
      animated({{.path = "rotation", .values = {0, 0, 0, 1, 0, 0, s, s}, .type = "VEC4", .node = 2}});
  auto& attributes = m.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] =
      m.accessor("VEC4", std::vector<std::uint8_t>{0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0});
  attributes["WEIGHTS_0"] = m.accessor("VEC4", Floats{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0});
  // Moved back from where they were bound: the elbow from (0, 0.5, 0).
  Floats inverse(32, 0.0f);
  for (const std::size_t k : {0u, 5u, 10u, 15u, 16u, 21u, 26u, 31u}) inverse[k] = 1;
  inverse[16 + 13] = -0.5f;
  m.root["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", m.accessor("MAT4", inverse)}}};
  m.root["nodes"] = {{{"mesh", 0}, {"skin", 0}},
                     {{"translation", {0, 0, 2}}, {"children", {2}}},
                     {{"translation", {0, 0.5, 0}}}};
  m.root["scenes"][0]["nodes"] = {0, 1};
  for (const double t : {0.0, 0.3, 0.5, 1.0}) {
    const SceneDesc scene = parse(m, moment(t));
    const MeshData& mesh = mesh_of(scene);
    ASSERT_EQ(mesh.positions.size(), 4u);
    const double x = std::cos(t * M_PI / 2), y = std::sin(t * M_PI / 2);
    // The elbow turns (1, 0.5) and (0, 0.5) about itself.
    const Vec3d want[4] = {{0, 0, 2}, {1, 0, 2}, {x - y / 2, 0.5 + y + x / 2, 2}, {-y / 4, 0.75 + x / 4, 2}};
    for (std::size_t k = 0; k < 4; ++k)
      expect_place(mesh.origin + static_cast<Vec3d>(mesh.positions[k]), want[k]);
  }
}

TEST(GltfAnimation, LightsAndVisibilityByPointers) {
  GltfMaker m = square();
  m.root["extensionsUsed"] = {"KHR_lights_punctual", "KHR_animation_pointer", "KHR_node_visibility"};
  m.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 1}, {"color", {1, 1, 1}}}};
  m.root["nodes"] = {{{"mesh", 0}, {"extensions", {{"KHR_node_visibility", {{"visible", true}}}}}},
                     {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
  m.root["scenes"][0]["nodes"] = {0, 1};
  const int input = m.accessor("SCALAR", Floats{0, 1}), dim = m.accessor("SCALAR", Floats{8, 0}),
            red = m.accessor("VEC3", Floats{1, 1, 1, 1, 0, 0}),
            shown = m.accessor("SCALAR", std::vector<std::uint8_t>{1, 0});
  const auto channel = [](int sampler, const char* pointer) {
    return json{{"sampler", sampler},
                {"target",
                 {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}};
  };
  m.root["animations"] = {{{"samplers",
                            {{{"input", input}, {"output", dim}},
                             {{"input", input}, {"output", red}},
                             {{"input", input}, {"output", shown}, {"interpolation", "STEP"}}}},
                           {"channels",
                            {channel(0, "/extensions/KHR_lights_punctual/lights/0/intensity"),
                             channel(1, "/extensions/KHR_lights_punctual/lights/0/color"),
                             channel(2, "/nodes/0/extensions/KHR_node_visibility/visible")}}}};
  const SceneDesc half = parse(m, moment(0.5)), end = parse(m, moment(1));
  EXPECT_EQ(half.shapes.size(), 1u);
  EXPECT_TRUE(end.shapes.empty());
  const Rgb i = std::get<PointLightDesc>(half.emitters.at(0).kind).intensity;
  EXPECT_FLOAT_EQ(i.r, 4);
  EXPECT_FLOAT_EQ(i.g, 2);
  EXPECT_EQ(half.motion.moving.size(), 3u);
}

TEST(GltfAnimation, ClipsAreChosenByName) {
  GltfMaker m = animated({{.values = {0, 0, 0, 1, 0, 0}}}, "walk");
  const int input = m.accessor("SCALAR", Floats{0, 1}), output = m.accessor("VEC3", Floats{1, 1, 1, 3, 3, 3});
  m.root["animations"].push_back(
      {{"name", "grow"},
       {"samplers", {{{"input", input}, {"output", output}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}});
  ReadOptions options = moment(1);
  const auto corner = [&](const std::string& clip) {
    options.clip = clip;
    return parse(m, options).shapes.at(0).to_world.place({1, 1, 0});
  };
  expect_place(corner(""), {2, 1, 0});
  expect_place(corner("walk"), {2, 1, 0});
  expect_place(corner("grow"), {3, 3, 0});
  expect_place(corner("*"), {4, 3, 0});
  options.clip = "run";
  EXPECT_NE(failure(m.gltf(), options).find("no clip 'run'"), std::string::npos);
  EXPECT_NE(failure(m.gltf(), options).find("walk, grow"), std::string::npos);
}

TEST(GltfAnimation, WithoutATimeTheNodesStand) {
  GltfMaker m = animated({{.values = {5, 0, 0, 6, 0, 0}}});
  m.root["nodes"][0]["translation"] = {1, 2, 3};
  const SceneDesc scene = parse(m);
  EXPECT_EQ(scene.shapes[0].to_world.origin(), (Vec3d{1, 2, 3}));
  EXPECT_EQ(warning_about(scene, "animation"), nullptr);
  ReadOptions strict;
  strict.strict = true;
  EXPECT_EQ(failure(m.gltf(), strict), "");
}

// A still needs no animation, so a broken one is a note.
TEST(GltfAnimation, BrokenOnesSpoilNoStill) {
  const SceneDesc scene = parse(animated({{.times = {1, 0}, .values = {5, 0, 0, 6, 0, 0}}}));
  EXPECT_EQ(scene.shapes.size(), 1u);
  EXPECT_TRUE(scene.motion.moving.empty());
  EXPECT_TRUE(std::any_of(scene.warnings.begin(), scene.warnings.end(), [](const Warning& w) {
    return w.harmless && w.what.find("do not rise") != std::string::npos;
  }));
}

// What builds on meshes can keep what it built.
TEST(GltfAnimation, MeshesThatDoNotDeformAreTheSameAtAllTimes) {
  const GltfMaker m = animated({{.values = {0, 0, 0, 1, 0, 0}}});
  ReadOptions options = moment(0);
  options.meshes = std::make_shared<MeshCache>();
  const SceneDesc first = parse(m, options);
  options.time = 0.7;
  const SceneDesc second = parse(m, options);
  EXPECT_EQ(&mesh_of(first), &mesh_of(second));
  EXPECT_NE(first.shapes[0].to_world, second.shapes[0].to_world);
}

TEST(GltfAnimation, BadOnesAreRefusedWithTheirPlace) {
  const auto fails = [](const Channel& channel, const std::string& part) {
    const std::string said = failure(animated({channel}).gltf(), moment(0.5));
    EXPECT_NE(said.find(part), std::string::npos) << said;
    EXPECT_NE(said.find("made.gltf:"), std::string::npos) << said;
  };
  const Floats two = {0, 0, 0, 1, 0, 0}, three = {0, 0, 0, 1, 0, 0, 2, 0, 0};
  fails({.times = {0, 2, 1}, .values = three}, "do not rise (key 2)");
  fails({.times = {0, 1, 1}, .values = three}, "do not rise (key 2)");
  fails({.times = {-1, 1}, .values = two}, "negative");
  fails({.times = {0, NAN}, .values = two}, "not finite");
  fails({.times = {0, 1, 2, 3}, .values = two}, "2 values for 4 keys");
  fails({.values = two, .interpolation = "CUBICSPLINE"}, "three for each key");
  fails({.values = two, .interpolation = "BOUNCE"}, "LINEAR, STEP and CUBICSPLINE");
  fails({.path = "rotation", .values = two}, "values of 3 numbers");
  fails({.path = "color", .values = two}, "translation, rotation, scale and weights");
  fails({.values = two, .node = 7}, "7");
  // Pointers to what is not there, or is no number.
  for (const char* pointer : {"/foo/weights", "/nodes/abc/translation", "/nodes/9/scale", "/nodes",
                              "/asset/version", "nodes/0/scale", "/nodes/0/mesh/x"}) {
    GltfMaker p = animated({{.values = two}});
    p.root["animations"][0]["channels"][0]["target"] = {
        {"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
    EXPECT_NE(failure(p.gltf(), moment(0.5)), "") << pointer;
  }
  GltfMaker m = animated({{.values = two}, {.values = two}});
  EXPECT_NE(failure(m.gltf(), moment(0)).find("another channel moves"), std::string::npos);
  m = animated({{.values = two}});
  m.root["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_NE(failure(m.gltf(), moment(0)).find("has a matrix and is animated"), std::string::npos);
}

}  // namespace
}  // namespace lumirank::scenedesc
