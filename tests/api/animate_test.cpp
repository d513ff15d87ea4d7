// Shots: frames, what is kept, what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>
#include <vector>

#include "api/render_tensor.h"
#include "api/shot_chunks.h"
#include "image/image_io.h"
#include "lumirank/animate.h"
#include "support/refused.h"
#include "support/scene_file.h"

namespace lumirank {
namespace {

namespace fs = std::filesystem;
using test::refused;
using test::TemporaryFolder;

const std::string kLamp =
    "<emitter type=\"point\"><point name=\"position\" x=\"0\" y=\"4\" z=\"1\"/></emitter>";
const std::string kPanel =
    "<shape type=\"rectangle\"><transform name=\"to_world\"><rotate x=\"1\" angle=\"90\"/><translate y=\"4\" "
    "z=\"1\"/></transform><emitter type=\"area\"><rgb name=\"radiance\" value=\"5\"/></emitter></shape>";

// A lamp over a floor; a ball that moves from left to right in one second, unless `moves` is false.
std::string moving_scene(const TemporaryFolder& folder, bool moves = true, const std::string& of_ball = "",
                         const std::string& lamp = kLamp) {
  const std::string file = folder / "moving.xml";
  std::ofstream(file)
      << "<scene version=\"3.0.0\"><sensor type=\"perspective\"><float name=\"fov\" value=\"50\"/><transform "
         "name=\"to_world\"><lookat origin=\"0,3,6\" target=\"0,0,0\" up=\"0,1,0\"/></transform><film "
         "type=\"hdrfilm\"><integer name=\"width\" value=\"16\"/><integer name=\"height\" "
         "value=\"12\"/></film>"
         "</sensor><shape type=\"rectangle\"><transform name=\"to_world\"><rotate x=\"1\" "
         "angle=\"-90\"/><scale "
         "value=\"4\"/></transform></shape><shape type=\"sphere\"><float name=\"radius\" value=\"0.6\"/>"
         "<animation name=\"to_world\"><transform time=\"0\"><translate x=\"-1\" y=\"1\"/></transform>"
      << "<transform time=\"1\"><translate x=\"" << (moves ? 1 : -1) << "\" y=\"1\"/></transform></animation>"
      << of_ball << "</shape>" << lamp << "</scene>";
  return file;
}

AnimateSettings small_shot(int first, int last) {
  AnimateSettings settings;
  settings.render.lights.count = 150;
  settings.render.view.spp = 1;
  settings.render.method.name = "brute-force";
  settings.render.traced.rest = RestOfPaths::skip;
  settings.frames_per_second = 4;
  settings.first = first, settings.last = last;
  settings.endings = {".pfm"};
  return settings;
}

std::string bytes_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
std::string frame(const std::string& folder, int k) {
  return folder + "/frame_000" + std::to_string(k) + ".pfm";
}
TEST(Animate, FramesAreThePicturesOfTheirMoments) {
  const TemporaryFolder folder;
  const Scene scene = Scene::load(moving_scene(folder));
  const std::string out = folder / "shot";
  const AnimateSettings settings = small_shot(0, -1);
  const AnimationResult result = animate(scene, settings, out);
  EXPECT_EQ(result.rendered, 5);  // 0, ¼, ½, ¾, 1 s
  EXPECT_FALSE(fs::exists(out + "/frame_0005.pfm"));
  std::set<std::string> different;
  for (int k = 0; k < 5; ++k) {
    write_picture(folder / "still.pfm", render(scene.at(k / 4.0), settings.render).picture);
    EXPECT_EQ(bytes_of(frame(out, k)), bytes_of(folder / "still.pfm")) << k;
    different.insert(bytes_of(frame(out, k)));
  }
  EXPECT_EQ(different.size(), 5u);
  EXPECT_EQ(scene.info().motion_end, 1);
}

// Lights, receivers and random numbers are the same in every frame, so nothing flickers where nothing moves.
TEST(Animate, AStaticSceneHasOneFrame) {
  const TemporaryFolder folder;
  const Scene scene = Scene::load(moving_scene(folder, false));
  AnimateSettings settings = small_shot(0, 3);
  for (const char* method : {"brute-force", "row-column-sampling", "slice-cuts"}) {
    settings.render.method.name = method;
    const std::string out = folder / method;
    animate(scene, settings, out);
    for (int k = 1; k < 4; ++k) EXPECT_EQ(bytes_of(frame(out, k)), bytes_of(frame(out, 0))) << method << k;
  }
}

TEST(Animate, GoesOnWhereItStoppedToTheSameBits) {
  const TemporaryFolder folder;
  const Scene scene = Scene::load(moving_scene(folder));
  const std::string whole = folder / "whole", parts = folder / "parts";
  animate(scene, small_shot(0, 4), whole);
  // Two processes with frames of their own, one of them killed between a picture and its report.
  EXPECT_EQ(animate(scene, small_shot(2, 3), parts).rendered, 2);
  fs::remove(parts + "/frame_0003.json");
  std::ofstream(frame(parts, 3)) << "half";
  const AnimationResult rest = animate(scene, small_shot(0, 4), parts);
  EXPECT_EQ(rest.kept, 1);
  EXPECT_EQ(rest.rendered, 4);
  for (int k = 0; k < 5; ++k) EXPECT_EQ(bytes_of(frame(parts, k)), bytes_of(frame(whole, k))) << k;
}

TEST(Animate, CancelledItKeepsWhatIsFinished) {
  const TemporaryFolder folder;
  const Scene scene = Scene::load(moving_scene(folder));
  const std::string out = folder / "shot";
  std::atomic<bool> stop = false;
  Sinks sinks;
  sinks.cancel = &stop;
  sinks.progress = [&](const char*, double fraction) { stop = fraction > 0.3; };
  const AnimationResult result = animate(scene, small_shot(0, 4), out, sinks);
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(result.rendered, 2);
  EXPECT_TRUE(fs::exists(out + "/frame_0001.json"));
  EXPECT_FALSE(fs::exists(frame(out, 2)));
}

// What tensor clustering cannot do is refused, not left out in silence; what it leaves out by default is
// said.
TEST(Animate, TensorClusteringSaysWhatItDoesNot) {
  const TemporaryFolder folder;
  const Scene scene = Scene::load(moving_scene(folder));
  const auto with = [&](const auto& change) {
    AnimateSettings settings = small_shot(0, 1);
    settings.tensor = TensorSettings{};
    change(settings);
    return refused([&] { animate(scene, settings, folder / "none"); });
  };
  EXPECT_NE(with([](auto& s) { s.render.time = 1; }).find("no time budget"), std::string::npos);
  EXPECT_NE(with([](auto& s) { s.render.layers = {"direct"}; }).find("no layers"), std::string::npos);
  EXPECT_NE(with([](auto& s) { s.tensor->bits = 17; }).find("16 or 32"), std::string::npos);
  EXPECT_NE(with([](auto& s) { s.tensor->overlap = -1; }).find("negative number of frames"),
            std::string::npos);
  EXPECT_NE(with([](auto& s) { s.tensor->max_change = -1; }).find("change of light"), std::string::npos);
  EXPECT_NE(with([](auto& s) { s.tensor->filter = -1; }).find("negative number of frames"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "none"));
}

// By default frames are what stills are, averaged with their neighbors; lights are shared where nothing makes
// them anew for each frame.
TEST(Animate, ByDefaultFramesAreStillsAveragedWithTheirNeighbors) {
  const TemporaryFolder folder;
  const Scene moving = Scene::load(moving_scene(folder));
  const auto chosen = [](const Scene& scene, const auto& change) {
    AnimateSettings settings = small_shot(0, 1);
    settings.render.method.name = "auto";
    change(settings);
    choose_shot_method(scene, settings);
    return settings;
  };
  const auto is_averaged = [](const AnimateSettings& s) { return s.temporal_filter == kShotFilter; };
  const auto shares_lights = [](const AnimateSettings& s) {
    return s.render.lights.placement == LightPlacement::gather;
  };
  const AnimateSettings usual = chosen(moving, [](auto&) {});
  EXPECT_TRUE(is_averaged(usual));
  EXPECT_FALSE(usual.tensor);
  EXPECT_FALSE(shares_lights(usual));
  EXPECT_TRUE(is_averaged(chosen(moving, [](auto& s) { s.render.time = 1; })));
  EXPECT_TRUE(is_averaged(chosen(moving, [](auto& s) { s.render.method.target_error = 0.1; })));
  EXPECT_EQ(chosen(moving, [](auto& s) { s.temporal_filter = 0; }).temporal_filter, 0);
  for (const auto& settings : {chosen(moving, [](auto& s) { s.render.method.name = "slice-cuts"; }),
                               chosen(moving, [](auto& s) { s.tensor = TensorSettings{}; }),
                               chosen(moving, [](auto& s) { s.render.layers = {"direct"}; })}) {
    EXPECT_FALSE(settings.temporal_filter);
    EXPECT_TRUE(shares_lights(settings));
  }
  const std::string still = folder / "still.xml";
  std::ofstream(still) << "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><shape type=\"rectangle\"/>"
                       << kLamp << "</scene>";
  EXPECT_FALSE(chosen(Scene::load(still), [](auto&) {}).temporal_filter);
}

// What fills space is there in frames as in stills.
TEST(Animate, ByDefaultFramesHaveTheMediaOfTheScene) {
  const TemporaryFolder folder;
  const Scene scene = Scene::load(moving_scene(folder, true,
                                               "<bsdf type=\"null\"/><medium name=\"interior\" "
                                               "type=\"homogeneous\"><rgb name=\"sigma_t\" value=\"3\"/>"
                                               "<rgb name=\"albedo\" value=\"0.9\"/></medium>"));
  AnimateSettings settings = small_shot(1, 2);
  settings.render = {};
  settings.render.view.spp = 4;
  settings.render.denoise = Denoise::off;
  choose_shot_method(scene, settings);
  animate(scene, settings, folder / "shot");
  const auto report = nlohmann::json::parse(bytes_of(folder / "shot/frame_0001.json"));
  EXPECT_EQ(report["method"], "path-tracing");
  EXPECT_EQ(report["shot.averaged"], 5);  // all: one before, and three of four after
}

TEST(Animate, AveragedFramesHaveTheSameBitsWhoeverMakesThem) {
  const TemporaryFolder folder;
  const Scene scene = Scene::load(moving_scene(folder));
  AnimateSettings settings = small_shot(0, 4);
  settings.render.method.name = "auto";
  settings.render.denoise = Denoise::off;
  settings.render.passes = 2;
  settings.temporal_filter = 1;
  EXPECT_EQ(animate(scene, settings, folder / "whole").rendered, 5);
  for (const auto& [first, last] : {std::pair{3, 3}, {0, 1}, {2, 4}}) {
    settings.first = first, settings.last = last;
    animate(scene, settings, folder / "parts");
  }
  settings.temporal_filter = 0, settings.first = 0, settings.last = 4;
  animate(scene, settings, folder / "alone");
  for (int k = 0; k < 5; ++k) {
    EXPECT_EQ(bytes_of(frame(folder / "parts", k)), bytes_of(frame(folder / "whole", k))) << k;
    EXPECT_NE(bytes_of(frame(folder / "alone", k)), bytes_of(frame(folder / "whole", k))) << k;
  }
  settings.temporal_filter = 1;
  settings.tensor = TensorSettings{};
  EXPECT_NE(refused([&] { animate(scene, settings, folder / "none"); }).find("a filter of its own"),
            std::string::npos);
}

// Whatever the clock says in the first of them, and in a process that goes on with the shot.
TEST(Animate, AveragedFramesOfABudgetRepeatWhatTheFirstChose) {
  const TemporaryFolder folder;
  const Scene scene = Scene::load(moving_scene(folder));
  AnimateSettings settings = small_shot(0, 2);
  settings.render.method.name = "auto";
  settings.render.denoise = Denoise::off;
  settings.render.view.spp.reset();
  settings.render.time = 0.05;
  settings.temporal_filter = 1;
  animate(scene, settings, folder / "shot");
  settings.first = 3, settings.last = 4;
  animate(scene, settings, folder / "shot");
  const auto choices = [&](int k) {
    return nlohmann::json::parse(
        bytes_of(folder / "shot/frame_000" + std::to_string(k) + ".json"))["choices"];
  };
  EXPECT_FALSE(choices(0).empty());
  for (int k = 1; k < 5; ++k) EXPECT_EQ(choices(k), choices(0)) << k;
}

// Light that columns cannot carry (here a mirror's caustics) is traced beside them, and is what a still has.
TEST(Animate, TensorClusteringTracesTheRestOfTheLight) {
  const TemporaryFolder folder;
  const Scene scene = Scene::load(moving_scene(folder, true, "<bsdf type=\"conductor\"/>", kPanel));
  AnimateSettings settings = small_shot(1, 1);
  const auto picture = [&](RestOfPaths rest, bool clustered) {
    settings.render.traced.rest = rest;
    settings.tensor.reset();
    if (clustered) settings.tensor = TensorSettings{.chunk = 1, .overlap = 0};
    const std::string out =
        folder / ((rest == RestOfPaths::trace ? "trace" : "skip") + std::to_string(clustered));
    EXPECT_EQ(animate(scene, settings, out).rendered, 1);
    return image::read_image(frame(out, 1)).color.pixels;
  };
  const auto added = [&](bool clustered) {
    std::vector<Rgb> more = picture(RestOfPaths::trace, clustered);
    const std::vector<Rgb> less = picture(RestOfPaths::skip, clustered);
    for (std::size_t k = 0; k < more.size(); ++k) more[k] = more[k] - less[k];
    return more;
  };
  const std::vector<Rgb> still = added(false), clustered = added(true);
  ASSERT_EQ(still.size(), clustered.size());
  float most = 0;
  for (std::size_t k = 0; k < still.size(); ++k)
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(clustered[k][c], still[k][c], 1e-5) << k;
      most = std::max(most, still[k][c]);
    }
  EXPECT_GT(most, 0.01);
}

AnimateSettings clustered_shot(int first, int last) {
  AnimateSettings settings = small_shot(first, last);
  settings.tensor = TensorSettings{.chunk = 2, .overlap = 1, .rows = 20, .columns = 10};
  return settings;
}

TEST(Animate, TensorClusteringOfAStaticSceneHasOneFrame) {
  const TemporaryFolder folder;
  const Scene scene = Scene::load(moving_scene(folder, false));
  animate(scene, clustered_shot(0, 3), folder / "shot");  // two chunks, as long as each other
  for (int k = 1; k < 4; ++k)
    EXPECT_EQ(bytes_of(frame(folder / "shot", k)), bytes_of(frame(folder / "shot", 0))) << k;
}

// Chunks are blended where they overlap, by pictures that one leaves for the next: whoever makes them, and in
// whatever order, bits are the same.
TEST(Animate, ChunksOverlapToTheSameBitsWhoeverMakesThem) {
  const TemporaryFolder folder;
  const Scene scene = Scene::load(moving_scene(folder));
  const std::string whole = folder / "whole", parts = folder / "parts";
  animate(scene, clustered_shot(0, 4), whole);
  for (const auto& [first, last] : {std::pair{4, 4}, {1, 2}, {0, 3}})
    animate(scene, clustered_shot(first, last), parts);
  for (int k = 0; k < 5; ++k) {
    EXPECT_EQ(bytes_of(frame(parts, k)), bytes_of(frame(whole, k))) << k;
    EXPECT_FALSE(fs::exists(whole + "/tail_000" + std::to_string(k) + ".pfm")) << k;
  }
}

TEST(ShotChunks, ShareFramesWithTheNext) {
  const api::ShotChunks chunks(10, 29, 8, 3);
  const api::Chunk first = chunks.of(12), last = chunks.of(29);
  EXPECT_EQ(std::tuple(first.first, first.last, first.tail_last), std::tuple(10, 17, 20));
  EXPECT_EQ(std::tuple(last.first, last.last, last.tail_last), std::tuple(26, 29, 29));
  EXPECT_EQ(chunks.before(last).first, 18);
  EXPECT_EQ(chunks.part(10), 1);
  EXPECT_EQ(chunks.part(17), 1);
  EXPECT_EQ(chunks.part(18), 0.25);
  EXPECT_EQ(chunks.part(20), 0.75);
  EXPECT_EQ(chunks.part(21), 1);
  EXPECT_EQ(api::ShotChunks(0, 9, 2, 4).of(0).tail_last, 3);  // no longer than a chunk
}

TEST(Animate, ChunksAreAsShortAsMemoryWants) {
  const TemporaryFolder folder;
  const Scene scene = Scene::load(moving_scene(folder));
  AnimateSettings settings = clustered_shot(0, 4);
  settings.tensor->memory = 1;
  EXPECT_NE(
      refused([&] { animate(scene, settings, folder / "none"); }).find("more than the memory that is given"),
      std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "none/frame_0000.pfm"));
  settings.tensor->chunk = 1000;
  settings.render.lights.count = 100'000;
  int before = 0;
  for (const double megabytes : {300, 600, 3000, 1'000'000}) {
    settings.tensor->memory = megabytes;
    const int frames =
        api::frames_within_memory({scene.at(0), scene.at(0.25)}, settings.render, *settings.tensor);
    EXPECT_GT(frames, before) << megabytes;
    before = frames;
  }
  EXPECT_EQ(before, 1000);
}

