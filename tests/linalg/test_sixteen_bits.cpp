// What 16 bits lose: bounds for single numbers, and the cost of clusterings against those of single
// precision.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "linalg/blas.h"
#include "linalg/clustering.h"
#include "linalg/column_sketch.h"
#include "linalg/sampled_rows.h"
#include "linalg/short_float.h"
#include "linalg/test_data.h"
#include "support/statistics.h"

namespace lumirank::linalg {
namespace {

using namespace test;

TEST(ShortFloat, IsWithinTwoToTheMinusTwelveDownToTwoToTheMinusThirtyOne) {
  EXPECT_EQ(lengthen(shorten(0.0f)), 0.0f);
  for (int exponent = -40; exponent <= 0; ++exponent) {
    Rng rng(1, Stage::test, 30, static_cast<std::uint64_t>(exponent + 64));
    for (int k = 0; k < 200; ++k) {
      const float x = std::ldexp(1 + rng.next_float(), exponent);
      const float y = lengthen(shorten(x));
      // Below, everything rounds to a number no further away than the least.
      const float bound = exponent >= -31 ? 0x1p-12f * x : 0x1p-31f * (1 + 0x1p-11f);
      EXPECT_LE(std::abs(y - x), std::max(bound, exponent == -31 ? 0x1p-31f * 0x1p-11f : 0.0f)) << x;
    }
  }
  // The greatest number below 2 rounds down: above it there is none.
  const float max_value = std::nextafter(2.0f, 0.0f);
  EXPECT_LE(max_value - lengthen(shorten(max_value)), 0x1p-11f);
}

TEST(ShortFloat, ScalesArePowersOfTwoAndHaveInverses) {
  for (float x : {0.0f, 1e-45f, 1e-38f, 1e-3f, 1.0f, 3.0f, 1e30f, std::numeric_limits<float>::max()}) {
    const float s = scale_for(x);
    int exponent = 0;
    EXPECT_EQ(std::frexp(s, &exponent), 0.5f) << x;
    EXPECT_TRUE(std::isfinite(1 / s)) << x;
    if (x > 0x1p-126f && x < 0x1p126f) {
      EXPECT_LE(s, x);
      EXPECT_LT(x, 2 * s);
    }
  }
}

// Half a unit, and a unit is at most 2⁻¹⁴ of the largest coordinate; the largest itself may be cut off by
// half a unit.
TEST(PackedPoints, AreWithinTwoToTheMinusFifteenOfTheLargestCoordinate) {
  for (float length : {0.0f, 1e-44f, 1e-20f, 1.0f, 12345.0f, 1e30f}) {
    Rng rng(2, Stage::test, 31, std::bit_cast<std::uint32_t>(length));
    std::vector<float> point(50), back(50);
    std::vector<std::int16_t> units(50);
    float max_value = 0;
    for (float& v : point) {
      v = length * static_cast<float>(rng.next_gaussian());
      max_value = std::max(max_value, std::abs(v));
    }
    const float unit = pack_point(point, units.data());
    PointReader(Points{nullptr, 1, 50, units.data(), &unit}).read(0, back.data());
    // Numbers without an inverse are in units of the least normal one.
    const float bound = std::max(max_value * 0x1p-15f, 0x1p-127f);
    for (std::size_t d = 0; d < 50; ++d) EXPECT_LE(std::abs(back[d] - point[d]), bound * (1 + 0x1p-20f));
  }
}

TEST(SampledRows, KeepEntriesInAnyNumberOfBlocks) {
  const std::size_t n = 5000, rows = 37;
  SampledRows sampled(n);
  std::vector<std::vector<float>> all(rows, std::vector<float>(n));
  for (std::size_t i = 0; i < rows; ++i) {
    Rng rng(3, Stage::test, 32, i);
    // Six decades, and one entry in four is 0.
    for (float& v : all[i]) v = rng.next_float() < 0.25f ? 0.0f : std::pow(10.0f, 6 * rng.next_float() - 3);
    sampled.add(all[i]);
  }
  ASSERT_EQ(sampled.size(), rows);
  ASSERT_EQ(sampled.blocks(), 3u);
  float out[SampledRows::kBlockRows];
  for (std::size_t j = 0; j < n; j += 7)
    for (std::size_t i = 0; i < 48; ++i) {
      sampled.read(i / 16, j, out);
      const float expected = i < rows ? all[i][j] : 0.0f;
      EXPECT_LE(std::abs(out[i % 16] - expected), 0x1p-12f * expected * (1 + 0x1p-20f)) << i << " " << j;
    }
}

// A matrix as rendering makes them: smooth products, random visibility, a few bright entries.
struct Made {
  std::size_t rows, columns;
  std::vector<float> entries;  // columns × rows
  PointCloud cloud() const { return {rows, entries}; }
};
Made made_matrix(std::size_t rows, std::size_t columns, std::uint64_t seed) {
  Made m{rows, columns, std::vector<float>(rows * columns)};
  for (std::size_t j = 0; j < columns; ++j) {
    Rng column(seed, Stage::test, 33, j);
    const float x = column.next_float(), power = std::pow(30.0f, column.next_float());
    for (std::size_t i = 0; i < rows; ++i) {
      Rng entry(seed, Stage::test, 34, j * rows + i);
      const float y = (static_cast<float>(i) + 0.5f) / static_cast<float>(rows);
      const float near = 1 / (0.01f + (x - y) * (x - y));
      const bool seen = std::sin(40 * (x + y)) > -0.5f || entry.next_float() < 0.1f;
      m.entries[j * rows + i] = seen ? power * near : 0.0f;
    }
  }
  return m;
}

// The projection of ColumnSketch in single precision and all at once.
PointCloud projected(const Made& m, std::size_t dimension, std::uint64_t seed) {
  std::vector<float> gaussian(m.rows * dimension);
  for (std::size_t i = 0; i < m.rows; ++i) {
    Rng rng(seed, Stage::projection, i);
    for (std::size_t d = 0; d < dimension; ++d)
      gaussian[i * dimension + d] =
          static_cast<float>(rng.next_gaussian() / std::sqrt(static_cast<double>(dimension)));
  }
  PointCloud cloud{dimension, std::vector<float>(m.columns * dimension)};
  gemm({m.columns, dimension, m.rows}, m.entries.data(), m.rows, gaussian.data(), dimension,
       cloud.values.data(), dimension);
  return cloud;
}

// Row by row as a sketch takes them, the entry in one channel, so that it is the scalar.
ColumnSketch sketched(const Made& m, std::size_t dimension, std::uint64_t seed) {
  ColumnSketch sketch({m.columns, dimension}, seed);
  std::vector<float> values(m.columns * 3, 0.0f);
  for (std::size_t i = 0; i < m.rows; ++i) {
    for (std::size_t j = 0; j < m.columns; ++j) values[j * 3 + 1] = m.entries[j * m.rows + i];
    sketch.add_row(i, 1, values);
  }
  return sketch;
}

// Waiting costs a row 2⁻¹² of each entry, and each of the 4 flushes of 100 rows at most 2⁻¹⁵ of the largest
// coordinate: together below 2⁻¹² + 4·√50·2⁻¹⁵ of a column's projected length, √(r'/r') of its true one times
// a factor of the projection, which stays below 2. Everything else is rounding of single precision.
TEST(PackedPoints, SketchesAreThoseOfSinglePrecisionWithinRounding) {
  const Made m = made_matrix(100, 500, 4);
  const PointCloud floats = projected(m, 50, 9);
  ColumnSketch sketch = sketched(m, 50, 9);
  PointReader reader(sketch.points());
  for (std::size_t j = 0; j < m.columns; ++j) {
    double difference = 0;
    const auto x = reader[j];
    for (std::size_t d = 0; d < 50; ++d)
      difference += std::pow(static_cast<double>(x[d]) - static_cast<double>(floats[j][d]), 2);
    EXPECT_LT(std::sqrt(difference),
              2 * (0x1p-12 + 4 * std::sqrt(50.0) * 0x1p-15) * static_cast<double>(sketch.norm(j)));
  }
}

// The expected squared error of the estimate, computed from all entries, of clusterings by 16-bit points over
// that of clusterings by single precision, the same seeds: less than 2 % more in the mean. One-sided t-test
// over 40 seeds at 99.9 %; it fails if the mean is not shown to be below.
TEST(PackedPoints, ClusteringsCostNoMoreThanThoseOfSinglePrecision) {
  const Made m = made_matrix(120, 1500, 5);
  const PointCloud truth = m.cloud();
  const auto true_norms = own_norms(truth.points());
  const auto all = all_of(truth);
  std::vector<double> logarithms(40);
  parallel_for(logarithms.size(), 1, [&](std::size_t k, std::size_t) {
    const std::uint64_t seed = 100 + k;
    const ClusteringSettings settings{ClusteringAlgorithm::combined, 60, seed};
    const PointCloud floats = projected(m, 50, seed);
    ColumnSketch sketch = sketched(m, 50, seed);
    const auto cost = [&](const Points& points) {
      const auto norms = own_norms(points);
      return total_cost(truth.points(), true_norms, cluster(points, norms, all, {}, settings).partition());
    };
    logarithms[k] = std::log(cost(sketch.points()) / cost(floats.points()));
  });
  const auto m_log = lumirank::test::mean_of(logarithms);
  const double t = lumirank::test::student_quantile(0.002, 1, 39);
  EXPECT_LT(m_log.mean + t * m_log.standard_error, std::log(1.02))
      << m_log.mean << " ± " << m_log.standard_error;
  RecordProperty("log_ratio", std::to_string(m_log.mean));
}

// Memory per column of a wide matrix: 2·50 bytes of coordinates, 4 of their unit, 12 of norms; while rows
// arrive 2·32 for those that wait, and a scale for every 2,048 columns and waiting row.
TEST(PackedPoints, MemoryOfASketch) {
  const std::size_t n = 10 * 2048, scales = 10 * 32 * 4;
  ColumnSketch sketch({n, 50}, 1);
  sketch.add_row(0, 1, std::vector<float>(n * 3, 1.0f));
  EXPECT_EQ(sketch.memory_bytes(), n * (100 + 4 + 12 + 64) + scales);
  sketch.points();
  EXPECT_EQ(sketch.memory_bytes(), n * (100 + 4 + 12) + scales);
}

}  // namespace
}  // namespace lumirank::linalg
