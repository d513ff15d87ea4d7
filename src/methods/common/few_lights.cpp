#include "methods/common/few_lights.h"

#include "methods/common/all_columns.h"

namespace lumirank::methods {

namespace {

struct FewLightsSettings {
  std::size_t lights = 1000;
};

// The matrix already has only the lights that lights_wanted asked for.
class FewLights final : public Method {
 public:
  explicit FewLights(const FewLightsSettings&) {}
  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    return brute_force_with_error(matrix, options);
  }
};

}  // namespace

MethodInfo few_lights_info(const MethodText& text, const std::string& what) {
  const Fields<FewLightsSettings> fields{count_field<FewLightsSettings>(
      {"lights", "columns", what + " to generate; every one is rendered, so time is in proportion."},
      &FewLightsSettings::lights, 1, kMaxColumns)};
  MethodInfo info = method_info<FewLights>(text, fields);
  info.lights_wanted = [name = text.name, fields](const SettingsMap& settings) {
    return read_settings(name, fields, settings).lights;
  };
  return info;
}

}  // namespace lumirank::methods