// All columns of a chunk of one frame are those that the frame has by itself, added up in another order.
TEST(Animate, TensorClusteringOfNoColumnsSumsThemAll) {
  const TemporaryFolder folder;
  const Scene scene = Scene::load(moving_scene(folder));
  AnimateSettings settings = small_shot(1, 2);
  settings.render.lights.placement = LightPlacement::gather;  // as clusterings have it
  fs::create_directory(folder / "alone");
  for (const int k : {1, 2})
    write_picture(frame(folder / "alone", k), render(scene.at(k / 4.0), settings.render).picture);
  settings.tensor = TensorSettings{.chunk = 1, .overlap = 0, .columns = 0};
  animate(scene, settings, folder / "summed");
  const auto values = [&](const char* shot, int k) {
    const std::string bytes = bytes_of(frame(folder / shot, k));
    std::vector<float> out(std::size_t{16} * 12 * 3);
    std::memcpy(out.data(), bytes.data() + bytes.size() - out.size() * sizeof(float),
                out.size() * sizeof(float));
    return out;
  };
  for (const int k : {1, 2}) {
    const auto want = values("alone", k), have = values("summed", k);
    const float brightest = *std::max_element(want.begin(), want.end());
    EXPECT_GT(brightest, 0);
    for (std::size_t n = 0; n < want.size(); ++n) EXPECT_NEAR(have[n], want[n], 1e-5f * brightest) << n;
  }
}

