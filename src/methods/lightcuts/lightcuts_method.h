// The method itself, for those that differ from it by their settings.
#pragma once

#include "methods/method.h"

namespace lumirank::methods {

enum class Reconstruction { on, off };

struct LightcutsSettings {
  double error_bound = 0.02;
  std::size_t max_nodes = 1000;
  Reconstruction reconstruction = Reconstruction::on;
  double interpolation_tolerance = 0.005;
  double similarity = 0.95;
};

class Lightcuts final : public Method {
 public:
  explicit Lightcuts(const LightcutsSettings& settings) : settings_(settings) {}
  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override;

 private:
  LightcutsSettings settings_;
};

}  // namespace lumirank::methods
