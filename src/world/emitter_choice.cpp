#include "world/emitter_choice.h"

#include <algorithm>
#include <variant>

namespace lumirank::world {
namespace {

constexpr double kMinOfGroup = 0.25, kEvenPart = 0.1;

bool is_far(const emitters::Emitter& e) {
  return std::holds_alternative<emitters::DirectionalEmitter>(e.kind) ||
         std::holds_alternative<emitters::EnvironmentEmitter>(e.kind);
}

}  // namespace

EmitterChoice::EmitterChoice(const World& world) {
  std::vector<double> weights;
  std::vector<bool> far;
  double total[2] = {0, 0};
  const float radius = world.bounds().radius();
  for (std::size_t e = 0; e < world.emitters().size(); ++e) {
    const double power = mean(emitters::power(world.emitters()[e], radius));
    if (!(power > 0)) continue;
    emitters_.push_back(static_cast<int>(e));
    weights.push_back(power);
    far.push_back(is_far(world.emitters()[e]));
    total[far.back() ? 1 : 0] += power;
  }
  if (emitters_.empty()) return;
  double share[2] = {total[0] / (total[0] + total[1]), total[1] / (total[0] + total[1])};
  if (total[0] > 0 && total[1] > 0) {
    share[1] = std::clamp(share[1], kMinOfGroup, 1 - kMinOfGroup);
    share[0] = 1 - share[1];
  }
  cdf_.push_back(0);
  const double even = kEvenPart / static_cast<double>(weights.size());
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const int group = far[k] ? 1 : 0;
    cdf_.push_back(cdf_.back() + (1 - kEvenPart) * share[group] * weights[k] / total[group] + even);
  }
  for (double& c : cdf_) c /= cdf_.back();
}

EmitterChoice::Drawn EmitterChoice::draw(double u) const {
  const auto above = std::upper_bound(cdf_.begin() + 1, cdf_.end() - 1, u);
  const auto k = static_cast<std::size_t>(above - cdf_.begin()) - 1;
  const double p = probability(k);
  const auto remapped = static_cast<float>(std::clamp((u - cdf_[k]) / p, 0.0, 1.0));
  return {emitters_[k], p, std::min(remapped, 0x1.fffffep-1f)};
}

}  // namespace lumirank::world
