// The lighting matrix of a world with participating media, on the CPU: receivers and eye segments × points
// and rays (Huo et al. 2016, equations 3 to 6).
//
// Rows: first the receivers, then their segments. Columns: first the points, then the rays. An entry with a
// ray or a segment in it is an integral along it; it is estimated without bias by one place on each
// (ray_sampling.h), drawn by numbers that belong to the pair or to its column, so that it is the same
// wherever it is asked for. E holds what media and panes let pass, V is 0 or 1.
#pragma once

#include <memory>

#include "matrix/lighting_matrix.h"
#include "transport/lights/ray_lights.h"
#include "transport/pairs/scene_matrix_settings.h"
#include "transport/rows/receivers.h"
#include "world/world.h"

namespace lumirank::transport {

struct MediaMatrixSettings {
  SceneMatrixSettings scene;
  bool shared_places = false;  // as in MediaPairs::Settings
};

// Holds references: world, receivers and lights must outlive it.
class MediaMatrix final : public matrix::LightingMatrix {
 public:
  MediaMatrix(const world::World& world, const Receivers& receivers, const LightsInMedia& lights,
              const MediaMatrixSettings& settings);
  ~MediaMatrix() override;

  std::size_t rows() const override;
  std::size_t columns() const override;
  matrix::Cost row(matrix::Index i, std::span<Rgb> out, matrix::Part part) const override;
  matrix::Cost column(matrix::Index j, std::span<Rgb> out, matrix::Part part) const override;
  matrix::Cost block(std::span<const matrix::Index> rows, std::span<const matrix::Index> columns,
                     std::span<Rgb> out, matrix::Part part) const override;
  matrix::Cost entries(std::span<const matrix::Index> rows, std::span<const matrix::Index> columns,
                       std::span<Rgb> out, matrix::Part part) const override;
  matrix::Cost accumulate(std::span<const matrix::ScaledColumn> columns, std::span<Rgb> sums,
                          const Sinks& sinks) const override;
  static constexpr matrix::Capabilities kCapabilities = matrix::Capabilities::all();
  matrix::Capabilities capabilities() const override { return kCapabilities; }
  matrix::RowFeatures row_features() const override;
  matrix::ColumnFeatures column_features() const override;
  // Of rays and segments bounds are those of the integrals (media_row_bounds.h).
  matrix::ColumnSet column_set(matrix::Index j) const override;
  std::unique_ptr<matrix::RowBounds> row_bounds() const override;
  std::size_t memory_bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lumirank::transport
