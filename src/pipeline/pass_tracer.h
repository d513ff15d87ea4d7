// One pass of a render in passes: receivers and lights of its own, what is traced beside them, and the
// picture that its method estimates from both. Knows nothing of other passes, budgets and denoisers.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "image/image.h"
#include "lumirank/settings.h"
#include "matrix/metered_matrix.h"
#include "methods/method.h"
#include "pipeline/develop.h"
#include "pipeline/prepared.h"

namespace lumirank::pipeline {

// What a pass takes for its lights, and what in proportion to its pixels: the records of a method too, since
// both they and the lights of each grow with the root of these.
struct PassSeconds {
  double fixed = 0, by_pixel = 0;
  double total() const { return fixed + by_pixel; }
};

class PassTracer {
 public:
  // Adds to `seconds`, by stage. What is given by reference must outlive this.
  PassTracer(SharedWorld world, const methods::MethodInfo& info, std::unique_ptr<methods::Method> method,
             const RenderSettings& settings, const Sinks& sinks, std::map<std::string, double>& seconds);

  // What lights are aimed by; before any pass.
  void aim(SharedSurvey survey) { survey_ = std::move(survey); }
  // In eighths of a usual pass (PassPlan): lights, and draws of each receiver.
  void set_size(int eighths);
  int eighths() const { return eighths_; }
  // Each pass after this has one of side² sets of interleaved pixels, so many of them a pass of the film.
  void interleave(int side) { side_ = side; }
  int parts() const { return side_ * side_; }

  Recipe recipe_of(std::uint64_t number, const View& view) const;
  // Of one pass.
  std::size_t lights_of(const View& view) const;
  // What surfaces send, without emission that is seen; black in pixels that the pass has not. False if it was
  // cancelled.
  bool trace(std::uint64_t number, const View& view, image::Image& image, PassSeconds& took);

  // Of the last pass.
  const SharedPrepared& prepared() const { return prepared_; }
  const TracedLight& traced() const { return traced_; }
  methods::Estimate& estimate() { return estimate_; }
  // Of all passes since it was last forgotten.
  const matrix::Cost& cost() const { return cost_; }
  void forget_cost() { cost_ = {}; }

 private:
  SharedWorld world_;
  const methods::MethodInfo& info_;
  std::unique_ptr<methods::Method> method_;
  const RenderSettings& settings_;
  Sinks sinks_;
  std::map<std::string, double>& seconds_;
  FilmParts sent_;
  SharedSurvey survey_;
  int eighths_, side_ = 1;
  SharedPrepared prepared_;
  TracedLight traced_;
  methods::Estimate estimate_;
  matrix::Cost cost_;
};

}  // namespace lumirank::pipeline
