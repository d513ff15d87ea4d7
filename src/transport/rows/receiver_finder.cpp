#include "transport/rows/receiver_finder.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace lumirank::transport {
namespace {

// Normals of one surface, within a pixel and beyond: 26 degrees. Of lobes sharper than this roughness the
// cone narrows with it beyond the pixel, because what they reflect turns with the normal.
constexpr float kSameNormal = 0.9f, kBroadLobe = 0.5f;
// How far one surface may leave a plane: so much of a pixel, and so much of the way between the places (a
// surface that turns by 26 degrees on it leaves its tangent plane by a quarter). Chains widen it: curved
// mirrors spread what a pixel sees.
constexpr float kPlanePixels = 0.5f, kPlaneSlope = 0.25f, kChainSpread = 4;
// Fibers have no plane: what counts is how far they are from each other, in pixels.
constexpr float kFiberPixels = 3;
// Square of the distance on the film, in pixels, at which a neighbor counts half.
constexpr float kHalfWeight = 0.25f;
// The receivers must reflect this share of what the vertex does, or they tell nothing of its light.
constexpr float kMinReflected = 0.01f;

}  // namespace

bool same_surface(const EyeVertex& vertex, float footprint, std::uint32_t surface, Vec3f position,
                  Vec3f normal, Vec3f ng, bool far) {
  if (surface != vertex.surface) return false;
  const Vec3f between = position - vertex.position;
  if (vertex.depth > 1) footprint *= kChainSpread;
  const bool fiber = vertex.ng == Vec3f{0, 0, 0};
  if (fiber || ng == Vec3f{0, 0, 0})
    return fiber && ng == Vec3f{0, 0, 0} && length(between) <= kFiberPixels * footprint;
  float least_cosine = kSameNormal;
  if (far && vertex.roughness < kBroadLobe)
    least_cosine = 1 - (1 - kSameNormal) * (vertex.roughness / kBroadLobe) * (vertex.roughness / kBroadLobe);
  // Within a pixel bumps are averaged: either normal may tell that it is one surface.
  if (dot(normal, vertex.normal) < least_cosine && (far || dot(ng, vertex.ng) < kSameNormal)) return false;
  return std::abs(dot(vertex.ng, between)) <= kPlanePixels * footprint + kPlaneSlope * length(between);
}

ReceiverFinder::ReceiverFinder(const Receivers& receivers, Vec2i corner)
    : receivers_(receivers), corner_(corner) {
  const std::size_t count = receivers.size();
  first_.assign(static_cast<std::size_t>(receivers.width) * static_cast<std::size_t>(receivers.height) + 1,
                0);
  const auto pixel_of = [&](std::size_t i) {
    const Vec2f film = receivers.film[receivers.sample[i]];
    return static_cast<std::size_t>(static_cast<int>(film.y) - corner.y) *
               static_cast<std::size_t>(receivers.width) +
           static_cast<std::size_t>(static_cast<int>(film.x) - corner.x);
  };
  for (std::size_t i = 0; i < count; ++i) ++first_[pixel_of(i) + 1];
  for (std::size_t p = 1; p < first_.size(); ++p) first_[p] += first_[p - 1];
  order_.resize(count);
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < count; ++i) order_[next[pixel_of(i)]++] = static_cast<std::uint32_t>(i);
  albedo_.resize(count);
  parallel_for(count, 1 << 12, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      albedo_[i] = receivers.closure[i] == Receivers::kLambertian
                       ? receivers.albedo[i]
                       : scatter::rough_albedo(receivers.closure_at(i), receivers.wo[i]);
  });
}

template <typename Fits>
void ReceiverFinder::gather(Vec2i pixel, int reach, Vec2f film, std::vector<Near>& near, Fits&& fits) const {
  near.clear();
  const int x0 = std::max(0, pixel.x - corner_.x - reach),
            x1 = std::min(receivers_.width - 1, pixel.x - corner_.x + reach);
  for (int y = std::max(0, pixel.y - corner_.y - reach);
       y <= std::min(receivers_.height - 1, pixel.y - corner_.y + reach); ++y)
    for (int x = x0; x <= x1; ++x) {
      const std::size_t p = static_cast<std::size_t>(y) * static_cast<std::size_t>(receivers_.width) +
                            static_cast<std::size_t>(x);
      for (std::uint32_t k = first_[p]; k < first_[p + 1]; ++k) {
        const std::uint32_t i = order_[k];
        // Receivers that were added serve their own pixel, so that a window needs no more than its neighbors.
        if ((reach > 0 && is_added(i)) || !fits(i)) continue;
        float weight = 1;
        if (reach > 0) {
          const Vec2f at = receivers_.film[receivers_.sample[i]];
          const float dx = at.x - film.x, dy = at.y - film.y;
          weight = kHalfWeight / (kHalfWeight + dx * dx + dy * dy);
        }
        near.push_back({i, weight});
      }
    }
}

bool ReceiverFinder::tells(const EyeVertex& vertex, std::span<const Near> near) const {
  if (near.empty()) return false;
  Rgb reflected{0};
  float weights = 0;
  for (const Near& n : near) reflected += albedo_[n.receiver] * n.weight, weights += n.weight;
  for (int c = 0; c < 3; ++c)
    if (vertex.albedo[c] > 0 && !(reflected[c] >= kMinReflected * vertex.albedo[c] * weights)) return false;
  return true;
}

FilmFit ReceiverFinder::find(Vec2i pixel, Vec2f film, const EyeVertex& vertex, float footprint,
                             std::vector<Near>& near) const {
  const auto same = [&](bool far) {
    return [this, &vertex, footprint, far](std::uint32_t i) {
      return same_surface(vertex, footprint, receivers_.surface[i], receivers_.position[i],
                          receivers_.normal[i], receivers_.ng[i], far);
    };
  };
  const auto sort = [&](std::uint32_t i) { return receivers_.surface[i] == vertex.surface; };
  const auto any = [](std::uint32_t) { return true; };
  gather(pixel, 0, film, near, same(false));
  if (tells(vertex, near)) return FilmFit::own_pixel;
  gather(pixel, 1, film, near, same(true));
  if (tells(vertex, near)) return FilmFit::neighbors;
  gather(pixel, 0, film, near, sort);
  if (tells(vertex, near)) return FilmFit::own_pixel_sort;
  gather(pixel, 1, film, near, sort);
  if (tells(vertex, near)) return FilmFit::neighbors_sort;
  gather(pixel, 0, film, near, any);
  if (tells(vertex, near)) return FilmFit::any;
  gather(pixel, 1, film, near, any);
  return near.empty() ? FilmFit::none : FilmFit::any;
}

Rgb ReceiverFinder::light(const EyeVertex& vertex, std::span<const Near> near,
                          std::span<const Rgb> light) const {
  Rgb sum{0}, reflected{0};
  for (const Near& n : near) {
    sum += light[n.receiver] * n.weight;
    reflected += albedo_[n.receiver] * n.weight;
  }
  Rgb leaving{0};
  for (int c = 0; c < 3; ++c)
    if (reflected[c] > 0) leaving[c] = vertex.albedo[c] * (sum[c] / reflected[c]);
  return leaving;
}

}  // namespace lumirank::transport
