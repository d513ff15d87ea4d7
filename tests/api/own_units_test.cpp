// A scene that is tiny, huge or far from the origin gives the picture of the same scene at the origin. The
// same seed draws the same numbers, so pictures differ by single paths that rounding turns aside: less than a
// quarter of what another seed changes, which in a sum of squares adds 3 % to the noise.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iomanip>
#include <memory>
#include <sstream>

#include "scenedesc/gltf_maker.h"
#include "support/scene_file.h"

namespace lumirank::test {
namespace {

// p → scale · p + shift.
struct Place {
  double scale = 1;
  std::array<double, 3> shift{0, 0, 0};
};
const Place kHere;
Place scaled(double s) { return {s, {0, 0, 0}}; }
Place moved(double d) { return {1, {d, -d, 0.5 * d}}; }

using Corner = std::array<double, 3>;
using Quad = std::array<Corner, 4>;  // counter-clockwise as seen from the front
// A box without its front, and a block on its floor.
const std::vector<Quad> kWalls = {
    {{{-1, -1, 1}, {1, -1, 1}, {1, -1, -1}, {-1, -1, -1}}},
    {{{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}}},
    {{{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}}},
    {{{-1, -1, 1}, {-1, -1, -1}, {-1, 1, -1}, {-1, 1, 1}}},
    {{{1, -1, -1}, {1, -1, 1}, {1, 1, 1}, {1, 1, -1}}},
    {{{-0.4, -1, 0.4}, {0.3, -1, 0.4}, {0.3, -0.3, 0.4}, {-0.4, -0.3, 0.4}}},
    {{{-0.4, -0.3, 0.4}, {0.3, -0.3, 0.4}, {0.3, -0.3, -0.3}, {-0.4, -0.3, -0.3}}},
};
const std::vector<Quad> kLamp = {{{{-0.5, 0.9, -0.5}, {0.5, 0.9, -0.5}, {0.5, 0.9, 0.5}, {-0.5, 0.9, 0.5}}}};

class Numbers {
 public:
  explicit Numbers(const Place& at) : at_(at) {}
  Corner place(const Corner& p) const {
    Corner out;
    for (std::size_t k = 0; k < 3; ++k) out[k] = at_.scale * p[k] + at_.shift[k];
    return out;
  }
  static std::string text(double x) {
    std::ostringstream out;
    out << std::setprecision(17) << x;
    return out.str();
  }
  std::string text(const Corner& p) const {
    const Corner q = place(p);
    return text(q[0]) + " " + text(q[1]) + " " + text(q[2]);
  }
  std::string length(double x) const { return text(at_.scale * x); }
  const Place& at() const { return at_; }

