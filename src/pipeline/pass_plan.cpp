#include "pipeline/pass_plan.h"

#include <algorithm>
#include <cmath>

namespace lumirank::pipeline {
namespace {

// Sizes of passes in eighths: a smaller one is not worth its receivers, a larger one not its lights.
constexpr int kMinOfFirst = 3, kMin = 2, kMax = 12;
// Passes that there shall be: their halves tell the noise. But two that are larger are better than three
// below this size.
constexpr int kWantedPasses = 3, kMinOfThree = 4;
// Of what is left a pass is planned for, since no two take the same time.
constexpr double kPlanned = 0.98;
constexpr double kLeastSeconds = 1e-3;
// What earlier passes count beside the last one: the first takes longer than all others.
constexpr double kKept = 0.4;

}  // namespace

void PassPlan::expect(double fixed, double per_eighth) {
  fixed_ = std::max(kLeastSeconds, fixed), per_eighth_ = std::max(kLeastSeconds / kWhole, per_eighth);
}

void PassPlan::took(int eighths, double seconds, double drawing) {
  ++passes_;
  for (double* sum : {&weight_, &eighths_, &seconds_, &drawing_}) *sum *= kKept;
  weight_ += 1, eighths_ += eighths, seconds_ += seconds, drawing_ += drawing;
  expect((seconds_ - drawing_) / weight_, drawing_ / eighths_);
}

int PassPlan::next(double left) const {
  const bool first = passes_ == 0;
  if (!resizes_) return first || whole() < left ? kWhole : 0;
  const double planned = kPlanned * left;
  const auto in_one_of = [&](int passes) {
    return static_cast<int>(
        std::floor(std::clamp((planned / passes - fixed_) / per_eighth_, 0.0, 1.0 * kMax)));
  };
  const int least = first ? kMinOfFirst : kMin;
  int passes = static_cast<int>(std::clamp(std::round(planned / whole()), 1.0, 65536.0));
  passes = std::max(passes, kWantedPasses - passes_);
  while (passes > 1 && in_one_of(passes) < (passes_ + passes < kWantedPasses ? least : kMinOfThree)) --passes;
  const int eighths = in_one_of(passes);
  if (eighths >= least) return eighths;
  return first ? kMinOfFirst : 0;
}

}  // namespace lumirank::pipeline
