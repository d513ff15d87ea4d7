// Transforms between keys, and the Mitsuba and pbrt scenes and numbered mesh files that move by them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "scenedesc/meshes/mesh_reader.h"
#include "scenedesc/moment.h"
#include "scenedesc/pbrt_scene.h"
#include "scenedesc/schema/frame_files.h"
#include "scenedesc/schema/keyed_transform.h"
#include "scenedesc/writer/mitsuba_writer.h"
#include "support/refused.h"
#include "support/scene_file.h"

namespace lumirank::scenedesc {
namespace {

void expect_transform(const Transform& have, const Transform& want, double tolerance = 1e-9) {
  for (std::size_t k = 0; k < 16; ++k) EXPECT_NEAR(have.m[k], want.m[k], tolerance) << "element " << k;
}
void expect_vector(Vec3d have, Vec3d want, double tolerance = 1e-9) {
  EXPECT_NEAR(have.x, want.x, tolerance);
  EXPECT_NEAR(have.y, want.y, tolerance);
  EXPECT_NEAR(have.z, want.z, tolerance);
}

TEST(KeyedTransform, KeysAreMetAndHeldOutside) {
  const Transform a =
      Transform::translate(1, 2, 3) * Transform::rotate(1, 2, 0, 70) * Transform::scale(2, 1, 0.5);
  const Transform b =
      Transform::rotate(0, 1, 1, -120) * Transform::scale(1, 3, 1) * Transform::rotate(1, 0, 0, 20);
  const std::vector<TransformKey> keys = {{1, a}, {3, b}};
  for (const double before : {-5.0, 1.0}) EXPECT_EQ(transform_at(keys, before), a);
  for (const double after : {3.0, 7.0}) EXPECT_EQ(transform_at(keys, after), b);
  expect_transform(transform_at(keys, 1 + 1e-12), a);
  expect_transform(transform_at(keys, 3 - 1e-12), b);
}

// Closed form: turning about one axis while moving and growing.
TEST(KeyedTransform, TurnsMovesAndStretchesApart) {
  const auto pose = [](double t) {
    return Transform::translate(4 * t, 0, -t) * Transform::rotate(0.3, 1, 0.2, 10 + 150 * t) *
           Transform::scale(1 + t, 2 - t, 1);
  };
  for (const double t : {0.1, 0.5, 0.8})
    expect_transform(transform_at({{0, pose(0)}, {1, pose(1)}}, t), pose(t));
}

TEST(KeyedTransform, MirrorsStayMirrors) {
  const auto pose = [](double t) { return Transform::rotate(0, 0, 1, 90 * t) * Transform::scale(-1, 1, 1); };
  const Transform half = transform_at({{0, pose(0)}, {1, pose(1)}}, 0.5);
  EXPECT_NEAR(half.determinant3(), -1, 1e-12);
  expect_transform(half, pose(0.5));
  // Nothing lies between a mirror and none: the earlier one is kept.
  EXPECT_EQ(transform_at({{0, pose(0)}, {1, Transform{}}}, 0.9), pose(0));
}

SceneDesc mitsuba(const std::string& keys, const ReadOptions& options) {
  return parse_mitsuba("<scene version=\"3.0.0\"><shape type=\"sphere\"><animation name=\"to_world\">" +
                           keys + "</animation></shape><sensor type=\"perspective\"/></scene>",
                       testing::TempDir() + "moving.xml", options);
}

TEST(MitsubaMotion, AnimationsAtAMoment) {
  const std::string keys =
      "<transform time=\"1\"><translate x=\"2\"/></transform>"
      "<transform time=\"2\"><rotate z=\"1\" angle=\"90\"/><translate x=\"4\"/></transform>";
  EXPECT_EQ(mitsuba(keys, {}).shapes[0].to_world.origin(), (Vec3d{2, 0, 0}));
  const SceneDesc half = mitsuba(keys, moment(1.5));
  EXPECT_NEAR(half.shapes[0].to_world.origin().x, 3, 1e-12);
  EXPECT_NEAR(half.shapes[0].to_world.axis(0).y, std::sqrt(0.5), 1e-12);
  EXPECT_EQ(half.motion.begin, 1);
  EXPECT_EQ(half.motion.end, 2);
  EXPECT_EQ(half.motion.moving.size(), 1u);
  for (const char* wrong :
       {"<transform time=\"1\"/><transform time=\"0\"/>", "<transform time=\"1\"/><transform time=\"1\"/>"})
    EXPECT_THROW(mitsuba(wrong, moment(0)), InputError) << wrong;
}

TEST(PbrtMotion, ActiveTransformsAtAMoment) {
  const std::string world =
      "ActiveTransform EndTime\nTranslate 4 0 0\nRotate 90 0 0 1\nActiveTransform All\nTranslate 0 0 1\n"
      "Shape \"sphere\"\n";
  const std::string head = "TransformTimes 1 3\n";
  EXPECT_EQ(pbrt_world(world, head).shapes[0].to_world.origin(), (Vec3d{0, 0, 1}));
  const SceneDesc half = pbrt_world(world, head, moment(2)), end = pbrt_world(world, head, moment(5));
  EXPECT_NEAR(half.shapes[0].to_world.origin().x, 2, 1e-12);
  EXPECT_NEAR(half.shapes[0].to_world.axis(0).y, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(end.shapes[0].to_world.axis(0).y, 1, 1e-12);
  EXPECT_EQ(half.motion.begin, 1);
  EXPECT_EQ(half.motion.end, 3);
  EXPECT_EQ(pbrt_world("Shape \"sphere\"\n").motion.moving.size(), 0u);
  EXPECT_THROW(pbrt_world(world, "TransformTimes 3 1\n"), InputError);
}

// A camera that flies by the lamps, and lamps of all kinds that have a place.
TEST(MitsubaMotion, CamerasAndLampsMove) {
  const auto keys = [](const std::string& first, const std::string& last) {
    return "<animation name=\"to_world\"><transform time=\"1\">" + first +
           "</transform><transform time=\"3\">" + last + "</transform></animation>";
  };
  const std::string text =
      "<scene version=\"3.0.0\"><sensor type=\"perspective\">" +
      keys("<lookat origin=\"0,0,5\" target=\"0,0,0\" up=\"0,1,0\"/>",
           "<lookat origin=\"4,0,5\" target=\"0,0,5\" up=\"0,1,0\"/>") +
      "</sensor><emitter type=\"point\">" + keys("<translate y=\"2\"/>", "<translate x=\"4\" y=\"6\"/>") +
      "</emitter><emitter type=\"spot\">" + keys("", "<rotate y=\"1\" angle=\"90\"/><translate z=\"8\"/>") +
      "</emitter><shape type=\"sphere\">" + keys("<translate z=\"1\"/>", "<translate z=\"-3\"/>") +
      "<emitter type=\"area\"/></shape></scene>";
  // A quarter of the way, in which turns of 90° have turned by 22.5°.
  const double part = 0.25, turned = part * M_PI / 2;
  const SceneDesc scene = parse_mitsuba(text, testing::TempDir() + "flight.xml", moment(1 + 2 * part));
  const Transform& camera = scene.sensors.at(0).to_world;
  expect_vector(camera.origin(), {1, 0, 5});
  expect_vector(camera.axis(2), {-std::sin(turned), 0, -std::cos(turned)});
  expect_vector(camera.axis(1), {0, 1, 0});
  expect_vector(std::get<PointLightDesc>(scene.emitters.at(0).kind).position, {1, 3, 0});
  const Transform& spot = std::get<SpotLightDesc>(scene.emitters.at(1).kind).to_world;
  expect_vector(spot.origin(), {0, 0, 2});
  expect_vector(spot.axis(2), {std::sin(turned), 0, std::cos(turned)});
  ASSERT_TRUE(scene.shapes.at(0).emitter);
  expect_vector(scene.shapes[0].to_world.origin(), {0, 0, 0});
  EXPECT_EQ(scene.motion.moving.size(), 4u);
  EXPECT_EQ(scene.motion.begin, 1);
  EXPECT_EQ(scene.motion.end, 3);
}

// pbrt's camera has the inverse of the transform before it, at both ends of the motion.
TEST(PbrtMotion, CamerasAndLampsMove) {
  const std::string head =
      "TransformTimes 1 3\n"
      "ActiveTransform StartTime\nLookAt 0 0 5  0 0 0  0 1 0\n"
      "ActiveTransform EndTime\nLookAt 4 0 5  0 0 5  0 1 0\n"
      "ActiveTransform All\nCamera \"perspective\"\n";
  const std::string world =
      "AttributeBegin\nActiveTransform StartTime\nTranslate 0 2 0\nActiveTransform EndTime\n"
      "Translate 4 6 0\nActiveTransform All\nLightSource \"point\" \"point3 from\" [0 0 1]\nAttributeEnd\n"
      "AttributeBegin\nActiveTransform EndTime\nTranslate 0 0 8\nRotate 90 0 1 0\nActiveTransform All\n"
      "LightSource \"spot\" \"point3 from\" [0 0 0] \"point3 to\" [0 0 1]\nAttributeEnd\n"
      "AttributeBegin\nActiveTransform EndTime\nTranslate 0 0 -4\nActiveTransform All\n"
      "AreaLightSource \"diffuse\"\nShape \"sphere\"\nAttributeEnd\n";
  const double part = 0.25, turned = part * M_PI / 2;
  const SceneDesc scene = pbrt_world(world, head, moment(1 + 2 * part));
  const Transform& camera = scene.sensors.at(0).to_world;
  expect_vector(camera.origin(), {1, 0, 5});
  expect_vector(camera.axis(2), {-std::sin(turned), 0, -std::cos(turned)});
  expect_vector(camera.axis(1), {0, 1, 0});
  expect_vector(std::get<PointLightDesc>(scene.emitters.at(0).kind).position, {1, 3, 1});
  const Transform& spot = std::get<SpotLightDesc>(scene.emitters.at(1).kind).to_world;
  expect_vector(spot.origin(), {0, 0, 2});
  expect_vector(spot.axis(2), {std::sin(turned), 0, std::cos(turned)}, 1e-6);
  ASSERT_TRUE(scene.shapes.at(0).emitter);
  expect_vector(scene.shapes[0].to_world.origin(), {0, 0, -1});
  EXPECT_EQ(scene.motion.moving.size(), 4u);
  // Without a moment it is the start.
  const SceneDesc start = pbrt_world(world, head);
  expect_vector(start.sensors.at(0).to_world.origin(), {0, 0, 5});
  expect_vector(std::get<PointLightDesc>(start.emitters.at(0).kind).position, {0, 2, 1});
}

TEST(FrameFiles, TheNearestOfThoseThatThereAre) {
  const test::TemporaryFolder folder;
  for (const char* name :
       {"cloth.0003.ply", "cloth.0005.ply", "cloth.0010.ply", "cloth.x.ply", "cloth.12.ply"})
    std::ofstream(folder / name) << "ply";
  const std::string pattern = folder / "cloth.####.ply";
  const auto number = [&](std::optional<int> frame) {
    const auto found = file_of_frame(pattern, frame);
    return found ? std::filesystem::path(found->path).filename().string() : "";
  };
  EXPECT_EQ(number({}), "cloth.0003.ply");
  EXPECT_EQ(number(0), "cloth.0003.ply");
  EXPECT_EQ(number(4), "cloth.0003.ply");
  EXPECT_EQ(number(5), "cloth.0005.ply");
  EXPECT_EQ(number(8), "cloth.0010.ply");
  EXPECT_EQ(number(99), "cloth.0010.ply");
  EXPECT_EQ(file_of_frame(pattern, 1)->last, 10);
  EXPECT_FALSE(file_of_frame(folder / "cloth.0003.ply", 1));
  EXPECT_FALSE(file_of_frame(folder / "other.##.ply", 1));
}

TEST(FrameFiles, MeshesOfASceneMoveByThem) {
  const test::TemporaryFolder folder;
  for (const char* name : {"m_00.ply", "m_01.ply", "m_02.ply"}) std::ofstream(folder / name) << "ply\n";
  const auto file_at = [&](const ReadOptions& options) {
    const SceneDesc scene = parse_mitsuba(
        "<scene version=\"3.0.0\"><shape type=\"ply\"><string name=\"filename\" value=\"m_##.ply\"/></shape>"
        "<sensor type=\"perspective\"/></scene>",
        folder / "a.xml", options);
    EXPECT_NEAR(scene.motion.end, 2.0 / options.frames_per_second, 1e-12);
    return std::filesystem::path(std::get<MeshFileDesc>(scene.shapes[0].kind).filename).filename().string();
  };
  ReadOptions options = moment(0.1);
  options.frames_per_second = 10;
  EXPECT_EQ(file_at(options), "m_01.ply");
  EXPECT_EQ(file_at({}), "m_00.ply");
}

TEST(FrameFiles, VolumesOfASceneMoveByThem) {
  const test::TemporaryFolder folder;
  for (const char* name : {"puff.0.vol", "puff.1.vol", "puff.2.vol"}) std::ofstream(folder / name) << "VOL";
  ReadOptions options = moment(0.1);
  options.frames_per_second = 10;
  const SceneDesc scene = parse_mitsuba(
      "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><shape type=\"cube\"><medium name=\"interior\" "
      "type=\"heterogeneous\"><volume type=\"gridvolume\" name=\"sigma_t\"><string name=\"filename\" "
      "value=\"puff.#.vol\"/></volume></medium></shape></scene>",
      folder / "a.xml", options);
  const auto& grid = std::get<GridFileDesc>(scene.volumes.at(0).kind);
  EXPECT_EQ(grid.filename, folder / "puff.1.vol");
  EXPECT_EQ(grid.sequence.size(), 3u);
  EXPECT_NEAR(scene.motion.end, 0.2, 1e-12);
  const std::vector<std::string> files = files_of(scene);
  EXPECT_EQ(std::count(files.begin(), files.end(), folder / "puff.2.vol"), 1);
}

// A square of `vertices` corners around its middle.
std::string fan(std::size_t vertices, bool ply) {
  std::string text = ply ? "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices) +
                               "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                               std::to_string(vertices - 2) +
                               "\nproperty list uchar int vertex_indices\nend_header\n"
                         : "";
  for (std::size_t k = 0; k < vertices; ++k)
    text += (ply ? "" : "v ") + std::to_string(std::cos(static_cast<double>(k))) + " " +
            std::to_string(std::sin(static_cast<double>(k))) + " 0\n";
  for (std::size_t k = 2; k < vertices; ++k)
    text += ply ? "3 0 " + std::to_string(k - 1) + " " + std::to_string(k) + "\n"
                : "f 1 " + std::to_string(k) + " " + std::to_string(k + 1) + "\n";
  return text;
}

TEST(FrameFiles, AMeshThatBecomesAnotherIsRefusedWithBothFiles) {
  for (const bool ply : {true, false}) {
    const test::TemporaryFolder folder;
    const std::string ending = ply ? ".ply" : ".obj";
    std::ofstream(folder / ("m_00" + ending)) << fan(4, ply);
    std::ofstream(folder / ("m_01" + ending)) << fan(4, ply) << (ply ? "" : "# v 1 2 3\nvt 0 0\n");
    std::ofstream(folder / ("m_02" + ending)) << fan(5, ply);
    MeshFileDesc file;
    file.format = ply ? MeshFormat::ply : MeshFormat::obj;
    file.sequence = {folder / ("m_00" + ending)};
    for (const char* same : {"m_00", "m_01"}) {
      file.filename = folder / (same + ending);
      EXPECT_EQ(read_mesh(file).positions.size(), 4u) << same;
    }
    file.filename = folder / ("m_02" + ending);
    try {
      read_mesh(file);
      FAIL() << "read as if it were the same mesh";
    } catch (const InputError& error) {
      const std::string said = error.what();
      for (const std::string& part : {"m_00" + ending, "m_02" + ending, std::string("5 vertices and 3 faces"),
                                      std::string("4 vertices and 2 faces")})
        EXPECT_NE(said.find(part), std::string::npos) << part << " in: " << said;
    }
    // As many, but otherwise joined.
    std::string turned = fan(4, ply);
    turned.replace(turned.find(ply ? "3 0 1 2" : "f 1 2 3"), 7, ply ? "3 0 2 1" : "f 1 3 2");
    std::ofstream(folder / ("m_03" + ending)) << turned;
    MeshFileDesc other = file;
    other.filename = folder / ("m_03" + ending);
    EXPECT_NE(test::refused([&] { read_mesh(other); }).find("other faces than the first"), std::string::npos);
    if (ply) {  // values may be on lines of their own
      std::string spread = fan(4, ply);
      const std::size_t body = spread.find("end_header\n") + 11;
      std::replace(spread.begin() + static_cast<std::ptrdiff_t>(body), spread.end(), ' ', '\n');
      std::ofstream(folder / "m_04.ply") << spread;
      other.filename = folder / "m_04.ply";
      EXPECT_EQ(read_mesh(other).positions.size(), 4u);
    }
    file.sequence.clear();  // by itself it is sound
    EXPECT_EQ(read_mesh(file).positions.size(), 5u);
  }
}

}  // namespace
}  // namespace lumirank::scenedesc
