// Completion of visibility: on matrices whose visibility is known, from how many rays, and with which errors.
#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "matrix/entry_reader.h"
#include "matrix/metered_matrix.h"
#include "matrix/synthetic.h"
#include "methods/common/column_pass.h"
#include "methods/common/slices/slices.h"
#include "methods/method.h"
#include "methods/visibility_completion/completion.h"

namespace lumirank::methods {
namespace {

using Settings = std::map<std::string, std::string>;
constexpr std::size_t kSquareSide = 32, kReceivers = kSquareSide * kSquareSide, kShadows = 130;

// A square of 32×32 receivers, and for each column an edge of a shadow, at a random place and angle.
matrix::DenseMatrix shadow_matrix() {
  std::vector<float> visible(kReceivers * kShadows);
  for (std::size_t j = 0; j < kShadows; ++j) {
    Rng rng(1, Stage::test, 60, j);
    const float angle = 2 * kPi * rng.next_float(), offset = rng.next_float() - 0.5f;
    for (std::size_t i = 0; i < kReceivers; ++i) {
      const float x = (static_cast<float>(i % kSquareSide) + 0.5f) / kSquareSide - 0.5f;
      const float y = (static_cast<float>(i / kSquareSide) + 0.5f) / kSquareSide - 0.5f;
      visible[i * kShadows + j] = x * std::cos(angle) + y * std::sin(angle) < offset;
    }
  }
  matrix::DenseMatrix m(kReceivers, kShadows, std::vector<Rgb>(kReceivers * kShadows, Rgb(1)),
                        std::move(visible));
  for (std::size_t i = 0; i < kReceivers; ++i) {
    m.row_position.push_back({static_cast<float>(i % kSquareSide), static_cast<float>(i / kSquareSide), 0});
    m.row_normal.push_back({0, 0, 1});
  }
  m.power.assign(kShadows, 1.0f);
  return m;
}

struct Completed {
  double sampled, wrong;  // shares of all entries
  Completion::Counts counts;
};

template <typename Complete>
Completed complete_by(const matrix::DenseMatrix& m, Complete&& how) {
  const matrix::MeteredMatrix metered(m);
  const auto reader = metered.reader();
  Completion completion(*reader);
  const SlicePoints points(m.row_features(), m.rows());
  std::vector<matrix::Index> rows, columns;
  std::vector<linalg::NestedLevels::Point> places;
  for (matrix::Index i = 0; i < m.rows(); ++i) rows.push_back(i), places.push_back(points[i]);
  for (matrix::Index j = 0; j < m.columns(); ++j) columns.push_back(j);
  reader->set_rows(rows);
  how(completion, Completion::Slice{rows, places, columns, 7});
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < m.rows(); ++i)
    for (std::size_t j = 0; j < m.columns(); ++j)
      wrong += completion.visible(i, j) != (m.at(i, j, matrix::Part::visibility).r > 0);
  const double all = static_cast<double>(m.rows() * m.columns());
  EXPECT_EQ(completion.counts().sampled, metered.total().entries);
  return {static_cast<double>(completion.counts().sampled) / all, static_cast<double>(wrong) / all,
          completion.counts()};
}

// A random line meets at most 2·32 of the squares between 32×32 receivers. On a level of spacing s a receiver
// may have neighbors that differ only if the line passes within 2s of it: 4s/32 of the level's receivers.
// With s = 4, 2.8, 2, 1.4 and levels of 1/16, 1/8, 1/4, 1/2 of all, and the coarsest 1/16, that is at most
// 1/16 + 4/32·(4/16 + 2.8/8 + 2/4 + 1.4/2) = 0.29. What is filled in wrongly lies on the wrong side of the
// line by less than the last spacing.
TEST(Completion, FollowsTheEdgesOfShadows) {
  const auto m = shadow_matrix();
  const Completed c = complete_by(m, [](Completion& completion, const Completion::Slice& slice) {
    completion.complete(slice, {16, 0.0});
  });
  EXPECT_LT(c.sampled, 0.29);
  EXPECT_LT(c.wrong, 0.02);
  EXPECT_EQ(c.counts.checks, 0u);
}

TEST(Completion, ChecksCostWhatTheySayAndCorrect) {
  const auto m = shadow_matrix();
  const auto with = [&](double checks) {
    return complete_by(shadow_matrix(), [&](Completion& completion, const Completion::Slice& slice) {
      completion.complete(slice, {16, checks});
    });
  };
  EXPECT_LE(with(0.2).wrong, with(0.0).wrong);
  const Completed all = with(1.0);
  EXPECT_EQ(all.sampled, 1.0);
  EXPECT_EQ(all.wrong, 0.0);
}

double error(const matrix::DenseMatrix& m, Settings settings) {
  RunOptions options;
  settings["slice-rows"] = "256";
  return relative_l1_difference(find_method("visibility-completion").make(settings)->run(m, options).sums,
                                m.exact_sums());
}

TEST(VisibilityCompletion, ConvergesToAllColumns) {
  const auto m = shadow_matrix();
  // All columns, so that only visibility is uncertain; then also all rays. Sums of 130 entries in floats.
  const Settings all{{"columns", "130"}};
  Settings more = all, exact = all;
  more["checks"] = "0.3", exact["checks"] = "1";
  EXPECT_LT(error(m, all), 0.05);
  EXPECT_LE(error(m, more), error(m, all));
  EXPECT_LT(error(m, exact), 130 * 0x1p-24);
  EXPECT_GT(error(m, {{"columns", "20"}}), error(m, all));
}

}  // namespace
}  // namespace lumirank::methods
