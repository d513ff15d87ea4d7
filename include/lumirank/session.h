// A render in its three steps, each as often as wanted: what is prepared outlives a call.
//
//   Prepared prepared = prepare(scene, settings);          // world, receivers, virtual lights, matrix
//   Estimate estimate = estimate_sums(prepared, {.name = "slice-cuts"});
//   Picture picture = develop(prepared, estimate);
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lumirank/export.h"
#include "lumirank/lumirank.h"
#include "lumirank/matrix.h"

namespace lumirank {

// Owns what it is made of, never changes, is cheap to copy, and may be used by many threads at once.
class LUMIRANK_API Prepared {
 public:
  Matrix matrix() const;
  int width() const;  // of the picture, pixels
  int height() const;
  // Names of the scene's emitters; those that share a name are one light to relight().
  std::vector<std::string> lights() const;
  std::map<std::string, double> seconds() const;  // by stage

  struct Impl;
  Prepared() = default;  // holds nothing
  explicit Prepared(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
  explicit operator bool() const { return impl_ != nullptr; }
  const Impl& impl() const { return *impl_; }

 private:
  std::shared_ptr<const Impl> impl_;
};

// Of `settings` it reads view, lights, traced, layers, seed and threads; the rest of the paths and the
// compensation are left to render(). What `previous` has of the same scene (the world), view (receivers) and
// lights is taken over. Throws InputError, Cancelled.
LUMIRANK_API Prepared prepare(const Scene& scene, const RenderSettings& settings, const Sinks& sinks = {},
                              const Prepared& previous = {});

// What a method made of the matrix.
struct Estimate {
  std::vector<Rgb> sums;  // one per row
  // The same as a combination of columns, sums = Σ scale_k·A(·, column_k), for methods that make one for all
  // rows (brute-force, power-sampling, row-column-sampling, instant-radiosity); empty for others.
  std::vector<WeightedColumn> combination;
  std::map<std::string, double> numbers;  // as in Report
  std::map<std::string, std::string> notes;
  MatrixCost cost;
  bool interrupted = false;  // cancelled: `sums` is the best whole estimate so far
};

struct EstimateOptions {
  double time = 0;  // seconds for the method; 0: no limit
  Sinks sinks = {};
  // Called with whole estimates while they improve; may be empty.
  std::function<void(std::span<const Rgb> sums)> on_estimate = {};
};

// Any method, as often as wanted, on one matrix ("auto": slice-cuts). Throws InputError for settings that the
// method does not take, Cancelled if there is nothing yet.
LUMIRANK_API Estimate estimate_sums(const Prepared& prepared, const MethodSettings& method,
                                    const EstimateOptions& options = {});

// The picture of row sums with the light that was traced beside the matrix; `layers` as --aov names them, but
// for the illuminance. Throws InputError for layers that the estimate or what is prepared cannot give.
LUMIRANK_API Picture develop(const Prepared& prepared, const Estimate& estimate,
                             const std::vector<std::string>& layers = {}, const Sinks& sinks = {});

// The same picture under other lights: the light of each emitter is multiplied with a factor per channel.
// Columns are gone over once, when it is made; each picture after that is a sum of a few.
class LUMIRANK_API Relighting {
 public:
  // Throws InputError if the estimate is no combination of columns, or if direct light was traced, which
  // does not know its emitter: prepare with `traced.direct = DirectLight::matrix`.
  Relighting(const Prepared& prepared, const Estimate& estimate, const Sinks& sinks = {});

  std::vector<std::string> lights() const;
  // Factors by the lights' names; lights without one keep theirs. Emission that the eye sees directly stays
  // as it is. Throws InputError for an unknown name.
  Picture picture(const std::map<std::string, Rgb>& factors) const;

 private:
  Picture emission_;             // seen directly
  std::vector<Plane> by_light_;  // named
};

}  // namespace lumirank
