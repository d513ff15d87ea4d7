#include "transport/rows/film_receivers.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "transport/rows/film_order.h"
#include "transport/rows/film_samples.h"
#include "transport/rows/receiver_finder.h"

namespace lumirank::transport {
namespace {

constexpr std::size_t kTilesAtOnce = 16;
// What a surface must bring at least to the picture to be worth a receiver, as a share of a white pixel.
constexpr float kMinFilmShare = 0.004f;

// Film samples of one pixel that see the same surface and have no receiver.
struct Unlit {
  EyeVertex leader;   // the first of them
  float footprint;    // there
  int sample;         // of the one that was drawn for all,
  std::uint64_t id;   // and its vertex
  float weight = 0;   // of all: chains and albedos
  Rgb throughput{0};  // of all: chains
};

struct AddedPiece {
  std::vector<EyeVertex> vertices;
  std::vector<Vec2f> film;            // of each
  std::vector<std::size_t> per_tile;  // how many
  scatter::ClosurePool pool;
};

class FilmReceivers {
 public:
  FilmReceivers(const world::World& world, const world::Camera& camera, const ReceiverSettings& settings,
                Vec2i corner, const Receivers& receivers)
      : world_(world),
        camera_(camera),
        settings_(settings),
        corner_(corner),
        receivers_(receivers),
        finder_(receivers, corner),
        order_(receivers.width, receivers.height),
        pieces_((order_.tiles.size() + kTilesAtOnce - 1) / kTilesAtOnce) {}

  void find(const Sinks& sinks) {
    std::atomic<std::size_t> done{0};
    parallel_for(order_.tiles.size(), kTilesAtOnce, [&](std::size_t begin, std::size_t end) {
      if (sinks.cancelled()) return;
      AddedPiece& piece = pieces_[begin / kTilesAtOnce];
      FilmEye eye(world_, camera_, settings_);
      for (std::size_t t = begin; t < end; ++t) {
        const std::size_t before = piece.vertices.size();
        for (const Vec2i p : order_.pixels(order_.tiles[t])) {
          const Vec2i pixel{corner_.x + p.x, corner_.y + p.y};
          if (has_neighbors(camera_, receivers_, corner_, pixel)) add_of_pixel(eye, pixel, piece);
        }
        piece.per_tile.push_back(piece.vertices.size() - before);
      }
      sinks.report("film samples",
                   static_cast<double>(done += end - begin) / static_cast<double>(order_.tiles.size()));
    });
    if (sinks.cancelled()) throw Cancelled();
  }

  // Those of the pieces among the receivers that they were found for, which `all` is now.
  Receivers join(Receivers all) {
    std::vector<std::uint32_t> first_closure(pieces_.size());
    std::vector<std::size_t> first_added(pieces_.size() + 1, 0);
    for (std::size_t p = 0; p < pieces_.size(); ++p)
      first_added[p + 1] = first_added[p] + pieces_[p].vertices.size();
    if (first_added.back() == 0) return all;
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      first_closure[p] = all.closures.append(pieces_[p].pool);
      pieces_[p].pool = {};
    }
    all.closures.shrink();
    Receivers out = all;
    out.resize(all.size() + first_added.back(), true);
    out.added = first_added.back();
    for (const AddedPiece& piece : pieces_)
      out.film.insert(out.film.end(), piece.film.begin(), piece.film.end());
    out.emission.resize(out.film.size());
    std::size_t read = 0, written = 0;
    std::vector<EyeVertex> tile;
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      std::size_t k = 0;
      for (std::size_t t = 0; t < pieces_[p].per_tile.size(); ++t) {
        tile.clear();
        const std::size_t end = end_of_tile(p * kTilesAtOnce + t, all.samples());
        while (read < all.size() && all.sample[read] < end) tile.push_back(all.get(read++));
        for (std::size_t left = pieces_[p].per_tile[t]; left > 0; --left, ++k) {
          EyeVertex v = pieces_[p].vertices[k];
          v.sample = static_cast<std::uint32_t>(all.samples() + first_added[p] + k);
          if (v.closure != Receivers::kLambertian) v.closure += first_closure[p];
          tile.push_back(v);
        }
        sort_by_shading(tile.begin(), tile.end());
        for (const EyeVertex& v : tile) out.set(written++, v);
      }
    }
    return out;
  }