 private:
  Place at_;
};

// Mesh files are opened when a scene is built.
struct Scenery {
  std::shared_ptr<TemporaryFolder> folder;
  Scene scene;
};

std::string sensor_xml(const Numbers& n) {
  return "<sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/><float name=\"near_clip\" value=\"" +
         n.length(0.01) + "\"/><float name=\"far_clip\" value=\"" + n.length(100) +
         "\"/><transform name=\"to_world\"><lookat origin=\"" + n.text({0.2, 0.1, 3.8}) + "\" target=\"" +
         n.text({0, 0, 0}) +
         "\" up=\"0,1,0\"/></transform><film type=\"hdrfilm\"><integer name=\"width\" value=\"16\"/>"
         "<integer name=\"height\" value=\"12\"/><rfilter type=\"box\"/></film></sensor>";
}

// Rectangles and cubes under transforms, a sphere at a place, a point light.
Scenery mitsuba_shapes(const Place& at) {
  const Numbers n(at);
  const auto shape = [&](const char* type, const std::string& steps, const std::string& more) {
    const Corner o = n.place({0, 0, 0});
    const std::string s = Numbers::text(at.scale);
    return "<shape type=\"" + std::string(type) + "\"><transform name=\"to_world\">" + steps +
           "<scale value=\"" + s + "\"/><translate x=\"" + Numbers::text(o[0]) + "\" y=\"" +
           Numbers::text(o[1]) + "\" z=\"" + Numbers::text(o[2]) + "\"/></transform>" + more + "</shape>";
  };
  const auto turned = [](const char* axis, int degrees) {
    return "<translate z=\"-1\"/><rotate " + std::string(axis) + "=\"1\" angle=\"" + std::to_string(degrees) +
           "\"/>";
  };
  std::string xml =
      sensor_xml(n) + shape("rectangle", turned("x", 0), "") + shape("rectangle", turned("x", 90), "") +
      shape("rectangle", turned("x", -90), "") + shape("rectangle", turned("y", 90), "") +
      shape("rectangle", turned("y", -90), "") +
      shape("cube", "<scale value=\"0.35\"/><translate x=\"-0.3\" y=\"-0.65\"/>", "") +
      shape("rectangle", "<scale value=\"0.4\"/><rotate x=\"1\" angle=\"90\"/><translate y=\"0.9\"/>",
            "<emitter type=\"area\"><rgb name=\"radiance\" value=\"8, 7, 5\"/></emitter>");
  const Corner ball = n.place({0.5, -0.7, 0.3}), lamp = n.place({-0.6, 0.2, 0.6});
  const auto point = [](const char* name, const Corner& p) {
    return "<point name=\"" + std::string(name) + "\" x=\"" + Numbers::text(p[0]) + "\" y=\"" +
           Numbers::text(p[1]) + "\" z=\"" + Numbers::text(p[2]) + "\"/>";
  };
  xml += "<shape type=\"sphere\">" + point("center", ball) + "<float name=\"radius\" value=\"" +
         n.length(0.3) + "\"/></shape><emitter type=\"point\">" + point("position", lamp) +
         "<rgb name=\"intensity\" value=\"" + Numbers::text(0.5 * at.scale * at.scale) + "\"/></emitter>";
  return {nullptr, load_text(xml)};
}

std::string obj(const std::vector<Quad>& quads, const Numbers& n) {
  std::string out;
  for (const Quad& q : quads) {
    for (const Corner& p : q) out += "v " + n.text(p) + "\n";
    out += "f -4 -3 -2 -1\n";
  }
  return out;
}

Scenery obj_files(const Place& at) {
  const Numbers n(at);
  const auto held = std::make_shared<TemporaryFolder>();
  const TemporaryFolder& folder = *held;
  std::ofstream(folder / "walls.obj") << obj(kWalls, n);
  std::ofstream(folder / "lamp.obj") << obj(kLamp, n);
  std::ofstream(folder / "scene.xml")
      << "<scene version=\"3.0.0\">" + sensor_xml(n) +
             "<shape type=\"obj\"><string name=\"filename\" value=\"walls.obj\"/><boolean "
             "name=\"face_normals\" value=\"true\"/></shape><shape type=\"obj\"><string name=\"filename\" "
             "value=\"lamp.obj\"/><emitter type=\"area\"><rgb name=\"radiance\" value=\"8, 7, "
             "5\"/></emitter></shape></scene>";
  return {held, Scene::load(folder / "scene.xml")};
}

Scenery pbrt_lists(const Place& at) {
  const Numbers n(at);
  const TemporaryFolder folder;
  const auto mesh = [&](const std::vector<Quad>& quads) {
    std::string points, indices;
    for (std::size_t k = 0; k < quads.size(); ++k) {
      for (const Corner& p : quads[k]) points += " " + n.text(p);
      for (const std::size_t i : {0, 1, 2, 0, 2, 3}) indices += " " + std::to_string(4 * k + i);
    }
    return "Shape \"trianglemesh\" \"integer indices\" [" + indices + " ] \"point3 P\" [" + points + " ]\n";
  };
  std::ofstream(folder / "scene.pbrt")
      << "LookAt " + n.text({0.2, 0.1, 3.8}) + " " + n.text({0, 0, 0}) +
             " 0 1 0\nCamera \"perspective\" \"float fov\" 30\nFilm \"rgb\" \"integer xresolution\" 16 "
             "\"integer yresolution\" 12\nPixelFilter \"box\"\nWorldBegin\n" +
             mesh(kWalls) + "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [ 8 7 5 ]\n" +
             mesh(kLamp) + "AttributeEnd\n";
  return {nullptr, Scene::load(folder / "scene.pbrt")};
}

// Meshes around their origin under a node, seen by the camera that files without one get.
Scenery gltf_nodes(const Place& at) {
  using json = nlohmann::json;
  scenedesc::GltfMaker m;
  json primitives = json::array();
  for (const auto* quads : {&kWalls, &kLamp}) {
    std::vector<float> positions;
    std::vector<std::uint16_t> indices;
    for (std::size_t k = 0; k < quads->size(); ++k) {
      for (const Corner& p : (*quads)[k])
        for (const double x : p) positions.push_back(static_cast<float>(x));
      for (const std::size_t i : {0, 1, 2, 0, 2, 3}) indices.push_back(static_cast<std::uint16_t>(4 * k + i));
    }
    const int p = m.accessor("VEC3", positions), i = m.accessor("SCALAR", indices);
    primitives.push_back(
        {{"attributes", {{"POSITION", p}}}, {"indices", i}, {"material", primitives.size()}});
  }
  m.root["meshes"] = {{{"primitives", primitives}}};
  m.root["materials"] = {{{"doubleSided", true}},
                         {{"emissiveFactor", {1, 0.9, 0.6}},
                          {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}}}};
  m.root["extensionsUsed"] = {"KHR_materials_emissive_strength"};
  m.root["nodes"] = {{{"mesh", 0},
                      {"translation", {at.shift[0], at.shift[1], at.shift[2]}},
                      {"scale", {at.scale, at.scale, at.scale}}}};
  const TemporaryFolder folder;
  std::ofstream(folder / "scene.gltf") << m.gltf();
  return {nullptr, Scene::load(folder / "scene.gltf")};
}

using Pixels = std::vector<float>;

Pixels traced(const Scene& scene, std::uint64_t seed) {
  RenderSettings settings;
  settings.seed = seed, settings.view.width = 16, settings.view.height = 12, settings.threads = 1;
  ReferenceSettings how;
  how.spp = 32;
  return reference(scene, settings, how).picture.planes[0].rgb;
}
Pixels summed(const Scene& scene, std::uint64_t seed) {
  RenderSettings settings;
  settings.seed = seed, settings.view.width = 16, settings.view.height = 12, settings.threads = 1;
  settings.method.name = "brute-force", settings.lights.count = 300, settings.view.spp = 4;
  return render(scene, settings).picture.planes[0].rgb;
}

double relative_l1(const Pixels& a, const Pixels& truth) {
  double difference = 0, total = 0;
  for (std::size_t k = 0; k < truth.size(); ++k)
    difference += std::abs(double{a[k]} - truth[k]), total += truth[k];
  return difference / total;
}

struct Format {
  const char* name;
  Scenery (*scene)(const Place&);
  std::vector<Place> places;
};

class OwnUnits : public testing::TestWithParam<Format> {};

void compare(const Format& format, Pixels (*picture)(const Scene&, std::uint64_t), const char* what,
             const std::vector<Place>& places) {
  const Scenery here = format.scene(kHere);
  const Pixels truth = picture(here.scene, 1);
  const double noise = relative_l1(picture(here.scene, 2), truth);
  EXPECT_GT(noise, 0);
  for (const Place& place : places) {
    const Scenery there = format.scene(place);
    // Rounding sends some particles other ways than at the origin, but most lights are the same.
    EXPECT_LT(relative_l1(picture(there.scene, 1), truth), 0.7 * noise)
        << what << ", scale " << place.scale << ", moved by " << place.shift[0] << "; noise " << noise;
  }
}

TEST_P(OwnUnits, TheReferenceIsThatOfTheSceneAtTheOrigin) {
  compare(GetParam(), traced, "reference", GetParam().places);
}

TEST_P(OwnUnits, SoIsTheMatrix) {
  if (std::string(GetParam().name) == "gltf" || std::string(GetParam().name) == "pbrt")
    return;  // the same world as that of the others, once it is read
  compare(GetParam(), summed, "matrix", {scaled(1e-9), moved(1e5)});
}

INSTANTIATE_TEST_SUITE_P(
    Formats, OwnUnits,
    testing::Values(Format{"mitsuba",
                           mitsuba_shapes,
                           {scaled(1e-9), scaled(1e-6), scaled(1e6), scaled(1e12), moved(1e4), moved(1e5)}},
                    Format{"obj", obj_files, {scaled(1e-9), scaled(1e6), moved(1e4), moved(1e5), moved(1e7)}},
                    Format{"pbrt", pbrt_lists, {scaled(1e-9), moved(1e5)}},
                    Format{"gltf", gltf_nodes, {scaled(1e-9), moved(1e5)}}),
    [](const auto& format) { return std::string(format.param.name); });

// The wall at the back is 4.8 away from a camera on the axis.
TEST(OwnUnitsReported, DepthPositionBoundsAndPowersAreInTheFilesUnits) {
  for (const Place& place : {kHere, scaled(1e-9), scaled(1e9), moved(1e5)}) {
    const Numbers n(place);
    const auto number = [](double x) { return Numbers::text(x); };
    const Corner o = n.place({0, 0, 0});
    const std::string at_place = "<scale value=\"" + number(place.scale) + "\"/><translate x=\"" +
                                 number(o[0]) + "\" y=\"" + number(o[1]) + "\" z=\"" + number(o[2]) + "\"/>";
    const Scene scene = load_text(
        "<sensor type=\"orthographic\"><float name=\"near_clip\" value=\"0.01\"/><transform "
        "name=\"to_world\"><scale x=\"0.1\" y=\"0.1\"/><rotate y=\"1\" angle=\"180\"/><translate "
        "z=\"3.8\"/>" +
        at_place +
        "</transform><film type=\"hdrfilm\"><integer name=\"width\" value=\"4\"/><integer name=\"height\" "
        "value=\"4\"/><rfilter type=\"box\"/></film></sensor><shape type=\"rectangle\"><transform "
        "name=\"to_world\"><translate z=\"-1\"/>" +
        at_place +
        "</transform><emitter type=\"area\"><rgb name=\"radiance\" value=\"2\"/></emitter></shape>");
    RenderSettings settings;
    settings.method.name = "brute-force", settings.lights.count = 20, settings.threads = 1;
    settings.layers = {"depth", "position"};
    const Picture picture = render(scene, settings).picture;
    ASSERT_EQ(picture.planes.size(), 3u);
    // Several roundings of 2⁻²⁴ along the ray, which begins at the near plane.
    EXPECT_NEAR(picture.planes[1].rgb[0] / (4.79 * place.scale), 1, 8 * 0x1p-24);
    const double z = place.scale * -1 + place.shift[2];
    EXPECT_NEAR(picture.planes[2].rgb[2] / z, 1, 4 * 0x1p-24);

    const SceneInfo info = scene.info();
    for (std::size_t k = 0; k < 3; ++k) {
      const double min_corner = place.scale * -1 + place.shift[k];
      EXPECT_NEAR(info.bounds[0][k] / min_corner, 1, 4 * 0x1p-24);
    }
    const double power = 2 * M_PI * 4 * place.scale * place.scale;
    EXPECT_NEAR(info.emitters[0].power[0] / power, 1, 1e-5);
  }
}

std::vector<std::string> warnings_of(const std::string& clip) {
  const Scene scene = load_text(
      "<sensor type=\"perspective\">" + clip +
      "<transform name=\"to_world\"><lookat origin=\"0 0 10\" target=\"0 0 0\" up=\"0 1 0\"/></transform>"
      "<film type=\"hdrfilm\"><integer name=\"width\" value=\"8\"/><integer name=\"height\" value=\"8\"/>"
      "</film></sensor><shape type=\"cube\"/><emitter type=\"point\"/>");
  std::vector<std::string> warnings;
  Sinks sinks;
  sinks.warning = [&](const std::string& text) { warnings.push_back(text); };
  RenderSettings settings;
  settings.method.name = "brute-force", settings.lights.count = 10, settings.threads = 1;
  render(scene, settings, sinks);
  ReferenceSettings how;
  how.spp = 1;
  reference(scene, settings, how, sinks);
  return warnings;
}

TEST(EmptyView, ClippingPlanesThatHideEverythingAreNamed) {
  EXPECT_TRUE(warnings_of("").empty());
  for (const auto& [clip, what] :
       {std::pair{"<float name=\"far_clip\" value=\"5\"/>", "far clipping plane"},
        std::pair{"<float name=\"near_clip\" value=\"50\"/>", "near clipping plane"},
        // So that no ray of the grid would meet it anyway.
        std::pair{
            "<float name=\"far_clip\" value=\"5\"/><float name=\"principal_point_offset_x\" value=\"9\"/>",
            "far clipping plane"}}) {
    const auto warnings = warnings_of(clip);
    ASSERT_EQ(warnings.size(), 2u) << clip;
    for (const std::string& text : warnings) EXPECT_NE(text.find(what), std::string::npos) << text;
  }
  const auto warnings = warnings_of("<float name=\"principal_point_offset_x\" value=\"40\"/>");
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[0].find("meets a surface"), std::string::npos) << warnings[0];
}

}  // namespace
}  // namespace lumirank::test
