#include "methods/instant_radiosity/instant_radiosity.h"

#include "methods/common/all_columns.h"
#include "methods/parameters.h"

namespace lumirank::methods {

namespace {

struct InstantRadiositySettings {
  std::size_t lights = 1000;
};

const Fields<InstantRadiositySettings> kInstantRadiosityFields{count_field<InstantRadiositySettings>(
    {"lights", "columns", "Virtual lights to generate; every one is rendered, so time is in proportion."},
    &InstantRadiositySettings::lights, 1, kMaxColumns)};

// The matrix already has only the lights that lights_wanted asked for.
class InstantRadiosity final : public Method {
 public:
  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    return brute_force_with_error(matrix, options);
  }
};

}  // namespace

MethodInfo instant_radiosity_info() {
  const std::string name = "instant-radiosity";
  return {name,
          "Generates few virtual lights and renders all of them.",
          "Keller 1997, Instant Radiosity",
          parameters_of(kInstantRadiosityFields),
          [=](const SettingsMap& settings) -> std::unique_ptr<Method> {
            read_settings(name, kInstantRadiosityFields, settings);
            return std::make_unique<InstantRadiosity>();
          },
          [=](const SettingsMap& settings) {
            return read_settings(name, kInstantRadiosityFields, settings).lights;
          },
          "",
          matrix::kCombination};
}

}  // namespace lumirank::methods
