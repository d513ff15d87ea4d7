#include "pipeline/compensation.h"

#include "base/random.h"
#include "pathtrace/reference.h"

namespace lumirank::pipeline {

bool compensate_clamping(const Prepared& prepared, const RenderSettings& settings, image::Image& image,
                         const Sinks& sinks) {
  // A reference with the same seed is independent of it.
  pathtrace::ReferenceOptions options = reference_options(
      settings.view.only, hash_ids(settings.seed, Stage::reference, 1), ReferencePaths::columns);
  options.carried = prepared.columns.carried;
  try {
    const auto traced = pathtrace::path_trace(*prepared.world, prepared.view, options,
                                              {.spp = settings.traced.compensate}, sinks);
    if (traced.interrupted) return false;
    for (std::size_t p = 0; p < traced.indirect.pixels.size(); ++p)
      image.pixels[p] += traced.indirect.pixels[p];
  } catch (const Cancelled&) {
    return false;
  }
  return true;
}

}  // namespace lumirank::pipeline
