// A method that needs what a matrix does not tell refuses it in plain words before it runs; all others run.
#include <gtest/gtest.h>

#include "base/error.h"
#include "matrix/metered_matrix.h"
#include "matrix/synthetic.h"
#include "methods/common/column_pass.h"
#include "methods/method.h"

namespace lumirank::methods {
namespace {

using matrix::Ability;
using matrix::Capabilities;

class WithoutBounds final : public matrix::DenseMatrix {
 public:
  explicit WithoutBounds(matrix::DenseMatrix&& m) : DenseMatrix(std::move(m)) {}
  Capabilities capabilities() const override {
    return DenseMatrix::capabilities().without({Ability::bounds});
  }
  matrix::ColumnSet column_set(matrix::Index j) const override { return LightingMatrix::column_set(j); }
  std::unique_ptr<matrix::RowBounds> row_bounds() const override { return LightingMatrix::row_bounds(); }
};

// Runs every method: those that do not need `lacks` give sums, the others say what it is and who does
// without, and evaluate nothing.
void expect_refused_where_needed(const matrix::LightingMatrix& m, Ability lacks, const std::string& words) {
  ASSERT_FALSE(m.capabilities().has(lacks));
  std::size_t refused = 0;
  for (const MethodInfo& info : all_methods()) {
    const matrix::MeteredMatrix metered(m);
    if (!info.contract.needs.has(lacks)) {
      EXPECT_EQ(info.make({})->run(metered, {}).sums.size(), m.rows()) << info.name;
      continue;
    }
    ++refused;
    try {
      info.make({})->run(metered, {});
      ADD_FAILURE() << info.name << " ran";
    } catch (const InputError& e) {
      const std::string text = e.what();
      for (const std::string& part : {info.name, words, std::string("brute-force")})
        EXPECT_NE(text.find(part), std::string::npos) << text;
    }
    EXPECT_EQ(metered.total().entries, 0u) << info.name;
  }
  EXPECT_GT(refused, 0u);
  EXPECT_LT(refused, all_methods().size());
}

TEST(Capabilities, MethodsThatRefineByBoundsRefuseAMatrixWithout) {
  const WithoutBounds m(matrix::low_rank_matrix({300, 400, 1}, 5));
  EXPECT_THROW(m.column_set(0), InternalError);
  EXPECT_THROW(m.row_bounds(), InternalError);
  expect_refused_where_needed(m, Ability::bounds, "bounds");
  for (const char* name :
       {"lightcuts", "multidimensional-lightcuts", "stochastic-lightcuts", "slice-cuts", "sampling-recovery"})
    EXPECT_TRUE(find_method(name).contract.needs.has(Ability::bounds)) << name;
}

TEST(Capabilities, MethodsThatRecoverVisibilitiesRefuseFog) {
  const auto m = matrix::hazy_matrix({300, 400, 1});
  expect_refused_where_needed(m, Ability::binary_visibility, "partly");
  for (const char* name : {"visibility-completion", "sampling-recovery"})
    EXPECT_TRUE(find_method(name).contract.needs.has(Ability::binary_visibility)) << name;
}

// What the others make of fog, of 0.14 to 1 at random from entry to entry, is right: the same but for the
// order of the sum where all columns are summed, within a tenth where some stand for others.
TEST(Capabilities, OthersSumFog) {
  const auto m = matrix::hazy_matrix({300, 400, 1});
  const auto exact = m.exact_sums();
  const auto error = [&](const char* name, const std::map<std::string, std::string>& settings) {
    return relative_l1_difference(find_method(name).make(settings)->run(m, {}).sums, exact);
  };
  EXPECT_LT(error("brute-force", {}), 400 * 0x1p-24);
  EXPECT_LT(error("lightcuts", {}), 0.1);
  EXPECT_LT(error("slice-cuts", {}), 0.1);
  EXPECT_LT(error("power-sampling", {}), 0.1);
}

TEST(Capabilities, NoMethodNeedsWhatAPlainMatrixLacks) {
  const auto plain = matrix::clustered_matrix({300, 400, 1}, 5);  // has pixels and powers alone
  for (const MethodInfo& info : all_methods())
    EXPECT_NO_THROW(require_capabilities(info, plain.capabilities())) << info.name;
}

}  // namespace
}  // namespace lumirank::methods
