#include "pathtrace/reference.h"

#include <array>
#include <cmath>
#include <optional>
#include <variant>

#include "base/error.h"
#include "base/morton.h"
#include "base/parallel.h"
#include "base/sample_stream.h"
#include "base/timer.h"
#include "film/filter_sampler.h"
#include "pathtrace/light_tracer.h"
#include "pathtrace/volume_path_tracer.h"

namespace lumirank::pathtrace {
// Members of PathFilm::Impl, so they have names of their own instead of an anonymous namespace.
// Sums over the samples of one half, in double precision so that long runs lose nothing.
struct PathFilmHalf {
  struct Sum {
    double r = 0, g = 0, b = 0;
    void add(Rgb c) { r += c.r, g += c.g, b += c.b; }
    Rgb scaled(double s) const {
      return {static_cast<float>(r * s), static_cast<float>(g * s), static_cast<float>(b * s)};
    }
  };
  std::vector<Sum> emission, direct, indirect;
  // Of the luminance of what surfaces send: of paths from the eye; and the squares of all paths.
  std::vector<double> by_eye, squares;
  int count = 0;
  explicit PathFilmHalf(std::size_t pixels)
      : emission(pixels), direct(pixels), indirect(pixels), by_eye(pixels), squares(pixels) {}
};

namespace {

constexpr std::size_t kPixelsAtOnce = 8192, kPixelsOfPart = 256, kLightPathsAtOnce = 1024;

struct ImageParts {
  bool emission, direct, indirect;
};

image::Image mean_image(const world::View& view, std::span<const PathFilmHalf* const> halves,
                        ImageParts wanted) {
  image::Image image(view.width, view.height);
  int count = 0;
  for (const PathFilmHalf* h : halves) count += h->count;
  const double scale = 1.0 / std::max(1, count);
  parallel_for(image.pixels.size(), kPixelsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      for (const PathFilmHalf* h : halves) {
        if (wanted.emission) image.pixels[p] += h->emission[p].scaled(scale);
        if (wanted.direct) image.pixels[p] += h->direct[p].scaled(scale);
        if (wanted.indirect) image.pixels[p] += h->indirect[p].scaled(scale);
      }
  });
  return image;
}

// Relative L1 of the mean of both halves. For the mean of two independent estimates E|mean - truth| is E|A -
// B|/2.
double stated_error(const world::View& view, const PathFilmHalf& a, const PathFilmHalf& b,
                    ImageParts wanted) {
  if (a.count == 0 || b.count == 0) return std::numeric_limits<double>::infinity();
  const PathFilmHalf* pa[] = {&a};
  const PathFilmHalf* pb[] = {&b};
  const image::Image ia = mean_image(view, pa, wanted), ib = mean_image(view, pb, wanted);
  double difference = 0, total = 0;
  for (std::size_t p = 0; p < ia.pixels.size(); ++p)
    for (int c = 0; c < 3; ++c) {
      difference += std::abs(static_cast<double>(ia.pixels[p][c]) - ib.pixels[p][c]);
      total += static_cast<double>(ia.pixels[p][c]) + ib.pixels[p][c];
    }
  return total > 0 ? difference / total : 0.0;
}

// Van der Corput's sequence.
double reversed_bits(std::uint32_t k) {
  double value = 0;
  for (double digit = 0.5; k > 0; k >>= 1, digit /= 2) value += static_cast<double>(k & 1) * digit;
  return value;
}

}  // namespace

struct PathFilm::Impl {
  // What traces one instant.
  struct Tracing {
    std::variant<PathTracer, VolumePathTracer> tracer;
    world::Camera camera;

