#include "transport/rows/receivers.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/sample_stream.h"
#include "transport/rows/eye_chain.h"
#include "transport/rows/film_order.h"
#include "transport/rows/film_receivers.h"

namespace lumirank::transport {
namespace {

constexpr std::size_t kTilesPerPiece = 64;

struct Crop {
  int x, y, width, height;
};

Crop crop_of(const world::Camera& camera, const ReceiverSettings& s) {
  if (s.crop_width == 0 && s.crop_height == 0) return {0, 0, camera.width(), camera.height()};
  const bool inside = s.crop_x >= 0 && s.crop_y >= 0 && s.crop_width > 0 && s.crop_height > 0 &&
                      s.crop_x <= camera.width() - s.crop_width &&
                      s.crop_y <= camera.height() - s.crop_height;
  if (!inside)
    throw InputError("the crop window (" + std::to_string(s.crop_x) + ", " + std::to_string(s.crop_y) + ", " +
                         std::to_string(s.crop_width) + " × " + std::to_string(s.crop_height) +
                         ") does not lie on the film of " + std::to_string(camera.width()) + " × " +
                         std::to_string(camera.height()) + " pixels",
                     "give a window with positive size inside the film");
  return {s.crop_x, s.crop_y, s.crop_width, s.crop_height};
}

// What one piece of tiles found, receivers already in their final order.
struct Piece {
  std::vector<EyeVertex> vertices;
  std::vector<EyeSegment> segments;
  scatter::ClosurePool pool;
};

// Of the k-th sample of a pixel of the whole film.
std::uint64_t sample_id(int x, int y, std::uint64_t k) {
  return hash_ids(static_cast<std::uint64_t>(y) << 32 | static_cast<std::uint32_t>(x), Stage::receivers, k);
}

// Which instant the samples of a pixel belong to. Neighbors on the film lie far apart in time: the order is
// that of a lattice with a step near the golden section.
class InstantOrder {
 public:
  explicit InstantOrder(const ReceiverSettings& settings) : settings_(settings) {
    step_ = std::max(1, static_cast<int>(0.618034 * settings.spp));
    while (std::gcd(step_, settings.spp) != 1) ++step_;
  }
  bool has(std::uint64_t pixel, int sample) const {
    if (settings_.instants == 1) return true;
    const double start = unit_double(hash_ids(settings_.seed, Stage::shutter, pixel));
    const std::int64_t place = static_cast<std::int64_t>(sample) * step_ % settings_.spp;
    const double time = static_cast<double>(place) / settings_.spp + start;
    const int instant = static_cast<int>((time - std::floor(time)) * settings_.instants);
    return std::min(instant, settings_.instants - 1) == settings_.instant;
  }

 private:
  const ReceiverSettings& settings_;
  int step_ = 1;
};

template <typename T>
void keep_only(std::vector<T>& values, const std::vector<std::uint8_t>& kept) {
  if (values.empty()) return;
  std::size_t to = 0;
  for (std::size_t k = 0; k < kept.size(); ++k)
    if (kept[k]) values[to++] = values[k];
  values.resize(to);
  values.shrink_to_fit();
}

class ReceiverTracer {
 public:
  ReceiverTracer(const world::World& world, const world::Camera& camera, const ReceiverSettings& settings)
      : world_(world),
        camera_(camera),
        settings_(settings),
        crop_(crop_of(camera, settings)),
        order_(crop_.width, crop_.height),
        instants_(settings_) {}

