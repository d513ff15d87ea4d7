// Rows: the points that the film sees, at the end of specular chains from the eye.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/rgb.h"
#include "base/sinks.h"
#include "base/vec.h"
#include "film/pixel_lattice.h"
#include "scatter/closure.h"
#include "scatter/closure_pool.h"
#include "transport/rows/eye_segments.h"
#include "world/camera.h"
#include "world/world.h"

namespace lumirank::transport {

struct ReceiverSettings {
  std::uint64_t seed = 1;
  int spp = 4;  // film samples per pixel, stratified √spp × √spp when square
  // Of several pictures with one seed, whose mean is wanted, the number of this one: their samples are spread
  // evenly together.
  std::uint64_t pass = 0;
  int max_depth = -1;  // Mitsuba's count
  // What is traced, 0: the whole film. A picture of a window needs as much around it as its filter reaches.
  int crop_x = 0, crop_y = 0, crop_width = 0, crop_height = 0;
  bool first_hits = true;  // keep the first_… arrays, for AOVs: 40 B and some µs per sample
  // Specular vertices at which both reflection and refraction are followed; at later ones, one is drawn.
  int max_splits = 3;
  // Film samples per pixel that take their light from receivers (film_samples.h); 0: receivers are the film
  // samples. Otherwise places that no receiver sees get receivers of their own.
  int film_samples = 0;
  // Of so many instants of an open shutter, the samples of one: each pixel's samples are spread evenly over
  // the instants, from a start of its own, so that every instant has 1/instants of them on average.
  int instants = 1, instant = 0;
  // Only these pixels of the whole film; the samples of all others see nothing.
  film::PixelLattice pixels;
  // Of participating media, as in ChainSettings.
  int eye_medium = -1, segments = 0;
  bool segments_by_depth = false;
};

struct EyeVertex;

// Sorted in Morton order of 4×4-pixel tiles, so that neighbors in the image are neighbors in memory.
// A film sample may have several receivers (glass, smooth coatings) or none (it sees only emitters or the
// background).
struct Receivers {
  std::vector<Vec3f> position;
  // Shading and geometric, in the hemisphere of wo where they agree. On a fiber ng is zero
  // (Closure::is_fiber()).
  std::vector<Vec3f> normal, ng;
  std::vector<Vec3f> wo;    // unit, back along the eye path
  std::vector<Rgb> weight;  // throughput of the specular chain
  // Who it is, by its pixel, number of sample and chain: the same in every window of the film that shows it,
  // and whatever other receivers there are.
  std::vector<std::uint64_t> id;
  std::vector<std::uint32_t> sample;   // film sample that it belongs to
  std::vector<std::uint16_t> depth;    // path segments from the eye to here (1: seen directly)
  std::vector<std::uint32_t> closure;  // index into closures (not lambertian), or kLambertian
  std::vector<Rgb> albedo;             // of lambertian receivers: diffuse reflectance
  std::vector<std::uint32_t> surface;  // as in EyeVertex; empty without film samples of their own
  // Participating media on the side of wo and on the other; empty where they are not asked for.
  std::vector<std::array<std::int16_t, 2>> media;
  EyeSegments segments;           // rows within them
  scatter::ClosurePool closures;  // non-delta lobes only
  // The last so many are one scattering further from the eye than the others (gathered_receivers.h).
  std::size_t gathered = 0;
  bool is_gathered(std::size_t i) const { return i >= size() - gathered; }
  // The closure of any receiver, lambertian or not, without its delta lobes.
  scatter::Closure closure_at(std::size_t i) const;

  static constexpr std::uint32_t kLambertian = 0xffffffffu;

  // Film samples: position on the whole film in pixels, and the emission that is seen directly or through the
  // chain. The last ones stand for receivers that were added where film samples found none: they have no
  // emission, and a picture made of this grid of samples alone leaves them out.
  std::size_t added = 0;
  std::vector<Vec2f> film;
  std::vector<Rgb> emission;
  // First hit of each sample, for AOVs: zero (distance: infinite) where the background is seen. Empty if not
  // asked for.
  std::vector<Rgb> first_albedo;
  std::vector<Vec3f> first_normal, first_ng, first_position;  // normals on the eye's side
  std::vector<float> first_distance;
  int width = 0, height = 0;  // of the cropped film

  // Whose random numbers a receiver uses: its id in 32 bits.
  std::uint32_t key(std::size_t i) const;

  std::size_t size() const { return position.size(); }
  std::size_t samples() const { return film.size(); }
  std::size_t grid_samples() const { return film.size() - added; }
  std::size_t memory_bytes() const;

  // All fields of one receiver; closures stay where they are.
  void resize(std::size_t count, bool with_surface, bool with_media = false);
  EyeVertex get(std::size_t i) const;
  void set(std::size_t i, const EyeVertex& vertex);
};

// A white diffuse receiver (albedo 1) at every first hit, for the irradiance there: E = π times its radiance.
// Weights are 1, depths 1; film samples stay those of `seen`, which has its first hits.
Receivers white_receivers(const Receivers& seen);

// What is left to columns where lobes with a roughness below `limit` take their light elsewhere: receivers
// without those lobes, and only where one is left. Film samples stay those of `all`.
Receivers broad_receivers(Receivers all, float limit);

Receivers trace_receivers(const world::World& world, const world::Camera& camera,
                          const ReceiverSettings& settings, const Sinks& sinks = {});

}  // namespace lumirank::transport