// Lights on gather samples are the same lights in every frame of a shot, planned for its whole motion: so one
// frame is the same whichever others are asked for, and is not that of a still with a plan of its own.
TEST(Animate, FramesOneByOneSharePlansOfGatherLights) {
  const TemporaryFolder folder;
  const Scene scene = Scene::load(moving_scene(folder));
  AnimateSettings settings = small_shot(0, 2);
  settings.render.lights.placement = LightPlacement::gather;
  animate(scene, settings, folder / "some");
  settings.first = settings.last = 2;
  animate(scene, settings, folder / "one");
  EXPECT_EQ(bytes_of(frame(folder / "some", 2)), bytes_of(frame(folder / "one", 2)));
  write_picture(folder / "still.pfm", render(scene.at(0.5), settings.render).picture);
  EXPECT_NE(bytes_of(folder / "still.pfm"), bytes_of(frame(folder / "one", 2)));
}

TEST(Animate, TensorClusteringWritesItsClusters) {
  const TemporaryFolder folder;
  const Scene scene = Scene::load(moving_scene(folder));
  AnimateSettings settings = small_shot(0, 4);
  settings.tensor =
      TensorSettings{.chunk = 3, .overlap = 1, .rows = 20, .columns = 10, .write_clusters = true};
  animate(scene, settings, folder / "shot");
  for (const auto& [name, last] : {std::pair{"clusters_0000.json", 3}, {"clusters_0003.json", 4}}) {
    const auto chunk = nlohmann::json::parse(bytes_of(folder / "shot/" + name));
    EXPECT_EQ(chunk["frames"][1], last);
    // Every light-frame pair is in one rectangle at most, and most are in one.
    std::set<std::pair<int, int>> pairs;
    for (const auto& r : chunk["rectangles"])
      for (int k = r["frames"][0]; k <= r["frames"][1]; ++k)
        for (const int light : r["lights"]) EXPECT_TRUE(pairs.insert({light, k}).second);
    const int frames = last - chunk["frames"][0].get<int>() + 1;
    EXPECT_GT(pairs.size(), 0.5 * frames * chunk["lights"].get<double>());
  }
}

