// Paths that carry all light may go on after the first passes, where they have less noise for their seconds:
// whether they do is tried on the picture itself.
#pragma once

#include <functional>
#include <optional>

#include "base/sinks.h"
#include "lumirank/settings.h"
#include "methods/common/timed_choices.h"
#include "pipeline/mixed_picture.h"
#include "pipeline/pass_picture.h"
#include "pipeline/paths_beside.h"
#include "pipeline/rest_tracing.h"
#include "world/world.h"

namespace lumirank::pipeline {

// They are tried after so many passes at least, if so many more would fit.
inline constexpr int kPassesBeforePaths = 2;
inline constexpr double kWorthATrial = 3;

class PathsAfterPasses {
 public:
  struct Passes {
    double seconds;  // of all so far
    int rounds;      // that show every pixel
  };
  // `left`: seconds of the budget; `shown`: after each portion of paths. What is given by reference must
  // outlive this.
  PathsAfterPasses(const world::World& world, const RenderSettings& settings, PassPicture& passes,
                   const RestTracing& rest, MixedPicture& picture, methods::TimedChoices& choices,
                   std::function<double()> left, std::function<void()> shown, const Sinks& sinks)
      : world_(world),
        settings_(settings),
        passes_(passes),
        rest_(rest),
        picture_(picture),
        choices_(choices),
        left_(std::move(left)),
        shown_(std::move(shown)),
        sinks_(sinks) {}

  // Tries them on the view that passes render, which may be smaller than what was asked for, and goes on by
  // them until the budget is over, or the error is met, if they are better. False if it was cancelled.
  bool run(const View& view, bool is_smaller, const Passes& passes);

  // Nothing if there was no time to try them.
  const std::optional<PathsBeside>& paths() const { return paths_; }
  double passes_over_paths() const { return passes_over_paths_; }  // noise, see there

 private:
  bool try_out(const View& view, const Passes& passes);
  bool have_better_emission(bool is_smaller);
  bool go_on(std::optional<std::int64_t> earlier);
  bool add_features();
  void choose_share(double passes_seconds);

  const world::World& world_;
  const RenderSettings& settings_;
  PassPicture& passes_;
  const RestTracing& rest_;
  MixedPicture& picture_;
  methods::TimedChoices& choices_;
  std::function<double()> left_;
  std::function<void()> shown_;
  const Sinks& sinks_;
  std::optional<PathsBeside> paths_;
  double passes_over_paths_ = 0;
  bool own_emission_ = false;
  int features_ = 0;
};

}  // namespace lumirank::pipeline
