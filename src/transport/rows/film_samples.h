// Film samples apart from receivers: what the eye sees at many places of a pixel, each with the emission that
// is its own and the surfaces at the ends of its chains, whose light the receivers near it know.
//
// After the antialiasing of tensor clustering (Hašan et al. 2008, end of section 5), which finds for every
// sample of a deep frame buffer with three times the resolution the nearest pixel by position, normal and
// albedo. Here every sample is traced when it is wanted and none is kept.
#pragma once

#include <cstdint>
#include <vector>

#include "base/random.h"
#include "transport/rows/eye_chain.h"
#include "transport/rows/film_order.h"
#include "transport/rows/receivers.h"
#include "world/camera.h"
#include "world/world.h"

namespace lumirank::transport {

struct FilmSample {
  Vec2f film;  // on the whole film, in pixels
  Rgb emission;
  Rgb straight;  // the part of it that comes by no mirror and no bending glass
  Rgb sharp;     // the part of that which is in focus: one sample sees what all of its pixel see
};

// Traces the film samples of one pixel after the other. World and camera must outlive it; one for each
// thread.
class FilmEye {
 public:
  // Of the settings: seed, film_samples (0: of the sequence alone), max_depth, max_splits, eye_medium,
  // segments.
  FilmEye(const world::World& world, const world::Camera& camera, const ReceiverSettings& settings);

  // The pixel of the whole film that the following calls are about.
  void begin(Vec2i pixel);
  // Sample k of the pixel: the same whenever it is asked for. What `first` and `pool` get:
  // EyeChain::follow().
  FilmSample trace(int k, FirstHit* first, scatter::ClosurePool* pool = nullptr);
  // The same of an endless sequence, of which the first ones are evenly spread over the pixel however many
  // they are, together with those of neighboring pixels.
  FilmSample trace_in_sequence(std::uint64_t number);
  // Of the sample traced last; without a pool they have their albedo and roughness.
  const std::vector<EyeVertex>& vertices() const { return vertices_; }
  float unlikely() const { return chain_.unlikely(); }
  // What it passed of participating media, if settings ask for segments.
  const std::vector<EyeSegment>& segments() const { return chain_.segments(); }
  // Width of a pixel where a vertex lies, out of focus that of the circle of confusion. An estimate: mirrors
  // are taken for flat.
  float footprint(const EyeVertex& vertex) const;
  // Key of random numbers of the pixel.
  std::uint64_t pixel_id() const { return id_; }

 private:
  struct Look {
    std::uint64_t number;
    Vec2f in_pixel, on_lens;  // in the unit square
    Rng random;
  };
  FilmSample follow(Look look, FirstHit* first, scatter::ClosurePool* pool);
  // How far from center_ another ray has come.
  float apart(const geometry::Ray& ray, float distance) const;
  // Whether a pixel is wider than the circle of confusion at that distance along an eye ray.
  bool in_focus(float distance) const;

  const world::World& world_;
  const world::Camera& camera_;
  ReceiverSettings settings_;
  EyeChain chain_;
  PixelPattern pattern_;
  Vec2i pixel_{0, 0};
  std::uint64_t id_ = 0;
  geometry::Ray center_, beside_, off_axis_;
  std::vector<EyeVertex> vertices_;
};

}  // namespace lumirank::transport
