#include "transport/cpu/scene_matrix.h"

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "transport/cpu/scene_matrix_impl.h"

namespace lumirank::transport {

using matrix::Cost;
using matrix::Index;
using matrix::Part;

namespace {

bool has_cutouts(const geometry::RayScene& rays) {
  return std::any_of(rays.placements().begin(), rays.placements().end(),
                     [](const geometry::Placement& p) { return p.blocking == geometry::Blocking::cutout; });
}

// Proportional to the power that a light sends out, on one scale for all kinds that have an area or a flux: a
// surface light's Φ times its albedo, an emitter sample's π·L·A, a point light's mean intensity times 4π (a
// spot's times its cone). Directional light sends E through the disc of the scene's bounding sphere.
Rgb emitted_power(const VirtualLights& lights, std::size_t j, float scene_radius) {
  const Rgb power = lights.power[j];
  switch (lights.kind[j]) {
    case LightKind::omni:
      return power * 4 * kPi;
    case LightKind::oriented:
      return power * kPi;
    case LightKind::directional:
      return power * kPi * scene_radius * scene_radius;
    case LightKind::spot: {
      const SpotShape& spot = lights.spots[lights.closure[j]];
      if (spot.profile) return power * spot.profile->total();
      return power * 2 * kPi * (1 - 0.5f * (spot.cos_beam + spot.cos_cutoff));
    }
    case LightKind::surface:
      break;
  }
  if (lights.closure[j] == VirtualLights::kLambertian) return lights.power[j] * lights.albedo[j];
  return lights.power[j] * scatter::albedo(lights.closure_at(j), lights.incoming[j]);
}

std::size_t items_in_tile(const TilePlan& plan, std::size_t tile) {
  std::size_t n = 0;
  for (const TilePlan::Run& run : plan.tile(tile))
    n += static_cast<std::size_t>(std::count_if(plan.item.begin() + run.begin, plan.item.begin() + run.end,
                                                [](std::uint32_t item) { return item != kNoItem; }));
  return n;
}

// What a_j·G·(π f_x)(π f_y) of a column may be because it stands for `scale` times its area. Without clamping
// nothing is bounded, so that who switches it off gets an unbiased picture.
float max_contribution(const matrix::ScaledColumn& s, float clamp) {
  if (!(s.max_contribution > 0) || clamp == kInfinity) return kInfinity;
  return s.max_contribution / std::max(max_component(s.scale), 1e-30f);
}

void require(bool holds, const char* what) {
  if (!holds) throw InternalError(std::string("transport::SceneMatrix: ") + what);
}

}  // namespace

SceneMatrix::Impl::Impl(const world::World& world_, const Receivers& receivers_, const VirtualLights& lights_,
                        const SceneMatrixSettings& settings_)
    : world(world_),
      receivers(receivers_),
      lights(lights_),
      settings(settings_),
      row_forms(receivers_.closures),
      column_forms(lights_.closures),
      rows(make_rows(receivers_, row_forms, settings_, has_cutouts(world.rays()) || lights_.spherical())),
      columns(make_columns(lights_, column_forms, has_cutouts(world.rays()) || lights_.spherical())) {
  context.rows = &rows;
  context.columns = &columns;
  context.has_spheres = lights.spherical();
  context.spheres = {settings.spheres, &receivers, &lights, mix64(settings.seed ^ 0x73706865ull)};
  context.row_scatter = {
      &receivers.closures, &row_forms, &receivers.closure,          &receivers.normal, &receivers.ng,
      &receivers.wo,       false,      settings.traced_direct_below};
  context.column_scatter = {&lights.closures, &column_forms, &lights.closure, &lights.normal, &lights.ng,
                            &lights.incoming, true};
  if (context.has_spheres) {
    row_cones = lobe_cones(receivers.closures), column_cones = lobe_cones(lights.closures);
    context.row_scatter.cones = &row_cones, context.column_scatter.cones = &column_cones;
  }
  context.lights = &lights;
  context.rays = &world.rays();
  context.pair_seed = mix64(settings.seed);
  context.clamp = settings.clamp > 0 ? settings.clamp : kInfinity;
  context.compensated = settings.compensated;
  context.has_cutouts = has_cutouts(world.rays());
  context.has_attenuating = world.rays().has_attenuating();
  context.has_directional =
      std::find(lights.kind.begin(), lights.kind.end(), LightKind::directional) != lights.kind.end();
  context.has_two_sided = !rows.two_sided.empty() || !columns.two_sided.empty();

  row_pixel.resize(receivers.size());
  row_weight.resize(receivers.size());
  for (std::size_t i = 0; i < row_pixel.size(); ++i) {
    row_pixel[i] = receivers.film[receivers.sample[i]];
    row_weight[i] = mean(receivers.weight[i]);
  }
  if (settings.row_albedo) {
    row_albedo.resize(receivers.size());
    parallel_for(receivers.size(), 1 << 10, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        row_albedo[i] = receivers.closure[i] == Receivers::kLambertian
                            ? receivers.albedo[i]
                            : scatter::albedo(receivers.closure_at(i), receivers.wo[i]);
    });
  }
  peaks = light_peaks(lights);
  const float radius = world.bounds().radius();
  column_power.resize(lights.size());
  column_group.resize(lights.size(), 0);
  column_indirect.resize(lights.size());
  column_emitted.resize(lights.size());
  parallel_for(lights.size(), 1 << 12, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      column_emitted[j] = emitted_power(lights, j, radius);
      column_power[j] = luminance(column_emitted[j]);
      column_indirect[j] = lights.kind[j] == LightKind::surface;
      if (settings.group_by_emitter) column_group[j] = lights.emitter[j];
    }
  });
}

