#include "pipeline/noise_metric.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace lumirank::pipeline {
namespace {

// A picture of 2 whose halves are 0.4 apart: noise of 0.2 in every value.
TEST(NoiseMetric, IsTheErrorOfTheNoiseAlone) {
  const image::Image picture(16, 16, Rgb(2));
  const image::Image difference(16, 16, Rgb(0.4f));
  EXPECT_NEAR(noise_by(ErrorMetric::l1, picture, difference), 0.1, 1e-6);
  EXPECT_NEAR(noise_by(ErrorMetric::relmse, picture, difference), 0.01, 1e-5);
  const double flip = noise_by(ErrorMetric::flip, picture, difference);
  EXPECT_GT(flip, 0);
  EXPECT_LT(flip, noise_by(ErrorMetric::flip, picture, image::Image(16, 16, Rgb(0.8f))));
  for (const auto metric : {ErrorMetric::l1, ErrorMetric::relmse, ErrorMetric::flip})
    EXPECT_EQ(noise_by(metric, picture, image::Image(16, 16)), 0);
}

TEST(NoiseMetric, IsRefusedWhereNoEstimateHasIt) {
  MethodSettings method;
  EXPECT_NO_THROW(check_metric(method, false));
  method.error_metric = ErrorMetric::flip;
  EXPECT_THROW(check_metric(method, true), InputError);  // no target
  method.target_error = 0.1;
  EXPECT_NO_THROW(check_metric(method, true));
  EXPECT_THROW(check_metric(method, false), InputError);
}

}  // namespace
}  // namespace lumirank::pipeline
