#include <algorithm>
#include <cmath>

#include "base/bounds.h"
#include "base/error.h"
#include "base/morton.h"
#include "base/parallel.h"
#include "transport/lights/light_record.h"

namespace lumirank::transport {
namespace {

constexpr std::size_t kGrain = 1 << 14;

struct Place {
  std::uint64_t key;
  std::uint32_t batch, index;  // in the order of making
};

// 20 bits per axis of a cube; the upper four bits of the 64 tell the sort of light.
std::uint64_t code(Vec3f p, Vec3f lo, float side) {
  const float scale = side > 0 ? 1048575.0f / side : 0.0f;
  const auto cell = [&](float x) {
    return static_cast<std::uint32_t>(std::clamp(x * scale, 0.0f, 1048575.0f));
  };
  const Vec3f q = p - lo;
  return morton3(cell(q.x), cell(q.y), cell(q.z));
}

std::uint64_t sort_key(const LightRecord& light, Vec3f lo, float side) {
  const auto kind = static_cast<std::uint64_t>(light.kind);
  const std::uint64_t glossy =
      light.kind == LightKind::surface && light.closure != VirtualLights::kLambertian ? 1 : 0;
  const std::uint64_t where = light.kind == LightKind::directional ? code(light.normal, Vec3f{-1, -1, -1}, 2)
                                                                   : code(light.position, lo, side);
  return (kind << 1 | glossy) << 60 | where;
}

std::vector<Place> sorted_places(std::span<const LightBatch> batches, std::span<const std::size_t> first) {
  Bounds3f box;
  for (const LightBatch& batch : batches)
    for (const LightRecord& light : batch.lights)
      if (light.kind != LightKind::directional) box.extend(light.position);
  const Vec3f size = box.empty() ? Vec3f{} : box.diagonal();
  const float side = std::max(size.x, std::max(size.y, size.z));
  std::vector<Place> places(first.back());
  parallel_for(batches.size(), 1, [&](std::size_t b, std::size_t) {
    for (std::size_t k = 0; k < batches[b].lights.size(); ++k)
      places[first[b] + k] = {sort_key(batches[b].lights[k], box.lo, side), static_cast<std::uint32_t>(b),
                              static_cast<std::uint32_t>(k)};
  });
  parallel_sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    if (a.key != b.key) return a.key < b.key;
    return a.batch != b.batch ? a.batch < b.batch : a.index < b.index;
  });
  return places;
}

void resize(VirtualLights& lights, std::size_t n) {
  lights.kind.resize(n), lights.position.resize(n), lights.normal.resize(n), lights.ng.resize(n);
  lights.power.resize(n), lights.area.resize(n), lights.emitter.resize(n), lights.depth.resize(n);
  lights.closure.resize(n), lights.albedo.resize(n), lights.incoming.resize(n), lights.half.resize(n);
  lights.path.resize(n), lights.id.resize(n);
}

}  // namespace

VirtualLights lay_out(std::span<LightBatch> batches) {
  VirtualLights out;
  std::vector<std::size_t> first(batches.size() + 1, 0);
  std::vector<std::uint32_t> first_closure(batches.size()), first_spot(batches.size());
  for (std::size_t b = 0; b < batches.size(); ++b) {
    first[b + 1] = first[b] + batches[b].lights.size();
    first_closure[b] = out.closures.append(batches[b].closures);
    batches[b].closures = {};
    first_spot[b] = static_cast<std::uint32_t>(out.spots.size());
    out.spots.insert(out.spots.end(), batches[b].spots.begin(), batches[b].spots.end());
  }
  const std::size_t n = first.back();
  if (n >= 0xffffffffull)
    throw InputError("there would be " + std::to_string(n) + " virtual lights; at most 2^32 - 1 are possible",
                     "ask for fewer lights");
  const std::vector<Place> places = sorted_places(batches, first);
  resize(out, n);
  parallel_for(n, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      const std::uint32_t batch = places[j].batch;
      const LightRecord& light = batches[batch].lights[places[j].index];
      out.kind[j] = light.kind;
      out.position[j] = light.position, out.normal[j] = light.normal, out.ng[j] = light.ng;
      out.power[j] = light.power, out.area[j] = light.area, out.emitter[j] = light.emitter,
      out.depth[j] = light.depth, out.half[j] = light.half;
      out.albedo[j] = light.albedo, out.incoming[j] = light.incoming;
      out.path[j] = light.path, out.id[j] = light.id;
      out.closure[j] = light.closure;
      if (light.kind == LightKind::spot) {
        out.closure[j] += first_spot[batch];
      } else if (light.closure != VirtualLights::kLambertian) {
        out.closure[j] += first_closure[batch];
      }
    }
  });
  for (LightBatch& batch : batches) batch = {};
  // Closures follow the order of their lights, so that a run of lights reads a run of closures.
  std::vector<std::uint32_t> order;
  for (std::size_t j = 0; j < n; ++j) {
    if (out.kind[j] != LightKind::surface || out.closure[j] == VirtualLights::kLambertian) continue;
    order.push_back(out.closure[j]);
    out.closure[j] = static_cast<std::uint32_t>(order.size() - 1);
  }
  out.closures.reorder(order);
  out.closures.shrink();
  out.spots.shrink_to_fit();
  return out;
}

}  // namespace lumirank::transport
