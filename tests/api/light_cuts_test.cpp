// Light cuts on the matrices of scenes, whose bounds come from geometry and materials.
#include <gtest/gtest.h>

#include <cstring>

#include "api/scene.h"
#include "api/whole_renders.h"
#include "lumirank/lumirank.h"
#include "methods/common/column_pass.h"
#include "methods/common/row_group_pass.h"
#include "methods/unbiasedness.h"
#include "pipeline/prepared.h"

namespace lumirank {
namespace {

// 300 lights in an example scene, seen by 24×16 pixels of two samples.
class LightCutsInScenes : public testing::TestWithParam<const char*> {
 protected:
  LightCutsInScenes() : scene_(test::example(GetParam())) {
    settings_.view.width = 24, settings_.view.height = 16, settings_.view.spp = 2;
    std::vector<scenedesc::Warning> warnings;
    world_ = std::make_unique<world::World>(world::World::build(scene_.impl().desc, {}, warnings));
    const world::View view = pipeline::make_view(scene_.impl().desc, settings_.view);
    const pipeline::Recipe recipe = pipeline::make_recipe(settings_, view);
    rows_ = pipeline::matrix_rows(pipeline::trace_rows(*world_, view, recipe, {}), recipe);
    transport::LightSettings ls;
    ls.seed = 1, ls.count = 300, ls.max_depth = view.max_depth;
    lights_ = transport::trace_virtual_lights(*world_, ls);
    transport::SceneMatrixSettings ms;
    ms.max_depth = view.max_depth;
    matrix_ = std::make_unique<transport::SceneMatrix>(*world_, *rows_, lights_, ms);
  }

  std::vector<Rgb> sums(const char* method, const std::map<std::string, std::string>& settings = {}) const {
    return methods::find_method(method).make(settings)->run(*matrix_, {}).sums;
  }
  // What the picture shows of them.
  std::vector<Rgb> pixels(std::span<const Rgb> sums) const {
    const auto weight = matrix_->row_features().weight;
    const methods::RowGroups units = methods::RowGroups::pixels(*matrix_);
    std::vector<Rgb> out(units.size());
    for (std::size_t u = 0; u < units.size(); ++u)
      for (const matrix::Index i : units[u]) out[u] += sums[i] * weight[i];
    return out;
  }

  Scene scene_;
  RenderSettings settings_;
  std::unique_ptr<world::World> world_;
  pipeline::SharedRows rows_;
  transport::VirtualLights lights_;
  std::unique_ptr<transport::SceneMatrix> matrix_;
};

TEST_P(LightCutsInScenes, WithoutBoundAndLimitEqualBruteForce) {
  const auto truth = sums("brute-force");
  // Sums of 300 floats in another order; what a bound of 0 leaves out is 0.
  EXPECT_LT(
      methods::relative_difference(
          sums("lightcuts", {{"error-bound", "0"}, {"max-nodes", "1000000"}, {"reconstruction", "off"}}),
          truth),
      1e-6);
  EXPECT_LT(methods::relative_difference(
                pixels(sums("multidimensional-lightcuts", {{"error-bound", "0"}, {"max-pairs", "1000000"}})),
                pixels(truth)),
            1e-6);
}

TEST_P(LightCutsInScenes, StochasticOnesAreUnbiased) {
  const auto truth = sums("brute-force");
  EXPECT_LT(methods::relative_difference(sums("stochastic-lightcuts", {{"nodes", "1000000"}}), truth), 1e-6);
  // 11 two-sided t-tests at a joint confidence of 99.9 %.
  using SettingsMap = std::map<std::string, std::string>;
  const SettingsMap fixed{{"nodes", "10"}}, bounded{{"nodes", "60"}, {"error-bound", "0.1"}};
  for (const SettingsMap& some : {fixed, bounded}) {
    methods::test::UnbiasednessTest t(truth, 10);
    const auto method = methods::find_method("stochastic-lightcuts").make(some);
    for (std::uint64_t seed = 1; seed <= methods::test::runs(150); ++seed) {
      methods::RunOptions options;
      options.seed = seed;
      t.add(method->run(*matrix_, options).sums);
    }
    EXPECT_LT(t.max_t(), t.limit());
  }
}

// A cut's nodes are each below a share of the total, so the smaller the share the smaller the error.
TEST_P(LightCutsInScenes, ErrorFallsWithTheBound) {
  const auto truth = pixels(sums("brute-force"));
  for (const char* method : {"lightcuts", "multidimensional-lightcuts"}) {
    std::vector<double> errors;
    for (const char* bound : {"0.2", "0.02", "0.0005"})
      errors.push_back(methods::relative_l1_difference(
          pixels(sums(method, {{"error-bound", bound},
                               {method[0] == 'l' ? "reconstruction" : "max-pairs",
                                method[0] == 'l' ? "off" : "100000"}})),
          truth));
    EXPECT_GT(errors[0], errors[1]) << method;
    EXPECT_GT(errors[1], errors[2]) << method;
  }
}

INSTANTIATE_TEST_SUITE_P(Examples, LightCutsInScenes, testing::Values("box.xml", "interior.xml"),
                         [](const auto& p) { return std::string(p.param, std::strchr(p.param, '.')); });

}  // namespace
}  // namespace lumirank
