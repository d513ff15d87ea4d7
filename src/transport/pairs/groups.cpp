#include "transport/pairs/groups.h"

#include <algorithm>
#include <span>
#include <type_traits>

#include "base/parallel.h"
#include "world/world.h"

namespace lumirank::transport {
namespace {

// Big enough that the runs of a tile are long, small enough that a tile stays in a core's own cache.
constexpr std::uint32_t kRowTile = 2048;
constexpr std::uint32_t kColumnTile = 4096;
constexpr float kNoLimit = 1e9f;
// Tasks that share no tile, and so no group.
constexpr std::size_t kGroupPiece = 1 << 14;
static_assert(kGroupPiece % kRowTile == 0 && kGroupPiece % kColumnTile == 0);

// Lanes that no depth lets shine: padding, and what is black.
template <typename Group>
Group empty_group() {
  Group group{};
  if constexpr (std::is_same_v<Group, RowGroup>) {
    group.depth_max = splat(-kNoLimit);
  } else {
    group.depth = splat(-kNoLimit);
  }
  return group;
}

// All but the groups' lanes.
template <typename Group>
GroupStore<Group> empty_store(std::span<const std::uint16_t> kinds, std::uint32_t tile, bool some_two_sided,
                              bool with_keys) {
  GroupStore<Group> store;
  store.plan = TilePlan::build(kinds, tile);
  store.groups.assign(store.plan.groups(), empty_group<Group>());
  if (some_two_sided) store.two_sided.assign(store.plan.item.size(), 0);
  if (with_keys) store.key.assign(store.plan.item.size(), 0);
  return store;
}

// A surface answers only where wo lies on the same side of both normals (scatter::eval).
bool answers(Vec3f n, Vec3f ng, Vec3f wo) { return dot(n, wo) * dot(ng, wo) > 0; }

Vec3f as_vector(Rgb v) { return {v.r, v.g, v.b}; }

std::uint16_t kind_of_row(const Receivers& receivers, const ScatterForms& forms, std::size_t i) {
  const std::uint32_t closure = receivers.closure[i];
  return closure == Receivers::kLambertian
             ? kRowLambertian
             : static_cast<std::uint16_t>(kRowScatter + forms.of_recipe(receivers.closures.recipe(closure)));
}

// Receiver i into its lane.
void fill_row(const Receivers& receivers, Sides sides, const SceneMatrixSettings& settings, std::size_t i,
              RowGroup& group, int lane) {
  const Vec3f wo = receivers.wo[i];
  const float side = dot(receivers.normal[i], wo) < 0 ? -1.0f : 1.0f;
  const Vec3f ng = receivers.ng[i] * side;
  const Vec3f n = sides == Sides::fiber ? receivers.closure_at(i).frame.s : receivers.normal[i] * side;
  const bool lambertian = receivers.closure[i] == Receivers::kLambertian;
  const bool black = lambertian
                         ? max_component(receivers.albedo[i]) <= 0
                         : receivers.closures.lobes(receivers.closures.recipe(receivers.closure[i])).empty();
  set_lane(group.p, lane, receivers.position[i]);
  set_lane(group.n, lane, n), set_lane(group.ng, lane, ng);
  set_lane(group.origin, lane, world::World::offset_origin(receivers.position[i], ng, n));
  if (lambertian) set_lane(group.f, lane, as_vector(receivers.albedo[i] * kInvPi));
  if (black || (sides != Sides::fiber && !answers(n, ng, wo))) return;
  // Lobes have a roughness of 1 at most: above it, all direct light is traced.
  group.depth_min[lane] = settings.traced_direct_below > 1 ? 1.0f : 0.0f;
  group.depth_max[lane] = settings.max_depth < 0 ? kNoLimit
                                                 : static_cast<float>(settings.max_depth) - 1.0f -
                                                       static_cast<float>(receivers.depth[i]);
}

std::uint16_t kind_of_column(const VirtualLights& lights, const ScatterForms& forms, std::size_t j) {
  switch (lights.kind[j]) {
    case LightKind::omni:
      return kColumnOmni;
    case LightKind::oriented:
      return kColumnFacing;
    case LightKind::directional:
      return kColumnDirectional;
    case LightKind::spot:
      return kColumnSpot;
    case LightKind::surface:
      break;
  }
  if (lights.closure[j] == VirtualLights::kLambertian)
    return lights.spherical() ? kColumnSphere : kColumnFacing;
  return static_cast<std::uint16_t>(kColumnScatter +
                                    forms.of_recipe(lights.closures.recipe(lights.closure[j])));
}

// What kernels know of a light: of surface lights turned to the side that is lit, and black where they send
// nothing.
struct ColumnFields {
  Vec3f n, ng, target;
  Rgb power;
  float clamp_area;
};
ColumnFields surface_fields(const VirtualLights& lights, Sides sides, std::size_t j) {
  ColumnFields c{lights.normal[j], lights.ng[j], {}, lights.power[j], lights.area[j]};
  const Vec3f wo = lights.incoming[j];
  if (dot(c.n, wo) < 0) c.n = -c.n, c.ng = -c.ng;
  c.target = world::World::offset_origin(lights.position[j], c.ng, c.n);
  const bool lambertian = lights.closure[j] == VirtualLights::kLambertian;
  if (sides == Sides::fiber) c.n = lights.closure_at(j).frame.s;
  if ((sides != Sides::fiber && !answers(c.n, c.ng, wo)) ||
      (!lambertian && lights.closures.lobes(lights.closures.recipe(lights.closure[j])).empty()))
    c.power = Rgb(0);
  if (lambertian) {
    c.power *= lights.albedo[j] * kInvPi;
    c.clamp_area *= max_component(lights.albedo[j]);
  }
  if (lights.spherical()) c.power *= 1 / (kPi * lights.radius[j] * lights.radius[j]);
  return c;
}
ColumnFields column_fields(const VirtualLights& lights, Sides sides, std::size_t j) {
  if (lights.kind[j] == LightKind::surface) return surface_fields(lights, sides, j);
  const Vec3f p = lights.position[j], n = lights.normal[j];
  const Vec3f target = lights.kind[j] == LightKind::directional ? -n
                       : lights.kind[j] == LightKind::oriented  ? world::World::offset_origin(p, n, n)
                                                                : p;
  return {n, n, target, lights.power[j], lights.area[j]};
}

// Light j into its lane.
void fill_column(const VirtualLights& lights, Sides sides, std::size_t j, ColumnGroup& group, int lane) {
  const ColumnFields c = column_fields(lights, sides, j);
  set_lane(group.p, lane, lights.position[j]);
  set_lane(group.n, lane, c.n), set_lane(group.ng, lane, c.ng), set_lane(group.target, lane, c.target);
  set_lane(group.power, lane, as_vector(c.power));
  group.clamp_area[lane] = c.clamp_area;
  if (!lights.reach.empty()) group.near[lane] = square(lights.reach[j]);
  if (lights.kind[j] == LightKind::surface && lights.spherical())
    group.radius[lane] = lights.radius[j], group.hidden[lane] = lights.hidden[j];
  if (max_component(c.power) > 0) group.depth[lane] = static_cast<float>(lights.depth[j]);
}

}  // namespace

RowStore make_rows(const Receivers& receivers, const ScatterForms& forms, const SceneMatrixSettings& settings,
                   bool with_keys) {
  const std::size_t count = receivers.size();
  std::vector<std::uint16_t> kinds(count);
  for (std::size_t i = 0; i < count; ++i) kinds[i] = kind_of_row(receivers, forms, i);
  RowStore store = empty_store<RowGroup>(kinds, kRowTile, forms.some_two_sided(), with_keys);
  parallel_for(count, kGroupPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t slot = store.plan.slot[i];
      if (with_keys) store.key[slot] = receivers.key(i);
      const Sides sides = kinds[i] < kRowScatter
                              ? Sides::front
                              : forms[static_cast<std::uint16_t>(kinds[i] - kRowScatter)].sides;
      if (!store.two_sided.empty()) store.two_sided[slot] = sides != Sides::front;
      fill_row(receivers, sides, settings, i, store.groups[slot / 16], static_cast<int>(slot % 16));
    }
  });
  return store;
}

ColumnStore make_columns(const VirtualLights& lights, const ScatterForms& forms, bool with_keys) {
  const std::size_t count = lights.size();
  std::vector<std::uint16_t> kinds(count);
  for (std::size_t j = 0; j < count; ++j) kinds[j] = kind_of_column(lights, forms, j);
  ColumnStore store = empty_store<ColumnGroup>(kinds, kColumnTile, forms.some_two_sided(), with_keys);
  parallel_for(count, kGroupPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      const std::uint32_t slot = store.plan.slot[j];
      if (with_keys) store.key[slot] = lights.key(j);
      const Sides sides = kinds[j] < kColumnScatter
                              ? Sides::front
                              : forms[static_cast<std::uint16_t>(kinds[j] - kColumnScatter)].sides;
      if (!store.two_sided.empty()) store.two_sided[slot] = sides != Sides::front;
      fill_column(lights, sides, j, store.groups[slot / 16], static_cast<int>(slot % 16));
    }
  });
  return store;
}

}  // namespace lumirank::transport
