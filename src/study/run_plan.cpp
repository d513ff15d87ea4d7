#include "study/run_plan.h"

#include <algorithm>

#include "base/error.h"
#include "methods/method.h"

namespace lumirank::study {
namespace {

// As a person wrote it, for messages.
std::string name_of(const ComparisonSweep& sweep) {
  std::string name = sweep.method.empty() ? "" : sweep.method + ".";
  for (std::size_t k = 0; k < sweep.keys.size(); ++k) name += (k > 0 ? ":" : "") + sweep.keys[k];
  return name;
}

void apply(PlannedRun& run, const ComparisonSweep& sweep, const std::vector<std::string>& values) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    const std::string& name = sweep.keys[k];
    if (sweep.method.empty()) {
      RenderSettings checked;
      set_field(checked, name, values[k]);
      if (name == "lights")
        run.lights = checked.lights.count_or_default();
      else
        run.spp = checked.view.spp_or_default();
    } else {
      run.method_settings[name] = values[k];
    }
    run.label += " " + name + "=" + values[k];
  }
}

void require_sound(const ComparisonSweep& sweep, const CompareSettings& settings) {
  const std::string name = name_of(sweep);
  if (sweep.method.empty() && name != "lights" && name != "spp")
    throw InputError("'" + name + "' cannot be swept", "write METHOD.KEY, lights or spp");
  if (!sweep.method.empty() && std::ranges::find(settings.methods, sweep.method) == settings.methods.end())
    throw InputError("the sweep of '" + name + "' belongs to a method that is not compared",
                     "add it to --methods");
  if (sweep.values.empty()) throw InputError("the sweep of '" + name + "' has no values");
  for (const std::vector<std::string>& values : sweep.values)
    if (values.size() != sweep.keys.size())
      throw InputError("a value of the sweep of '" + name + "' has " + std::to_string(values.size()) +
                       " parts for " + std::to_string(sweep.keys.size()) + " parameters");
}

bool has_parameter(const methods::MethodInfo& info, const std::string& key) {
  return std::any_of(info.parameters.begin(), info.parameters.end(),
                     [&](const auto& p) { return p.key == key; });
}

// --set is for the methods that have the parameter; one that none of them has is a mistake.
void require_known_settings(const CompareSettings& settings) {
  for (const auto& setting : settings.base.method.parameters) {
    std::string valid;
    bool known = false;
    for (const std::string& name : settings.methods) {
      const methods::MethodInfo& info = methods::find_method(name);
      known = known || has_parameter(info, setting.first);
      for (const auto& p : info.parameters) valid += (valid.empty() ? "" : ", ") + name + "." + p.key;
    }
    if (!known)
      throw InputError("no method that is compared has the parameter '" + setting.first + "'",
                       valid.empty() ? "they have none" : "they have " + valid);
  }
}

void check_plan(const CompareSettings& settings) {
  if (settings.methods.empty()) throw InputError("there is no method to compare", "give --methods a,b,c");
  for (const ComparisonSweep& sweep : settings.sweeps) require_sound(sweep, settings);
  for (const double time : settings.times)
    if (!(time > 0 && time <= 1e7))  // also what is not a number
      throw InputError("a time budget of --times is not positive", "give seconds, --times 1,2,4");
  require_known_settings(settings);
}

// What a method runs with where nothing is swept.
PlannedRun base_run(const methods::MethodInfo& info, const CompareSettings& settings) {
  PlannedRun base;
  base.method = base.label = base.series = info.name;
  base.lights = settings.base.lights.count_or_default();
  base.spp = settings.base.view.spp_or_default();
  for (const auto& setting : settings.base.method.parameters)
    if (has_parameter(info, setting.first))
      base.method_settings.insert_or_assign(setting.first, setting.second);
  return base;
}

// All points of one method's curves. Every sweep of this method, and --times, is a curve of its own: they are
// not multiplied with each other.
std::vector<PlannedRun> points_of(const PlannedRun& base, const CompareSettings& settings) {
  std::vector<PlannedRun> points;
  std::vector<std::size_t> curves;  // first points
  for (const ComparisonSweep& sweep : settings.sweeps) {
    if (!sweep.method.empty() && sweep.method != base.method) continue;
    curves.push_back(points.size());
    for (const std::vector<std::string>& values : sweep.values) {
      PlannedRun run = base;
      apply(run, sweep, values);
      points.push_back(run);
    }
  }
  if (!settings.times.empty()) curves.push_back(points.size());
  for (double time : settings.times) {
    PlannedRun run = base;
    run.time = time;
    std::string seconds = std::to_string(time);
    seconds.erase(seconds.find_last_not_of('0') + 1);
    if (seconds.back() == '.') seconds.pop_back();
    run.label += " " + seconds + " s";
    points.push_back(run);
  }
  // Several are told apart by what their first points have been given.
  for (std::size_t c = 0; c < curves.size() && curves.size() > 1; ++c)
    for (std::size_t k = curves[c]; k < (c + 1 < curves.size() ? curves[c + 1] : points.size()); ++k)
      points[k].series += " (" + points[curves[c]].label.substr(base.label.size() + 1) + " …)";
  if (points.empty()) points.push_back(base);
  return points;
}

}  // namespace

std::vector<PlannedRun> plan_runs(const CompareSettings& settings) {
  check_plan(settings);
  std::vector<PlannedRun> runs;
  for (const std::string& name : settings.methods) {
    const methods::MethodInfo& info = methods::find_method(name);
    for (const PlannedRun& point : points_of(base_run(info, settings), settings))
      for (int k = 0; k < settings.seeds; ++k) {
        runs.push_back(point);
        runs.back().seed = settings.base.seed + static_cast<std::uint64_t>(k);
        info.make(runs.back().method_settings);  // wrong parameters are found before anything runs
      }
  }
  return runs;
}

}  // namespace lumirank::study
