// A method estimates the row sums of a lighting matrix from few of its entries.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/rgb.h"
#include "base/sinks.h"
#include "matrix/lighting_matrix.h"

namespace lumirank::methods {

// One parameter of a method, for --set, JSON, `lumirank methods` and the documentation alike.
struct Parameter {
  std::string key;           // "rows"
  std::string type;          // "integer", "number", "choice"
  std::string default_text;  // "300"
  std::string range;         // "1 …", "cost|random"
  std::string unit;          // "" or "rows"
  std::string help;          // what it does and what it costs
  // Switches off a step of the paper, or what is ours alone: for experiments, listed on request only.
  bool experiment = false;
};

// What a run did, beside its numbers: seconds and counts by stable keys ("seconds.rows", "rows", "columns",
// …).
struct Trace {
  std::map<std::string, double> numbers;
  std::map<std::string, std::string> notes;
};

class TimedChoices;

struct RunOptions {
  std::uint64_t seed = 1;
  double time_seconds = 0;  // > 0: stop when this much time has passed since the call
  double target_error = 0;  // > 0: stop when the whole error (common/exact_rows.h) falls below
  // The sums are one of several estimates that are averaged, and the mean is denoised: errors had better
  // differ from pixel to pixel, even if there are a few more of them.
  bool one_of_passes = false;
  TimedChoices* choices = nullptr;  // with a budget: where the clock's choices are kept, see timed_choices.h
  // Seconds since any moment, for time_seconds; empty: the wall clock. Tests let time pass by the entry.
  std::function<double()> clock;
  Sinks sinks;
  // Called with a complete estimate of all row sums whenever a better one exists (progressive display). May
  // be empty.
  std::function<void(std::span<const Rgb> sums)> on_estimate;
};

struct Estimate {
  std::vector<Rgb> sums;  // one per row
  // The same estimate as a linear combination of columns, sums = Σ scale_k · A(·, column_k), for methods
  // whose estimate is one (all global ones): it splits the image by light and relights it. Empty for others.
  std::vector<matrix::ScaledColumn> combination;
  Trace trace;
  bool interrupted = false;  // cancelled: `sums` is the best complete estimate so far
};

class Method {
 public:
  virtual ~Method() = default;
  virtual Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const = 0;
};

struct MethodInfo {
  std::string name;     // "row-column-sampling"
  std::string summary;  // one sentence
  std::string paper;    // "" for a baseline without one
  std::vector<Parameter> parameters;
  // Settings as JSON text; unknown keys and wrong values throw InputError that lists the valid ones.
  std::function<std::unique_ptr<Method>(const std::map<std::string, std::string>& settings)> make;
  // instant-radiosity wants fewer lights rather than all of them: how many of the generated columns it uses
  // (0: all).
  std::function<std::size_t(const std::map<std::string, std::string>& settings)> lights_wanted;
  // For a method that does not aim at RunOptions::target_error though its sums err: the parameters that
  // decide its error, for a warning. "error-bound or max-nodes"; empty for all others.
  std::string error_parameters{};
  // What it needs of a matrix, and whether its estimate is one combination of columns.
  matrix::MethodContract contract{};
  // Where its settings decide what rays in media are to be; empty: as in the contract.
  std::function<matrix::MethodContract::Segments(const std::map<std::string, std::string>& settings)>
      segments_wanted{};
};

// The list: adding a method here enrols it in the command line, the documentation and the tests that all
// methods must pass.
const std::vector<MethodInfo>& all_methods();
// Not among them: it takes all frames of a shot (methods/tensor_clustering/).
inline constexpr const char* kMethodOfShots = "tensor-clustering";
// Throws InputError naming the valid methods.
const MethodInfo& find_method(const std::string& name);
// Throws InputError if the method needs something that a matrix with these capabilities does not tell, naming
// it and the methods that do without. Every method of the list asks this of its matrix before it runs; who
// knows the capabilities earlier asks earlier.
void require_capabilities(const MethodInfo& method, matrix::Capabilities offered);

}  // namespace lumirank::methods
