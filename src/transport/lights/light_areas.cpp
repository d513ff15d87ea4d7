#include "transport/lights/light_areas.h"

#include "base/neighbor_distance.h"

namespace lumirank::transport {

void measure_areas(VirtualLights& lights, float scene_radius) {
  std::vector<std::size_t> which[2];
  std::vector<Vec3f> points[2];
  std::vector<std::uint32_t> paths[2];
  for (std::size_t j = 0; j < lights.size(); ++j) {
    if (lights.kind[j] != LightKind::surface) continue;
    const std::size_t h = lights.half[j] == 2 ? 1 : 0;
    which[h].push_back(j);
    points[h].push_back(lights.position[j]);
    paths[h].push_back(lights.path[j]);
  }
  const auto all = static_cast<float>(which[0].size() + which[1].size());
  for (std::size_t h = 0; h < 2; ++h) {
    const float share = static_cast<float>(which[h].size()) / all;
    const std::vector<Neighbor> found = neighbors(points[h], paths[h], kAreaNeighbor);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Neighbor& n = found[i];
      const float disc =
          n.count > 0 ? n.distance_squared / static_cast<float>(n.count) : square(scene_radius);
      lights.area[which[h][i]] = kPi * disc * share;
    }
  }
}

}  // namespace lumirank::transport