// Film samples take their light from the tensor's rows: those of the frame, as many as `film_samples` says.
TEST(Animate, TensorClusteringHasFilmSamples) {
  const TemporaryFolder folder;
  const Scene scene = Scene::load(moving_scene(folder));
  const auto mean = [&](int film_samples) {
    AnimateSettings settings = small_shot(0, 1);
    settings.render.view.film_samples = film_samples;
    settings.tensor = TensorSettings{};
    const std::string out = folder / ("shot" + std::to_string(film_samples));
    EXPECT_EQ(animate(scene, settings, out).rendered, 2);
    const auto report = nlohmann::json::parse(bytes_of(out + "/frame_0001.json"));
    EXPECT_EQ(report["film.samples"], film_samples);
    EXPECT_EQ(report.contains("film.from_own_pixel"), film_samples > 0);
    const auto pixels = image::read_image(frame(out, 1)).color.pixels;
    double sum = 0;
    for (const Rgb& p : pixels) sum += p.g;
    return sum / static_cast<double>(pixels.size());
  };
  const double receivers = mean(0);
  EXPECT_GT(receivers, 0);
  EXPECT_NEAR(mean(16) / receivers, 1, 0.03);
}

// A fine mesh that moves, frame by frame with structures of their own and with refitted ones: the same
// pictures but for rounding, and hardly any memory for the structure from the third frame on.
TEST(Animate, RefitsWhereOnlyVerticesMove) {
  const TemporaryFolder folder;
  constexpr int kSide = 184;
  {
    std::ofstream mesh(folder / "grid.obj");
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x)
        mesh << "v " << 2.0 * x / (kSide - 1) - 1 << ' ' << 2.0 * y / (kSide - 1) - 1 << ' '
             << 0.3 * (x % 7 == 0) << '\n';
    for (int y = 1; y < kSide; ++y)
      for (int x = 1; x < kSide; ++x)
        mesh << "f " << y * kSide + x << ' ' << y * kSide + x + 1 << ' ' << (y - 1) * kSide + x + 1 << ' '
             << (y - 1) * kSide + x << '\n';
  }
  const Scene scene = Scene::load(
      moving_scene(folder, true, "",
                   kLamp + "<shape type=\"obj\"><string name=\"filename\" value=\"grid.obj\"/><animation "
                           "name=\"to_world\"><transform time=\"0\"><translate y=\"1\" z=\"-1\"/></transform>"
                           "<transform time=\"1\"><rotate y=\"1\" angle=\"40\"/><translate y=\"1.5\"/>"
                           "</transform></animation></shape>"));
  AnimateSettings settings = small_shot(0, 3);
  animate(scene, settings, folder / "built");
  settings.refit = true;
  animate(scene, settings, folder / "refitted");
  for (int k = 0; k < 4; ++k) {
    const auto want = image::read_image(frame(folder / "built", k)).color.pixels;
    const auto have = image::read_image(frame(folder / "refitted", k)).color.pixels;
    ASSERT_EQ(have.size(), want.size());
    double difference = 0, sum = 0;
    for (std::size_t n = 0; n < want.size(); ++n)
      difference += std::abs(have[n].g - want[n].g), sum += want[n].g;
    EXPECT_GT(sum, 0);
    EXPECT_LT(difference, 1e-3 * sum) << k;
  }
  const auto scene_bytes = [&](const char* shot) {
    const auto report = nlohmann::json::parse(bytes_of(folder / (std::string(shot) + "/frame_0002.json")));
    return report["memory.scene_bytes"].get<double>();
  };
  EXPECT_LT(scene_bytes("refitted"), 0.6 * scene_bytes("built"));
  settings.refit = false;
  EXPECT_NE(refused([&] { animate(scene, settings, folder / "refitted"); }).find("its \"refit\""),
            std::string::npos);
  settings.refit = true;
  settings.tensor = TensorSettings{};
  EXPECT_NE(refused([&] { animate(scene, settings, folder / "tensor"); }).find("leave out --refit"),
            std::string::npos);
  settings.tensor.reset();
  settings.render.view.shutter_open = 0, settings.render.view.shutter_close = 0.5;
  EXPECT_NE(refused([&] { animate(scene, settings, folder / "open"); }).find("an open shutter"),
            std::string::npos);
}

