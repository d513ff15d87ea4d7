// Render settings as JSON, and from the report of an earlier render.
#include <nlohmann/json.hpp>

#include "lumirank/error.h"
#include "settings/table.h"

namespace lumirank {

std::string to_json(const RenderSettings& settings) {
  nlohmann::ordered_json json;
  for (const settings::Row& row : settings::table()) json[row.field.key] = row.get(settings);
  json["set"] = nlohmann::ordered_json::object();
  for (const auto& [key, value] : settings.method.parameters) json["set"][key] = value;
  return json.dump();
}

RenderSettings render_settings_from_json(const std::string& text) {
  nlohmann::json json;
  try {
    json = nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& e) {
    throw InputError(std::string("the settings are not JSON: ") + e.what());
  }
  if (!json.is_object()) throw InputError("the settings must be a JSON object");
  RenderSettings settings;
  const auto as_text = [](const std::string& key, const nlohmann::json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number()) return value.dump();
    throw InputError("the value of '" + key + "' must be text or a number");
  };
  for (const auto& [key, value] : json.items()) {
    if (key == "set") {
      if (!value.is_object()) throw InputError("'set' must be an object of the method's parameters");
      for (const auto& [k, v] : value.items()) settings.method.parameters[k] = as_text(k, v);
    } else {
      set_field(settings, key, as_text(key, value));
    }
  }
  // A report names every setting, asked for or not.
  if (settings.lights.count == VirtualLightSettings::kDefaultCount) settings.lights.count.reset();
  ViewSettings& view = settings.view;
  ViewSettings unset = view;
  unset.film_samples.reset();
  if (view.film_samples == unset.film_samples_or_default()) view.film_samples.reset();
  if (view.spp == ViewSettings::kDefaultSpp) view.spp.reset();
  return settings;
}

RenderSettings render_settings_from_report(const std::string& report) {
  const nlohmann::json json = nlohmann::json::parse(report, nullptr, false);
  if (!json.is_object() || !json.contains("parameters"))
    throw InputError("this is not a report of a render", "give the file that --report wrote");
  RenderSettings settings = render_settings_from_json(json["parameters"].dump());
  if (settings.time <= 0) return settings;
  try {
    settings.choices = json.at("choices").get<decltype(settings.choices)>();
  } catch (const nlohmann::json::exception&) {
    throw InputError("the report of a run under --time lacks the choices that the clock made",
                     json.value("stopped", "") == "cancelled"
                         ? "the run was interrupted: it cannot be replayed"
                         : "render again with --report");
  }
  return settings;
}

}  // namespace lumirank
