// Frames of tensor clustering against all columns of the same lights: what its clusters approach.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "image/image_io.h"
#include "lumirank/animate.h"
#include "support/scene_file.h"

namespace lumirank {
namespace {

using test::TemporaryFolder;
using Frames = std::vector<std::vector<Rgb>>;

constexpr int kShotWidth = 32, kShotHeight = 24;

std::string animation(const std::string& first, const std::string& last) {
  return "<animation name=\"to_world\"><transform time=\"0\">" + first +
         "</transform><transform time=\"1\">" + last + "</transform></animation>";
}
std::string camera(const std::string& to_world) {
  return "<sensor type=\"perspective\"><float name=\"fov\" value=\"60\"/>" + to_world +
         "<film type=\"hdrfilm\"><integer name=\"width\" value=\"" + std::to_string(kShotWidth) +
         "\"/><integer name=\"height\" value=\"" + std::to_string(kShotHeight) +
         "\"/><rfilter type=\"box\"/></film></sensor>";
}
std::string look_at(const std::string& origin, const std::string& target) {
  return "<lookat origin=\"" + origin + "\" target=\"" + target + "\" up=\"0,1,0\"/>";
}
std::string diffuse(const std::string& color) {
  return "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"" + color + "\"/></bsdf>";
}
// The square of 2 × 2 that faces +z, put somewhere by `place`.
std::string square(const std::string& place, const std::string& of_it) {
  return "<shape type=\"rectangle\"><transform name=\"to_world\">" + place + "</transform>" + of_it +
         "</shape>";
}
// A floor, a back and a side wall of colors of their own, and a box that throws shadows.
std::string corner_with_a_box() {
  return square("<rotate x=\"1\" angle=\"-90\"/><scale value=\"3\"/>", diffuse("0.6,0.5,0.4")) +
         square("<scale value=\"3\"/><translate y=\"3\" z=\"-3\"/>", diffuse("0.7,0.7,0.7")) +
         square("<rotate y=\"1\" angle=\"90\"/><scale value=\"3\"/><translate x=\"-3\" y=\"3\"/>",
                diffuse("0.7,0.2,0.1")) +
         "<shape type=\"cube\"><transform name=\"to_world\"><scale value=\"0.6\"/><rotate y=\"1\" "
         "angle=\"30\"/><translate x=\"0.5\" y=\"0.6\" z=\"-1\"/></transform>" +
         diffuse("0.3,0.4,0.7") + "</shape>";
}
const std::string kPanelAbove =
    square("<rotate x=\"1\" angle=\"90\"/><scale value=\"0.7\"/><translate y=\"4\"/>",
           "<emitter type=\"area\"><rgb name=\"radiance\" value=\"9\"/></emitter>");

std::string scene_file(const TemporaryFolder& folder, const std::string& body) {
  std::ofstream(folder / "scene.xml") << "<scene version=\"3.0.0\">" << body << "</scene>";
  return folder / "scene.xml";
}

// Five frames in one chunk.
AnimateSettings shot(std::uint64_t lights) {
  AnimateSettings settings;
  settings.render.lights.count = lights;
  settings.render.view.spp = 1, settings.render.view.film_samples = 0;
  settings.render.view.max_depth = 3;  // photons of more bounces take most of the time
  settings.render.traced.rest = RestOfPaths::skip;
  settings.render.traced.direct = DirectLight::matrix;
  settings.frames_per_second = 4;
  settings.first = 0, settings.last = 4;
  settings.endings = {".pfm"};
  settings.tensor = TensorSettings{.overlap = 0, .rows = 48};
  return settings;
}

Frames frames_of(const Scene& scene, const AnimateSettings& settings) {
  const TemporaryFolder out;
  animate(scene, settings, out / "shot");
  Frames frames;
  for (int k = settings.first; k <= settings.last; ++k)
    frames.push_back(image::read_image(out / ("shot/frame_000" + std::to_string(k) + ".pfm")).color.pixels);
  return frames;
}
Frames truth_of(const Scene& scene, AnimateSettings settings) {
  settings.tensor->columns = 0, settings.render.method.target_error = 0;
  return frames_of(scene, settings);
}

// ‖have − want‖ / ‖want‖ over the pixels that count.
template <typename Counts>
double relative_l2(const std::vector<Rgb>& have, const std::vector<Rgb>& want, const Counts& counts) {
  double difference = 0, all = 0;
  for (std::size_t k = 0; k < want.size(); ++k)
    for (int c = 0; counts(k) && c < 3; ++c) {
      const double w = want[k][c], off = static_cast<double>(have[k][c]) - w;
      difference += off * off, all += w * w;
    }
  EXPECT_GT(all, 0);
  return std::sqrt(difference / all);
}
std::vector<double> errors(const Frames& have, const Frames& want) {
  EXPECT_EQ(have.size(), want.size());
  std::vector<double> of_frame;
  for (std::size_t k = 0; k < want.size(); ++k)
    of_frame.push_back(relative_l2(have[k], want[k], [](std::size_t) { return true; }));
  return of_frame;
}
double worst(const std::vector<double>& of_frame) {
  return *std::max_element(of_frame.begin(), of_frame.end());
}

// A camera that flies through a diffuse corner.
Scene flight(const TemporaryFolder& folder, const std::string& what_else = "") {
  return Scene::load(
      scene_file(folder, camera(animation(look_at("2,2,5", "-0.5,1,-1"), look_at("3,3,3.5", "-0.5,0.7,-1"))) +
                             corner_with_a_box() + kPanelAbove + what_else));
}

TEST(ShotTruth, EveryFrameHasTheErrorThatWasAskedFor) {
  const TemporaryFolder folder;
  const Scene scene = flight(folder);
  AnimateSettings settings = shot(1500);
  settings.render.view.spp = 4;
  settings.tensor->columns = 10;  // far too few, if they were what counts
  const Frames truth = truth_of(scene, settings);
  for (const double error : {0.05, 0.01}) {
    settings.render.method.target_error = error;
    for (const double e : errors(frames_of(scene, settings), truth)) EXPECT_LE(e, error);
  }
}

TEST(ShotTruth, MoreColumnsHaveLessError) {
  const TemporaryFolder folder;
  const Scene scene = flight(folder);
  AnimateSettings settings = shot(1500);
  settings.render.view.spp = 4;
  const Frames truth = truth_of(scene, settings);
  const auto with = [&](int columns) {
    settings.tensor->columns = columns;
    return errors(frames_of(scene, settings), truth);
  };
  const std::vector<double> few = with(10), many = with(200);
  for (std::size_t k = 0; k < many.size(); ++k) EXPECT_LT(many[k], 0.5 * few[k]) << k;
  EXPECT_LT(worst(few), 0.1);
  EXPECT_LT(worst(many), 0.01);
}

// A rough metal plate on the floor that mirrors a lamp. A cluster that lasts for the whole shot carries the
// highlight to where it was in another frame; what bounds changes takes it from there, and shines where it
// is.
void expect_no_ghost(const std::string& of_camera, const std::string& of_lamp) {
  const TemporaryFolder folder;
  const Scene scene = Scene::load(scene_file(
      folder,
      camera(of_camera) + corner_with_a_box() +
          square("<rotate x=\"1\" angle=\"-90\"/><scale value=\"2\"/><translate y=\"0.2\" z=\"2.4\"/>",
                 "<bsdf type=\"roughconductor\"><float name=\"alpha\" value=\"0.2\"/></bsdf>") +
          "<shape type=\"sphere\"><float name=\"radius\" value=\"0.3\"/>" + of_lamp +
          "<emitter type=\"area\"><rgb name=\"radiance\" value=\"30\"/></emitter></shape>"));
  AnimateSettings settings = shot(1000);
  settings.render.view.spp = 4, settings.render.view.max_depth = 2;
  settings.tensor->columns = 50, settings.tensor->carrying = TensorSettings::Carrying::always;
  const Frames truth = truth_of(scene, settings);
  // Where the highlight is in any frame, so where it would stay too: in the lower half, below the lamp.
  const std::size_t lower = truth[0].size() / 2;
  float brightest = 0;
  for (const auto& frame : truth)
    for (std::size_t k = lower; k < frame.size(); ++k) brightest = std::max(brightest, frame[k].g);
  const auto shines = [&](std::size_t k) {
    return k >= lower && std::any_of(truth.begin(), truth.end(),
                                     [&](const auto& frame) { return frame[k].g > brightest / 2; });
  };
  const auto worst_highlight = [&] {
    const Frames frames = frames_of(scene, settings);
    double error = 0;
    for (std::size_t k = 0; k < truth.size(); ++k)
      error = std::max(error, relative_l2(frames[k], truth[k], shines));
    return error;
  };
  EXPECT_LT(worst_highlight(), 0.08);
  settings.tensor->time_weight = 0;
  EXPECT_LT(worst_highlight(), 0.08);
  settings.tensor->max_change = 0, settings.tensor->filter = 0;
  EXPECT_GT(worst_highlight(), 0.4);  // so it is the bound that does it
}

TEST(ShotTruth, AHighlightDoesNotGhostWhereTheCameraMoves) {
  expect_no_ghost(animation(look_at("1.2,2,5", "0,0.5,0"), look_at("-0.8,2,5", "0,0.5,0")),
                  "<transform name=\"to_world\"><translate y=\"2.5\" z=\"-2.2\"/></transform>");
}
TEST(ShotTruth, AHighlightDoesNotGhostWhereItsLampMoves) {
  expect_no_ghost(
      "<transform name=\"to_world\">" + look_at("1.2,2,5", "0,0.5,0") + "</transform>",
      animation("<translate x=\"-1.5\" y=\"2.5\" z=\"-2.2\"/>", "<translate x=\"1\" y=\"2.5\" z=\"-2.2\"/>"));
}

// A dozen hairs that move by `place`.
std::string tuft(const TemporaryFolder& folder, const std::string& place) {
  const std::string file = folder / "tuft.txt";
  std::ofstream out(file);
  for (int k = 0; k < 12; ++k)
    for (int i = 0; i < 5; ++i)
      out << 0.25 * (k % 4) - 0.4 + (0.1 * (k % 5) - 0.2) * i * i / 16 << ' ' << 0.3 * i << ' '
          << 0.25 * (k / 4) - 0.25 << ' ' << 0.05 - 0.008 * i << (i < 4 ? "\n" : "\n\n");
  return "<shape type=\"bsplinecurve\"><string name=\"filename\" value=\"" + file + "\"/>" + place +
         "<bsdf type=\"hair\"><float name=\"beta_m\" value=\"0.3\"/></bsdf></shape>";
}

AnimateSettings shot_of_spheres() {
  AnimateSettings settings = shot(400);
  settings.render.lights.type = LightType::sphere;
  settings.render.lights.placement = LightPlacement::gather;
  return settings;
}

void expect_spheres_converge(const Scene& scene) {
  AnimateSettings settings = shot_of_spheres();
  const Frames truth = truth_of(scene, settings);
  for (const auto& [columns, error] : {std::pair{100, 0.015}, {400, 1e-4}}) {  // and each light by itself
    settings.tensor->columns = columns;
    EXPECT_LT(worst(errors(frames_of(scene, settings), truth)), error) << columns;
  }
}

TEST(ShotTruth, SphericalLightsConverge) {
  const TemporaryFolder folder;
  expect_spheres_converge(flight(folder));
}
TEST(ShotTruth, SphericalLightsConvergeAmongHairsThatMove) {
  const TemporaryFolder folder;
  const Scene scene = flight(folder, tuft(folder, animation("<translate x=\"-1.5\" z=\"0.5\"/>",
                                                            "<translate x=\"-0.5\" z=\"0.8\"/>")));
  expect_spheres_converge(scene);
}

TEST(ShotTruth, SphericalLightsAndHairsStandStillWhereNothingMoves) {
  const TemporaryFolder folder;
  const std::string view = look_at("2,2,5", "-0.5,1,-1"), place = "<translate x=\"-1.5\" z=\"0.5\"/>";
  AnimateSettings settings = shot_of_spheres();
  settings.tensor->columns = 20;
  std::vector<std::vector<Rgb>> pictures;
  for (const bool hairs : {false, true}) {
    const Scene scene =
        Scene::load(scene_file(folder, camera(animation(view, view)) + corner_with_a_box() + kPanelAbove +
                                           (hairs ? tuft(folder, animation(place, place)) : "")));
    for (const LightType type : {LightType::point, LightType::sphere}) {
      settings.render.lights.type = type;
      const Frames frames = frames_of(scene, settings);
      for (std::size_t k = 1; k < frames.size(); ++k) EXPECT_EQ(frames[k], frames[0]) << k;
      for (const auto& other : pictures) EXPECT_NE(frames[0], other);  // both are really there
      pictures.push_back(frames[0]);
    }
  }
}

}  // namespace
}  // namespace lumirank
