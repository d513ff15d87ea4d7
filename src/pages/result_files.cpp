// results.json and results.csv.
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "image/atomic_file.h"
#include "pages/page.h"

namespace lumirank::pages {
namespace {

using nlohmann::json;

// JSON has no word for these; null is what readers expect.
json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json numbers(const std::map<std::string, double>& values) {
  json out = json::object();
  for (const auto& [key, value] : values) out[key] = number(value);
  return out;
}

json to_json(const ComparisonRun& run) {
  const PictureError& e = run.error;
  return {{"method", run.method},
          {"label", run.label},
          {"series", run.series},
          {"settings", run.settings},
          {"seed", run.seed},
          {"seconds", number(run.seconds)},
          {"setup_seconds", number(run.setup_seconds)},
          {"rays", number(run.rays)},
          {"entries", number(run.entries)},
          {"sampling_rate", number(run.sampling_rate)},
          {"error",
           {{"relative_l1", number(e.relative_l1)},
            {"relative_l2", number(e.relative_l2)},
            {"rmse", number(e.rmse)},
            {"relmse", number(e.relmse)},
            {"bias", number(e.bias)},
            {"flip", number(e.flip)}}},
          {"phases", numbers(run.phases)},
          {"numbers", numbers(run.numbers)},
          {"image", run.image_file},
          {"error_image", run.error_image_file}};
}

// RFC 4180: quoted where a comma, quote or line end demands it.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

std::string field(double value) {
  if (!std::isfinite(value)) return "";
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

}  // namespace

void write_results_json(const std::string& folder, const Comparison& results) {
  json out = {{"version", results.version},
              {"scene", results.scene},
              {"width", results.width},
              {"height", results.height},
              {"reference",
               {{"kind", results.reference_kind},
                {"relative_l1", number(results.reference_error)},
                {"seconds", number(results.reference_seconds)},
                {"image", results.reference_image}}},
              {"error_full_scale", number(results.error_full_scale)},
              {"notes", results.notes}};
  out["runs"] = json::array();
  for (const ComparisonRun& run : results.runs) out["runs"].push_back(to_json(run));
  out["singular_values"] = json::array();
  for (const double value : results.singular_values) out["singular_values"].push_back(number(value));
  // File names may hold bytes that are not UTF-8.
  image::write_whole_file(folder + "/results.json",
                          out.dump(2, ' ', false, json::error_handler_t::replace) + "\n");
}

void write_results_csv(const std::string& folder, const Comparison& results) {
  std::set<std::string> settings, phases;
  for (const ComparisonRun& run : results.runs) {
    for (const auto& [key, value] : run.settings) settings.insert(key);
    for (const auto& [key, value] : run.phases) phases.insert(key);
  }
  std::string out =
      "method,label,series,seed,seconds,setup_seconds,rays,entries,sampling_rate,relative_l1,relative_l2,"
      "rmse,relmse,bias,flip,image,error_image";
  for (const std::string& key : settings) out += "," + field("setting." + key);
  for (const std::string& key : phases) out += "," + field("seconds." + key);
  out += "\r\n";
  for (const ComparisonRun& run : results.runs) {
    out +=
        field(run.method) + "," + field(run.label) + "," + field(run.series) + "," + std::to_string(run.seed);
    for (const double value :
         {run.seconds, run.setup_seconds, run.rays, run.entries, run.sampling_rate, run.error.relative_l1,
          run.error.relative_l2, run.error.rmse, run.error.relmse, run.error.bias, run.error.flip})
      out += "," + field(value);
    out += "," + field(run.image_file) + "," + field(run.error_image_file);
    for (const std::string& key : settings) {
      const auto found = run.settings.find(key);
      out += "," + (found == run.settings.end() ? "" : field(found->second));
    }
    for (const std::string& key : phases) {
      const auto found = run.phases.find(key);
      out += "," + (found == run.phases.end() ? "" : field(found->second));
    }
    out += "\r\n";
  }
  image::write_whole_file(folder + "/results.csv", out);
}

}  // namespace lumirank::pages
