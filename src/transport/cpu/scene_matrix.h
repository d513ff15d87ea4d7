// The lighting matrix of a world: receivers × virtual lights on the CPU.
#pragma once

#include <memory>

#include "matrix/entry_reader.h"
#include "matrix/lighting_matrix.h"
#include "transport/lights/virtual_lights.h"
#include "transport/pairs/scene_matrix_settings.h"
#include "transport/rows/receivers.h"
#include "world/world.h"

namespace lumirank::transport {

// Holds references: world, receivers and lights must outlive it.
class SceneMatrix final : public matrix::LightingMatrix {
 public:
  SceneMatrix(const world::World& world, const Receivers& receivers, const VirtualLights& lights,
              const SceneMatrixSettings& settings);
  ~SceneMatrix() override;

  // Of every world: cut-outs are decided by a hash of the pair, and what thin glass lets pass is part of E,
  // so that V is 0 or 1.
  static constexpr matrix::Capabilities kCapabilities = matrix::Capabilities::all();

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
  std::unique_ptr<matrix::EntryReader> reader() const override;
  matrix::Capabilities capabilities() const override { return kCapabilities; }
  matrix::ColumnSet column_set(matrix::Index j) const override;
  std::unique_ptr<matrix::RowBounds> row_bounds() const override;
  matrix::RowFeatures row_features() const override;
  matrix::ColumnFeatures column_features() const override;

  // Of the matrix itself, without the receivers and lights that it is made of.
  std::size_t memory_bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lumirank::transport
