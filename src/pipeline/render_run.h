// One render of a world that is built: from the plan of its time to the picture and its report.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/timer.h"
#include "lumirank/lumirank.h"
#include "methods/method.h"
#include "pipeline/light_path_pilot.h"
#include "pipeline/pixel_features.h"
#include "pipeline/prepared.h"

namespace lumirank::pipeline {

struct RenderTask {
  SharedWorld world;
  View view;
  const methods::MethodInfo* info = nullptr;
  std::unique_ptr<methods::Method> method;
  std::shared_ptr<const ShotLights> shot_lights;  // see Recipe; may be nullptr
  std::string why;                                // it is this method
  bool may_be_paths = false;                      // instead of passes, where they have less noise
  bool by_default = false;                        // nobody asked for it: a short time may choose another
  double lumens_per_unit = 1;
  Timer timer;  // since the scene began to be read
  double build_seconds = 0;
  // Of the passes or paths that a picture has by default, where neither time nor error says how many.
  double part_of_usual = 1;
  PictureFeatures* features = nullptr;  // told by passes and paths to who gives it
  double denoiser_pixel_seconds = 0;    // where it was tried out
  // Beside paths that carry all light, where that was found out.
  std::optional<LightPathPilot> light_paths = std::nullopt;
};

RenderResult run_render(RenderTask task, const RenderSettings& settings, const Sinks& sinks,
                        const PreviewCallback& on_preview);

}  // namespace lumirank::pipeline
