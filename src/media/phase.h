// Phase functions: into which directions a medium scatters. Normalized over the sphere, per steradian, and
// the same at every place of a medium.
//
// Henyey, Greenstein, "Diffuse radiation in the galaxy", 1941. Blasi, Le Saëc, Schlick, "A rendering
// algorithm for discrete volume density objects", 1993: nearly the same shape by a square instead of a root.
#pragma once

#include <array>
#include <cstdint>

#include "base/lanes.h"
#include "base/rgb.h"
#include "base/vec.h"

namespace lumirank::media {

struct PhaseLobe {
  enum class Kind : std::uint8_t { henyey_greenstein, schlick };
  Kind kind = Kind::henyey_greenstein;
  Rgb g{0};          // mean cosine for each channel, within (-1, 1); 0: isotropic
  float weight = 1;  // of the mixture; all sum to 1
};

// A mixture of at most kMaxLobes.
struct PhaseFunction {
  static constexpr int kMaxLobes = 4;
  std::array<PhaseLobe, kMaxLobes> lobes{};
  int count = 1;

  // For each channel. `cosine`: of the angle between the directions in which light travels before and after.
  Rgb eval(float cosine) const;
  Lane3 eval(Lane cosine) const;  // the same bits
  // A direction in which a path goes on that came along `forward` (unit), with the density eval() of one
  // channel.
  Vec3f sample(Vec3f forward, int channel, float u_lobe, Vec2f u) const;
  // At least eval() of all cosines in between; of one lobe no more than that.
  Rgb max_value(float min_cosine = -1, float max_cosine = 1) const;
  bool isotropic() const { return count == 1 && is_black(lobes[0].g); }
  bool gray() const;  // alike for all channels
};

}  // namespace lumirank::media
