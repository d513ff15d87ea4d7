// Implementation of SceneMatrix; internal to its source files.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "transport/cpu/pair_block.h"
#include "transport/cpu/scene_matrix.h"
#include "transport/lights/light_peaks.h"

namespace lumirank::transport {

struct SceneMatrix::Impl {
  Impl(const world::World& world, const Receivers& receivers, const VirtualLights& lights,
       const SceneMatrixSettings& settings);

  const world::World& world;
  const Receivers& receivers;
  const VirtualLights& lights;
  SceneMatrixSettings settings;
  ScatterForms row_forms, column_forms;
  std::vector<LobeCone> row_cones, column_cones;  // where lights are spherical
  RowStore rows;
  ColumnStore columns;
  PairContext context;
  std::vector<Vec2f> row_pixel;
  std::vector<float> row_weight, column_power;
  std::vector<Rgb> row_albedo;  // if asked for
  std::vector<std::uint16_t> column_group;
  std::vector<std::uint8_t> column_indirect;
  std::vector<Rgb> column_emitted;
  std::vector<LightPeak> peaks;  // by closure of the lights

  // Work space of one task at a time; kept for the next one.
  class Lease {
   public:
    explicit Lease(const Impl& impl);
    ~Lease();
    PairBlock* operator->() { return block_.get(); }
    PairBlock& operator*() { return *block_; }

   private:
    const Impl& impl_;
    std::unique_ptr<PairBlock> block_;
  };

  mutable std::mutex mutex;
  mutable std::vector<std::unique_ptr<PairBlock>> spare_blocks;
};

}  // namespace lumirank::transport
