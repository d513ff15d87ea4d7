#include "transport/cpu/media_matrix.h"

#include <algorithm>
#include <atomic>

#include "base/error.h"
#include "base/parallel.h"
#include "transport/cpu/media_pair.h"
#include "transport/cpu/scene_matrix.h"

namespace lumirank::transport {

using matrix::Cost;
using matrix::Index;
using matrix::Part;

namespace {

// Entries that one task of accumulate() computes between two looks at whether it was cancelled, about.
constexpr std::size_t kRowsPerTask = 64;

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

  // Of pairs that are not both points. `cost` gets what it took.
  Rgb entry(Index i, Index j, Part part, Cost& cost) const {
    MediaPairs::Entry e;
    if (is_surface(i))
      e = pairs.ray_to_receiver(i, j - point_count, part);
    else if (is_point(j))
      e = pairs.point_to_segment(i - surfaces, j, part);
    else
      e = pairs.ray_to_segment(i - surfaces, j - point_count, part);
    ++cost.entries;
    if (e.traced)
      ++cost.rays;
    else
      ++cost.culled;
    return e.of(part);
  }

  // Through media, what was without them.
  Rgb attenuated(Rgb value, Index i, Index j, Part part) const {
    return part == Part::visibility || is_black(value) ? value : value * pairs.media_between(i, j);
  }

  static void count_energy(Cost& cost, Rgb value, Part part) {
    if (part == Part::value) cost.energy += static_cast<double>(value.r + value.g + value.b);
  }

  // One row for the columns, which begin with all that are points: out[k] = A(i, columns[k]).
  Cost few(Index i, std::span<const Index> columns, std::span<Rgb> out, Part part,
           std::vector<Index>& of_points, std::vector<Rgb>& values) const {
    Cost cost;
    of_points.clear();
    if (is_surface(i))
      for (const Index j : columns)
        if (is_point(j)) of_points.push_back(j);
    values.resize(of_points.size());
    if (!of_points.empty()) {
      const Cost own = points.block(std::span(&i, 1), of_points, values, part);
      cost.entries += own.entries, cost.culled += own.culled, cost.rays += own.rays;
      cost.clamped += own.clamped, cost.lost += own.lost;
    }
    std::size_t next = 0;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const bool both = is_surface(i) && is_point(columns[k]);
      out[k] = both ? attenuated(values[next++], i, columns[k], part) : entry(i, columns[k], part, cost);
      count_energy(cost, out[k], part);
    }
    return cost;
  }
};

MediaMatrix::MediaMatrix(const world::World& world, const Receivers& receivers, const LightsInMedia& lights,
                         const MediaMatrixSettings& settings)
    : impl_(std::make_unique<Impl>(world, receivers, lights, settings)) {}
MediaMatrix::~MediaMatrix() = default;

std::size_t MediaMatrix::rows() const { return impl_->surfaces + impl_->segments; }
std::size_t MediaMatrix::columns() const { return impl_->point_count + impl_->ray_count; }

namespace {

// Runs work(k, cost) for all k in parallel; the sum of costs does not depend on the threads.
template <typename Work>
Cost summed(std::size_t count, std::size_t grain, Work&& work) {
  std::vector<Cost> costs((count + grain - 1) / grain);
  parallel_for(count, grain,
               [&](std::size_t begin, std::size_t end) { work(begin, end, costs[begin / grain]); });
  Cost total;
  for (const Cost& cost : costs) total += cost;
  return total;
}

}  // namespace

Cost MediaMatrix::block(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
                        Part part) const {
  const Impl& m = *impl_;
  if (columns.empty()) return {};
  // Long rows are cut, so that one row alone keeps all threads busy.
  constexpr std::size_t kCut = 256;
  const std::size_t cuts = (columns.size() + kCut - 1) / kCut;
  return summed(rows.size() * cuts, std::max<std::size_t>(1, 64 / cuts),
                [&](std::size_t begin, std::size_t end, Cost& cost) {
                  std::vector<Index> of_points;
                  std::vector<Rgb> values;
                  for (std::size_t k = begin; k < end; ++k) {
                    const std::size_t a = k / cuts, from = k % cuts * kCut,
                                      count = std::min(kCut, columns.size() - from);
                    cost += m.few(rows[a], columns.subspan(from, count),
                                  out.subspan(a * columns.size() + from, count), part, of_points, values);
                  }
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
    if (m.is_surface(rows[k]) && m.is_point(columns[k]))
      surface_rows.push_back(rows[k]), point_columns.push_back(columns[k]), places.push_back(k);
  std::vector<Rgb> values(places.size());
  Cost cost;
  if (!places.empty()) {
    cost = m.points.entries(surface_rows, point_columns, values, part);
    cost.energy = 0;
    for (std::size_t n = 0; n < places.size(); ++n) {
      out[places[n]] = m.attenuated(values[n], surface_rows[n], point_columns[n], part);
      Impl::count_energy(cost, out[places[n]], part);
    }
  }
  return cost + summed(rows.size(), 64, [&](std::size_t begin, std::size_t end, Cost& own) {
           for (std::size_t k = begin; k < end; ++k) {
             if (m.is_surface(rows[k]) && m.is_point(columns[k])) continue;
             out[k] = m.entry(rows[k], columns[k], part, own);
             Impl::count_energy(own, out[k], part);
           }
         });
}

Cost MediaMatrix::accumulate(std::span<const matrix::ScaledColumn> columns, std::span<Rgb> sums,
                             const Sinks& sinks) const {
  const Impl& m = *impl_;
  std::vector<Index> numbers;
  numbers.reserve(columns.size());
  for (const matrix::ScaledColumn& c : columns) numbers.push_back(c.column);
  std::atomic<std::size_t> done{0};
  return summed(rows(), kRowsPerTask, [&](std::size_t begin, std::size_t end, Cost& cost) {
    std::vector<Index> of_points;
    std::vector<Rgb> values, row(columns.size());
    for (std::size_t i = begin; i < end; ++i) {
      if (sinks.cancelled()) return;
      cost += m.few(static_cast<Index>(i), numbers, row, Part::value, of_points, values);
      Rgb sum = sums[i];
      for (std::size_t k = 0; k < columns.size(); ++k) sum += row[k] * columns[k].scale;
      sums[i] = sum;
    }
    done += end - begin;
    sinks.report("columns", static_cast<double>(done) / static_cast<double>(rows()));
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

std::size_t MediaMatrix::memory_bytes() const {
  const Impl& m = *impl_;
  const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return m.points.memory_bytes() + bytes(m.row_pixel) + bytes(m.row_position) + bytes(m.row_normal) +
         bytes(m.row_weight) + bytes(m.row_id) + bytes(m.column_position) + bytes(m.column_normal) +
         bytes(m.column_power) + bytes(m.column_group) + bytes(m.column_indirect) + bytes(m.column_half) +
         bytes(m.column_emitted) + bytes(m.column_id) + bytes(m.column_branch) + bytes(m.row_slice);
}

}  // namespace lumirank::transport