    void trace(std::span<const PathTracer::Start> eye_paths, std::span<Radiance> found) const {
      std::visit([&](const auto& by) { by.trace(eye_paths, found); }, tracer);
    }
  };
  world::View view;
  ReferenceOptions options;
  std::vector<Instant> instants;  // keep their worlds
  std::vector<Tracing> tracing;
  film::FilterSampler filter;
  std::size_t pixels, light_paths = 0;  // these for one path in each pixel
  std::optional<EmissionSampler> starts;
  std::optional<LightTracer> light_tracer;
  PathFilmHalf halves[2];
  ReferenceResult result;

  Impl(const world::View& v, const ReferenceOptions& o)
      : view(v),
        options(o),
        filter(world::make_filter(v.sensor.film.filter)),
        pixels(static_cast<std::size_t>(v.width) * static_cast<std::size_t>(v.height)),
        halves{PathFilmHalf(pixels), PathFilmHalf(pixels)} {}

  void add_instant(const world::World& world, const world::View& v) {
    world::Camera camera(v.sensor, world.units());
    if (options.paths == Paths::all && !world.media().empty()) {
      tracing.push_back({VolumePathTracer(world, options.seed, v.max_depth, v.sensor.medium), camera});
    } else {
      const PathSettings settings{options.seed, v.max_depth, options.paths, options.carried};
      tracing.push_back({PathTracer(world, settings), camera});
    }
  }

  void trace_light_paths(const world::World& world) {
    if (!(options.light_paths > 0) || options.paths == Paths::columns) return;
    if (options.paths != Paths::all && !world.media().empty()) return;
    const Vec3f eye = tracing.front().camera.eye();
    starts.emplace(world, options.aim_light_paths ? LightTargets(world, eye) : LightTargets());
    light_paths = static_cast<std::size_t>(std::ceil(options.light_paths * static_cast<double>(pixels)));
    if (starts->empty()) return;
    Tracing& by = tracing.front();
    const auto number = static_cast<double>(light_paths);
    const auto reach = static_cast<float>(world::make_filter(view.sensor.film.filter).reach());
    const Vec2f corner{static_cast<float>(view.crop_x), static_cast<float>(view.crop_y)};
    const LightTracer::Window window{{corner.x - reach, corner.y - reach},
                                     {corner.x + static_cast<float>(view.width) + reach,
                                      corner.y + static_cast<float>(view.height) + reach}};
    light_tracer.emplace(world, by.camera, *starts, window,
                         PathSettings{options.seed, view.max_depth, options.paths, {}}, number,
                         view.sensor.medium);
    const LightPathBalance balance(*starts, by.camera, number, options.merged_pixels);
    std::visit([&](auto& tracer) { tracer.share_with_light_paths(balance); }, by.tracer);
  }

  const Tracing& at(std::uint64_t pixel, int sample) const {
    if (tracing.size() == 1) return tracing.front();
    const auto half = static_cast<std::uint64_t>(sample & 1);
    const double place = reversed_bits(static_cast<std::uint32_t>(sample) >> 1) +
                         unit_double(hash_ids(options.seed, Stage::shutter, ~pixel, half));
    const auto count = static_cast<double>(tracing.size());
    return tracing[std::min(static_cast<std::size_t>((place - std::floor(place)) * count),
                            tracing.size() - 1)];
  }

  int film_x(std::size_t p) const {
    return static_cast<int>(p % static_cast<std::size_t>(view.width)) + view.crop_x;
  }
  int film_y(std::size_t p) const {
    return static_cast<int>(p / static_cast<std::size_t>(view.width)) + view.crop_y;
  }

  // Paths that are traced together.
  struct Batch {
    struct Path {
      std::size_t pixel;
      int sample;
      float weight;
    };
    const Tracing* by = nullptr;
    std::size_t count = 0;
    std::array<Path, PathTracer::kPathsAtOnce> paths;
    std::array<PathTracer::Start, PathTracer::kPathsAtOnce> starts;
    std::array<std::vector<MergePoint>, PathTracer::kPathsAtOnce> points;
  };

