#include "transport/rows/film_samples.h"

#include "base/morton.h"
#include "base/random.h"
#include "base/sample_stream.h"

namespace lumirank::transport {

FilmEye::FilmEye(const world::World& world, const world::Camera& camera, const ReceiverSettings& settings)
    : world_(world),
      camera_(camera),
      settings_(settings),
      chain_(world_, {settings.max_depth, settings.max_splits, settings.eye_medium, settings.segments,
                      settings.segments_by_depth}),
      pattern_(1, 0) {}

void FilmEye::begin(Vec2i pixel) {
  pixel_ = pixel;
  id_ = static_cast<std::uint64_t>(pixel.y) * static_cast<std::uint64_t>(camera_.width()) +
        static_cast<std::uint64_t>(pixel.x);
  if (settings_.film_samples > 0)
    pattern_ =
        PixelPattern(settings_.film_samples, hash_ids(settings_.seed, Stage::film_samples, id_, ~0ull));
  const Vec2f center{static_cast<float>(pixel.x) + 0.5f, static_cast<float>(pixel.y) + 0.5f};
  center_ = camera_.ray(center, {0.5f, 0.5f});
  beside_ = camera_.ray({center.x + 1, center.y}, {0.5f, 0.5f});
  off_axis_ = camera_.ray(center, {1, 0.5f});
}

FilmSample FilmEye::trace(int k, FirstHit* first, scatter::ClosurePool* pool) {
  const auto number = static_cast<std::uint64_t>(k);
  Rng rng(settings_.seed, Stage::film_samples, id_, number);
  const Vec2f film_jitter = rng.next_2d();
  const auto place = pattern_.place(k, film_jitter, rng.next_2d());
  return follow({number, place.film, place.lens, rng}, first, pool);
}

FilmSample FilmEye::trace_in_sequence(std::uint64_t number) {
  const auto place = static_cast<std::uint32_t>(
      morton2(static_cast<std::uint32_t>(pixel_.x), static_cast<std::uint32_t>(pixel_.y)));
  // Those of odd number are a set of their own.
  SampleStream spread = SampleStream::over_film(settings_.seed, Stage::film_samples, 0, place, 2 * number);
  const Vec2f in_pixel = spread.next_2d();
  return follow({number, in_pixel, spread.next_2d(), Rng(settings_.seed, Stage::film_samples, id_, number)},
                nullptr, nullptr);
}

FilmSample FilmEye::follow(Look look, FirstHit* first, scatter::ClosurePool* pool) {
  FilmSample sample;
  sample.film = on_pixel(pixel_, look.in_pixel);
  vertices_.clear();
  const std::uint64_t pixel =
      static_cast<std::uint64_t>(pixel_.y) << 32 | static_cast<std::uint32_t>(pixel_.x);
  sample.emission =
      chain_.follow(camera_.ray(sample.film, look.on_lens), hash_ids(pixel, Stage::film_samples, look.number),
                    0, look.random, vertices_, pool, first);
  for (const SeenEmission& seen : chain_.straight_emission()) {
    sample.straight += seen.radiance;
    if (in_focus(seen.distance)) sample.sharp += seen.radiance;
  }
  return sample;
}

float FilmEye::apart(const geometry::Ray& ray, float distance) const {
  return length(ray.origin - center_.origin + (ray.direction - center_.direction) * distance);
}

float FilmEye::footprint(const EyeVertex& vertex) const {
  return apart(beside_, vertex.distance) + 2 * apart(off_axis_, vertex.distance);
}

bool FilmEye::in_focus(float distance) const {
  // Farther away than anything in the scene both grow alike.
  constexpr float kVeryFar = 1e6f;
  const float d = std::min(distance, kVeryFar);
  return 2 * apart(off_axis_, d) <= apart(beside_, d);
}

}  // namespace lumirank::transport
