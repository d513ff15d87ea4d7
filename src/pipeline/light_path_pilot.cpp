#include "pipeline/light_path_pilot.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "base/random.h"
#include "pathtrace/light_tracer.h"
#include "pipeline/recipe.h"

namespace lumirank::pipeline {
namespace {

constexpr double kEyePixels = 2048;
constexpr int kEyePaths = 2;  // of each pixel
constexpr std::size_t kLightPaths = 1 << 14, kLightPathsOfPart = 512;
// Noise counts over what is around, in blocks of so many pixels a side, and a part of what is usual.
constexpr int kBlock = 4;
constexpr double kUsualPart = 0.1;
constexpr double kNumbers[] = {0.5, 1, 2};
// What a light path takes, in eye paths: 0.1 to 0.7 on twenty scenes.
constexpr double kLightPathTime = 0.4;
// Below that they are not worth the trouble.
constexpr double kWorth = 0.9;

using pathtrace::LightTracer;

class Pilot {
 public:
  Pilot(const world::World& world, const world::View& view, std::uint64_t seed, pathtrace::Paths paths,
        const Sinks& sinks)
      : world_(world),
        sinks_(sinks),
        seed_(hash_ids(seed, Stage::pilot, ~2ull)),
        camera_(whole_film(view, kEyePixels), world.units()),
        starts_(world),
        settings_{seed_, view.max_depth, paths, {}},
        width_(camera_.width()),
        height_(camera_.height()),
        across_((width_ + kBlock - 1) / kBlock),
        brightness_(static_cast<std::size_t>(across_ * ((height_ + kBlock - 1) / kBlock))) {}

  LightPathPilot run() {
    LightPathPilot pilot;
    if (starts_.empty()) return pilot;
    find_brightness();
    if (!(usual_ > 0)) return pilot;
    pathtrace::PathTracer eye(world_, settings_);
    eye.share_with_light_paths(starts_, camera_, pixels());
    const double by_eye = variance_of(eye);
    const std::vector<Found> found = trace_light();
    if (sinks_.cancelled()) return pilot;
    // Of what eye paths share with as many light paths as there are pixels.
    double shared = 0;
    for (const Found& f : found) shared += f.weight * f.ratio / ((1 + f.ratio) * (1 + f.ratio));
    const double other = std::max(0.0, by_eye - shared);
    const auto variance = [&](double number) {
      double sum = other;
      for (const Found& f : found) sum += f.weight * f.ratio / (1 + number * f.ratio);
      return sum;
    };
    const double alone = variance(0);
    if (!(alone > 0)) return pilot;
    double least = kWorth;
    for (const double number : kNumbers) {
      const double of_alone = variance(number) / alone, seconds = 1 + kLightPathTime * number;
      if (of_alone * seconds < least) {
        least = of_alone * seconds;
        pilot = {number, of_alone, seconds};
      }
    }
    return pilot;
  }

 private:
  // What a light path brought, squared and over what is usual there, and light_path_ratio() in full.
  struct Found {
    double weight, ratio;
  };

  double pixels() const { return static_cast<double>(width_) * height_; }
  std::size_t block(int x, int y) const {
    return static_cast<std::size_t>((y / kBlock) * across_ + x / kBlock);
  }
  double relative_square(double value, int x, int y) const {
    const double usual = brightness_[block(x, y)] + kUsualPart * usual_;
    return value * value / (usual * usual);
  }
  double trace_eye(const pathtrace::PathTracer& tracer, int x, int y, int k) const {
    const auto p =
        static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(width_) + static_cast<std::uint64_t>(x);
    Rng random(seed_, Stage::reference, ~p, static_cast<std::uint64_t>(k));
    const Vec2f jitter = random.next_2d();
    const Vec2f film{static_cast<float>(x) + jitter.x, static_cast<float>(y) + jitter.y};
    const auto radiance = tracer.trace(camera_.ray(film, random.next_2d()), p, static_cast<std::uint64_t>(k));
    return static_cast<double>(luminance(radiance.direct + radiance.indirect));
  }

