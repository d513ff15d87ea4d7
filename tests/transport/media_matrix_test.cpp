// Entries in participating media: what they are, however they are asked for, and that their mean is the
// integral that they estimate.
#include <gtest/gtest.h>

#include <memory>
#include <numeric>
#include <vector>

#include "base/parallel.h"
#include "scatter/closure.h"
#include "support/scenes.h"
#include "support/statistics.h"
#include "transport/cpu/media_batch.h"
#include "transport/cpu/media_matrix.h"
#include "transport/foggy_room.h"
#include "world/straight_path.h"

namespace lumirank::transport {
namespace {

using matrix::Index;
using matrix::Part;
using testing::add_bsdf;
using testing::add_shape;

std::vector<Index> first(std::size_t count) {
  std::vector<Index> all(count);
  std::iota(all.begin(), all.end(), Index{0});
  return all;
}

std::vector<Rgb> whole(const MediaMatrix& m, Part part) {
  std::vector<Rgb> out(m.rows() * m.columns());
  m.block(first(m.rows()), first(m.columns()), out, part);
  return out;
}

TEST(MediaMatrix, AnEntryIsTheSameHoweverItIsAskedFor) {
  for (const bool shared : {false, true}) {
    const MediaMatrix m = room().matrix(shared);
    for (const Part part : {Part::value, Part::unoccluded, Part::visibility}) {
      std::vector<Rgb> all;
      with_threads(1, [&] { all = whole(m, part); });
      EXPECT_EQ(all, whole(m, part));
      std::vector<Rgb> row(m.columns()), column(m.rows());
      for (Index i = 0; i < m.rows(); i += 3) {
        m.row(i, row, part);
        for (std::size_t j = 0; j < row.size(); ++j)
          ASSERT_EQ(row[j], all[i * m.columns() + j]) << i << ' ' << j;
      }
      for (Index j = 0; j < m.columns(); j += 3) {
        m.column(j, column, part);
        for (std::size_t i = 0; i < column.size(); ++i)
          ASSERT_EQ(column[i], all[i * m.columns() + j]) << i << ' ' << j;
      }
      Rng rng(7, Stage::test);
      std::vector<Index> is, js;
      for (int n = 0; n < 3000; ++n)
        is.push_back(static_cast<Index>(rng.next_below(m.rows()))),
            js.push_back(static_cast<Index>(rng.next_below(m.columns())));
      std::vector<Rgb> some(is.size());
      m.entries(is, js, some, part);
      for (std::size_t n = 0; n < some.size(); ++n) ASSERT_EQ(some[n], all[is[n] * m.columns() + js[n]]);
    }
    std::vector<matrix::ScaledColumn> columns;
    for (Index j = 0; j < m.columns(); j += 2) columns.push_back({j, Rgb(1, 2, 0.5f)});
    std::vector<Rgb> sums(m.rows(), Rgb(0.25f)), expected = sums;
    m.accumulate(columns, sums, {});
    const std::vector<Rgb> all = whole(m, Part::value);
    for (std::size_t i = 0; i < sums.size(); ++i)
      for (const auto& c : columns) expected[i] += all[i * m.columns() + c.column] * c.scale;
    EXPECT_EQ(sums, expected);
  }
}

TEST(MediaMatrix, AValueIsWhatIsUnoccludedWhereItIsVisible) {
  const MediaMatrix m = room().matrix(false);
  const std::vector<Rgb> value = whole(m, Part::value), unoccluded = whole(m, Part::unoccluded),
                         visible = whole(m, Part::visibility);
  std::size_t lit = 0, hidden = 0;
  for (std::size_t k = 0; k < value.size(); ++k) {
    ASSERT_TRUE(visible[k] == Rgb(1) || visible[k] == Rgb(0));
    ASSERT_EQ(value[k], visible[k] == Rgb(1) ? unoccluded[k] : Rgb(0))
        << k / m.columns() << ' ' << k % m.columns();
    lit += !is_black(value[k]), hidden += !is_black(unoccluded[k]) && is_black(visible[k]);
  }
  EXPECT_GT(lit, value.size() / 4);
  EXPECT_GT(hidden, value.size() / 50);
}

// The integrals that entries estimate, sampled evenly along segment and ray, one pair at a time.
class PlainEstimate {
 public:
  explicit PlainEstimate(const FoggyRoom& room) : room_(room) {}

  Rgb of(PairKind kind, std::uint32_t i, std::uint32_t j, Rng& rng) const {
    const auto random = [&rng] { return rng.next_float(); };
    const EyeSegments& segments = room_.rows.segments;
    const RayLights& rays = room_.lights.rays;
    const VirtualLights& points = room_.lights.points;
    Rgb value(1);
    Vec3f x, y, ng{};
    int medium = -1;
    const bool far = !has_ray(kind) && points.kind[j] == LightKind::directional;
    if (has_segment(kind)) {
      const float t = random() * segments.length[i];
      x = segments.origin[i] + segments.direction[i] * t;
      medium = segments.medium[i];
      value *= media::transmittance(of(medium), segments.origin[i], segments.direction[i], t, random) *
               of(medium).at(x).scattering * segments.length[i];
    } else {
      x = room_.rows.position[i], ng = room_.rows.ng[i];
    }
    if (has_ray(kind)) {
      const float s = random() * rays.length[j];
      y = rays.origin[j] + rays.direction[j] * s;
      value *= media::transmittance(of(rays.medium[j]), rays.origin[j], rays.direction[j], s, random) *
               of(rays.medium[j]).at(y).scattering * (rays.power[j] * rays.length[j]);
    } else {
      y = points.position[j];
    }
    const float d = far ? kInfinity : length(y - x);
    const Vec3f w = far ? -points.normal[j] : (y - x) / d;
    if (!far) value *= 1 / (d * d);
    if (has_segment(kind)) {
      value *= of(medium).phase().eval(dot(segments.direction[i], w));
    } else {
      value *= scatter::eval(room_.rows.closure_at(i), room_.rows.wo[i], w);
      medium = room_.rows.media[i][dot(ng, w) >= 0 ? 0 : 1];
    }
    if (has_ray(kind))
      value *= of(rays.medium[j]).phase().eval(-dot(rays.direction[j], w));
    else
      value *= sent(j, w);
    return is_black(value) ? value : value * world::pass_straight(room_.world, {x, ng, w, d, medium}, random);
  }

