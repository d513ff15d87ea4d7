// What is chosen once for all frames of a shot under a time budget: passes or paths, how many of them, and of
// which size. Where each frame chooses by its own clock they differ in what they look like, and flicker.
#pragma once

#include <cstddef>

#include "api/render_in_shot.h"
#include "api/shot.h"

namespace lumirank::api {

class ShotChoices {
 public:
  // `shot` outlives it.
  explicit ShotChoices(const Shot& shot) : shot_(shot) {}

  // Takes what the clock chose for a frame that is finished, if there is one.
  void find_finished();

  // Whether passes or paths have less noise takes longer to find out than a frame may have, and is found once
  // for a shot of some length: of its middle, in as much time as some frames have.
  bool needs_pilot(std::size_t missing) const;
  void run_pilot(int frame, const InShot& in_shot, const Sinks& sinks);

  // Under a time budget the first frame chooses for all. A frame that is of another kind chooses anew.
  RenderResult render(int frame, RenderSettings settings, InShot in_shot, const Sinks& sinks);

 private:
  const Shot& shot_;
  decltype(RenderSettings::choices) choices_;
  InShot::Kind kind_ = InShot::Kind::open;
};

}  // namespace lumirank::api
