#include "pipeline/light_path_pilot.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/morton.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/timer.h"
#include "pathtrace/light_tracer.h"
#include "pathtrace/volume_path_tracer.h"
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
constexpr int kMaxHalves = 4;  // of the last of them
// Time of a light path's ray over that of an eye path's, of which two go from one closure: 1.1 to 3 in five
// scenes.
constexpr double kRayOfLight = 1.5;
// What a denoiser leaves of noise, measured in fourteen scenes; light that is lost as specks it cannot give
// back.
constexpr double kDenoised = 0.25;
// Of the error without them; above that they are not worth the trouble.
constexpr double kWorth = 0.85;
// More of them, or aimed ones, must leave so much less.
constexpr double kMoreIsWorth = 0.9;
// Eye paths per pixel of the picture that is thought of. What a single find adds to it beyond what is usual
// there is a speck, which a denoiser takes away, with the light that it stood for.
constexpr double kPicture = 16;
// Of a time that is asked for: light paths that cannot be judged in it are none. Where media are dense and
// full of holes, one path may take hundredths of a second.
constexpr double kPartOfTime = 0.25;

using pathtrace::LightTracer;

class Pilot {
 public:
  Pilot(const world::World& world, const world::View& view, std::uint64_t seed, pathtrace::Paths paths,
        pathtrace::LightTargets targets, double seconds, const Sinks& sinks)
      : world_(world),
        sinks_(sinks),
        seconds_(seconds),
        seed_(hash_ids(seed, Stage::pilot, ~2ull)),
        camera_(whole_film(view, kEyePixels), world.units()),
        aim_(!targets.empty()),
        starts_(world, std::move(targets)),
        settings_{seed_, view.max_depth, paths, {}},
        eye_medium_(view.sensor.medium),
        width_(camera_.width()),
        height_(camera_.height()),
        across_((width_ + kBlock - 1) / kBlock),
        brightness_(static_cast<std::size_t>(across_ * ((height_ + kBlock - 1) / kBlock))) {}

  LightPathPilot run() {
    LightPathPilot pilot;
    if (starts_.empty()) return pilot;
    find_brightness();
    if (!(usual_ > 0) || stopped_) return pilot;
    Noise other = noise_of(eye_tracer(settings_));
    if (settings_.paths != pathtrace::Paths::all) light_ = trace_light(settings_);
    std::vector<Found> found;
    for (const LightTracer::Splat& splat : light_.splats) found.push_back(found_by(splat));
    for (const LightTracer::Merged& merged : light_.merged) found.push_back(found_by(merged));
    if (stopped_) return pilot;
    const double light_path_time = kRayOfLight * static_cast<double>(light_.rays) / kLightPaths /
                                   (static_cast<double>(other.rays) / (kEyePaths * pixels()));
    double shown = 0, brightest = 0;
    for (const Found& f : found) {
      const double light = f.number * f.light / pixels();
      shown += light, brightest = std::max(brightest, light);
    }
    // Of what eye paths share with as many light paths as there are pixels.
    double shared = 0;
    for (const Found& f : found)
      shared += f.number * f.light * f.light * f.ratio / ((1 + f.ratio) * (1 + f.ratio));
    other.squares = std::max(0.0, other.squares - shared);
    const auto error = [&](double number) {
      const double paths = kPicture / (1 + light_path_time * number);
      Noise sum = other;
      for (const Found& f : found) {
        const double find = f.light * f.ratio / (1 + number * f.ratio);
        if (find < paths)
          sum.squares += f.number * f.light * find;
        else
          sum.lost += 2 * f.number * f.light;
      }
      return Error{std::sqrt(sum.squares / pixels() / paths), sum.lost / pixels()};
    };
    const Error alone = error(0);
    for (const double number : kNumbers) {
      const Error with = error(number);
      const double left = with.denoised() / alone.denoised(), seconds = 1 + light_path_time * number;
      if (left < kWorth && left < kMoreIsWorth * pilot.left)
        pilot = {number,  aim_, std::pow(with.whole() / alone.whole(), 2) / seconds,
                 seconds, left, shown - brightest};
    }
    return pilot;
  }

 private:
  // What a light path brought, over what is usual there; how many like it one for each pixel would bring;
  // and their density over that of eye paths.
  struct Found {
    double light, number, ratio;
  };
  struct Light : LightTracer::Found {
    std::size_t rays = 0;  // that they took
  };
  using EyeTracer = std::variant<pathtrace::PathTracer, pathtrace::VolumePathTracer>;
  // Of a picture: noise, and light that is missed.
  struct Error {
    double noise, lost;
    double whole() const { return noise + lost; }
    double denoised() const { return kDenoised * noise + lost; }
  };
  // Over what is usual, summed over pixels: variance of one path, and light of what is taken for specks.
  struct Noise {
    double squares = 0, lost = 0;
    std::size_t rays = 0;  // that it took
  };

