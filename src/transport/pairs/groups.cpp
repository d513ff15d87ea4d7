#include "transport/pairs/groups.h"

#include <algorithm>
#include <array>
#include <type_traits>

#include "base/parallel.h"
#include "world/world.h"

namespace lumirank::transport {
namespace {

// Big enough that the runs of a tile are long, small enough that a tile stays in a core's own cache.
constexpr std::uint32_t kRowTile = 2048;
constexpr std::uint32_t kColumnTile = 4096;
constexpr float kNoLimit = 1e9f;

// Lanes that no depth lets shine: padding, and what is black.
template <typename Group>
Group empty_group() {
  Group group;
  float* all = reinterpret_cast<float*>(&group);
  std::fill(all, all + sizeof(Group) / sizeof(float), 0.0f);
  if constexpr (std::is_same_v<Group, RowGroup>) {
    group.depth_max = splat(-kNoLimit);
  } else {
    group.depth = splat(-kNoLimit);
  }
  return group;
}

// A surface answers only where wo lies on the same side of both normals (scatter::eval).
bool answers(Vec3f n, Vec3f ng, Vec3f wo) { return dot(n, wo) * dot(ng, wo) > 0; }

}  // namespace

RowStore make_rows(const Receivers& receivers, const ScatterForms& forms, const SceneMatrixSettings& settings,
                   bool with_keys) {
  RowStore store;
  const std::size_t count = receivers.size();
  std::vector<std::uint16_t> kinds(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t closure = receivers.closure[i];
    kinds[i] =
        closure == Receivers::kLambertian
            ? kRowLambertian
            : static_cast<std::uint16_t>(kRowScatter + forms.of_recipe(receivers.closures.recipe(closure)));
  }
  const bool some_two_sided = forms.some_two_sided();
  store.plan = TilePlan::build(kinds, kRowTile);
  store.groups.assign(store.plan.groups(), empty_group<RowGroup>());
  if (some_two_sided) store.two_sided.assign(store.plan.item.size(), 0);
  if (with_keys) store.key.assign(store.plan.item.size(), 0);

  parallel_for(count, 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t slot = store.plan.slot[i];
      if (with_keys) store.key[slot] = receivers.key(i);
      float* to = store.at(slot);
      const Vec3f wo = receivers.wo[i];
      const float side = dot(receivers.normal[i], wo) < 0 ? -1.0f : 1.0f;
      Vec3f n = receivers.normal[i] * side, ng = receivers.ng[i] * side;
      const bool lambertian = kinds[i] == kRowLambertian;
      const Sides sides =
          lambertian ? Sides::front : forms[static_cast<std::uint16_t>(kinds[i] - kRowScatter)].sides;
      if (sides == Sides::fibre) n = receivers.closure_at(i).frame.s;
      const bool black =
          lambertian ? max_component(receivers.albedo[i]) <= 0
                     : receivers.closures.lobes(receivers.closures.recipe(receivers.closure[i])).empty();
      write3(to, receivers.position[i]), write3(to + 3 * 16, n), write3(to + 6 * 16, ng);
      write3(to + 9 * 16, world::World::offset_origin(receivers.position[i], ng, n));
      if (lambertian) {
        const Rgb f = receivers.albedo[i] * kInvPi;
        write3(to + 12 * 16, {f.r, f.g, f.b});
      } else if (some_two_sided) {
        store.two_sided[slot] = sides != Sides::front;
      }
      if (black || (sides != Sides::fibre && !answers(n, ng, wo))) continue;
      // Lobes have a roughness of 1 at most: above it, all direct light is traced.
      const bool direct_elsewhere = settings.traced_direct_below > 1;
      to[15 * 16] = direct_elsewhere ? 1.0f : 0.0f;
      to[16 * 16] = settings.max_depth < 0 ? kNoLimit
                                           : static_cast<float>(settings.max_depth) - 1.0f -
                                                 static_cast<float>(receivers.depth[i]);
    }
  });
  return store;
}

ColumnStore make_columns(const VirtualLights& lights, const ScatterForms& forms, bool with_keys) {
  ColumnStore store;
  const std::size_t count = lights.size();
  std::vector<std::uint16_t> kinds(count);
  const bool some_two_sided = forms.some_two_sided();
  for (std::size_t j = 0; j < count; ++j) {
    switch (lights.kind[j]) {
      case LightKind::omni:
        kinds[j] = kColumnOmni;
        break;
      case LightKind::oriented:
        kinds[j] = kColumnFacing;
        break;
      case LightKind::directional:
        kinds[j] = kColumnDirectional;
        break;
      case LightKind::spot:
        kinds[j] = kColumnSpot;
        break;
      case LightKind::surface:
        kinds[j] = lights.spherical() ? kColumnSphere : kColumnFacing;
        if (lights.closure[j] != VirtualLights::kLambertian)
          kinds[j] = static_cast<std::uint16_t>(kColumnScatter +
                                                forms.of_recipe(lights.closures.recipe(lights.closure[j])));
        break;
    }
  }
  store.plan = TilePlan::build(kinds, kColumnTile);
  store.groups.assign(store.plan.groups(), empty_group<ColumnGroup>());
  if (some_two_sided) store.two_sided.assign(store.plan.item.size(), 0);
  if (with_keys) store.key.assign(store.plan.item.size(), 0);

  parallel_for(count, 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      const std::uint32_t slot = store.plan.slot[j];
      if (with_keys) store.key[slot] = static_cast<std::uint32_t>(j);
      float* to = store.at(slot);
      const LightKind kind = lights.kind[j];
      const Vec3f p = lights.position[j];
      Vec3f n = lights.normal[j], ng = kind == LightKind::surface ? lights.ng[j] : n;
      Vec3f target = p;
      Rgb power = lights.power[j];
      float area = lights.area[j];
      if (kind == LightKind::directional) {
        target = -n;
      } else if (kind == LightKind::oriented) {
        target = world::World::offset_origin(p, n, n);
      } else if (kind == LightKind::surface) {
        const Vec3f wo = lights.incoming[j];
        if (dot(n, wo) < 0) n = -n, ng = -ng;
        target = world::World::offset_origin(p, ng, n);
        const bool lambertian = lights.closure[j] == VirtualLights::kLambertian;
        const Sides sides =
            lambertian ? Sides::front : forms[static_cast<std::uint16_t>(kinds[j] - kColumnScatter)].sides;
        if (sides == Sides::fibre) n = lights.closure_at(j).frame.s;
        if ((sides != Sides::fibre && !answers(n, ng, wo)) ||
            (!lambertian && lights.closures.lobes(lights.closures.recipe(lights.closure[j])).empty()))
          power = Rgb(0);
        if (lambertian) {
          power *= lights.albedo[j] * kInvPi;
          area *= max_component(lights.albedo[j]);
        } else if (some_two_sided) {
          store.two_sided[slot] = sides != Sides::front;
        }
      }
      if (kind == LightKind::surface && lights.spherical()) {
        const float radius = lights.radius[j];
        power *= 1 / (kPi * radius * radius);
        to[17 * 16] = radius, to[18 * 16] = lights.hidden[j];
      }
      write3(to, p), write3(to + 3 * 16, n), write3(to + 6 * 16, ng), write3(to + 9 * 16, target);
      write3(to + 12 * 16, {power.r, power.g, power.b});
      to[15 * 16] = area;
      if (max_component(power) > 0) to[16 * 16] = static_cast<float>(lights.depth[j]);
    }
  });
  return store;
}

}  // namespace lumirank::transport
