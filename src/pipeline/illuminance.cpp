#include "pipeline/illuminance.h"

#include "base/error.h"
#include "pipeline/develop.h"

namespace lumirank::pipeline {

std::optional<image::Image> render_illuminance(const Prepared& prepared, const methods::Method& method,
                                               const methods::RunOptions& run, double lumens_per_unit) {
  const transport::Receivers white = transport::white_receivers(prepared.receivers());
  transport::SceneMatrixSettings ms = matrix_settings(prepared.recipe);
  ms.traced_direct_below = 0;  // nothing is glossy here
  ms.group_by_emitter = false;
  methods::Estimate estimate;
  try {
    const transport::SceneMatrix matrix(*prepared.world, white, prepared.lights(), ms);
    estimate = method.run(matrix, run);
  } catch (const Cancelled&) {
    return std::nullopt;
  }
  if (estimate.interrupted) return std::nullopt;
  std::vector<Rgb> lux(white.samples());
  const double factor = 3.14159265358979323846 * lumens_per_unit;
  for (std::size_t i = 0; i < white.size(); ++i)
    lux[white.sample[i]] = Rgb(static_cast<float>(factor * luminance(estimate.sums[i])));
  return develop(prepared.view, prepared.receivers(), lux);
}

}  // namespace lumirank::pipeline