  Receivers run(const Sinks& sinks) {
    const std::size_t samples =
        static_cast<std::size_t>(crop_.width) * static_cast<std::size_t>(crop_.height) * spp();
    if (samples >= 0xffffffffull)
      throw InputError("the film has " + std::to_string(samples) + " samples; at most 2^32 - 1 are possible",
                       "lower the samples per pixel or the size of the film");
    result_.width = crop_.width, result_.height = crop_.height;
    result_.film.resize(samples);
    result_.emission.resize(samples);
    if (settings_.first_hits) {
      result_.first_albedo.resize(samples);
      result_.first_normal.resize(samples);
      result_.first_ng.resize(samples);
      result_.first_position.resize(samples);
      result_.first_distance.resize(samples);
    }
    if (settings_.instants > 1) kept_.resize(samples);
    pieces_.resize((order_.tiles.size() + kTilesPerPiece - 1) / kTilesPerPiece);
    std::atomic<std::size_t> done{0};
    parallel_for(order_.tiles.size(), kTilesPerPiece, [&](std::size_t begin, std::size_t end) {
      if (sinks.cancelled()) return;
      trace_piece(begin, end);
      done += end - begin;
      sinks.report("receivers", static_cast<double>(done) / static_cast<double>(order_.tiles.size()));
    });
    if (sinks.cancelled()) throw Cancelled();
    gather();
    if (settings_.instants > 1) drop_other_instants();
    return std::move(result_);
  }

 private:
  std::size_t spp() const { return static_cast<std::size_t>(settings_.spp); }

  void trace_piece(std::size_t begin, std::size_t end) {
    Piece& piece = pieces_[begin / kTilesPerPiece];
    EyeChain chain(world_, {settings_.max_depth, settings_.max_splits, settings_.eye_medium,
                            settings_.segments, settings_.segments_by_depth});
    for (std::size_t t = begin; t < end; ++t) {
      const auto first_of_tile = static_cast<std::ptrdiff_t>(piece.vertices.size());
      std::size_t sample = order_.tiles[t].first_pixel * spp();
      for (const Vec2i pixel : order_.pixels(order_.tiles[t]))
        trace_pixel(pixel, sample, chain, piece), sample += spp();
      sort_by_shading(piece.vertices.begin() + first_of_tile, piece.vertices.end());
    }
    piece.vertices.shrink_to_fit();
  }

  // Random numbers belong to the pixel of the whole film, so a crop shows the same picture.
  void trace_pixel(Vec2i pixel, std::size_t sample, EyeChain& chain, Piece& piece) {
    const int x = crop_.x + pixel.x, y = crop_.y + pixel.y;
    if (!settings_.pixels.has(x, y)) {
      for (int k = 0; k < settings_.spp; ++k) result_.film[sample++] = on_pixel({x, y}, {0.5f, 0.5f});
      return;
    }
    const std::uint64_t id = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(camera_.width()) +
                             static_cast<std::uint64_t>(x);
    const PixelPattern pattern(settings_.spp, hash_ids(settings_.seed, Stage::receivers, id, ~0ull));
    for (int k = 0; k < settings_.spp; ++k, ++sample) {
      if (!instants_.has(id, k)) continue;
      if (!kept_.empty()) kept_[sample] = 1;
      const auto number = static_cast<std::uint64_t>(k);
      Rng rng(settings_.seed, Stage::receivers, id, number | settings_.pass << 32);
      SampleStream jitter(settings_.seed, Stage::receivers, hash_ids(id, Stage::passes, number),
                          settings_.pass);
      const Vec2f film_jitter = jitter.next_2d();
      const auto place = pattern.place(k, film_jitter, jitter.next_2d());
      const Vec2f on_film = on_pixel({x, y}, place.film);
      result_.film[sample] = on_film;
      FirstHit first;
      result_.emission[sample] =
          chain.follow(camera_.ray(on_film, place.lens), sample_id(x, y, static_cast<std::uint64_t>(k)),
                       static_cast<std::uint32_t>(sample), rng, piece.vertices, &piece.pool,
                       settings_.first_hits ? &first : nullptr);
      piece.segments.insert(piece.segments.end(), chain.segments().begin(), chain.segments().end());
      if (!settings_.first_hits) continue;
      result_.first_albedo[sample] = first.albedo;
      result_.first_normal[sample] = first.normal;
      result_.first_ng[sample] = first.ng;
      result_.first_position[sample] = first.position;
      result_.first_distance[sample] = first.distance;
    }
  }

