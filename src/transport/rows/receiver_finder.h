// Which receivers a film sample takes its light from: those near it that see the same kind of surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "transport/rows/eye_chain.h"
#include "transport/rows/receivers.h"

namespace lumirank::transport {

// Where the receivers were found, from what is sought to what is better than nothing. "The same surface" is
// one with the same material at the end of a chain through the same specular surfaces, a similar normal, and
// a place in the same plane; "the same sort" has that material and chain alone.
enum class FilmFit {
  own_pixel,       // the same surface, among the receivers of the film sample's pixel
  neighbors,       // the same surface, among those of the eight pixels around it
  own_pixel_sort,  // the same sort of surface
  neighbors_sort,
  any,   // whatever surface
  none,  // there is no receiver
};
inline constexpr int kFilmFits = 6;

// Light is estimated by ratios of sums: albedo · Σ w·L / Σ w·a over the receivers found, with their light L
// and albedo a, per channel. Where albedos are equal this is the weighted mean of L; textures stay those of
// film samples; and over many receivers of a pixel the mean of its film samples tends to the mean of L,
// whatever the surface scatters, because receivers of the own pixel have equal weights. A neighbor's weight
// falls with its distance on the film.
class ReceiverFinder {
 public:
  struct Near {
    std::uint32_t receiver;
    float weight;
  };
  // `corner`: the upper left pixel of the window that the receivers were traced for. Receivers must have
  // their `surface` and outlive it.
  ReceiverFinder(const Receivers& receivers, Vec2i corner);

  // Fills `near` with the receivers for the vertex of a film sample. `pixel` and `film` on the whole film;
  // `footprint`: FilmEye::footprint().
  FilmFit find(Vec2i pixel, Vec2f film, const EyeVertex& vertex, float footprint,
               std::vector<Near>& near) const;
  // The light that leaves the vertex towards the eye, chain not counted. `light`: that of all receivers.
  Rgb light(const EyeVertex& vertex, std::span<const Near> near, std::span<const Rgb> light) const;

 private:
  template <typename Fits>
  void gather(Vec2i pixel, int reach, Vec2f film, std::vector<Near>& near, Fits&& fits) const;
  bool tells(const EyeVertex& vertex, std::span<const Near> near) const;
  bool is_added(std::uint32_t i) const { return receivers_.sample[i] >= receivers_.grid_samples(); }

  const Receivers& receivers_;
  Vec2i corner_;
  std::vector<std::uint32_t> first_, order_;  // receivers by pixel
  std::vector<Rgb> albedo_;
};

// Whether two vertices of one surface, seen close to each other, lie on the same part of it; `other` is a
// receiver or another vertex. `far`: beyond the pixel, where what a sharp lobe reflects must agree too.
bool same_surface(const EyeVertex& vertex, float footprint, std::uint32_t surface, Vec3f position,
                  Vec3f normal, Vec3f ng, bool far);

}  // namespace lumirank::transport
