#include "methods/brute_force/brute_force.h"

#include "methods/common/all_columns.h"
#include "methods/parameters.h"

namespace lumirank::methods {

namespace {

struct NoSettings {};
const Fields<NoSettings> kBruteForceFields{};

class BruteForce final : public Method {
 public:
  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    return brute_force_with_error(matrix, options);
  }
};

}  // namespace

MethodInfo brute_force_info() {
  return {"brute-force",
          "Renders every column: exact for the given lights, and slow.",
          "",
          parameters_of(kBruteForceFields),
          [](const SettingsMap& settings) -> std::unique_ptr<Method> {
            read_settings("brute-force", kBruteForceFields, settings);
            return std::make_unique<BruteForce>();
          },
          [](const SettingsMap&) -> std::size_t { return 0; },
          "",
          {.needs = {}, .combination = true, .instants = true}};
}

}  // namespace lumirank::methods