  // `points`: nullptr, or where light paths are to be merged with what is traced.
  void trace_pixel(std::size_t p, int begin, int end, std::vector<MergePoint>* points, Batch& batch) {
    const int x = film_x(p), y = film_y(p);
    const auto place =
        static_cast<std::uint32_t>(morton2(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)));
    for (int s = begin; s < end; ++s) {
      const Tracing& now = this->at(place, s);
      if (batch.by != &now || batch.count == batch.paths.size()) trace_batch(batch, points);
      batch.by = &now;
      SampleStream random =
          SampleStream::over_film(options.seed, Stage::reference, 1, place, static_cast<std::uint64_t>(s));
      const auto at = filter.sample(random.next_2d());
      const Vec2f film{static_cast<float>(x) + 0.5f + at.offset.x,
                       static_cast<float>(y) + 0.5f + at.offset.y};
      const std::size_t k = batch.count++;
      batch.paths[k] = {p, s, at.weight};
      batch.starts[k] = {now.camera.ray(film, random.next_2d()), place, static_cast<std::uint64_t>(s),
                         points ? &batch.points[k] : nullptr};
    }
  }

  void trace_batch(Batch& batch, std::vector<MergePoint>* points) {
    if (batch.count == 0) return;
    std::array<Radiance, PathTracer::kPathsAtOnce> found;
    batch.by->trace({batch.starts.data(), batch.count}, {found.data(), batch.count});
    for (std::size_t k = 0; k < batch.count; ++k) {
      const auto [p, s, weight] = batch.paths[k];
      const Radiance& radiance = found[k];
      if (points) {
        for (MergePoint& point : batch.points[k])
          point.pixel = static_cast<std::uint32_t>(p), point.throughput *= weight;
        points->insert(points->end(), batch.points[k].begin(), batch.points[k].end());
        batch.points[k].clear();
      }
      if (!is_finite(radiance.total()))
        throw InternalError("the reference met a value that is not finite; replay pixel " +
                            std::to_string(film_x(p)) + "," + std::to_string(film_y(p)) + " sample " +
                            std::to_string(s));
      PathFilmHalf& half = halves[s & 1];
      half.emission[p].add(radiance.emission * weight);
      half.direct[p].add(radiance.direct * weight);
      half.indirect[p].add(radiance.indirect * weight);
      const double light = sent_luminance(radiance.direct, radiance.indirect) * static_cast<double>(weight);
      half.by_eye[p] += light;
      half.squares[p] += light * light;
    }
    batch.count = 0;
  }

  bool merges() const { return light_tracer && options.merged_pixels > 0; }

  ImageParts wanted() const { return {options.emission, options.direct, options.indirect}; }
  ImageParts sent() const { return {false, options.direct, options.indirect}; }
  double sent_luminance(Rgb direct, Rgb indirect) const {
    Rgb sum{0};
    if (options.direct) sum += direct;
    if (options.indirect) sum += indirect;
    return static_cast<double>(luminance(sum));
  }

  image::Image difference(ImageParts parts) const {
    const PathFilmHalf *a[] = {&halves[0]}, *b[] = {&halves[1]};
    image::Image difference = mean_image(view, a, parts);
    const image::Image other = mean_image(view, b, parts);
    for (std::size_t p = 0; p < other.pixels.size(); ++p)
      difference.pixels[p] = difference.pixels[p] - other.pixels[p];
    return difference;
  }

  // Those that belong to sample s of all pixels. The order of sums is fixed.
  void add_light_paths(int s, const MergePoints& points, const Sinks& sinks) {
    const std::size_t parts = (light_paths + kLightPathsAtOnce - 1) / kLightPathsAtOnce;
    std::vector<LightTracer::Found> found(parts);
    const auto half = static_cast<std::uint64_t>(s & 1);
    const std::uint64_t before = (static_cast<std::uint64_t>(s) >> 1) * light_paths;
    parallel_for(parts, 1, [&](std::size_t begin, std::size_t end) {
      if (sinks.cancelled()) return;
      for (std::size_t part = begin; part < end; ++part)
        for (std::size_t k = part * kLightPathsAtOnce;
             k < std::min(light_paths, (part + 1) * kLightPathsAtOnce); ++k) {
          const std::uint64_t number = 2 * (before + k) + half;
          light_tracer->trace(SampleStream(options.seed, Stage::light_paths, 0, number),
                              hash_ids(options.seed, Stage::opacity, ~0ull, number), points, found[part]);
        }
    });
    if (sinks.cancelled()) return;
    const auto add = [&](std::size_t p, Rgb value, bool direct) {
      PathFilmHalf& sums = halves[s & 1];
      (direct ? sums.direct : sums.indirect)[p].add(value);
      const double light = sent_luminance(direct ? value : Rgb{}, direct ? Rgb{} : value);
      sums.squares[p] += light * light;
    };
    std::uint64_t number = 0;
    for (const LightTracer::Found& part : found) {
      for (const LightTracer::Splat& splat : part.splats) {
        Rng random(options.seed, Stage::light_paths, ~static_cast<std::uint64_t>(s), ++number);
        const auto pixel = filter.pixel(splat.film, random.next_2d());
        const int x = pixel.at.x - view.crop_x, y = pixel.at.y - view.crop_y;
        if (x < 0 || y < 0 || x >= view.width || y >= view.height) continue;
        const std::size_t p =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width) + static_cast<std::size_t>(x);
        add(p, splat.value * pixel.weight, splat.direct);
      }
      for (const LightTracer::Merged& merged : part.merged) add(merged.pixel, merged.value, merged.direct);
    }
  }
};