TEST(Animate, RefusesOtherShotsAndMomentsThatAreNot) {
  const TemporaryFolder folder;
  const Scene scene = Scene::load(moving_scene(folder));
  const std::string out = folder / "shot";
  animate(scene, small_shot(0, 0), out);
  const std::string kept = bytes_of(frame(out, 0));
  AnimateSettings other = small_shot(0, 1);
  other.render.seed = 2;
  EXPECT_NE(refused([&] { animate(scene, other, out); }).find("frames of another shot: its \"settings\""),
            std::string::npos);
  other = small_shot(0, 1);
  other.frames_per_second = 8;
  EXPECT_NE(refused([&] { animate(scene, other, out); }).find("frames_per_second"), std::string::npos);
  EXPECT_EQ(bytes_of(frame(out, 0)), kept);
  EXPECT_FALSE(fs::exists(frame(out, 1)));
  EXPECT_NE(refused([&] { animate(scene, small_shot(0, 5), out); }).find("has frames 0 to 4 at 4.0"),
            std::string::npos);
  EXPECT_NE(refused([&] { animate(scene, small_shot(3, 2), out); }).find("no frames from 3 to 2"),
            std::string::npos);
  const std::string strange = folder / "strange";
  fs::create_directories(strange);
  std::ofstream(strange + "/frame_0001.exr") << "x";
  EXPECT_NE(refused([&] { animate(scene, small_shot(0, 1), strange); }).find("no shot.json"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(strange + "/shot.json"));
}

}  // namespace
}  // namespace lumirank
