// A method whose estimate is one sum of columns says of which: that sum splits a picture by light.
#include <gtest/gtest.h>

#include <atomic>
#include <set>

#include "matrix/synthetic.h"
#include "methods/common/column_pass.h"
#include "methods/method.h"
#include "methods/method_names.h"

namespace lumirank::methods {
namespace {

// All entries are positive, so n additions in single precision in two orders differ by less than 2·n·2⁻²⁴
// relative; n is the number of columns, met at most once in each of up to five passes.
void expect_same_sums(const matrix::LightingMatrix& m, const Estimate& e, const char* what) {
  ASSERT_FALSE(e.combination.empty()) << what;
  std::vector<Rgb> sums(m.rows());
  m.accumulate(e.combination, sums);
  const double allowed = 2 * 5 * static_cast<double>(m.columns()) / (1 << 24);
  EXPECT_LT(relative_difference(sums, e.sums), allowed) << what;
}

class Combination : public testing::TestWithParam<std::string> {};

TEST_P(Combination, ItsColumnsGiveTheSums) {
  const auto m = matrix::sparse_matrix({600, 900, 1}, 0.3);
  const auto method = find_method(GetParam()).make({});
  RunOptions options;
  expect_same_sums(m, method->run(m, options), "by default");
  options.target_error = 0.02;  // several rounds or passes
  expect_same_sums(m, method->run(m, options), "with a target");
}

TEST_P(Combination, AlsoOfAPartThatWasCutShort) {
  const auto m = matrix::sparse_matrix({600, 900, 1}, 0.3);
  std::atomic<bool> cancel{false};
  RunOptions options;
  options.sinks.cancel = &cancel;
  options.on_estimate = [&](std::span<const Rgb>) { cancel = true; };  // after the first block of columns
  const Estimate e = find_method(GetParam()).make({})->run(m, options);
  EXPECT_TRUE(e.interrupted);
  expect_same_sums(m, e, "cut short");
}

// Columns of their own for receivers, pixels or slices: no one sum.
const std::set<std::string> kLocal{
    "adaptive-lightslice",         "column-completion",    "lightcuts",
    "row-guided-sampling",         "lightslice",           "multidimensional-lightcuts",
    "sampling-recovery",           "slice-cuts",           "stochastic-lightcuts",
    "scalable-virtual-ray-lights", "visibility-completion"};

std::vector<std::string> names_with_a_combination() {
  std::vector<std::string> n;
  for (const MethodInfo& m : all_methods())
    if (!kLocal.contains(m.name)) n.push_back(m.name);
  return n;
}

// A picture is refused before it is made where a layer takes what the method does not have.
TEST(LocalMethods, EveryMethodSaysWhetherItHasOne) {
  for (const MethodInfo& m : all_methods())
    EXPECT_EQ(m.contract.combination, !kLocal.contains(m.name)) << m.name;
}

TEST(LocalMethods, CombinationIsLeftEmptyWhereColumnsDifferFromRowToRow) {
  const auto m = matrix::sparse_matrix({600, 900, 1}, 0.3);
  for (const std::string& name : kLocal)
    EXPECT_TRUE(find_method(name).make({})->run(m, {}).combination.empty()) << name;
}

INSTANTIATE_TEST_SUITE_P(Methods, Combination, testing::ValuesIn(names_with_a_combination()),
                         test::name_of_test);

}  // namespace
}  // namespace lumirank::methods
