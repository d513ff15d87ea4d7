#include "transport/segments/cut_points.h"

#include <algorithm>
#include <cmath>

#include "media/tracking.h"

namespace lumirank::transport {
namespace {

// Points that coincide would leave parts without length.
void drop_coinciding(float length, std::vector<float>& out) {
  const float least = 1e-5f * length;
  float last = 0;
  std::erase_if(out, [&](float t) {
    if (t - last < least || length - t < least) return true;
    last = t;
    return false;
  });
}

}  // namespace

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
  drop_coinciding(length, out);
}

void cut_points_by_depth(const media::DepthProfile& profile, float length, int pieces,
                         std::vector<float>& out) {
  out.clear();
  const float collides = -std::expm1(-mean(profile.whole_depth()));
  for (int k = 1; k < pieces; ++k) {
    const float part = collides * static_cast<float>(k) / static_cast<float>(pieces);
    const float t = profile.place_of_mean(-std::log1p(-part));
    if (t > 0 && t < length) out.push_back(t);
  }
  drop_coinciding(length, out);
}

}  // namespace lumirank::transport
