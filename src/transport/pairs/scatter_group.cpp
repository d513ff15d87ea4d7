#include "transport/pairs/scatter_group.h"

#include <algorithm>
#include <cmath>

#include "transport/pairs/lobe_lanes.h"
#include "transport/pairs/tile_plan.h"

namespace lumirank::transport {
namespace {

constexpr std::size_t kChunk = 256;

void put(Lane3& to, int lane, Vec3f v) { to.x[lane] = v.x, to.y[lane] = v.y, to.z[lane] = v.z; }
void put(Lane3& to, int lane, Rgb c) { to.x[lane] = c.r, to.y[lane] = c.g, to.z[lane] = c.b; }

void read(CoatLanes& lanes, int lane, const scatter::Coat& coat) {
  lanes.eta[lane] = coat.eta, lanes.bend[lane] = coat.bend;
  for (int i = 0; i < 6; ++i) lanes.t[i][lane] = coat.t[i];
  put(lanes.depth, lane, coat.depth);
  lanes.trapped[lane] = coat.trapped, lanes.width[lane] = coat.width;
  lanes.critical[lane] = std::sqrt(std::max(0.0f, 1 - 1 / (coat.bend * coat.bend)));
}

void put(LobeCones& cones, int lane, const LobeCone& cone, Vec3f wo, Vec3f n) {
  put(cones.axis, lane, n * (2 * dot(n, wo)) - wo);
  cones.per_solid_angle[lane] = cone.per_solid_angle;
  cones.cos_reach[lane] = cone.cos_reach, cones.sin_reach[lane] = cone.sin_reach;
  cones.alpha_u[lane] = cone.alpha_u, cones.alpha_v[lane] = cone.alpha_v;
}

// Reads the plain parameters of one closure into a lane.
void read(ScatterGroup& group, LobeLanes* lobes, CoatLanes* coats, int lane, const ScatterSide& side,
          std::uint32_t item) {
  const std::uint32_t closure = (*side.closure)[item];
  // The frame as scatter::ClosurePool::get() makes it, then mirrored to wo's side.
  const float outward = side.pool->side(closure);
  const Vec3f wo = (*side.wo)[item], n = (*side.normal)[item] * outward, ng = (*side.ng)[item] * outward;
  const bool outside = dot(n, wo) > 0;
  const float turn = outside ? 1.0f : -1.0f;
  put(group.wo, lane, wo);
  put(group.n, lane, n * turn);
  put(group.ng, lane, ng * turn);
  if (group.form->anisotropic) {
    const Frame frame = Frame::from_normal_tangent(n, side.pool->tangent(closure));
    put(group.s, lane, frame.s);
    put(group.t, lane, frame.t);
  }
  const std::uint32_t recipe = side.pool->recipe(closure);
  const auto shared = side.pool->lobes(recipe);
  const auto colors = side.pool->colors(closure);
  if (side.cones) put(group.cones, lane, (*side.cones)[recipe], wo, n * turn);
  for (std::size_t k = 0; k < shared.size(); ++k) {
    const scatter::Lobe& lobe = shared[k];
    put(lobes[k].color, lane, colors[k]);
    lobes[k].alpha_u[lane] = lobe.alpha_u, lobes[k].alpha_v[lane] = lobe.alpha_v;
    const scatter::LaneForm form = group.form->lobes[k].lanes;
    const bool inverse = form == scatter::LaneForm::microfacet_reflect && !outside;
    lobes[k].eta[lane] = inverse ? 1 / lobe.eta : lobe.eta;
    put(lobes[k].a, lane, lobe.conductor_eta);
    put(lobes[k].b, lane, lobe.conductor_k);
    if (form == scatter::LaneForm::disney_diffuse) lobes[k].b.x[lane] = lobe.extra;
    if (lobe.coat) read(coats[k], lane, lobe.coat);
    const bool traced = scatter::lobe_roughness(lobe) < side.traced_below;
    lobes[k].traced[lane] = traced ? -1 : 0;
    group.some_traced = group.some_traced || traced;
  }
}

template <typename T>
void spread(T& lanes, std::size_t fields) {
  float* all = reinterpret_cast<float*>(&lanes);
  for (std::size_t k = 0; k < fields; ++k) store(all + 16 * k, splat(all[16 * k]));
}

}  // namespace

void ScatterArena::clear() {
  closures_.clear();
  coats_.clear();
  chunk_ = used_ = 0;
}

CoatLanes* ScatterArena::new_coats(const ScatterForm& form) {
  return form.coated ? coats_.emplace_back(form.lobes.size()).data() : nullptr;
}

LobeLanes* ScatterArena::new_lobes(std::size_t count) {
  if (!chunks_.empty() && used_ + count > kChunk) ++chunk_, used_ = 0;
  if (chunk_ >= chunks_.size()) chunks_.emplace_back(kChunk);
  used_ += count;
  return chunks_[chunk_].data() + (used_ - count);
}

void ScatterArena::keep(ScatterGroup& group, int lane, const ScatterSide& side, std::uint32_t item) {
  group.closure[lane] = group.broad[lane] = nullptr;
  if (item == kNoItem) return;
  const scatter::Closure& whole = closures_.emplace_back(side.get(item));
  group.closure[lane] = group.broad[lane] = &whole;
  if (side.cones)
    put(group.cones, lane, (*side.cones)[side.pool->recipe((*side.closure)[item])], (*side.wo)[item],
        whole.frame.n);
  if (whole.roughness() >= side.traced_below) return;
  group.broad[lane] = &closures_.emplace_back(scatter::broad_part(whole, side.traced_below));
  group.some_traced = true;
}

ScatterGroup ScatterArena::fetch(const ScatterSide& side, const std::uint32_t items[16]) {
  ScatterGroup group;
  group.adjoint = side.adjoint;
  const std::uint32_t first = *std::find_if(items, items + 16, [](std::uint32_t i) { return i != kNoItem; });
  group.form = &(*side.forms)[side.forms->of_recipe(side.pool->recipe((*side.closure)[first]))];
  if (!group.form->in_lanes) {
    for (int k = 0; k < 16; ++k) {
      keep(group, k, side, items[k]);
      put(group.wo, k, items[k] == kNoItem ? Vec3f{} : (*side.wo)[items[k]]);
    }
    return group;
  }
  LobeLanes* lobes = new_lobes(group.form->lobes.size());
  group.lobes = lobes;
  CoatLanes* coats = new_coats(*group.form);
  group.coats = coats;
  for (int k = 0; k < 16; ++k) read(group, lobes, coats, k, side, items[k] == kNoItem ? first : items[k]);
  prepare(group, lobes, coats);
  return group;
}

ScatterGroup ScatterArena::fetch(const ScatterSide& side, std::uint32_t item) {
  ScatterGroup group;
  group.adjoint = side.adjoint;
  group.form = &(*side.forms)[side.forms->of_recipe(side.pool->recipe((*side.closure)[item]))];
  if (!group.form->in_lanes) {
    keep(group, 0, side, item);
    for (int k = 0; k < 16; ++k) {
      group.closure[k] = group.closure[0], group.broad[k] = group.broad[0];
      put(group.wo, k, (*side.wo)[item]);
    }
    if (side.cones) spread(group.cones, sizeof(LobeCones) / sizeof(Lane));
    return group;
  }
  LobeLanes* lobes = new_lobes(group.form->lobes.size());
  group.lobes = lobes;
  CoatLanes* coats = new_coats(*group.form);
  group.coats = coats;
  read(group, lobes, coats, 0, side, item);
  for (Lane3* v : {&group.wo, &group.n, &group.ng}) spread(*v, 3);
  if (group.form->anisotropic) spread(group.s, 3), spread(group.t, 3);
  if (side.cones) spread(group.cones, sizeof(LobeCones) / sizeof(Lane));
  for (std::size_t k = 0; k < group.form->lobes.size(); ++k)
    spread(lobes[k], sizeof(LobeLanes) / sizeof(Lane));
  if (coats)
    for (std::size_t k = 0; k < group.form->lobes.size(); ++k)
      spread(coats[k], sizeof(CoatLanes) / sizeof(Lane));
  prepare(group, lobes, coats);
  return group;
}

Lane3 eval_f(const ScatterGroup& group, const Lane3& wi, LaneMask direct) {
  if (group.form->in_lanes) return eval_lobes(group, wi, direct);
  Lane3 f{};
  for (int k = 0; k < 16; ++k) {
    if (!group.closure[k]) continue;
    const Vec3f wo{group.wo.x[k], group.wo.y[k], group.wo.z[k]};
    const scatter::Closure& closure = direct[k] ? *group.broad[k] : *group.closure[k];
    put(f, k, scatter::eval_f(closure, wo, {wi.x[k], wi.y[k], wi.z[k]}, group.adjoint));
  }
  return f;
}

}  // namespace lumirank::transport