 private:
  const media::Medium& of(int medium) const { return room_.world.media()[static_cast<std::size_t>(medium)]; }
  Rgb sent(std::size_t j, Vec3f w) const {
    const VirtualLights& points = room_.lights.points;
    if (points.kind[j] == LightKind::oriented)
      return points.power[j] * std::max(0.0f, -dot(points.normal[j], w));
    if (points.kind[j] != LightKind::surface) return points.power[j];
    return points.power[j] * scatter::eval_f(points.closure_at(j), points.incoming[j], -w, true) *
           std::abs(dot(points.ng[j], w));
  }

  const FoggyRoom& room_;
};

// Many pairs of a kind, all seeds together: the mean of entries relative to the mean of plain estimates.
void expect_unbiased(PairKind kind, bool shared) {
  const FoggyRoom& r = room();
  const std::size_t rows = has_segment(kind) ? r.rows.segments.size() : r.rows.size();
  const std::size_t columns = has_ray(kind) ? r.lights.rays.size() : r.lights.points.size();
  ASSERT_GT(rows * columns, 100u);
  const PlainEstimate plain(r);
  Rng choice(11, Stage::test, static_cast<std::uint64_t>(kind)), rng(13, Stage::test);
  test::RunningMean differences;
  double sum = 0;
  // Each pair has its own scale, so that a few bright ones do not drown the others.
  std::vector<Index> is, js;
  for (int n = 0; n < 400; ++n)
    is.push_back(static_cast<Index>(choice.next_below(rows))),
        js.push_back(static_cast<Index>(choice.next_below(columns)));
  const auto scale_of = [&](std::size_t n) {
    // How near the two come bounds what both estimates may give.
    Rng own(17, Stage::test, n);
    double mean = 0;
    for (int k = 0; k < 64; ++k)
      mean += static_cast<double>(std::min(1e3f, plain.of(kind, is[n], js[n], own).g)) / 64;
    return mean;
  };
  std::vector<double> scales;
  for (std::size_t n = 0; n < is.size(); ++n) scales.push_back(scale_of(n));
  constexpr std::uint64_t kSeeds = 300;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const MediaPairs pairs(r.world, r.rows, r.lights, {seed, -1, shared});
    MediaBatch batch(pairs, Part::value);
    std::vector<Rgb> out(is.size());
    for (std::size_t n = 0; n < is.size(); ++n) batch.add(kind, is[n], js[n], out[n]);
    batch.finish();
    double mean = 0, other = 0;
    for (std::size_t n = 0; n < is.size(); ++n) {
      if (!(scales[n] > 0)) continue;
      const Rgb a = out[n], b = plain.of(kind, is[n], js[n], rng);
      mean += static_cast<double>(a.r + a.g + a.b) / scales[n];
      other += static_cast<double>(b.r + b.g + b.b) / scales[n];
    }
    differences.add(mean - other), sum += other;
  }
  sum /= kSeeds;
  EXPECT_NEAR(differences.mean(), 0, test::normal_quantile(1e-4, 8) * differences.standard_error());
  // A tenth more would be seen.
  EXPECT_LT(differences.standard_error(), 0.03 * sum) << static_cast<int>(kind);
}

TEST(MediaMatrix, EntriesEstimateTheirIntegrals) {
  for (const PairKind kind :
       {PairKind::ray_to_receiver, PairKind::point_to_segment, PairKind::ray_to_segment})
    for (const bool shared : {false, true}) expect_unbiased(kind, shared);
}

TEST(MediaMatrix, SharedPlacesMakeColumnsSmooth) {
  // Two rows that are the same segment by another name differ by tracking alone, which fog needs none of.
  FoggyRoom twins;
  const EyeSegments& from = room().rows.segments;
  std::size_t k = 0;
  while (k < from.size() && from.medium[k] != 0) ++k;
  ASSERT_LT(k, from.size());
  EyeSegments& s = twins.rows.segments;
  s.resize(2);
  for (std::size_t n = 0; n < 2; ++n)
    s.set(n, {from.origin[k], from.direction[k], from.length[k], from.weight[k], from.id[k] + n,
              from.sample[k], from.depth[k], from.medium[k]});
  const std::size_t first_segment = twins.rows.size();
  for (const bool shared : {false, true}) {
    const MediaMatrix m = twins.matrix(shared);
    const std::vector<Rgb> all = whole(m, Part::value);
    std::size_t same = 0, some = 0;
    for (std::size_t j = 0; j < m.columns(); ++j) {
      const Rgb a = all[first_segment * m.columns() + j], b = all[(first_segment + 1) * m.columns() + j];
      some += !is_black(a), same += !is_black(a) && a == b;
    }
    ASSERT_GT(some, 15u);
    if (shared)
      EXPECT_GT(same, some * 4 / 5);
    else
      EXPECT_LT(same, some / 5);
  }
}

}  // namespace
}  // namespace lumirank::transport
