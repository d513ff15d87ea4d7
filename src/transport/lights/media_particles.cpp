#include "transport/lights/media_particles.h"

#include <numeric>

#include "base/bounds.h"
#include "base/morton.h"

namespace lumirank::transport {

std::size_t lights_in(std::span<const MediaBatch> batches) {
  std::size_t count = 0;
  for (const MediaBatch& batch : batches) count += batch.points.lights.size() + batch.rays.size();
  return count;
}

// Along a Morton curve by their middles, so that neighbors are alike.
RayLights lay_out_rays(std::span<const MediaBatch> batches) {
  std::vector<RayRecord> all;
  for (const MediaBatch& batch : batches) all.insert(all.end(), batch.rays.begin(), batch.rays.end());
  Bounds3f box;
  const auto middle = [](const RayRecord& r) { return r.origin + r.direction * (0.5f * r.length); };
  for (const RayRecord& r : all) box.extend(middle(r));
  const auto code = [&](Vec3f p) {
    std::uint32_t cell[3];
    for (int axis = 0; axis < 3; ++axis) {
      const float size = box.hi[axis] - box.lo[axis];
      cell[axis] = size > 0 ? static_cast<std::uint32_t>((p[axis] - box.lo[axis]) / size * 2097151.0f) : 0;
    }
    return morton3(cell[0], cell[1], cell[2]);
  };
  std::vector<std::uint64_t> codes(all.size());
  for (std::size_t k = 0; k < all.size(); ++k) codes[k] = code(middle(all[k]));
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return codes[a] < codes[b]; });
  RayLights out;
  for (const std::size_t k : order) {
    const RayRecord& r = all[k];
    out.origin.push_back(r.origin), out.direction.push_back(r.direction), out.length.push_back(r.length);
    out.medium.push_back(r.medium), out.power.push_back(r.power), out.emitter.push_back(r.emitter);
    out.depth.push_back(r.depth), out.path.push_back(r.path), out.half.push_back(r.half),
        out.id.push_back(r.id);
  }
  return out;
}

// As MediaLightSettings::least_direct says. What shines from infinitely far is taken to light a disc of the
// scene's size.
void repeat_emitters(std::vector<LightRecord>& lights, std::size_t least, float radius) {
  const auto sent = [&](const LightRecord& light) {
    const float area = light.kind == LightKind::directional ? kPi * radius * radius : 4 * kPi;
    return static_cast<double>(area * mean(light.power));
  };
  double all = 0;
  for (const LightRecord& light : lights) all += sent(light);
  if (!(all > 0)) return;
  const std::size_t own = lights.size();
  for (std::size_t j = 0; j < own; ++j) {
    const double parts = static_cast<double>(least) * sent(lights[j]) / all;
    const auto copies = static_cast<std::size_t>(std::max(1.0, std::ceil(parts)));
    lights[j].power *= 1 / static_cast<float>(copies);
    for (std::size_t copy = 1; copy < copies; ++copy) {
      lights.push_back(lights[j]);
      lights.back().id = mix64(lights[j].id + copy);
    }
  }
}

}  // namespace lumirank::transport
