#include "transport/lights/light_reach.h"

#include <algorithm>

#include "transport/lights/sphere_lights.h"

namespace lumirank::transport {

LightReach::LightReach(const VirtualLights& lights, const world::World& world, float scale, float radii)
    : scale_(scale), radii_(radii), extent_(world.bounds().radius()) {
  std::vector<Vec3f> centers;
  for (std::size_t j = 0; j < lights.size(); ++j)
    if (lights.kind[j] == LightKind::surface) centers.push_back(lights.position[j]);
  if (centers.empty()) return;
  tree_.emplace(centers);
  neighbor_ = std::min(kSphereNeighbor, static_cast<int>(centers.size()));
}

float LightReach::at(Vec3f place) const {
  if (!tree_) return 0;
  return radii_ * sphere_radius(tree_->kth_distance_squared(place, neighbor_), scale_, extent_);
}

}  // namespace lumirank::transport