  // Rows of blocks, each by itself.
  template <typename OfRow>
  void for_rows(const OfRow& of_row) const {
    const auto rows = static_cast<std::size_t>((height_ + kBlock - 1) / kBlock);
    parallel_for(rows, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end && !sinks_.cancelled(); ++row) {
        const int first = static_cast<int>(row) * kBlock;
        for (int y = first; y < std::min(height_, first + kBlock); ++y) of_row(row, y);
      }
    });
  }

  void find_brightness() {
    pathtrace::PathSettings all = settings_;
    all.paths = pathtrace::Paths::all;
    const pathtrace::PathTracer tracer(world_, all);
    std::vector<int> count(brightness_.size());
    for_rows([&](std::size_t, int y) {
      for (int x = 0; x < width_; ++x)
        for (int k = 0; k < kEyePaths; ++k, ++count[block(x, y)])
          brightness_[block(x, y)] += trace_eye(tracer, x, y, k);
    });
    for (std::size_t b = 0; b < brightness_.size(); ++b) {
      usual_ += brightness_[b] / (kEyePaths * pixels());
      brightness_[b] /= std::max(1, count[b]);
    }
  }

  // Of one path in each pixel, over what is usual there.
  double variance_of(const pathtrace::PathTracer& tracer) const {
    std::vector<double> sums(static_cast<std::size_t>(height_));
    for_rows([&](std::size_t row, int y) {
      for (int x = 0; x < width_; ++x)
        sums[row] += relative_square(trace_eye(tracer, x, y, 0) - trace_eye(tracer, x, y, 1), x, y) / 2;
    });
    double sum = 0;
    for (const double s : sums) sum += s;
    return sum;
  }

  std::vector<Found> trace_light() const {
    const LightTracer tracer(world_, camera_, starts_,
                             {{0, 0}, {static_cast<float>(width_), static_cast<float>(height_)}}, settings_,
                             pixels());
    std::vector<std::vector<Found>> parts(kLightPaths / kLightPathsOfPart);
    parallel_for(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t part = begin; part < end && !sinks_.cancelled(); ++part) {
        std::vector<LightTracer::Splat> splats;
        for (std::size_t k = 0; k < kLightPathsOfPart; ++k) {
          const std::uint64_t number = part * kLightPathsOfPart + k;
          tracer.trace(SampleStream(seed_, Stage::light_paths, 0, 2 * number),
                       hash_ids(seed_, Stage::opacity, ~0ull, number), splats);
        }
        for (const LightTracer::Splat& s : splats) parts[part].push_back(found(s));
      }
    });
    std::vector<Found> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
  }

  Found found(const LightTracer::Splat& splat) const {
    const int x = std::clamp(static_cast<int>(splat.film.x), 0, width_ - 1);
    const int y = std::clamp(static_cast<int>(splat.film.y), 0, height_ - 1);
    const double ratio = static_cast<double>(splat.ratio);
    const double value = static_cast<double>(luminance(splat.value)) * (1 + ratio) / ratio;
    return {relative_square(value, x, y) * pixels() / kLightPaths, ratio};
  }

  const world::World& world_;
  const Sinks& sinks_;
  std::uint64_t seed_;
  world::Camera camera_;
  pathtrace::EmissionSampler starts_;
  pathtrace::PathSettings settings_;
  int width_, height_, across_;
  std::vector<double> brightness_;  // by blocks
  double usual_ = 0;
};

}  // namespace

LightPathPilot pilot_light_paths(const world::World& world, const world::View& view, std::uint64_t seed,
                                 pathtrace::Paths paths, const Sinks& sinks) {
  if (!world.media().empty()) return {};
  return Pilot(world, view, seed, paths, sinks).run();
}

}  // namespace lumirank::pipeline
