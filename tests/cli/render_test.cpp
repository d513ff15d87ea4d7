// `lumirank render` from outside: files, reports, settings and parts of the picture.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "program.h"

namespace lumirank::test {
namespace {

// Fixed numbers make the work small and the columns the same for all options that do not touch them.
const Arguments kBruteForce = {"--method", "brute-force", "--direct", "matrix"};

class Render : public testing::Test {
 protected:
  TemporaryFolder folder_;
  std::string scene_ = write_scene(folder_, small_room());

  Pixels render(const Arguments& more, const std::string& name = "picture.exr") {
    const std::string file = folder_ / name;
    const Outcome outcome = lumirank(render_small(scene_, file) + more);
    EXPECT_SUCCESS(outcome);
    return read_pixels(file);
  }
};

// Sums in two orders, and one rounding to the file, differ by a few units in the last place: n additions of
// positive terms by less than n·2⁻²⁴ relative, here with n = 300 columns and a filter of 4 samples.
void expect_close(double a, double b, const std::string& what) {
  EXPECT_NEAR(a, b, 2 * 304 * std::ldexp(1.0, -24) * (std::abs(a) + std::abs(b)) + 1e-12) << what;
}

TEST_F(Render, EveryFormatInOneRun) {
  const Outcome outcome =
      lumirank(render_small(scene_, folder_ / "a.exr") +
               Arguments{"--denoise", "off", "-o", folder_ / "a.png", "-o", folder_ / "a.pfm"});
  EXPECT_SUCCESS(outcome);
  for (const char* name : {"a.exr", "a.png", "a.pfm"}) {
    EXPECT_NE(outcome.out.find(folder_ / name), std::string::npos);
    const Pixels p = read_pixels(folder_ / name);
    EXPECT_EQ(p.width, 12);
    EXPECT_EQ(p.height, 10);
    EXPECT_TRUE(all_finite(p));
    EXPECT_GT(mean(p), 0);
  }
  EXPECT_EQ(read_pixels(folder_ / "a.exr"), read_pixels(folder_ / "a.pfm"));
  EXPECT_EQ(files_in(folder_ / "").size(), 4u) << "no temporary file is left";
}

// Once, beside what it has written, and not to who does not want one.
TEST_F(Render, SaysWhatADenoiserWouldGain) {
  const auto said = [&](const Arguments& more) {
    const Outcome outcome = start_lumirank(render_small(scene_, folder_ / "a.exr") + more, {},
                                           "export LUMIRANK_DENOISER=/nowhere");
    EXPECT_SUCCESS(outcome);
    const auto first = outcome.out.find("`make denoiser`");
    if (first != std::string::npos) {
      EXPECT_EQ(outcome.out.find("`make denoiser`", first + 1), std::string::npos);
    }
    return first != std::string::npos;
  };
  EXPECT_TRUE(said({"--passes", "2"}));
  EXPECT_FALSE(said({"--passes", "2", "--denoise", "off"}));
  EXPECT_FALSE(said({"--passes", "2", "--quiet"}));
  EXPECT_FALSE(said({"--method", "slice-cuts"})) << "which is not denoised";
}

TEST_F(Render, IlluminanceHasAFalseColorPictureBesideEachPng) {
  const Outcome outcome =
      lumirank(render_small(scene_, folder_ / "a.exr") +
               Arguments{"-o", folder_ / "a.png", "--aov", "illuminance", "--illuminance-range", "0:2e6"});
  EXPECT_SUCCESS(outcome);
  EXPECT_NE(outcome.out.find("a.illuminance.png"), std::string::npos);
  const Pixels p = read_pixels(folder_ / "a.illuminance.png");
  EXPECT_EQ(p.width, 12);
  EXPECT_GT(p.height, 10) << "the scale";
  EXPECT_EQ(files_in(folder_ / "").size(), 4u);
}

TEST_F(Render, QuietSaysNothing) {
  const Outcome outcome = lumirank(render_small(scene_, folder_ / "a.exr") + Arguments{"--quiet"});
  EXPECT_SUCCESS(outcome);
  EXPECT_EQ(outcome.out + outcome.err, "");
}

TEST_F(Render, TheReportHasTheStableKeys) {
  for (const char* method : {"auto", "brute-force", "instant-radiosity", "power-sampling"}) {
    const std::string file = folder_ / "report.json";
    render({"--method", method, "--report", file, "--seed", "7"});
    const auto report = read_json(file);
    for (const char* key : {"method", "seconds.total", "entries.evaluated", "rays.shadow", "rays.per_pixel",
                            "sampling_rate", "rows", "columns", "virtual_lights", "receivers",
                            "memory.peak_bytes", "parameters", "seed", "version"})
      ASSERT_TRUE(report.contains(key)) << method << " " << key;
    EXPECT_EQ(report["method"], std::string(method) == "auto" ? "row-guided-sampling" : method);
    EXPECT_EQ(report["seed"], 7);
    EXPECT_EQ(report["parameters"]["seed"], "7");
    // Every ray within a closed room meets a wall or the lamp, which reflects nothing and is no receiver.
    const double receivers = report["receivers"];
    const int passes =
        std::string(method) == "auto" ? 16 : 4;  // of one receiver per pixel, or so many at once
    EXPECT_LE(receivers, 12 * 10 * passes);
    EXPECT_GT(receivers, 0.9 * 12 * 10 * passes);
    const double entries = report["entries.evaluated"], rays = report["rays.shadow"],
                 rate = report["sampling_rate"], columns = report["virtual_lights"];
    EXPECT_GT(columns, 0);
    EXPECT_GT(rays, 0);
    EXPECT_LE(rays, entries) << "an entry needs one shadow ray, and many need none";
    EXPECT_NEAR(report["rays.per_pixel"].get<double>(), rays / 120, 1e-9 * rays);
    EXPECT_GE(rate, 0);
    if (std::string(method) != "auto") {  // each pass has lights of its own
      EXPECT_NEAR(rate, entries / (receivers * columns), 1e-9);
    }
    if (std::string(method) == "brute-force") {
      EXPECT_EQ(entries, receivers * columns);
      EXPECT_EQ(report["columns"], columns);
      EXPECT_EQ(rate, 1);
    }
    EXPECT_GT(report["memory.peak_bytes"], 1 << 20);
    // Phases one after another; those within the method are parts of it.
    double phases = 0;
    for (const char* phase : {"build", "receivers", "traced_direct", "lights", "matrix", "method", "film"})
      if (const std::string key = std::string("seconds.") + phase; report.contains(key)) {
        EXPECT_GE(report[key], 0);
        phases += report[key].get<double>();
      }
    EXPECT_LE(phases, report["seconds.total"].get<double>());
  }
}

// Of the reduced matrices, which slice-cuts evaluates entirely; of all entries it is a small share.
TEST_F(Render, TheSamplingRateIsTheMethodsOwn) {
  const std::string file = folder_ / "report.json";
  render({"--method", "slice-cuts", "--set", "initial-columns=4", "--set", "alpha=0.2", "--report", file});
  const auto report = read_json(file);
  EXPECT_GE(report["sampling_rate"].get<double>(), 1);
  EXPECT_LT(report["columns"].get<double>(), report["virtual_lights"].get<double>());
}

TEST_F(Render, ReplayGivesTheSameBits) {
  const std::string file = folder_ / "report.json";
  const Pixels first = render({"--report", file, "--seed", "3", "--method", "row-column-sampling", "--set",
                               "rows=40", "--set", "columns=30", "--crop", "2,1,7,6", "--aov", "indirect"});
  const std::string again = folder_ / "again.exr";
  const Outcome outcome = lumirank({"render", scene_, "-o", again, "--replay", file});
  EXPECT_SUCCESS(outcome);
  EXPECT_EQ(read_pixels(again), first);
  // Options beside it win.
  EXPECT_SUCCESS(lumirank({"render", scene_, "-o", again, "--replay", file, "--seed", "4"}));
  EXPECT_NE(read_pixels(again), first);
}

// Every method's clock choices are in its report, so its picture comes back whatever the clock says now.
TEST_F(Render, ReplayRepeatsWhatTheClockDecided) {
  const std::string report = folder_ / "report.json", again = folder_ / "again.exr";
  for (const char* method : {"auto", "power-sampling", "brute-force"}) {
    // So many lights that the budget cuts the run short.
    const std::string file = folder_ / "first.exr";
    EXPECT_SUCCESS(lumirank({"render", scene_, "-o", file, "--method", method, "--lights", "20000", "--size",
                             "60x50", "--time", "0.3", "--report", report, "--preview", folder_ / "p.png"}));
    const Pixels first = read_pixels(file);
    const auto choices = read_json(report)["choices"];
    EXPECT_TRUE(choices.contains(std::string(method) == "auto" ? "passes" : "receivers_per_pixel")) << method;
    const Arguments replay = {"render", scene_, "-o", again, "--replay", report};
    for (const char* threads : {"1", "3"}) {
      EXPECT_SUCCESS(lumirank(replay + Arguments{"--threads", threads, "--report", folder_ / "second.json"}));
      EXPECT_EQ(read_pixels(again), first) << method << " " << threads;
    }
    EXPECT_EQ(read_json(folder_ / "second.json")["choices"], choices) << "a replay can be replayed";
  }
  // The rest of the paths and the layers share the budget.
  const std::string file = folder_ / "first.exr";
  EXPECT_SUCCESS(
      lumirank({"render", scene_, "-o", file, "--lights", "20000", "--size", "60x50", "--time", "0.5",
                "--rest", "trace", "--aov", "direct,light:*,illuminance", "--report", report}));
  EXPECT_TRUE(read_json(report)["choices"].contains("rest_paths"));
  EXPECT_SUCCESS(lumirank({"render", scene_, "-o", again, "--replay", report, "--threads", "2"}));
  EXPECT_EQ(read_pixels(again), read_pixels(file));

  EXPECT_SUCCESS(lumirank({"render", scene_, "-o", file, "--method", "brute-force", "--lights", "20000",
                           "--size", "60x50", "--time", "0.3", "--report", report}));
  const Arguments replay = {"render", scene_, "-o", folder_ / "no.exr", "--replay", report};
  expect_refused(lumirank(replay + Arguments{"--lights", "300"}), "do not fit: 'lights_asked' was");
  expect_refused(lumirank(replay + Arguments{"--size", "10x10"}), "do not fit: 'receivers' was");
  expect_refused(lumirank(replay + Arguments{"--method", "power-sampling"}),
                 "do not fit: they lack 'method.power-sampling'");
  EXPECT_SUCCESS(lumirank(replay + Arguments{"--lights", "300", "--time", "1"}));

  auto json = read_json(report);
  json.erase("choices");
  std::ofstream(report) << json;
  expect_refused(lumirank(replay), "lacks the choices");
  json["choices"]["columns"] = "many";
  std::ofstream(report) << json;
  expect_refused(lumirank(replay), "lacks the choices");
}

TEST_F(Render, TheSeedChangesThePicture) {
  const Pixels a = render({"--seed", "1"}), b = render({"--seed", "2"}), c = render({"--seed", "1"});
  EXPECT_NE(a, b);
  EXPECT_EQ(a, c);
}

TEST_F(Render, TheNumberOfThreadsDoesNot) {
  for (const auto& listed : nlohmann::json::parse(lumirank({"methods", "--json"}).out)) {
    if (listed.at("of_shots") == true) continue;
    const auto method = listed.at("name").get<std::string>();
    const bool combines = method == "row-column-sampling" || method == "brute-force";
    const Arguments base = {"--method", method, "--aov", combines ? "direct,albedo" : "albedo"};
    const Pixels one = render(base + Arguments{"--threads", "1"});
    for (const char* threads : {"2", "4"})
      EXPECT_EQ(render(base + Arguments{"--threads", threads}), one) << method << " " << threads;
  }
}

TEST_F(Render, SizeAndReceiversPerPixel) {
  const std::string file = folder_ / "a.exr";
  // No lamp in sight: every sample of the closed room is a receiver.
  const std::string bare = write_scene(
      folder_, point_camera("0,0,1", "0,0,0", 16, 50) +
                   "<shape type=\"cube\"><boolean name=\"flip_normals\" value=\"true\"/><transform "
                   "name=\"to_world\"><scale value=\"2\"/></transform></shape><emitter type=\"point\"/>");
  const Arguments base = {"render", bare, "-o", file, "--lights", "50", "--report", folder_ / "r.json"};
  EXPECT_SUCCESS(lumirank(base));
  EXPECT_EQ(read_pixels(file).width, 16) << "as the scene says";
  EXPECT_EQ(read_json(folder_ / "r.json")["receivers"], 16 * 16 * 16) << "by default";
  EXPECT_SUCCESS(lumirank(base + Arguments{"--size", "7x5", "--spp", "9"}));
  EXPECT_EQ(read_pixels(file).height, 5);
  EXPECT_EQ(read_json(folder_ / "r.json")["receivers"], 7 * 5 * 9);
}

// The eye's samples are keyed by their pixel and lights are aimed at the whole film: a window sees what the
// whole sees there, whatever the filter reaches beyond its edges.
TEST_F(Render, ACropIsAWindowOfTheWhole) {
  const auto expect_window = [](const Pixels& whole, const Pixels& window, const std::string& channel) {
    ASSERT_EQ(window.width, 5) << channel;
    ASSERT_EQ(window.height, 4) << channel;
    for (std::size_t y = 0; y < 4; ++y)
      for (std::size_t x = 0; x < 5; ++x)
        EXPECT_EQ(window.channels.at(channel)[5 * y + x], whole.channels.at(channel)[12 * (y + 2) + x + 6])
            << channel << " at " << x << "," << y;
  };
  const Arguments eye = {"--aov", "albedo,normal,depth,position,samples,emission"};
  const Pixels whole = render(eye), window = render(eye + Arguments{"--crop", "6,2,5,4"});
  for (const auto& [channel, values] : whole.channels)
    if (channel.size() > 1) expect_window(whole, window, channel);  // all but the colors

  // Brute force has the same columns, and the same sums of them, also where filters reach beyond the window.
  const std::string ball =
      "<shape type=\"sphere\"><point name=\"center\" x=\"-0.7\" y=\"-1\" z=\"0\"/><float name=\"radius\" "
      "value=\"0.8\"/><bsdf type=\"roughconductor\"><float name=\"alpha\" value=\"0.1\"/></bsdf></shape>"
      "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"0.6\"/><translate "
      "z=\"0.5\"/></transform>"
      "<bsdf type=\"mask\"><float name=\"opacity\" value=\"0.5\"/><bsdf type=\"diffuse\"/></bsdf></shape>";
  for (const char* filter : {"box", "tent", "gaussian", "lanczos"}) {
    std::string room = small_room(ball);
    const std::string box = "<rfilter type=\"box\"/>";
    ASSERT_NE(room.find(box), std::string::npos);
    room.replace(room.find(box), box.size(), "<rfilter type=\"" + std::string(filter) + "\"/>");
    scene_ = write_scene(folder_, room);
    for (const char* direct : {"matrix", "auto"}) {
      const Arguments all = {"--method", "brute-force", "--aov", "direct", "--direct", direct};
      const Pixels full = render(all), part = render(all + Arguments{"--crop", "6,2,5,4"});
      for (const auto& [channel, values] : full.channels) expect_window(full, part, channel);
    }
  }

  const std::string file = folder_ / "reference.exr";
  const Arguments reference = {"reference", scene_, "-o", file, "--size", "12x10", "--spp", "4"};
  EXPECT_SUCCESS(lumirank(reference));
  const Pixels truth = read_pixels(file);
  EXPECT_SUCCESS(lumirank(reference + Arguments{"--crop", "6,2,5,4"}));
  for (const char* c : {"R", "G", "B"}) expect_window(truth, read_pixels(file), c);
}

TEST_F(Render, ExposureDoublesThePng) {
  const Pixels exr = render({}), dark = render({"--exposure", "-4"}, "dark.png"),
               darker = render({"--exposure", "-5"}, "darker.png");
  // sRGB's curve undone, a stop is a factor of 2 up to the rounding to 8 bits.
  const auto linear = [](float v) {
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
  };
  for (const char* c : {"R", "G", "B"})
    for (std::size_t p = 0; p < 120; ++p) {
      const float a = dark.channels.at(c)[p], b = darker.channels.at(c)[p];
      const float lo = linear(std::max(0.0f, b - 0.5f / 255)), hi = linear(b + 0.5f / 255);
      if (a >= 1) continue;  // cut off
      EXPECT_LE(linear(std::max(0.0f, a - 0.5f / 255)), 2 * hi + 1e-5f);
      EXPECT_GE(linear(a + 0.5f / 255), 2 * lo - 1e-5f);
      EXPECT_GE(linear(a + 0.5f / 255) + 1e-5f, exr.channels.at(c)[p] / 16);
    }
}

TEST_F(Render, ToneMapsDifferAndLeaveTheExrAlone) {
  const Outcome outcome = lumirank(render_small(scene_, folder_ / "a.exr") +
                                   Arguments{"-o", folder_ / "a.png", "--tonemap", "agx"});
  EXPECT_SUCCESS(outcome);
  const Pixels none = render({}, "none.png"), reinhard = render({"--tonemap", "reinhard"}, "reinhard.png");
  EXPECT_NE(none, reinhard);
  EXPECT_NE(read_pixels(folder_ / "a.png"), reinhard);
  EXPECT_EQ(read_pixels(folder_ / "a.exr"), render({}));
}

TEST_F(Render, DepthLimits) {
  // Depth 1 is emission alone: the lamp where it is seen (radiance 9, 8, 7), black elsewhere.
  const Pixels one = render(Arguments{"--max-depth", "1"} + kBruteForce);
  for (const float v : one.channels.at("R")) EXPECT_TRUE(v >= 0 && v <= 9 * (1 + 1e-6f)) << v;
  const Pixels emission = render(Arguments{"--aov", "emission"} + kBruteForce);
  for (const char* c : {"R", "G", "B"})
    EXPECT_EQ(one.channels.at(c), emission.channels.at(std::string("emission.") + c));
  // Depth 2 adds direct light and nothing else: one more than the depth at which indirect light is dropped.
  const Pixels two = render(Arguments{"--max-depth", "2", "--aov", "indirect,direct,emission"} + kBruteForce);
  for (std::size_t p = 0; p < 120; ++p) {
    EXPECT_EQ(two.channels.at("indirect.R")[p], 0);
    expect_close(two.channels.at("R")[p], two.channels.at("direct.R")[p] + two.channels.at("emission.R")[p],
                 "depth 2");
  }
  EXPECT_GT(mean(two), mean(one));
}

TEST_F(Render, WithoutTheClampNothingIsRemoved) {
  const std::string report = folder_ / "r.json";
  const Pixels off = render(Arguments{"--clamp", "0", "--report", report} + kBruteForce);
  EXPECT_EQ(read_json(report)["clamp.removed_fraction"], 0);
  const Pixels tight = render(Arguments{"--clamp", "0.001", "--report", report} + kBruteForce);
  EXPECT_GT(read_json(report)["clamp.removed_fraction"], 0);
  EXPECT_LT(mean(tight), mean(off));
}

TEST_F(Render, DirectAndIndirectAddUp) {
  const Pixels whole = render(Arguments{"--aov", "direct,indirect,emission,light:*"} + kBruteForce);
  for (const char* c : {"R", "G", "B"}) {
    const auto plane = [&](const std::string& aov) { return whole.channels.at(aov + "." + c); };
    const auto direct = plane("direct"), indirect = plane("indirect"), emission = plane("emission"),
               lamp = plane("light:lamp");
    for (std::size_t p = 0; p < 120; ++p) {
      expect_close(direct[p] + indirect[p] + emission[p], whole.channels.at(c)[p], "parts");
      expect_close(direct[p] + indirect[p], lamp[p], "one lamp is all the light");
      EXPECT_GT(indirect[p], 0);
    }
  }
}

// `--only` chooses the lights that are generated, so it shares none of them with the whole; but each part
// alone must be that part.
TEST_F(Render, OnlyDirectAndOnlyIndirect) {
  const Pixels direct = render(Arguments{"--only", "direct", "--aov", "direct,indirect"} + kBruteForce);
  const Pixels indirect = render(Arguments{"--only", "indirect", "--aov", "direct,indirect"} + kBruteForce);
  for (std::size_t p = 0; p < 120; ++p) {
    expect_close(direct.channels.at("R")[p], direct.channels.at("direct.R")[p], "direct");
    EXPECT_EQ(direct.channels.at("indirect.R")[p], 0);
    expect_close(indirect.channels.at("R")[p], indirect.channels.at("indirect.R")[p], "indirect");
    EXPECT_EQ(indirect.channels.at("direct.R")[p], 0);
  }
}

TEST_F(Render, LightsAreSplitByNameAndSum) {
  const std::string two = write_scene(
      folder_, small_room("<emitter type=\"point\" id=\"spark\"><point name=\"position\" x=\"-1\" y=\"0\" "
                          "z=\"1\"/><rgb name=\"intensity\" value=\"2\"/></emitter>"));
  for (const char* method : {"brute-force", "row-column-sampling", "power-sampling", "instant-radiosity"}) {
    const std::string file = folder_ / "lights.exr";
    EXPECT_SUCCESS(lumirank(render_small(two, file) +
                            Arguments{"--method", method, "--aov", "light:*,direct,indirect"}));
    const Pixels all = read_pixels(file);
    ASSERT_TRUE(all.channels.contains("light:lamp.R")) << method;
    ASSERT_TRUE(all.channels.contains("light:spark.R")) << method;
    for (const char* c : {".R", ".G", ".B"})
      for (std::size_t p = 0; p < 120; ++p) {
        const auto at = [&](const char* aov) {
          return static_cast<double>(all.channels.at(std::string(aov) + c)[p]);
        };
        expect_close(at("light:lamp") + at("light:spark"), at("direct") + at("indirect"), method);
      }
    EXPECT_SUCCESS(lumirank(render_small(two, file) + Arguments{"--method", method, "--aov", "light:spark"}));
    const Pixels one = read_pixels(file);
    EXPECT_EQ(one.channels.at("light:spark.G"), all.channels.at("light:spark.G"));
    EXPECT_FALSE(one.channels.contains("light:lamp.G"));
  }
}

TEST_F(Render, FirstHitsAreWhatTheSceneSays) {
  const Pixels p = render({"--aov", "albedo,normal,depth,position,samples"});
  const std::size_t center = 5 * 12 + 6;
  // In the middle the eye at z = 3.5 meets the wall z = -4 of reflectance 0.6, 0.5, 0.4, seen from its front.
  EXPECT_NEAR(p.channels.at("albedo.R")[center], 0.6, 1e-3);
  EXPECT_NEAR(p.channels.at("normal.B")[center], 1, 1e-5);
  EXPECT_NEAR(p.channels.at("position.B")[center], -4, 1e-3);
  EXPECT_GE(p.channels.at("depth.R")[center], 7.5f - 1e-3f);
  EXPECT_EQ(p.channels.at("samples.R")[center], 1);
}

TEST_F(Render, DefinesWinOverDefaults) {
  const std::string room = write_scene(
      folder_,
      "<default name=\"watts\" value=\"1\"/>" +
          small_room("<emitter type=\"point\"><point name=\"position\" "
                     "x=\"0\" y=\"0\" z=\"1\"/><rgb name=\"intensity\" value=\"$watts\"/></emitter>"));
  const std::string file = folder_ / "a.exr";
  EXPECT_SUCCESS(lumirank(render_small(room, file)));
  const double by_default = mean(read_pixels(file));
  EXPECT_SUCCESS(lumirank(render_small(room, file) + Arguments{"--define", "watts=50"}));
  EXPECT_GT(mean(read_pixels(file)), by_default);
  EXPECT_SUCCESS(lumirank(render_small(room, file) + Arguments{"--define", "watts=1"}));
  EXPECT_EQ(mean(read_pixels(file)), by_default);
}

TEST_F(Render, CamerasByName) {
  const std::string room = write_scene(
      folder_, small_room("<sensor type=\"perspective\" id=\"up\"><transform name=\"to_world\"><lookat "
                          "origin=\"0,-1,0\" target=\"0,1,0.1\" up=\"0,0,1\"/></transform></sensor>"));
  const std::string file = folder_ / "a.exr", other = folder_ / "b.exr";
  EXPECT_SUCCESS(lumirank(render_small(room, file)));
  EXPECT_SUCCESS(lumirank(render_small(room, other) + Arguments{"--camera", "up"}));
  EXPECT_NE(read_pixels(file), read_pixels(other));
  expect_refused(lumirank(render_small(room, file) + Arguments{"--camera", "down"}), "the cameras are 'up'");
}

TEST_F(Render, ThePreviewIsRewrittenAndWholeAtTheEnd) {
  const std::string preview = folder_ / "preview.png";
  { std::ofstream(preview) << "not an image"; }
  render({"--preview", preview, "--exposure", "1"});
  const Pixels last = read_pixels(preview);
  EXPECT_EQ(last, render({"--exposure", "1"}, "same.png")) << "the last one is the picture";
}

TEST_F(Render, StrictTurnsAWarningIntoARefusal) {
  const std::string odd = write_scene(
      folder_, small_room("<shape type=\"sphere\">\n<bsdf type=\"velvet\"/>\n</shape>\n"), "odd.xml");
  const std::string file = folder_ / "a.exr";
  const Outcome lenient = lumirank(render_small(odd, file));
  EXPECT_SUCCESS(lenient);
  EXPECT_NE(lenient.err.find("warning: "), std::string::npos);
  EXPECT_NE(lenient.err.find("odd.xml:"), std::string::npos);
  EXPECT_NE(lenient.err.find("velvet"), std::string::npos);
  std::filesystem::remove(file);
  const Outcome strict = lumirank(render_small(odd, file) + Arguments{"--strict"});
  expect_refused(strict, "velvet");
  EXPECT_NE(strict.err.find("odd.xml:"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(Examples, EachLoadsAndGivesAPicture) {
  const TemporaryFolder folder;
  for (const char* name : {"box", "interior", "lamps", "courtyard", "recesses"}) {
    const std::string file = folder / (std::string(name) + ".exr");
    const Outcome outcome =
        lumirank({"render", example(name), "-o", file, "--size", "16x12", "--lights", "4000"});
    EXPECT_SUCCESS(outcome) << name;
    EXPECT_EQ(outcome.err, "") << name << ": the project's own scenes need no replacement";
    const Pixels picture = read_pixels(file);
    EXPECT_TRUE(all_finite(picture)) << name;
    EXPECT_GT(mean(picture), 1e-4) << name;
  }
}

}  // namespace
}  // namespace lumirank::test
