// Receivers and lights as the kernels read them: groups of 16, structure of arrays within a group.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/lanes.h"
#include "transport/lights/virtual_lights.h"
#include "transport/pairs/scatter_forms.h"
#include "transport/pairs/scene_matrix_settings.h"
#include "transport/pairs/tile_plan.h"
#include "transport/rows/receivers.h"

namespace lumirank::transport {

struct RowGroup {
  // Position; shading and geometric normal, both on the side of wo. Fibres: n is the tangent, ng zero.
  Lane3 p, n, ng;
  Lane3 origin;               // where shadow rays start
  Lane3 f;                    // lambertian receivers: albedo/π
  Lane depth_min, depth_max;  // light depths that may shine here
};

struct ColumnGroup {
  Lane3 p, n, ng;   // as in RowGroup
  Lane3 target;     // where shadow rays end; directional: the direction towards the light
  Lane3 power;      // oriented, omni, spot, directional: as in VirtualLights; lambertian surface:
                    // Φ·albedo/π; other surface lights: Φ
  Lane clamp_area;  // a_j, times max(π·f_y) where f_y is constant
  Lane depth;
  Lane radius, hidden;  // of spherical lights, as in VirtualLights; their power is divided by πr²
};

// Where fields that are read one by one begin, in floats.
inline constexpr int kPositionField = 0, kGeometricNormalField = 6 * 16, kOriginField = 9 * 16,
                     kTargetField = 9 * 16;
static_assert(offsetof(RowGroup, ng) == kGeometricNormalField * sizeof(float) &&
              offsetof(ColumnGroup, ng) == kGeometricNormalField * sizeof(float) &&
              offsetof(RowGroup, origin) == kOriginField * sizeof(float) &&
              offsetof(ColumnGroup, target) == kTargetField * sizeof(float));

// Classes of receivers; from kRowScatter on, one for each form of scattering.
inline constexpr std::uint16_t kRowLambertian = 0, kRowScatter = 1;

// Classes of lights; from kColumnScatter on, one for each form of scattering.
enum ColumnKind : std::uint16_t {
  kColumnOmni,
  kColumnFacing,
  kColumnDirectional,
  kColumnSpot,
  kColumnSphere,  // lambertian surface, spherical
  kColumnScatter,
  // For kernels only: a form of scattering where surface lights are spherical.
  kColumnScatterSphere = 0xffff
};
constexpr bool scatters(ColumnKind kind) { return kind == kColumnScatter || kind == kColumnScatterSphere; }
constexpr bool is_sphere(ColumnKind kind) { return kind == kColumnSphere || kind == kColumnScatterSphere; }

template <typename Group>
struct GroupStore {
  static constexpr std::size_t kFields = sizeof(Group) / sizeof(Lane);

  TilePlan plan;
  std::vector<Group> groups;
  std::vector<std::uint8_t>
      two_sided;  // slot: not Sides::front, so where the ray starts depends on its direction; empty: none

  std::vector<std::uint32_t> key;  // slot: what random numbers belong to; empty where none are needed

  // The first field of a slot; field k of the same slot is 16·k floats on.
  const float* at(std::uint32_t slot) const {
    return reinterpret_cast<const float*>(groups.data() + (slot >> 4)) + (slot & 15);
  }
  float* at(std::uint32_t slot) { return const_cast<float*>(static_cast<const GroupStore*>(this)->at(slot)); }

  // 16 copies of one slot.
  void splat(std::uint32_t slot, Group& out) const {
    const float* from = at(slot);
    float* to = reinterpret_cast<float*>(&out);
    for (std::size_t k = 0; k < kFields; ++k) store(to + 16 * k, lumirank::splat(from[16 * k]));
  }
  // 16 slots from anywhere.
  void gather(const std::uint32_t slots[16], Group& out) const {
    bool same = true;
    for (int lane = 1; lane < 16; ++lane) same &= slots[lane] == slots[0];
    if (same) return splat(slots[0], out);
    float* to = reinterpret_cast<float*>(&out);
    for (int lane = 0; lane < 16; ++lane) {
      const float* from = at(slots[lane]);
      for (std::size_t k = 0; k < kFields; ++k) to[16 * k + lane] = from[16 * k];
    }
  }
  std::size_t memory_bytes() const {
    return groups.size() * sizeof(Group) + two_sided.size() +
           (key.size() + plan.item.size() + plan.slot.size() + plan.first_run.size()) * 4 +
           plan.kind.size() * 2 + plan.runs.size() * sizeof(TilePlan::Run);
  }
};

using RowStore = GroupStore<RowGroup>;
using ColumnStore = GroupStore<ColumnGroup>;

// with_keys: pairs need random numbers, for cut-outs or spherical lights.
RowStore make_rows(const Receivers& receivers, const ScatterForms& forms, const SceneMatrixSettings& settings,
                   bool with_keys);
ColumnStore make_columns(const VirtualLights& lights, const ScatterForms& forms, bool with_keys);

inline Vec3f read3(const float* p) { return {p[0], p[16], p[32]}; }
inline void write3(float* p, Vec3f v) { p[0] = v.x, p[16] = v.y, p[32] = v.z; }

}  // namespace lumirank::transport