  // What is asked before each path: whether it is too late, or nobody wants to know any more.
  bool stops() const {
    if (!stopped_ && (timer_.seconds() > seconds_ || sinks_.cancelled())) stopped_ = true;
    return stopped_;
  }
  double pixels() const { return static_cast<double>(width_) * height_; }
  std::size_t block(int x, int y) const {
    return static_cast<std::size_t>((y / kBlock) * across_ + x / kBlock);
  }
  double relative(double value, int x, int y) const {
    return value / (brightness_[block(x, y)] + kUsualPart * usual_);
  }
  struct EyePath {
    double light;
    std::size_t rays;
  };
  EyeTracer eye_tracer(const pathtrace::PathSettings& settings) const {
    const pathtrace::LightPathBalance balance(starts_, camera_, pixels(), pathtrace::kMergedPixels);
    const auto shared = [&balance](auto tracer) {
      tracer.share_with_light_paths(balance);
      return tracer;
    };
    if (world_.media().empty()) return shared(pathtrace::PathTracer(world_, settings));
    return shared(pathtrace::VolumePathTracer(world_, settings.seed, settings.max_depth, eye_medium_));
  }
  EyePath trace_eye(const EyeTracer& tracer, int x, int y, int k,
                    std::vector<pathtrace::MergePoint>* points = nullptr) const {
    if (stops()) return {0, 0};
    const auto place =
        static_cast<std::uint32_t>(morton2(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)));
    Rng random(seed_, Stage::reference, ~static_cast<std::uint64_t>(place), static_cast<std::uint64_t>(k));
    const Vec2f jitter = random.next_2d();
    const Vec2f film{static_cast<float>(x) + jitter.x, static_cast<float>(y) + jitter.y};
    const geometry::Ray ray = camera_.ray(film, random.next_2d());
    const std::size_t before = points ? points->size() : 0;
    const auto radiance = std::visit(
        [&](const auto& by) { return by.trace(ray, place, static_cast<std::uint64_t>(k), points); }, tracer);
    for (std::size_t j = before; points && j < points->size(); ++j)
      (*points)[j].pixel = static_cast<std::uint32_t>(y * width_ + x);
    // Besides its segments a path has a ray to a light at each vertex.
    return {static_cast<double>(luminance(radiance.direct + radiance.indirect)),
            2 * static_cast<std::size_t>(radiance.segments)};
  }

  // Rows of blocks, each by itself.
  template <typename OfRow>
  void for_rows(const OfRow& of_row) const {
    const auto rows = static_cast<std::size_t>((height_ + kBlock - 1) / kBlock);
    parallel_for(rows, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end && !stops(); ++row) {
        const int first = static_cast<int>(row) * kBlock;
        for (int y = first; y < std::min(height_, first + kBlock); ++y) of_row(row, y);
      }
    });
  }

  // Of all light, whichever paths are asked for; by both, since eye paths may hardly find any.
  void find_brightness() {
    pathtrace::PathSettings all = settings_;
    all.paths = pathtrace::Paths::all;
    const EyeTracer tracer = eye_tracer(all);
    std::vector<int> count(brightness_.size());
    std::vector<std::vector<pathtrace::MergePoint>> points(static_cast<std::size_t>(height_));
    for_rows([&](std::size_t row, int y) {
      for (int x = 0; x < width_; ++x) {
        // Light paths are merged with one of them.
        for (int k = 0; k < kEyePaths; ++k)
          brightness_[block(x, y)] +=
              trace_eye(tracer, x, y, k, k == 0 ? &points[row] : nullptr).light / kEyePaths;
        ++count[block(x, y)];
      }
    });
    merge_points_ = pathtrace::MergePoints(std::move(points));
    light_ = trace_light(all);
    const auto brighter = [&](Vec2i at, Rgb value) {
      brightness_[block(at.x, at.y)] += static_cast<double>(luminance(value)) * pixels() / kLightPaths;
    };
    for (const LightTracer::Splat& splat : light_.splats) brighter(pixel_of(splat), splat.value);
    for (const LightTracer::Merged& merged : light_.merged) brighter(pixel_of(merged), merged.value);
    for (std::size_t b = 0; b < brightness_.size(); ++b) {
      usual_ += brightness_[b] / pixels();
      brightness_[b] /= std::max(1, count[b]);
    }
  }

  Noise noise_of(const EyeTracer& tracer) const {
    std::vector<Noise> rows(static_cast<std::size_t>(height_));
    for_rows([&](std::size_t row, int y) {
      for (int x = 0; x < width_; ++x) {
        const EyePath a = trace_eye(tracer, x, y, 0), b = trace_eye(tracer, x, y, 1);
        const double apart = std::abs(relative(a.light - b.light, x, y));
        rows[row].rays += a.rays + b.rays;
        if (apart < kPicture)
          rows[row].squares += apart * apart / 2;
        else
          rows[row].lost += apart;
      }
    });
    Noise sum;
    for (const Noise& n : rows) sum.squares += n.squares, sum.lost += n.lost, sum.rays += n.rays;
    return sum;
  }

  Light trace_light(const pathtrace::PathSettings& settings) const {
    const LightTracer tracer(world_, camera_, starts_,
                             {{0, 0}, {static_cast<float>(width_), static_cast<float>(height_)}}, settings,
                             pixels(), eye_medium_);
    std::vector<LightTracer::Found> parts(kLightPaths / kLightPathsOfPart);
    std::vector<std::size_t> rays_of(parts.size());
    parallel_for(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t part = begin; part < end && !stops(); ++part) {
        for (std::size_t k = 0; k < kLightPathsOfPart && !stops(); ++k) {
          const std::uint64_t number = part * kLightPathsOfPart + k;
          rays_of[part] += static_cast<std::size_t>(
              tracer.trace(SampleStream(seed_, Stage::light_paths, 0, 2 * number),
                           hash_ids(seed_, Stage::opacity, ~0ull, number), merge_points_, parts[part]));
        }
      }
    });
    Light all;
    for (const auto& part : parts) {
      all.splats.insert(all.splats.end(), part.splats.begin(), part.splats.end());
      all.merged.insert(all.merged.end(), part.merged.begin(), part.merged.end());
    }
    for (const std::size_t r : rays_of) all.rays += r;
    return all;
  }

  Vec2i pixel_of(const LightTracer::Splat& splat) const {
    return {std::clamp(static_cast<int>(splat.film.x), 0, width_ - 1),
            std::clamp(static_cast<int>(splat.film.y), 0, height_ - 1)};
  }
  Vec2i pixel_of(const LightTracer::Merged& merged) const {
    const int p = static_cast<int>(merged.pixel);
    return {p % width_, p / width_};
  }
  template <typename Way>
  Found found_by(const Way& way) const {
    const Vec2i at = pixel_of(way);
    const double ratio = static_cast<double>(way.ratio);
    // Its share goes away: what it would bring without the eye paths.
    const double light = static_cast<double>(luminance(way.value)) * (1 + ratio) / ratio;
    return {relative(light, at.x, at.y), pixels() / kLightPaths, ratio};
  }

  const world::World& world_;
  const Sinks& sinks_;
  double seconds_;
  Timer timer_;
  mutable std::atomic<bool> stopped_ = false;
  std::uint64_t seed_;
  world::Camera camera_;
  bool aim_;
  pathtrace::EmissionSampler starts_;
  pathtrace::PathSettings settings_;
  int eye_medium_;
  int width_, height_, across_;
  std::vector<double> brightness_;  // by blocks
  double usual_ = 0;
  pathtrace::MergePoints merge_points_;
  Light light_;  // of the paths asked for, in the end
};

}  // namespace

