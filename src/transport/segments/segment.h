// Pieces of rays in media, eye rays and light rays alike, and how alike two of them are (Huo et al. 2016,
// section 4.2.1).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "media/medium.h"

namespace lumirank::transport {

struct Segment {
  Vec3f origin, direction;  // unit
  float length = 0;
  std::int16_t medium = -1;
  float transmittance = 1;  // over its length, mean of the channels
  Vec2f film;               // of eye rays, in pixels
  bool joined = false;      // goes on where the one before it in the list ends
  Vec3f end() const { return origin + direction * length; }
};

// Equations 8 to 13. Sums of terms from 0 to 1: how near beginnings and ends are, how alike the directions in
// which light is scattered, how alike the transmittances, and, of eye rays, how near on the film.
class SegmentSimilarity {
 public:
  // `diagonal`: of the scene's box. Segments further apart than an eighth of it are not near at all.
  SegmentSimilarity(std::span<const media::Medium> media, float diagonal, bool film)
      : media_(media), reach_(diagonal / 8), film_(film) {}
  float operator()(const Segment& a, const Segment& b) const;
  float most() const { return film_ ? 4.0f : 3.0f; }

 private:
  // Equation 11, where absolute differences are meant, each relative to the peak of the segment that has it
  // there.
  float phase_difference(const Segment& a, const Segment& b) const;

  std::span<const media::Medium> media_;
  float reach_;
  bool film_;
};

}  // namespace lumirank::transport
