#include "transport/cpu/media_matrix.h"

#include <algorithm>
#include <atomic>

#include "base/error.h"
#include "base/parallel.h"
#include "transport/cpu/media_batch.h"
#include "transport/cpu/scene_matrix.h"
#include "transport/pairs/media_row_bounds.h"

namespace lumirank::transport {

using matrix::Cost;
using matrix::Index;
using matrix::Part;

namespace {

// Entries of one task. Rows and columns that accumulate() computes at a time: between two looks at whether it
// was cancelled, and so that what they hold stays in a core's own cache.
constexpr std::size_t kEntriesPerTask = 4096;
constexpr std::size_t kRowsAtATime = 64, kColumnsAtATime = 256;

SceneMatrixSettings of_points(SceneMatrixSettings settings) {
  settings.traced_direct_below = 0;
  return settings;
}

}  // namespace

struct MediaMatrix::Impl {
  const world::World& world;
  const Receivers& receivers;
  const LightsInMedia& lights;
  SceneMatrixSettings settings;
  SceneMatrix points;  // receivers × points, without media
  MediaPairs pairs;
  std::size_t surfaces, segments, point_count, ray_count;
  // Features of rows and columns, the second kind behind the first.
  std::vector<Vec2f> row_pixel;
  std::vector<Vec3f> row_position, row_normal, column_position, column_normal;
  std::vector<float> row_weight, column_power;
  std::vector<std::uint64_t> row_id, column_id, column_branch;
  std::vector<std::uint32_t> row_slice;
  std::vector<std::uint16_t> column_group;
  std::vector<std::uint8_t> column_indirect, column_half;
  std::vector<Rgb> column_emitted;

  Impl(const world::World& w, const Receivers& r, const LightsInMedia& l, const MediaMatrixSettings& s)
      : world(w),
        receivers(r),
        lights(l),
        settings(of_points(s.scene)),
        points(w, r, l.points, settings),
        pairs(w, r, l, {mix64(settings.seed ^ 0x6d65646961ull), settings.max_depth, s.shared_places}),
        surfaces(r.size()),
        segments(r.segments.size()),
        point_count(l.points.size()),
        ray_count(l.rays.size()) {
    if (r.media.size() != surfaces)
      throw InternalError("transport::MediaMatrix: receivers do not know their media");
    take_row_features();
    take_column_features();
  }

  void take_row_features() {
    const matrix::RowFeatures f = points.row_features();
    row_pixel.assign(f.pixel.begin(), f.pixel.end());
    row_position = receivers.position, row_normal = receivers.normal, row_id = receivers.id;
    row_weight.assign(f.weight.begin(), f.weight.end());
    const EyeSegments& s = receivers.segments;
    for (std::size_t k = 0; k < segments; ++k) {
      row_pixel.push_back(receivers.film[s.sample[k]]);
      row_position.push_back(s.origin[k] + s.direction[k] * (0.5f * s.length[k]));
      // A medium is lit from all sides; what tells its rows apart is how they look at it.
      row_normal.push_back(-s.direction[k]);
      row_weight.push_back(mean(s.weight[k]));
      row_id.push_back(s.id[k]);
    }
    if (!s.slice.empty()) {
      row_slice.assign(surfaces, matrix::kNoSlice);
      row_slice.insert(row_slice.end(), s.slice.begin(), s.slice.end());
    }
  }

  void take_column_features() {
    const matrix::ColumnFeatures f = points.column_features();
    column_position.assign(f.position.begin(), f.position.end());
    column_normal.assign(f.normal.begin(), f.normal.end());
    column_power.assign(f.power.begin(), f.power.end());
    column_group.assign(f.group.begin(), f.group.end());
    column_indirect.assign(f.indirect.begin(), f.indirect.end());
    column_half.assign(f.half.begin(), f.half.end());
    column_emitted.assign(f.emitted.begin(), f.emitted.end());
    column_id.assign(f.id.begin(), f.id.end());
    const RayLights& rays = lights.rays;
    for (std::size_t j = 0; j < ray_count; ++j) {
      const float middle = 0.5f * rays.length[j];
      const Vec3f place = rays.origin[j] + rays.direction[j] * middle;
      column_position.push_back(place);
      column_normal.emplace_back();
      // What scatters along the way, by the medium in its middle.
      const media::Medium& medium = world.media()[static_cast<std::size_t>(rays.medium[j])];
      const media::Coefficients at = medium.at(place);
      Rgb emitted = rays.power[j];
      for (int c = 0; c < 3; ++c)
        emitted[c] *= at.extinction[c] > 0 ? at.scattering[c] / at.extinction[c] *
                                                 -std::expm1(-at.extinction[c] * rays.length[j])
                                           : 0.0f;
      // Where the middle is empty there may be something elsewhere.
      emitted += rays.power[j] * 1e-3f;
      column_emitted.push_back(emitted);
      column_power.push_back(luminance(emitted));
      column_group.push_back(settings.group_by_emitter ? rays.emitter[j] : std::uint16_t{0});
      column_indirect.push_back(1);
      column_half.push_back(rays.half[j]);
      column_id.push_back(rays.id[j]);
    }
    if (!rays.branch.empty()) {
      column_branch.assign(point_count, matrix::kNoBranch);
      column_branch.insert(column_branch.end(), rays.branch.begin(), rays.branch.end());
    }
  }

