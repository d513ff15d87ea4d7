#include "transport/lights/cut_rays.h"

#include <algorithm>
#include <cmath>

#include "media/tracking.h"

namespace lumirank::transport {

void append_piece(const RayLights& rays, std::size_t j, float offset, float length, Rgb power,
                  std::uint64_t id, RayLights& out) {
  out.origin.push_back(rays.origin[j] + rays.direction[j] * offset);
  out.direction.push_back(rays.direction[j]), out.length.push_back(length);
  out.medium.push_back(rays.medium[j]), out.power.push_back(power), out.emitter.push_back(rays.emitter[j]);
  out.depth.push_back(rays.depth[j]), out.path.push_back(rays.path[j]);
  out.half.push_back(rays.half[j]), out.id.push_back(id);
}

void append_pieces(const world::World& world, const RayLights& rays, std::size_t j,
                   std::span<const float> ends, Rng& rng, RayLights& out, std::vector<Rgb>& passed) {
  const media::Medium& medium = world.media()[static_cast<std::size_t>(rays.medium[j])];
  const auto random = [&rng] { return rng.next_float(); };
  Rgb power = rays.power[j];
  float from = 0;
  for (std::size_t k = 0; k < ends.size() && !is_black(power); ++k) {
    const float part = ends[k] - from;
    append_piece(rays, j, from, part, power, mix64(rays.id[j] + k + 1), out);
    passed.push_back(media::transmittance(medium, out.origin.back(), rays.direction[j], part, random));
    power *= passed.back();
    from = ends[k];
  }
}

RayLights cut_evenly(const world::World& world, const RayLights& rays, double pieces, std::uint64_t seed) {
  double total = 0;
  for (const float length : rays.length) total += static_cast<double>(length);
  const double each = total / (pieces * static_cast<double>(std::max<std::size_t>(1, rays.size())));
  RayLights out;
  std::vector<float> ends;
  std::vector<Rgb> passed;
  for (std::size_t j = 0; j < rays.size(); ++j) {
    const double wanted = std::ceil(static_cast<double>(rays.length[j]) / each);
    const auto count = static_cast<std::size_t>(std::clamp(wanted, 1.0, static_cast<double>(kMostPieces)));
    ends.clear(), passed.clear();
    for (std::size_t k = 1; k < count; ++k)
      ends.push_back(rays.length[j] * static_cast<float>(k) / static_cast<float>(count));
    ends.push_back(rays.length[j]);
    Rng rng(seed, Stage::segments, rays.id[j]);
    append_pieces(world, rays, j, ends, rng, out, passed);
  }
  return out;
}

}  // namespace lumirank::transport
