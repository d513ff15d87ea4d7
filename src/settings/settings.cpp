#include "lumirank/settings.h"

#include <cmath>

#include "lumirank/error.h"
#include "methods/method.h"
#include "settings/table.h"

namespace lumirank {

using settings::EnumNames;
using settings::parse_enum;
using settings::Row;
using settings::table;

namespace {

const Row& find_row(const std::string& key) {
  for (const Row& row : table())
    if (row.field.key == key) return row;
  std::string valid;
  for (const Row& row : table()) valid += (valid.empty() ? "" : ", ") + row.field.key;
  throw InputError("there is no setting '" + key + "'", "the settings are " + valid);
}

}  // namespace

const std::vector<Field>& render_fields() {
  static const std::vector<Field> fields = [] {
    std::vector<Field> f;
    for (const Row& row : table()) f.push_back(row.field);
    return f;
  }();
  return fields;
}

void set_field(RenderSettings& settings, const std::string& key, const std::string& value) {
  find_row(key).set(settings, value);
}

std::string get_field(const RenderSettings& settings, const std::string& key) {
  return find_row(key).get(settings);
}

ReferencePaths reference_paths(const std::string& name) { return parse_enum<ReferencePaths>("paths", name); }
std::string to_text(ReferencePaths paths) {
  return EnumNames<ReferencePaths>::names[static_cast<std::size_t>(paths)];
}
ToneMap tone_map(const std::string& name) { return parse_enum<ToneMap>("tonemap", name); }

void validate(const RenderSettings& settings) {
  for (const Row& row : table()) {  // ranges also hold for values that were assigned directly
    RenderSettings scratch;
    row.set(scratch, row.get(settings));
  }
  if (!(settings.time_spent >= 0 && std::isfinite(settings.time_spent)))
    throw InputError("the time that is spent already is negative or not finite", "set 'time_spent' to 0");
  if (!settings.choices.empty() && settings.time <= 0)
    throw InputError("choices of a timed run need its time budget", "set 'time', or clear the choices");
  if (settings.traced.local_paths > 0) {
    if (settings.traced.direct == DirectLight::matrix && settings.traced.local_sharp > 0)
      throw InputError("'local-paths' trace the direct light of sharp lobes too",
                       "leave out 'direct matrix', or set 'local-sharp' to 0");
    if (settings.traced.compensate > 0)
      throw InputError("'compensate' gives back light that 'local-paths' have traced",
                       "leave out one of them");
  }
  if (settings.traced.compensate > 0) {
    const auto refuse = [](const char* what, const char* remedy) {
      throw InputError(std::string("'compensate' ") + what, remedy);
    };
    if (settings.time > 0) refuse("cannot keep to a time budget", "leave out 'time', or 'compensate'");
    if (!(settings.lights.clamp > 0))
      refuse("has nothing to give back without clamping", "set 'clamp' above 0");
    if (settings.lights.type == LightType::sphere)
      refuse("is for point lights", "set 'light-type' to point or diffuse-point");
    if (settings.view.only == LightPart::direct)
      refuse("is for indirect light", "leave out 'only', or 'compensate'");
  }
  if (settings.view.is_open() && settings.view.film_samples.value_or(0) > 0)
    throw InputError("film samples are of one moment, and the shutter is open",
                     "leave out 'film-samples', or 'shutter'");
  if (settings.method.name != "auto") {
    const methods::MethodInfo& method = methods::find_method(settings.method.name);
    method.make(settings.method.parameters);
    if (method.contract.sums_of_pixels && settings.view.film_samples.value_or(0) > 0)
      throw InputError("the sums of " + method.name + " are right for whole pixels, not for surfaces in them",
                       "leave out 'film-samples'");
  }
}

}  // namespace lumirank
