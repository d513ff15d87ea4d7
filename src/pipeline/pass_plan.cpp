#include "pipeline/pass_plan.h"

#include <algorithm>
#include <cmath>

namespace lumirank::pipeline {
namespace {

// Sizes of passes in eighths: a smaller one is not worth its receivers, a larger one not its lights.
// Of interleaved pixels, neighbors do not share lights, and a large pass for each is as good as two small
// ones.
constexpr int kMinOfFirst = 3, kMin = 2, kMaxOfAllPixels = 12;
// How often all pixels shall be shown: halves tell the noise. But two passes that are larger are better than
// three below this size, and one of interleaved pixels is better than two.
constexpr int kWantedRounds = 3, kMinOfThree = 4, kMinInterleaved = 6;
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

int PassPlan::eighths_of(int passes, double seconds) const {
  const double most = parts_ > 1 ? kMax : kMaxOfAllPixels;
  return static_cast<int>(std::floor(std::clamp((seconds / passes - fixed_) / per_eighth_, 0.0, most)));
}

int PassPlan::passes_wanted(double left) const {
  const int fitting = static_cast<int>(std::clamp(std::round(left / whole()), 1.0, 65536.0));
  if (passes_ + fitting >= kWantedRounds * parts_) return fitting;
  for (int rounds = kWantedRounds; rounds > 1; --rounds) {
    const int passes = rounds * parts_ - passes_;
    int least = parts_ > 1 ? kMinInterleaved : rounds == kWantedRounds ? kMinOfThree : kMinOfFirst;
    if (rounds < kWantedRounds && every_pixel_is_shown()) least = kMin;
    if (passes > 0 && eighths_of(passes, left) >= least) return passes;
  }
  return every_pixel_is_shown() ? fitting : parts_ - passes_;
}

int PassPlan::next(double left) const {
  if (!resizes_) return !every_pixel_is_shown() || whole() < left ? kWhole : 0;
  const double planned = kPlanned * left;
  int passes = passes_wanted(planned);
  while (every_pixel_is_shown() && passes > 1 && eighths_of(passes, planned) < kMin) --passes;
  const int eighths = eighths_of(passes, planned);
  if (!every_pixel_is_shown()) return std::max(kMinOfFirst, eighths);
  return eighths >= kMin ? eighths : 0;
}

}  // namespace lumirank::pipeline
