// The lighting matrix of a scene that moves, over the instants of an open shutter.
#pragma once

#include <memory>
#include <vector>

#include "matrix/block_diagonal.h"
#include "transport/cpu/scene_matrix.h"

namespace lumirank::transport {

// What one instant's matrix is made of; all of it must outlive the whole.
struct InstantParts {
  const world::World& world;
  const Receivers& receivers;
  const VirtualLights& lights;
  std::shared_ptr<const SceneMatrix> matrix;
};

// Worlds must have the same units, matrices the same settings but for their seeds. Bounds are asked of rows
// of several instants at once, as of one set.
class InstantsMatrix final : public matrix::BlockDiagonal {
 public:
  InstantsMatrix(const std::vector<InstantParts>& parts, const SceneMatrixSettings& settings);

  std::unique_ptr<matrix::RowBounds> row_bounds() const override;

 private:
  std::vector<const Receivers*> receivers_;
  SceneMatrixSettings settings_;
};

}  // namespace lumirank::transport