 private:
  // One past the last of its film samples.
  std::size_t end_of_tile(std::size_t t, std::size_t all) const {
    return t + 1 < order_.tiles.size()
               ? order_.tiles[t + 1].first_pixel * static_cast<std::size_t>(settings_.spp)
               : all;
  }

  void add_of_pixel(FilmEye& eye, Vec2i pixel, AddedPiece& piece) {
    std::vector<Unlit> unlit;
    std::vector<ReceiverFinder::Near> near;
    eye.begin(pixel);
    Rng rng(settings_.seed, Stage::film_samples, eye.pixel_id(), ~0ull);
    for (int k = 0; k < settings_.film_samples; ++k) {
      const FilmSample sample = eye.trace(k, nullptr);
      for (const EyeVertex& v : eye.vertices()) {
        const float worth = max_component(v.weight * v.albedo);
        if (!(worth > 0)) continue;
        const float footprint = eye.footprint(v);
        if (finder_.find(pixel, sample.film, v, footprint, near) <= FilmFit::neighbors) continue;
        const auto like = std::find_if(unlit.begin(), unlit.end(), [&](const Unlit& u) {
          return same_surface(u.leader, u.footprint, v.surface, v.position, v.normal, v.ng, false);
        });
        Unlit& u = like != unlit.end() ? *like : unlit.emplace_back(Unlit{v, footprint, k, v.id});
        u.weight += worth;
        u.throughput += v.weight;
        // Each of them with a probability in proportion to what it brings.
        if (rng.next_float() * u.weight < worth) u.sample = k, u.id = v.id;
      }
    }
    std::stable_sort(unlit.begin(), unlit.end(),
                     [](const Unlit& a, const Unlit& b) { return a.weight > b.weight; });
    const auto room = static_cast<std::size_t>(std::ceil(kMaxAdded * static_cast<float>(settings_.spp)));
    for (std::size_t n = 0; n < std::min(room, unlit.size()); ++n)
      if (unlit[n].weight >= kMinFilmShare * static_cast<float>(settings_.film_samples))
        add(eye, unlit[n], piece);
  }

  void add(FilmEye& eye, const Unlit& unlit, AddedPiece& piece) const {
    const FilmSample sample = eye.trace(unlit.sample, nullptr, &piece.pool);
    for (EyeVertex v : eye.vertices()) {
      if (v.id != unlit.id) continue;
      v.weight =
          unlit.throughput * (static_cast<float>(settings_.spp) / static_cast<float>(settings_.film_samples));
      piece.vertices.push_back(v);
      piece.film.push_back(sample.film);
    }
  }

  const world::World& world_;
  const world::Camera& camera_;
  const ReceiverSettings& settings_;
  Vec2i corner_;
  const Receivers& receivers_;
  ReceiverFinder finder_;
  FilmOrder order_;
  std::vector<AddedPiece> pieces_;
};

}  // namespace

bool has_neighbors(const world::Camera& camera, const Receivers& receivers, Vec2i corner, Vec2i pixel) {
  const auto inside = [](int at, int first, int count, int whole) {
    return std::max(0, at - 1) >= first && std::min(whole - 1, at + 1) < first + count;
  };
  return inside(pixel.x, corner.x, receivers.width, camera.width()) &&
         inside(pixel.y, corner.y, receivers.height, camera.height());
}

Receivers with_film_receivers(const world::World& world, const world::Camera& camera,
                              const ReceiverSettings& settings, Vec2i corner, Receivers receivers,
                              const Sinks& sinks) {
  FilmReceivers film(world, camera, settings, corner, receivers);
  film.find(sinks);
  return film.join(std::move(receivers));
}

}  // namespace lumirank::transport
