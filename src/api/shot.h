// A shot that is being made: what the ways to make its frames have in common (shot_frames.h, shot_tensor.h).
#pragma once

#include "api/shot_folder.h"
#include "lumirank/animate.h"

namespace lumirank::api {

struct ShotRange {
  int first, last;          // frames that are asked for
  int first_key, last_key;  // of the motion
};

struct Shot {
  const Scene& scene;
  const AnimateSettings& settings;
  ShotRange range;
  ShotFolder folder;

  Scene at(int frame, const Sinks& sinks = {}) const {
    return scene.at(frame / settings.frames_per_second, sinks);
  }
};

}  // namespace lumirank::api