  void gather() {
    std::vector<std::size_t> first(pieces_.size() + 1, 0);
    std::vector<std::uint32_t> first_closure(pieces_.size());
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      first[p + 1] = first[p] + pieces_[p].vertices.size();
      first_closure[p] = result_.closures.append(pieces_[p].pool);
      pieces_[p].pool = {};
    }
    result_.closures.shrink();
    const std::size_t count = first.back();
    if (count >= 0xffffffffull)
      throw InputError("the film has " + std::to_string(count) + " receivers; at most 2^32 - 1 are possible",
                       "lower the samples per pixel or the size of the film");
    result_.resize(count, settings_.film_samples > 0, settings_.segments > 0);
    std::size_t segments = 0;
    for (const Piece& piece : pieces_) segments += piece.segments.size();
    result_.segments.resize(segments);
    segments = 0;
    for (const Piece& piece : pieces_)
      for (const EyeSegment& segment : piece.segments) result_.segments.set(segments++, segment);
    parallel_for(pieces_.size(), 1, [&](std::size_t p, std::size_t) {
      std::size_t i = first[p];
      for (EyeVertex& v : pieces_[p].vertices) {
        if (v.closure != Receivers::kLambertian) v.closure += first_closure[p];
        result_.set(i++, v);
      }
      pieces_[p] = Piece();
    });
  }

  // Film samples are those that were traced.
  void drop_other_instants() {
    std::vector<std::uint32_t> number(kept_.size());
    std::uint32_t next = 0;
    for (std::size_t k = 0; k < kept_.size(); ++k) number[k] = kept_[k] ? next++ : 0;
    for (std::uint32_t& sample : result_.sample) sample = number[sample];
    keep_only(result_.film, kept_), keep_only(result_.emission, kept_);
    keep_only(result_.first_albedo, kept_), keep_only(result_.first_normal, kept_);
    keep_only(result_.first_ng, kept_), keep_only(result_.first_position, kept_);
    keep_only(result_.first_distance, kept_);
  }

  const world::World& world_;
  const world::Camera& camera_;
  ReceiverSettings settings_;
  Crop crop_;
  FilmOrder order_;
  InstantOrder instants_;
  std::vector<std::uint8_t> kept_;  // by film sample; empty where all are
  std::vector<Piece> pieces_;
  Receivers result_;
};

}  // namespace

Receivers trace_receivers(const world::World& world, const world::Camera& camera,
                          const ReceiverSettings& settings, const Sinks& sinks) {
  if (settings.spp < 1)
    throw InputError("samples per pixel: " + std::to_string(settings.spp) + " is too few", "give at least 1");
  Receivers receivers = ReceiverTracer(world, camera, settings).run(sinks);
  if (settings.film_samples == 0) return receivers;
  const Crop crop = crop_of(camera, settings);
  return with_film_receivers(world, camera, settings, {crop.x, crop.y}, std::move(receivers), sinks);
}

void Receivers::resize(std::size_t count, bool with_surface, bool with_media) {
  position.resize(count), normal.resize(count), ng.resize(count), wo.resize(count);
  weight.resize(count), albedo.resize(count);
  id.resize(count), sample.resize(count), closure.resize(count), depth.resize(count);
  surface.resize(with_surface ? count : 0);
  media.resize(with_media ? count : 0);
}

EyeVertex Receivers::get(std::size_t i) const {
  EyeVertex v;
  v.position = position[i], v.normal = normal[i], v.ng = ng[i], v.wo = wo[i];
  v.weight = weight[i], v.albedo = albedo[i];
  v.id = id[i], v.sample = sample[i], v.closure = closure[i], v.depth = depth[i];
  if (!surface.empty()) v.surface = surface[i];
  if (!media.empty()) v.medium[0] = media[i][0], v.medium[1] = media[i][1];
  return v;
}

void Receivers::set(std::size_t i, const EyeVertex& v) {
  position[i] = v.position, normal[i] = v.normal, ng[i] = v.ng, wo[i] = v.wo;
  weight[i] = v.weight, albedo[i] = v.albedo;
  id[i] = v.id, sample[i] = v.sample, closure[i] = v.closure, depth[i] = v.depth;
  if (!surface.empty()) surface[i] = v.surface;
  if (!media.empty()) media[i] = {v.medium[0], v.medium[1]};
}