LightPathPilot pilot_light_paths(const world::World& world, const world::View& view, std::uint64_t seed,
                                 pathtrace::Paths paths, double time, const Sinks& sinks) {
  // What the eye looks through would stop paths that arrive from lamps.
  if (world.hides_emitters()) return {};
  if (paths != pathtrace::Paths::all && !world.media().empty()) return {};
  const Timer timer;
  const auto left = [&] { return time > 0 ? kPartOfTime * time - timer.seconds() : kInfinity; };
  const LightPathPilot freely = Pilot(world, view, seed, paths, {}, left(), sinks).run();
  pathtrace::LightTargets targets(world, world::Camera(view.sensor, world.units()).eye());
  if (targets.empty()) return freely;
  const LightPathPilot aimed = Pilot(world, view, seed, paths, std::move(targets), left(), sinks).run();
  return aimed.left < kMoreIsWorth * freely.left ? aimed : freely;
}

void choose_light_paths(methods::TimedChoices& choices, const char* of, double& light_paths, bool& aim) {
  const std::string halves = std::string(of) + "_half_light_paths", aimed = std::string(of) + "_aim";
  if (const auto earlier = choices.earlier(halves, kMaxHalves))
    light_paths = 0.5 * static_cast<double>(*earlier);
  if (const auto earlier = choices.earlier(aimed, 1)) aim = *earlier == 1;
  choices.record(halves, static_cast<std::int64_t>(2 * light_paths));
  choices.record(aimed, aim ? 1 : 0);
}

}  // namespace lumirank::pipeline