  bool is_surface(Index i) const { return i < surfaces; }
  bool is_point(Index j) const { return j < point_count; }

  bool both_points(Index i, Index j) const { return is_surface(i) && is_point(j); }
  PairKind kind(Index i, Index j) const {
    if (is_surface(i)) return is_point(j) ? PairKind::point_to_receiver : PairKind::ray_to_receiver;
    return is_point(j) ? PairKind::point_to_segment : PairKind::ray_to_segment;
  }

  // The entry goes to `out` by the end of the batch; of two points it has been there without media.
  void add(Index i, Index j, Part part, MediaBatch& batch, Rgb& out) const {
    const auto row = static_cast<Index>(is_surface(i) ? i : i - surfaces);
    const auto column = static_cast<Index>(is_point(j) ? j : j - point_count);
    if (!both_points(i, j))
      batch.add(kind(i, j), row, column, out);
    else if (part != Part::visibility && !is_black(out))
      batch.attenuate(row, column, out);
  }

  // Entries of which those of two points stand in `out` without media; pair(k) gives row and column.
  template <typename Pair>
  Cost evaluate(std::span<Rgb> out, Part part, Pair&& pair) const {
    return parallel_sum(out.size(), kEntriesPerTask, Cost{}, [&](std::size_t begin, std::size_t end) {
      MediaBatch batch(pairs, part);
      for (std::size_t k = begin; k < end; ++k) {
        const auto [i, j] = pair(k);
        add(i, j, part, batch, out[k]);
      }
      Cost cost = batch.finish();
      if (part == Part::value)
        for (std::size_t k = begin; k < end; ++k)
          cost.energy += static_cast<double>(out[k].r + out[k].g + out[k].b);
      return cost;
    });
  }
};

MediaMatrix::MediaMatrix(const world::World& world, const Receivers& receivers, const LightsInMedia& lights,
                         const MediaMatrixSettings& settings)
    : impl_(std::make_unique<Impl>(world, receivers, lights, settings)) {}
MediaMatrix::~MediaMatrix() = default;

std::size_t MediaMatrix::rows() const { return impl_->surfaces + impl_->segments; }
std::size_t MediaMatrix::columns() const { return impl_->point_count + impl_->ray_count; }

Cost MediaMatrix::block(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
                        Part part) const {
  const Impl& m = *impl_;
  std::vector<Index> surface_rows, point_columns;
  std::vector<std::size_t> row_places, column_places;
  for (std::size_t a = 0; a < rows.size(); ++a)
    if (m.is_surface(rows[a])) surface_rows.push_back(rows[a]), row_places.push_back(a);
  for (std::size_t b = 0; b < columns.size(); ++b)
    if (m.is_point(columns[b])) point_columns.push_back(columns[b]), column_places.push_back(b);
  Cost cost;
  if (!surface_rows.empty() && !point_columns.empty()) {
    std::vector<Rgb> values(surface_rows.size() * point_columns.size());
    cost = m.points.block(surface_rows, point_columns, values, part);
    cost.energy = 0;
    for (std::size_t a = 0; a < row_places.size(); ++a)
      for (std::size_t b = 0; b < column_places.size(); ++b)
        out[row_places[a] * columns.size() + column_places[b]] = values[a * column_places.size() + b];
  }
  return cost + m.evaluate(out, part, [&](std::size_t k) {
    return std::pair(rows[k / columns.size()], columns[k % columns.size()]);
  });
}

Cost MediaMatrix::row(Index i, std::span<Rgb> out, Part part) const {
  std::vector<Index> all(columns());
  for (std::size_t j = 0; j < all.size(); ++j) all[j] = static_cast<Index>(j);
  return block(std::span(&i, 1), all, out, part);
}

Cost MediaMatrix::column(Index j, std::span<Rgb> out, Part part) const {
  std::vector<Index> all(rows());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<Index>(i);
  return block(all, std::span(&j, 1), out, part);
}

Cost MediaMatrix::entries(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
                          Part part) const {
  const Impl& m = *impl_;
  std::vector<Index> surface_rows, point_columns;
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (m.both_points(rows[k], columns[k]))
      surface_rows.push_back(rows[k]), point_columns.push_back(columns[k]), places.push_back(k);
  Cost cost;
  if (!places.empty()) {
    std::vector<Rgb> values(places.size());
    cost = m.points.entries(surface_rows, point_columns, values, part);
    cost.energy = 0;
    for (std::size_t n = 0; n < places.size(); ++n) out[places[n]] = values[n];
  }
  return cost + m.evaluate(out, part, [&](std::size_t k) { return std::pair(rows[k], columns[k]); });
}

Cost MediaMatrix::accumulate(std::span<const matrix::ScaledColumn> columns, std::span<Rgb> sums,
                             const Sinks& sinks) const {
  std::vector<Index> numbers;
  numbers.reserve(columns.size());
  for (const matrix::ScaledColumn& c : columns) numbers.push_back(c.column);
  std::atomic<std::size_t> done{0};
  return parallel_sum(rows(), kRowsAtATime, Cost{}, [&](std::size_t begin, std::size_t end) {
    std::vector<Index> some;
    for (std::size_t i = begin; i < end; ++i) some.push_back(static_cast<Index>(i));
    std::vector<Rgb> values(some.size() * std::min(kColumnsAtATime, columns.size()));
    Cost cost;
    for (std::size_t from = 0; from < columns.size(); from += kColumnsAtATime) {
      if (sinks.cancelled()) return cost;
      const std::size_t count = std::min(kColumnsAtATime, columns.size() - from);
      const std::span out(values.data(), some.size() * count);
      cost += block(some, std::span(numbers).subspan(from, count), out, Part::value);
      for (std::size_t a = 0; a < some.size(); ++a)
        for (std::size_t k = 0; k < count; ++k) sums[some[a]] += out[a * count + k] * columns[from + k].scale;
    }
    done += end - begin;
    sinks.report("columns", static_cast<double>(done) / static_cast<double>(rows()));
    return cost;
  });
}

matrix::RowFeatures MediaMatrix::row_features() const {
  const Impl& m = *impl_;
  return {m.row_pixel, m.row_position, m.row_normal, m.row_weight, m.row_id, {}, {}, m.row_slice};
}

matrix::ColumnFeatures MediaMatrix::column_features() const {
  const Impl& m = *impl_;
  return {m.column_position, m.column_normal,   m.column_power,
          m.column_group,    m.column_indirect, m.column_half,
          m.column_emitted,  m.column_id,       {},
          m.column_branch};
}

matrix::ColumnSet MediaMatrix::column_set(Index j) const {
  const Impl& m = *impl_;
  if (m.is_point(j)) return m.points.column_set(j);
  const RayLights& rays = m.lights.rays;
  const std::size_t k = j - m.point_count;
  return ray_set(m.world.media()[static_cast<std::size_t>(rays.medium[k])], rays.medium[k], rays.origin[k],
                 rays.direction[k], rays.length[k], rays.power[k]);
}

std::unique_ptr<matrix::RowBounds> MediaMatrix::row_bounds() const {
  return std::make_unique<MediaRowBounds>(impl_->world, impl_->receivers,
                                          BoundRules{impl_->settings.spheres, 0});
}

std::size_t MediaMatrix::memory_bytes() const {
  const Impl& m = *impl_;
  const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return m.points.memory_bytes() + m.pairs.memory_bytes() + bytes(m.row_pixel) + bytes(m.row_position) +
         bytes(m.row_normal) + bytes(m.row_weight) + bytes(m.row_id) + bytes(m.column_position) +
         bytes(m.column_normal) + bytes(m.column_power) + bytes(m.column_group) + bytes(m.column_indirect) +
         bytes(m.column_half) + bytes(m.column_emitted) + bytes(m.column_id) + bytes(m.column_branch) +
         bytes(m.row_slice);
}

}  // namespace lumirank::transport
