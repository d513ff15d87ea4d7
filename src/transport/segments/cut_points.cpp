#include "transport/segments/cut_points.h"

#include <algorithm>

#include "media/tracking.h"

namespace lumirank::transport {

void cut_points(const media::Medium& medium, Vec3f origin, Vec3f direction, float length, int pieces,
                Rng& rng, std::vector<float>& out) {
  out.clear();
  const auto random = [&rng] { return rng.next_float(); };
  // The channel whose light comes from farthest would put few points where the others scatter: one of each in
  // turn.
  for (int k = 1; k < pieces; ++k) {
    const int channel = k % 3;
    media::ChannelThroughput unused;
    media::fly(medium, origin, direction, length, channel, random, unused,
               [&](float t, const media::Coefficients& at, Rgb bound) {
                 if (random() * bound[channel] >= at.extinction[channel]) return true;
                 if (t > 0 && t < length) out.push_back(t);
                 return false;
               });
  }
  std::sort(out.begin(), out.end());
  // Points that coincide would leave parts without length.
  const float least = 1e-5f * length;
  float last = 0;
  std::erase_if(out, [&](float t) {
    if (t - last < least || length - t < least) return true;
    last = t;
    return false;
  });
}

}  // namespace lumirank::transport