SceneMatrix::Impl::Lease::Lease(const Impl& impl) : impl_(impl) {
  const std::lock_guard lock(impl.mutex);
  if (impl.spare_blocks.empty()) {
    block_ = std::make_unique<PairBlock>(impl.context);
  } else {
    block_ = std::move(impl.spare_blocks.back());
    impl.spare_blocks.pop_back();
  }
}

SceneMatrix::Impl::Lease::~Lease() {
  const std::lock_guard lock(impl_.mutex);
  impl_.spare_blocks.push_back(std::move(block_));
}

SceneMatrix::SceneMatrix(const world::World& world, const Receivers& receivers, const VirtualLights& lights,
                         const SceneMatrixSettings& settings)
    : impl_(std::make_unique<Impl>(world, receivers, lights, settings)) {}

SceneMatrix::~SceneMatrix() = default;

std::size_t SceneMatrix::rows() const { return impl_->receivers.size(); }
std::size_t SceneMatrix::columns() const { return impl_->lights.size(); }

Cost SceneMatrix::row(Index i, std::span<Rgb> out, Part part) const {
  require(i < rows() && out.size() == columns(),
          "row() needs a row of the matrix and room for all its columns");
  const TilePlan& plan = impl_->columns.plan;
  const Cost all = parallel_sum(plan.tiles(), 1, Cost{}, [&](std::size_t tile, std::size_t) {
    Impl::Lease block(*impl_);
    block->set_column_tile(tile);
    block->set_row(impl_->rows.plan.slot[i]);
    const Cost cost = finish(*block, part, items_in_tile(plan, tile));
    const std::uint32_t* items = plan.item.data() + block->first_slot();
    copy_out(*block, part, {items, 16 * block->groups()}, [&](std::uint32_t to) -> Rgb& { return out[to]; });
    return cost;
  });
  return with_loss(impl_->context, all);
}

Cost SceneMatrix::column(Index j, std::span<Rgb> out, Part part) const {
  require(j < columns() && out.size() == rows(),
          "column() needs a column of the matrix and room for all its rows");
  const TilePlan& plan = impl_->rows.plan;
  const Cost all = parallel_sum(plan.tiles(), 1, Cost{}, [&](std::size_t tile, std::size_t) {
    Impl::Lease block(*impl_);
    block->set_row_tile(tile);
    block->set_column(impl_->columns.plan.slot[j]);
    const Cost cost = finish(*block, part, items_in_tile(plan, tile));
    const std::uint32_t* items = plan.item.data() + block->first_slot();
    copy_out(*block, part, {items, 16 * block->groups()}, [&](std::uint32_t to) -> Rgb& { return out[to]; });
    return cost;
  });
  return with_loss(impl_->context, all);
}

Cost SceneMatrix::accumulate(std::span<const matrix::ScaledColumn> scaled, std::span<Rgb> sums,
                             const Sinks& sinks) const {
  require(sums.size() == rows(), "accumulate() needs one sum per row");
  for (const matrix::ScaledColumn& s : scaled)
    require(s.column < columns(), "accumulate() of a column beyond the last");
  const TilePlan& plan = impl_->rows.plan;
  std::mutex progress;
  std::size_t done = 0;
  const Cost all = parallel_sum(plan.tiles(), 1, Cost{}, [&](std::size_t tile, std::size_t) {
    Cost cost;
    {
      Impl::Lease block(*impl_);
      block->set_row_tile(tile);
      block->load_sums(sums);
      const std::size_t items = items_in_tile(plan, tile);
      for (const matrix::ScaledColumn& s : scaled) {
        if (sinks.cancelled()) throw Cancelled();
        block->set_column(
            impl_->columns.plan.slot[s.column],
            impl_->settings.compensated ? kInfinity : max_contribution(s, impl_->context.clamp));
        block->trace();
        cost.entries += items;
        cost.culled += items - block->survivors();
        cost.rays += block->survivors();
        cost.clamped += block->add_to_sums(s.scale);
      }
      cost.energy = block->store_sums(sums);
    }
    if (sinks.progress) {
      const std::lock_guard lock(progress);
      ++done;
      sinks.report("columns", static_cast<double>(done) / static_cast<double>(plan.tiles()));
    }
    return cost;
  });
  return with_loss(impl_->context, all);
}

matrix::RowFeatures SceneMatrix::row_features() const {
  return {impl_->row_pixel,  impl_->receivers.position, impl_->receivers.normal,
          impl_->row_weight, impl_->receivers.id,       impl_->row_albedo};
}

matrix::ColumnFeatures SceneMatrix::column_features() const {
  return {impl_->lights.position, impl_->lights.normal, impl_->column_power,   impl_->column_group,
          impl_->column_indirect, impl_->lights.half,   impl_->column_emitted, impl_->lights.id};
}

std::size_t SceneMatrix::memory_bytes() const {
  const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return impl_->rows.memory_bytes() + impl_->columns.memory_bytes() + bytes(impl_->row_pixel) +
         bytes(impl_->row_weight) + bytes(impl_->column_power) + bytes(impl_->column_group) +
         bytes(impl_->column_indirect) + bytes(impl_->peaks);
}

}  // namespace lumirank::transport
