#include "study/run_plan.h"

#include <algorithm>

#include "base/error.h"
#include "methods/method.h"

namespace lumirank::study {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = text.find(separator, begin);
    parts.push_back(text.substr(begin, end == std::string::npos ? end : end - begin));
    if (end == std::string::npos) return parts;
    begin = end + 1;
  }
}

// "METHOD.KEY1:KEY2" → METHOD and its keys; "lights" and "spp" belong to every method.
struct SweepKey {
  std::string method;
  std::vector<std::string> keys;
};
SweepKey parse_key(const std::string& text) {
  if (text == "lights" || text == "spp") return {"", {text}};
  const std::size_t dot = text.find('.');
  if (dot == std::string::npos)
    throw InputError("'" + text + "' cannot be swept", "write METHOD.KEY, lights or spp");
  return {text.substr(0, dot), split(text.substr(dot + 1), ':')};
}

void apply(PlannedRun& run, const SweepKey& key, const std::string& value) {
  const auto values = split(value, ':');
  if (values.size() != key.keys.size())
    throw InputError("the sweep value '" + value + "' has " + std::to_string(values.size()) + " parts for " +
                     std::to_string(key.keys.size()) + " parameters");
  for (std::size_t k = 0; k < values.size(); ++k) {
    const std::string& name = key.keys[k];
    if (key.method.empty()) {
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
  for (const auto& sweep : settings.sweeps) {
    const SweepKey key = parse_key(sweep.key);
    if (!key.method.empty() &&
        std::find(settings.methods.begin(), settings.methods.end(), key.method) == settings.methods.end())
      throw InputError("the sweep of '" + sweep.key + "' belongs to a method that is not compared",
                       "add it to --methods");
    if (sweep.values.empty()) throw InputError("the sweep of '" + sweep.key + "' has no values");
  }

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
  for (const auto& sweep : settings.sweeps) {
    const SweepKey key = parse_key(sweep.key);
    if (!key.method.empty() && key.method != base.method) continue;
    curves.push_back(points.size());
    for (const std::string& value : sweep.values) {
      PlannedRun run = base;
      apply(run, key, value);
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
