#include "media/forced_collision.h"

#include <algorithm>
#include <cmath>

#include "media/tracking.h"

namespace lumirank::media {

RayPlace force_collision(const Medium& medium, Vec3f origin, Vec3f direction, float t_max, float u_channel,
                         float u) {
  Rgb whole{0};
  Medium::Walk::Piece piece;
  for (Medium::Walk walk(medium, origin, direction, t_max); walk.next(piece);)
    whole += over_length(piece.extinction.middle(), piece.end - piece.begin);
  int channels[3], count = 0;
  for (int c = 0; c < 3; ++c)
    if (whole[c] > 0) channels[count++] = c;
  if (count == 0) return {};
  const int channel = channels[std::min(count - 1, static_cast<int>(u_channel * static_cast<float>(count)))];
  const float wanted = -std::log1p(u * std::expm1(-whole[channel]));

  RayPlace place;
  Rgb depth{0};
  for (Medium::Walk walk(medium, origin, direction, t_max); walk.next(piece);) {
    const Rgb extinction = piece.extinction.middle();
    const Rgb beyond = depth + over_length(extinction, piece.end - piece.begin);
    if (extinction[channel] > 0) {
      // Of the last piece by rounding alone.
      place.t =
          std::min(piece.end, piece.begin + std::max(0.0f, wanted - depth[channel]) / extinction[channel]);
      const Rgb through = exp_minus(depth + over_length(extinction, place.t - piece.begin));
      place.pdf = 0;
      for (int k = 0; k < count; ++k) {
        const int c = channels[k];
        place.pdf += extinction[c] * through[c] / (-std::expm1(-whole[c]) * static_cast<float>(count));
      }
      if (wanted <= beyond[channel]) break;
    }
    depth = beyond;
  }
  return std::isfinite(place.t) && place.pdf > 0 ? place : RayPlace{};
}

}  // namespace lumirank::media
