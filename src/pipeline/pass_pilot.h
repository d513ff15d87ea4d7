// What the passes of a budget are of. A pass of a small film tells what those of the whole one will take, and
// so whether paths alone are better, whether a film of half the size is, and whether each pass has some of
// the pixels.
#pragma once

#include <map>
#include <string>

#include "lumirank/settings.h"
#include "methods/common/timed_choices.h"
#include "pipeline/pass_picture.h"
#include "pipeline/pass_tracer.h"
#include "pipeline/render_run.h"

namespace lumirank::pipeline {

// Fewer than so many passes of the whole film tell little, and are of interleaved pixels or of a smaller
// film. Numbers of passes end before kMaxPasses; those from there on are the pilot's.
inline constexpr int kFewPasses = 4, kMaxPasses = 65536;
// How noisy a pass is (relative L1), before that is known.
inline constexpr double kNoiseOfPass = 0.5;

class PassPilot {
 public:
  // Adds to `seconds`, by stage. `view`: the film that was asked for. What is given by reference must outlive
  // this.
  PassPilot(const RenderTask& task, const View& view, const RenderSettings& settings, PassTracer& tracer,
            PassPicture& picture, const RestTracing& rest, methods::TimedChoices& choices,
            std::map<std::string, double>& seconds, const Sinks& sinks);

  // Tries a small film and decides; and decides as an earlier run did. Throws Cancelled.
  void run();
  void repeat();

  // Passes may have other numbers of lights, of which receivers draw as many fewer or more.
  bool resizes() const;
  bool paths_alone() const { return paths_alone_; }
  // Beside those, if they were tried.
  const std::optional<LightPathPilot>& light_paths() const { return light_paths_; }
  const View& view() const { return view_; }  // of the size that is rendered
  // Of a pass of all pixels, without the rest; what all takes with it, over that; what follows the first
  // pass; and the seconds of the budget by which that was foretold. 0: nothing was tried.
  const PassSeconds& expected() const { return expected_; }
  double with_rest() const;
  const std::string& shortage() const { return shortage_; }  // empty where the budget is not short

 private:
  double left() const;
  double expected_with_rest() const { return expected_.total() * with_rest(); }
  void make_smaller(int divisor);
  void choose_size(int at_least);
  double rounds_worth_a_pixel() const;
  double min_round_seconds() const;
  void interleave();
  bool may_interleave() const;
  bool too_few_fit(double times) const;
  bool is_dear() const;
  bool may_be_half(double one_feature);
  bool small_paths_are_better(const View& small, const image::Image& first, double shrunk);

  const RenderTask& task_;
  const RenderSettings& settings_;
  PassTracer& tracer_;
  PassPicture& picture_;
  const RestTracing& rest_;
  methods::TimedChoices& choices_;
  std::map<std::string, double>& seconds_;
  const Sinks& sinks_;
  View whole_, view_;
  PassSeconds expected_;
  double features_expected_ = 0;  // seconds of what is traced before the passes
  bool paths_alone_ = false;
  std::optional<LightPathPilot> light_paths_;
  std::string shortage_;
};

}  // namespace lumirank::pipeline
