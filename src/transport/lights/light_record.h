// One virtual light before all are sorted and laid out; see VirtualLights for the fields.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scatter/closure_pool.h"
#include "transport/lights/virtual_lights.h"

namespace lumirank::transport {

struct LightRecord {
  Vec3f position, normal, ng, incoming;
  Rgb power, albedo;
  std::uint64_t id = 0;
  float area = 0;
  std::uint32_t path = VirtualLights::kNoPath;
  std::uint32_t closure = VirtualLights::kLambertian;
  std::uint16_t emitter = 0, depth = 0;
  LightKind kind = LightKind::surface;
  std::uint8_t half = 0;
  // Of particles, for who asks where they landed: not laid out.
  std::uint32_t placement = 0;  // of the surface
  bool behind = false;          // the light came to its inside
};

// What a surface light reflects, roughly: for choices, not for values.
inline float rough_reflectance(const LightRecord& light, bool lambertian) {
  return lambertian ? max_component(light.albedo) : 0.5f;
}
inline float rough_reflectance(const LightRecord& light) {
  return rough_reflectance(light, light.closure == VirtualLights::kLambertian);
}

// Lights in the order in which they were made, with the closures and spot shapes that they index.
struct LightBatch {
  std::vector<LightRecord> lights;
  scatter::ClosurePool closures;
  std::vector<SpotShape> spots;
};

// Joins the batches, sorts by kind, lambertian or not and Morton code (ties: order of making), and lays the
// lights out as arrays. The batches are emptied.
VirtualLights lay_out(std::span<LightBatch> batches);

}  // namespace lumirank::transport
