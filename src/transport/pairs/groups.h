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
  // Position; shading and geometric normal, both on the side of wo. Fibers: n is the tangent, ng zero.
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
  Lane near;        // squared distance within which E is 0
  Lane depth;
  Lane radius, hidden;  // of spherical lights, as in VirtualLights; their power is divided by πr²
};

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

inline Vec3f lane_of(const Lane3& v, int lane) { return {v.x[lane], v.y[lane], v.z[lane]}; }
inline void set_lane(Lane3& v, int lane, Vec3f value) {
  v.x[lane] = value.x, v.y[lane] = value.y, v.z[lane] = value.z;
}

// Groups consist of lanes alone, so that a slot can be copied field by field.
template <typename G>
struct GroupStore {
  using Group = G;
  static constexpr std::size_t kFields = sizeof(Group) / sizeof(Lane);
  static_assert(kFields * sizeof(Lane) == sizeof(Group));

  TilePlan plan;
  std::vector<Group> groups;
  std::vector<std::uint8_t>
      two_sided;  // slot: not Sides::front, so where the ray starts depends on its direction; empty: none

  std::vector<std::uint32_t> key;  // slot: what random numbers belong to; empty where none are needed

  // One field of one slot.
  Vec3f get(std::uint32_t slot, Lane3 Group::*field) const {
    return lane_of(groups[slot / 16].*field, static_cast<int>(slot % 16));
  }

  // 16 copies of one slot.
  void splat(std::uint32_t slot, Group& out) const {
    const float* from = first_field(slot);
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
      const float* from = first_field(slots[lane]);
      for (std::size_t k = 0; k < kFields; ++k) to[16 * k + lane] = from[16 * k];
    }
  }
  std::size_t memory_bytes() const {
    return groups.size() * sizeof(Group) + two_sided.size() +
           (key.size() + plan.item.size() + plan.slot.size() + plan.first_run.size()) * 4 +
           plan.kind.size() * 2 + plan.runs.size() * sizeof(TilePlan::Run);
  }

 private:
  // For what is done to all fields alike: field k of the same slot is 16·k floats on.
  const float* first_field(std::uint32_t slot) const {
    return reinterpret_cast<const float*>(groups.data() + slot / 16) + slot % 16;
  }
};

using RowStore = GroupStore<RowGroup>;
using ColumnStore = GroupStore<ColumnGroup>;

// with_keys: pairs need random numbers, for cut-outs or spherical lights.
RowStore make_rows(const Receivers& receivers, const ScatterForms& forms, const SceneMatrixSettings& settings,
                   bool with_keys);
ColumnStore make_columns(const VirtualLights& lights, const ScatterForms& forms, bool with_keys);

}  // namespace lumirank::transport
