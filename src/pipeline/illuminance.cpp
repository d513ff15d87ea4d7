#include "pipeline/illuminance.h"

#include <algorithm>

#include "base/error.h"
#include "base/timer.h"

namespace lumirank::pipeline {

bool wants_illuminance(const RenderSettings& settings) {
  return std::find(settings.aovs.begin(), settings.aovs.end(), "illuminance") != settings.aovs.end();
}

std::optional<image::Image> render_illuminance(Setup& setup, const RenderSettings& settings,
                                               const methods::Method& method, const methods::RunOptions& run,
                                               double lumens_per_unit) {
  const Timer timer;
  const transport::Receivers white = transport::white_receivers(setup.receivers);
  transport::SceneMatrixSettings ms = matrix_settings(setup, settings);
  ms.traced_direct_below = 0;  // nothing is glossy here
  ms.group_by_emitter = false;
  methods::Estimate estimate;
  try {
    const transport::SceneMatrix matrix(*setup.world, white, setup.lights, ms);
    estimate = method.run(matrix, run);
  } catch (const Cancelled&) {
    return std::nullopt;
  }
  if (estimate.interrupted) return std::nullopt;
  std::vector<Rgb> lux(white.samples());
  const double factor = 3.14159265358979323846 * lumens_per_unit;
  for (std::size_t i = 0; i < white.size(); ++i)
    lux[white.sample[i]] = Rgb(static_cast<float>(factor * luminance(estimate.sums[i])));
  setup.seconds["illuminance"] = timer.seconds();
  return develop(setup, lux);
}

}  // namespace lumirank::pipeline