PathFilm::PathFilm(const world::World& world, const world::View& view, const ReferenceOptions& options)
    : impl_(std::make_unique<Impl>(view, options)) {
  impl_->add_instant(world, view);
  impl_->trace_light_paths(world);
}
PathFilm::PathFilm(std::vector<Instant> instants, const ReferenceOptions& options)
    : impl_(std::make_unique<Impl>(instants.at(0).view, options)) {
  impl_->instants = std::move(instants);
  for (const Instant& instant : impl_->instants) impl_->add_instant(*instant.world, instant.view);
  if (impl_->instants.size() == 1) impl_->trace_light_paths(*impl_->instants.front().world);
}
PathFilm::~PathFilm() = default;
int PathFilm::paths() const { return impl_->result.spp; }

const ReferenceResult& PathFilm::result() const { return impl_->result; }

image::Image PathFilm::halves_difference() const { return impl_->difference(impl_->wanted()); }

image::Image PathFilm::sent() const {
  const PathFilmHalf* const both[] = {&impl_->halves[0], &impl_->halves[1]};
  return mean_image(impl_->view, both, impl_->sent());
}

std::vector<float> PathFilm::sent_deviation() const {
  const Impl& m = *impl_;
  const double count = std::max(1, m.result.spp);
  std::vector<float> deviation(m.pixels);
  for (std::size_t p = 0; p < m.pixels; ++p) {
    const double by_eye = (m.halves[0].by_eye[p] + m.halves[1].by_eye[p]) / count;
    // How many light paths come to a pixel is itself random, so their mean is not taken off.
    const double variance = (m.halves[0].squares[p] + m.halves[1].squares[p]) / count - by_eye * by_eye;
    deviation[p] = static_cast<float>(std::sqrt(std::max(0.0, variance) / count));
  }
  return deviation;
}

image::Image PathFilm::sent_difference() const { return impl_->difference(impl_->sent()); }

