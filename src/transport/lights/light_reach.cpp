#include "transport/lights/light_reach.h"

#include <algorithm>
#include <cmath>

#include "transport/lights/light_areas.h"
#include "transport/lights/sphere_lights.h"

namespace lumirank::transport {
namespace {

// Of all lights nine of ten reach less than half of the most.
constexpr double kOrdinary = 0.9;
constexpr float kMaxOverOrdinary = 2;

float reach_of(float area, float held) { return std::sqrt(area * held * kInvPi); }

}  // namespace

std::size_t LightReach::plant(const VirtualLights& lights, bool one_half, int neighbor) {
  std::vector<Vec3f> centers;
  for (std::size_t j = 0; j < lights.size(); ++j)
    if (lights.kind[j] == LightKind::surface && !(one_half && lights.half[j] == 2))
      centers.push_back(lights.position[j]);
  if (centers.empty()) return 0;
  tree_.emplace(centers);
  neighbor_ = std::min(neighbor, static_cast<int>(centers.size()));
  return centers.size();
}

LightReach::LightReach(const VirtualLights& lights, const world::World& world, float scale, float radii)
    : scale_(scale), radii_(radii), extent_(world.bounds().radius()) {
  plant(lights, false, kSphereNeighbor);
}

// Areas are measured in halves, of which either is like the other.
LightReach::LightReach(const VirtualLights& lights, float held, float max_reach)
    : points_(true), max_reach_(max_reach) {
  const std::size_t half = plant(lights, true, kAreaNeighbor);
  if (half == 0) return;
  const auto both =
      static_cast<float>(std::count(lights.kind.begin(), lights.kind.end(), LightKind::surface));
  const float share = static_cast<float>(half) / both;
  scale_ = reach_of(kPi / static_cast<float>(neighbor_) * share, held);
}

float LightReach::at(Vec3f place) const {
  if (!tree_) return 0;
  const float squared = tree_->kth_distance_squared(place, neighbor_);
  if (points_) return std::min(max_reach_, scale_ * std::sqrt(squared));
  return radii_ * sphere_radius(squared, scale_, extent_);
}

float give_reach(VirtualLights& lights, float held) {
  std::vector<float> of_surfaces;
  lights.reach.assign(lights.size(), 0);
  for (std::size_t j = 0; j < lights.size(); ++j) {
    if (lights.kind[j] != LightKind::surface) continue;
    lights.reach[j] = reach_of(lights.area[j], held);
    of_surfaces.push_back(lights.reach[j]);
  }
  if (of_surfaces.empty()) return 0;
  const auto ordinary =
      of_surfaces.begin() + static_cast<std::ptrdiff_t>(kOrdinary * static_cast<double>(of_surfaces.size()));
  std::nth_element(of_surfaces.begin(), ordinary, of_surfaces.end());
  const float max_reach = kMaxOverOrdinary * *ordinary;
  for (float& reach : lights.reach) reach = std::min(reach, max_reach);
  return max_reach;
}

}  // namespace lumirank::transport
