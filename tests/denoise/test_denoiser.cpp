// Those that denoise are skipped where Open Image Denoise is not installed (`make denoiser`); the others run
// anywhere.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <thread>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "denoise/denoiser.h"
#include "denoise/turning.h"

namespace lumirank::denoise {
namespace {

namespace fs = std::filesystem;
using image::Image;

// Environment variables as a test wants them, and a folder of its own.
class Search : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "lumirank-test-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    for (const char* variable : {"LUMIRANK_DENOISER", "XDG_DATA_HOME", "HOME"}) {
      const char* value = std::getenv(variable);
      before_[variable] = value ? std::optional<std::string>(value) : std::nullopt;
      unsetenv(variable);
    }
  }
  void TearDown() override {
    for (const auto& [variable, value] : before_)
      value ? setenv(variable.c_str(), value->c_str(), 1) : unsetenv(variable.c_str());
    fs::remove_all(folder_);
  }

  std::string write(const std::string& name) const {
    const fs::path file = folder_ / name;
    fs::create_directories(file.parent_path());
    std::ofstream(file) << "no library";
    return file.string();
  }

  fs::path folder_;

 private:
  std::map<std::string, std::optional<std::string>> before_;
};

bool says(const Found& found, const std::string& words) {
  return found.trouble.find(words) != std::string::npos;
}

TEST_F(Search, WithoutOneSaysWhereItLookedAndWhatHelps) {
  setenv("HOME", folder_.c_str(), 1);
  const Found found = Denoiser::find_anew();
  if (found.denoiser) GTEST_SKIP() << "the system has one";
  EXPECT_TRUE(found.absent);
  EXPECT_TRUE(says(found, (folder_ / ".local/share/lumirank/denoiser").string())) << found.trouble;
  EXPECT_TRUE(says(found, "where the system keeps its libraries")) << found.trouble;
  EXPECT_TRUE(says(found, "`make denoiser`")) << found.trouble;
  setenv("XDG_DATA_HOME", (folder_ / "data").c_str(), 1);
  EXPECT_TRUE(says(Denoiser::find_anew(), (folder_ / "data/lumirank/denoiser").string()));
}

TEST_F(Search, WhatIsChosenAndNotThereIsSaid) {
  const std::string nowhere = (folder_ / "nowhere").string();
  for (const std::string& chosen : {nowhere, folder_.string()}) {
    setenv("LUMIRANK_DENOISER", chosen.c_str(), 1);
    const Found found = Denoiser::find_anew();
    EXPECT_EQ(found.denoiser, nullptr);
    EXPECT_FALSE(found.absent);
    EXPECT_TRUE(says(found, "LUMIRANK_DENOISER is set to " + chosen)) << found.trouble;
    EXPECT_FALSE(says(found, "the system")) << "nothing else is tried: " << found.trouble;
  }
}

TEST_F(Search, WhatIsChosenAndNoLibraryIsSaid) {
  const std::string file = write("lib/libOpenImageDenoise.so.2");
  for (const std::string& chosen : {file, folder_.string(), (folder_ / "lib").string()}) {
    setenv("LUMIRANK_DENOISER", chosen.c_str(), 1);
    const Found found = Denoiser::find_anew();
    EXPECT_EQ(found.denoiser, nullptr);
    EXPECT_FALSE(found.absent);
    EXPECT_TRUE(says(found, "LUMIRANK_DENOISER is set to " + chosen)) << found.trouble;
    EXPECT_TRUE(says(found, file)) << "the loader's words name the file: " << found.trouble;
  }
}

TEST_F(Search, AnotherLibraryIsNotTakenForIt) {
  Dl_info libc{};
  ASSERT_NE(dladdr(reinterpret_cast<void*>(&std::getenv), &libc), 0);
  setenv("LUMIRANK_DENOISER", libc.dli_fname, 1);
  const Found found = Denoiser::find_anew();
  EXPECT_EQ(found.denoiser, nullptr);
  EXPECT_TRUE(says(found, "is not Open Image Denoise 2: it lacks the function oidnNewDevice"))
      << found.trouble;
}

TEST_F(Search, OneThatIsThereAndBrokenIsNotCalledAbsent) {
  setenv("XDG_DATA_HOME", folder_.c_str(), 1);
  const std::string file = write("lumirank/denoiser/lib/libOpenImageDenoise.so.2");
  const Found found = Denoiser::find_anew();
  if (found.denoiser) GTEST_SKIP() << "the system has one";
  EXPECT_FALSE(found.absent);
  EXPECT_TRUE(says(found, file)) << found.trouble;
}

class Denoising : public testing::Test {
 protected:
  void SetUp() override {
    if (Denoiser::find().absent) GTEST_SKIP() << Denoiser::find().trouble;
    denoiser_ = Denoiser::find().denoiser.get();
    ASSERT_NE(denoiser_, nullptr) << Denoiser::find().trouble;
  }