bool PathFilm::add(int paths, const Sinks& sinks, const std::function<void(double)>& progress) {
  Impl& m = *impl_;
  const ImageParts wanted = m.wanted();
  const int begin_path = m.result.spp, end_path = begin_path + paths;
  std::atomic<std::size_t> finished{0};
  const double all = static_cast<double>(m.pixels) * (m.merges() ? paths : 1);
  const auto trace = [&](int begin_sample, int end_sample, std::vector<std::vector<MergePoint>>* points) {
    parallel_for(m.pixels, kPixelsOfPart, [&](std::size_t begin, std::size_t end) {
      if (sinks.cancelled()) return;
      std::vector<MergePoint>* part = points ? &(*points)[begin / kPixelsOfPart] : nullptr;
      Impl::Batch batch;
      for (std::size_t p = begin; p < end; ++p) m.trace_pixel(p, begin_sample, end_sample, part, batch);
      m.trace_batch(batch, part);
      const double fraction = static_cast<double>(finished += end - begin) / all;
      if (progress) progress(fraction);
    });
  };
  if (!m.merges()) trace(begin_path, end_path, nullptr);
  for (int s = begin_path; s < end_path && m.light_tracer && !sinks.cancelled(); ++s) {
    std::vector<std::vector<MergePoint>> points;
    if (m.merges()) {
      points.resize((m.pixels + kPixelsOfPart - 1) / kPixelsOfPart);
      trace(s, s + 1, &points);
    }
    m.add_light_paths(s, MergePoints(std::move(points)), sinks);
  }
  if (sinks.cancelled()) {
    // The pass was left half done: its samples are unevenly spread and cannot be used.
    m.result.interrupted = true;
    return false;
  }
  for (int s = begin_path; s < end_path; ++s) ++m.halves[s & 1].count;
  const PathFilmHalf* both[] = {&m.halves[0], &m.halves[1]};
  m.result.emission = mean_image(m.view, both, {true, false, false});
  m.result.direct = mean_image(m.view, both, {false, true, false});
  m.result.indirect = mean_image(m.view, both, {false, false, true});
  m.result.spp = end_path;
  m.result.error = stated_error(m.view, m.halves[0], m.halves[1], wanted);
  m.result.image = mean_image(m.view, both, wanted);
  return true;
}

namespace {

ReferenceResult trace_until(PathFilm& film, const ReferenceEnd& end, const Sinks& sinks,
                            const std::function<void(const image::Image&)>& on_pass) {
  const int limit = end.spp > 0 ? end.spp : (end.time > 0 || end.error > 0 ? 1 << 20 : 64);
  const Timer timer;
  int done = 0;
  while (done < limit) {
    // Passes of growing size: the image is whole after each, and the error is not computed too often.
    const int pass = std::min(limit - done, std::clamp(done / 4, 2, 64));
    const bool whole = film.add(pass, sinks, [&](double fraction) {
      double progress = (done + pass * fraction) / limit;
      if (end.time > 0) progress = std::max(progress, timer.seconds() / end.time);
      sinks.report("reference", std::min(1.0, progress));
    });
    if (!whole) {
      if (done == 0) throw Cancelled();
      break;
    }
    done += pass;
    if (on_pass) on_pass(film.result().image);
    if (end.error > 0 && film.result().error <= end.error) break;
    // A pass is not begun that would, at the pace so far, end well after the budget.
    if (end.time > 0) {
      const double next = std::clamp(done / 4, 2, 64);
      if (timer.seconds() * (1 + 0.5 * next / done) > end.time) break;
    }
  }
  return film.result();
}

}  // namespace

ReferenceResult path_trace(const world::World& world, const world::View& view,
                           const ReferenceOptions& options, const ReferenceEnd& end, const Sinks& sinks,
                           const std::function<void(const image::Image&)>& on_pass) {
  PathFilm film(world, view, options);
  return trace_until(film, end, sinks, on_pass);
}

ReferenceResult path_trace(std::vector<Instant> instants, const ReferenceOptions& options,
                           const ReferenceEnd& end, const Sinks& sinks,
                           const std::function<void(const image::Image&)>& on_pass) {
  PathFilm film(std::move(instants), options);
  return trace_until(film, end, sinks, on_pass);
}

}  // namespace lumirank::pathtrace
