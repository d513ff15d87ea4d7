#include "methods/row_column/blend.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace lumirank::methods {

namespace {
constexpr std::size_t kBlendGrain = 16384;
// An expected error of 0 is not to be believed: rounding alone is larger.
double precision_of(double error) { return 1.0 / std::max(error * error, 1e-14); }
}  // namespace

double Blend::share_of(double expected_error) const {
  const double p = precision_of(expected_error);
  return p / (p + precision_);
}

double Blend::expected_error() const { return precision_ > 0 ? 1.0 / std::sqrt(precision_) : 0.0; }

std::vector<Rgb> Blend::with(std::span<const Rgb> sums, double expected_error) const {
  std::vector<Rgb> out(sums.begin(), sums.end());
  if (empty()) return out;
  const auto share = static_cast<float>(share_of(expected_error));
  parallel_for(out.size(), kBlendGrain, [&](std::size_t b, std::size_t e) {
    for (std::size_t i = b; i < e; ++i) out[i] = lerp(sums_[i], sums[i], share);
  });
  return out;
}

void Blend::add(std::span<const Rgb> sums, double expected_error) {
  std::vector<Rgb> next = with(sums, expected_error);
  if (!empty()) {
    disagreement_.resize(sums.size());
    parallel_for(sums.size(), kBlendGrain, [&](std::size_t b, std::size_t e) {
      for (std::size_t i = b; i < e; ++i) {
        const float d = norm2(sums[i] - sums_[i]);
        disagreement_[i] = d * d;
      }
    });
  }
  sums_ = std::move(next);
  precision_ += precision_of(expected_error);
}

}  // namespace lumirank::methods