  const Denoiser* denoiser_ = nullptr;
};

// `truth` times numbers between 0 and 2, as light from few samples varies.
Image with_noise(Image truth) {
  Rng random(1, Stage::test);
  for (Rgb& c : truth.pixels) c *= 2 * random.next_float();
  return truth;
}

// Mean absolute difference, relative to the mean of the truth, in columns [begin, end).
double error(const Image& image, const Image& truth, int begin, int end) {
  double sum = 0, reference = 0;
  for (int y = 0; y < truth.height; ++y)
    for (int x = begin; x < end; ++x) {
      sum += std::abs(mean(image.at(x, y)) - mean(truth.at(x, y)));
      reference += mean(truth.at(x, y));
    }
  return sum / reference;
}

double error(const Image& image, const Image& truth) { return error(image, truth, 0, truth.width); }

// A wall in two colors under even light, seen with noise.
struct TwoColors {
  Image albedo{128, 96}, normal{128, 96, Rgb(0, 0, 1)}, truth{128, 96}, noisy;

  TwoColors() {
    for (int y = 0; y < truth.height; ++y)
      for (int x = 0; x < truth.width; ++x)
        truth.at(x, y) = albedo.at(x, y) = x < 63 ? Rgb(0.8f, 0.3f, 0.2f) : Rgb(0.2f, 0.3f, 0.6f);
    noisy = with_noise(truth);
  }
};

TEST_F(Denoising, SaysItsVersion) {
  EXPECT_TRUE(denoiser_->version().starts_with("2.")) << denoiser_->version();
}

TEST_F(Denoising, FindsTheSameFromAllThreads) {
  const Found* other = nullptr;
  std::thread([&] { other = &Denoiser::find(); }).join();
  EXPECT_EQ(other, &Denoiser::find());
}

TEST_F(Denoising, ANoisyFlatPictureBecomesFlat) {
  const Image truth(96, 64, Rgb(0.4f, 0.5f, 0.6f));
  const Image noisy = with_noise(truth);
  EXPECT_GT(error(noisy, truth), 0.4);
  EXPECT_LT(error(denoiser_->denoise(noisy), truth), 0.08);
}

TEST_F(Denoising, EdgesOfFeaturesSurvive) {
  const TwoColors scene;
  for (const Features kind : {Features::clean, Features::noisy, Features::prefiltered}) {
    const Image image = denoiser_->denoise(scene.noisy, &scene.albedo, &scene.normal, kind);
    EXPECT_LT(error(image, scene.truth), 0.08);
    if (kind == Features::noisy) continue;  // may be thought noise at the picture's border
    // Each channel of its own: the two colors differ little in brightness.
    for (int y = 0; y < image.height; ++y) {
      EXPECT_GT(image.at(62, y).r, image.at(63, y).r + 0.3f) << static_cast<int>(kind) << ' ' << y;
      EXPECT_LT(image.at(62, y).b, image.at(63, y).b - 0.2f) << static_cast<int>(kind) << ' ' << y;
    }
  }
  EXPECT_LT(error(denoiser_->denoise(scene.noisy, &scene.albedo), scene.truth), 0.08) << "albedo alone";
}

TEST_F(Denoising, VeryBrightPixelsKeepTheirLight) {
  Image truth(96, 64, Rgb(1));
  for (int y = 16; y < 48; ++y)
    for (int x = 32; x < 64; ++x) truth.at(x, y) = Rgb(1e4f);
  const Image image = denoiser_->denoise(with_noise(truth));
  double inside = 0;
  for (int y = 20; y < 44; ++y)
    for (int x = 36; x < 60; ++x) inside += mean(image.at(x, y));
  EXPECT_NEAR(inside / (24 * 24), 1e4, 1e3);
}

TEST_F(Denoising, TheUnitOfLightDoesNotMatter) {
  const TwoColors scene;
  for (const float unit : {1e-4f, 1e4f}) {
    Image truth = scene.truth, noisy = scene.noisy;
    for (Rgb& c : truth.pixels) c *= unit;
    for (Rgb& c : noisy.pixels) c *= unit;
    EXPECT_LT(error(denoiser_->denoise(noisy, &scene.albedo, &scene.normal), truth), 0.08) << unit;
  }
}

TEST_F(Denoising, FeaturesOutOfRangeAreCut) {
  TwoColors scene;
  Image albedo = scene.albedo, normal = scene.normal;
  albedo.at(5, 5) = Rgb(1);
  normal.at(5, 5) = Rgb(0, 0.6f, 0.8f);
  const Image expected = denoiser_->denoise(scene.noisy, &albedo, &normal);
  albedo.at(5, 5) = Rgb(1e30f);
  normal.at(5, 5) = Rgb(0, 0.6f, 0.8f) * 3e38f;
  const Image image = denoiser_->denoise(scene.noisy, &albedo, &normal);
  EXPECT_LT(error(image, expected), 1e-5);
}