scatter::Closure Receivers::closure_at(std::size_t i) const {
  if (closure[i] != kLambertian) return closures.get(closure[i], normal[i], ng[i]);
  return scatter::lambertian(albedo[i], normal[i], ng[i]);
}

std::uint32_t Receivers::key(std::size_t i) const { return static_cast<std::uint32_t>(mix64(id[i]) >> 32); }

std::size_t Receivers::memory_bytes() const {
  const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return bytes(position) + bytes(normal) + bytes(ng) + bytes(wo) + bytes(weight) + bytes(id) + bytes(sample) +
         bytes(depth) + bytes(closure) + bytes(albedo) + bytes(surface) + bytes(media) +
         segments.memory_bytes() + closures.memory_bytes() + bytes(film) + bytes(emission) +
         bytes(first_albedo) + bytes(first_normal) + bytes(first_position) + bytes(first_distance);
}

Receivers white_receivers(const Receivers& seen) {
  Receivers out;
  out.film.assign(seen.film.begin(), seen.film.begin() + static_cast<std::ptrdiff_t>(seen.grid_samples()));
  out.emission.assign(out.samples(), Rgb(0));
  out.width = seen.width, out.height = seen.height;
  const auto pixels = static_cast<std::size_t>(seen.width) * static_cast<std::size_t>(seen.height);
  const std::size_t spp = pixels > 0 ? out.samples() / pixels : 1;
  for (std::size_t k = 0; k < out.samples(); ++k) {
    if (!std::isfinite(seen.first_distance[k])) continue;
    out.id.push_back(sample_id(static_cast<int>(seen.film[k].x), static_cast<int>(seen.film[k].y), k % spp));
    out.position.push_back(seen.first_position[k]);
    out.normal.push_back(seen.first_normal[k]), out.ng.push_back(seen.first_ng[k]);
    // Light is received from above the surface, at whatever angle it is seen: even where a shading normal
    // turns away from the eye, wo must lie on the side of both.
    out.wo.push_back(normalize(seen.first_normal[k] + seen.first_ng[k]));
    out.weight.push_back(Rgb(1)), out.albedo.push_back(Rgb(1));
    out.sample.push_back(static_cast<std::uint32_t>(k));
    out.depth.push_back(1);
    out.closure.push_back(Receivers::kLambertian);
  }
  return out;
}

Receivers broad_receivers(Receivers all, float limit) {
  Receivers out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::uint32_t closure = all.closure[i];
    Rgb albedo = all.albedo[i];
    if (closure != Receivers::kLambertian) {
      const scatter::Closure broad = scatter::broad_part(all.closure_at(i), limit);
      if (broad.count == 0) continue;
      closure = Receivers::kLambertian;
      if (broad.is_lambertian())
        albedo = broad.diffuse_color();
      else
        closure = out.closures.add(broad, all.normal[i]);
    }
    out.position.push_back(all.position[i]);
    out.normal.push_back(all.normal[i]), out.ng.push_back(all.ng[i]);
    out.wo.push_back(all.wo[i]);
    out.weight.push_back(all.weight[i]), out.albedo.push_back(albedo);
    out.id.push_back(all.id[i]), out.sample.push_back(all.sample[i]), out.depth.push_back(all.depth[i]);
    out.closure.push_back(closure);
    if (!all.surface.empty()) out.surface.push_back(all.surface[i]);
    if (all.is_gathered(i)) ++out.gathered;
  }
  out.closures.shrink();
  out.added = all.added;
  out.film = std::move(all.film), out.emission = std::move(all.emission);
  out.first_albedo = std::move(all.first_albedo);
  out.first_normal = std::move(all.first_normal), out.first_ng = std::move(all.first_ng);
  out.first_position = std::move(all.first_position), out.first_distance = std::move(all.first_distance);
  out.width = all.width, out.height = all.height;
  return out;
}

}  // namespace lumirank::transport
