#include "transport/cpu/instants_matrix.h"

#include "transport/pairs/row_bounds.h"

namespace lumirank::transport {

namespace {
std::vector<std::shared_ptr<const matrix::LightingMatrix>> blocks_of(const std::vector<InstantParts>& parts) {
  std::vector<std::shared_ptr<const matrix::LightingMatrix>> blocks;
  blocks.reserve(parts.size());
  for (const InstantParts& part : parts) blocks.push_back(part.matrix);
  return blocks;
}
}  // namespace

InstantsMatrix::InstantsMatrix(const std::vector<InstantParts>& parts, const SceneMatrixSettings& settings)
    : BlockDiagonal(blocks_of(parts)), settings_(settings) {
  const float radius = parts.front().world.bounds().radius();
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const InstantParts& part = parts[k];
    receivers_.push_back(&part.receivers);
    // The power of directional light is counted over the scene's disc, which differs from moment to moment.
    const float factor = square(radius / part.world.bounds().radius());
    for (std::size_t j = 0; j < part.lights.size(); ++j)
      if (part.lights.kind[j] == LightKind::directional) scale_power(first_column(k) + j, factor);
  }
}

std::unique_ptr<matrix::RowBounds> InstantsMatrix::row_bounds() const {
  return std::make_unique<SceneRowBounds>(receivers_,
                                          BoundRules{settings_.spheres, settings_.traced_direct_below});
}

}  // namespace lumirank::transport