TEST_F(Denoising, RefusesWhatIsNotFinite) {
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float bad : {std::nanf(""), infinity, -infinity})
    for (int which = 0; which < 3; ++which) {
      TwoColors scene;
      (which == 0 ? scene.noisy : which == 1 ? scene.albedo : scene.normal).at(3, 2).g = bad;
      try {
        denoiser_->denoise(scene.noisy, &scene.albedo, &scene.normal);
        FAIL() << bad << " in picture " << which;
      } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()).find("column 3, row 2"), std::string::npos) << e.what();
      }
    }
}

TEST_F(Denoising, RefusesPicturesThatDoNotFit) {
  const Image noisy(8, 6, Rgb(1)), other(6, 8, Rgb(1)), none;
  EXPECT_THROW(denoiser_->denoise(none), InputError);
  EXPECT_THROW(denoiser_->denoise(noisy, &other), InputError);
  EXPECT_THROW(denoiser_->denoise(noisy, &none), InputError);
  EXPECT_THROW(denoiser_->denoise(noisy, &noisy, &other), InputError);
  EXPECT_THROW(denoiser_->denoise(noisy, nullptr, &noisy), InputError) << "normals without an albedo";
}

// Those of a few pixels come out finite; to come out right they need some surroundings.
TEST_F(Denoising, PicturesOfAnySize) {
  for (const auto& [width, height] :
       {std::pair(1, 1), std::pair(1, 7), std::pair(33, 2), std::pair(37, 31)}) {
    const Image noisy(width, height, Rgb(0.5f));
    const Image image = denoiser_->denoise(noisy, &noisy, &noisy);
    EXPECT_EQ(image.width, width);
    EXPECT_EQ(image.height, height);
    EXPECT_LT(error(image, noisy), width < 37 ? 1 : 0.05) << width << ' ' << height;
  }
}

TEST_F(Denoising, GivesTheSameBitsOnAnyNumberOfThreads) {
  const TwoColors scene;
  const auto denoised = [&](int threads) {
    Image image;
    with_threads(threads, [&] { image = denoiser_->denoise(scene.noisy, &scene.albedo, &scene.normal); });
    return image;
  };
  const Image expected = denoised(1);
  for (const int threads : {1, 2, 3, 7, 0}) EXPECT_EQ(denoised(threads).pixels, expected.pixels) << threads;
}

TEST_F(Denoising, OfAllOrientationsNoneIsAnother) {
  const TwoColors scene;
  const auto denoised = [&](int orientations, int quarters) {
    const Image noisy = turned(scene.noisy, quarters), albedo = turned(scene.albedo, quarters),
                normal = turned(scene.normal, quarters);
    return turned(denoiser_->denoise(noisy, &albedo, &normal, Features::noisy, orientations), -quarters);
  };
  const Image one = denoised(1, 0), all = denoised(4, 0);
  double turned_differs = 0;
  for (int quarters = 1; quarters < 4; ++quarters) {
    EXPECT_LT(error(denoised(4, quarters), all), 1e-5) << quarters;
    turned_differs = std::max(turned_differs, error(denoised(1, quarters), one));
  }
  EXPECT_GT(turned_differs, 1e-4) << "one orientation alone is another picture";
}

TEST_F(Denoising, IsTheMeanOfItsOrientations) {
  const TwoColors scene;
  Image mean(scene.noisy.width, scene.noisy.height);
  for (const int quarters : {0, 2}) {
    const Image noisy = turned(scene.noisy, quarters), albedo = turned(scene.albedo, quarters),
                normal = turned(scene.normal, quarters);
    image::add_to(mean, turned(denoiser_->denoise(noisy, &albedo, &normal), -quarters));
  }
  for (Rgb& c : mean.pixels) c = 0.5f * c;
  const Image two = denoiser_->denoise(scene.noisy, &scene.albedo, &scene.normal, Features::noisy, 2);
  EXPECT_LT(error(two, mean), 1e-6);
}

TEST_F(Denoising, RefusesOrientationsThatThereAreNot) {
  const Image noisy(8, 6, Rgb(1));
  for (const int orientations : {-1, 0, 5})
    EXPECT_THROW(denoiser_->denoise(noisy, &noisy, &noisy, Features::noisy, orientations), InputError);
}

TEST_F(Denoising, ManyAtATime) {
  const TwoColors scene;
  const Image expected = denoiser_->denoise(scene.noisy, &scene.albedo);
  std::vector<Image> images(4);
  parallel_for(images.size(), 1, [&](std::size_t b, std::size_t e) {
    for (std::size_t i = b; i < e; ++i) images[i] = denoiser_->denoise(scene.noisy, &scene.albedo);
  });
  for (const Image& image : images) EXPECT_EQ(image.pixels, expected.pixels);
}

}  // namespace
}  // namespace lumirank::denoise
