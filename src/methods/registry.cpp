// The list of methods.
#include "base/error.h"
#include "methods/adaptive_lightslice/adaptive_lightslice.h"
#include "methods/brute_force/brute_force.h"
#include "methods/column_completion/column_completion.h"
#include "methods/instant_radiosity/instant_radiosity.h"
#include "methods/lightcuts/lightcuts.h"
#include "methods/lightcuts/scalable_virtual_ray_lights.h"
#include "methods/lightslice/lightslice.h"
#include "methods/method.h"
#include "methods/multidimensional_lightcuts/multidimensional_lightcuts.h"
#include "methods/power_sampling/power_sampling.h"
#include "methods/row_column/row_column.h"
#include "methods/row_guided_sampling/row_guided_sampling.h"
#include "methods/sampling_recovery/sampling_recovery.h"
#include "methods/slice_cuts/slice_cuts.h"
#include "methods/stochastic_lightcuts/stochastic_lightcuts.h"
#include "methods/virtual_ray_lights/virtual_ray_lights.h"
#include "methods/visibility_completion/visibility_completion.h"

namespace lumirank::methods {

namespace {

class CheckedMethod final : public Method {
 public:
  CheckedMethod(std::string name, std::unique_ptr<Method> method)
      : name_(std::move(name)), method_(std::move(method)) {}
  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    require_capabilities(find_method(name_), matrix.capabilities());
    return method_->run(matrix, options);
  }

 private:
  std::string name_;
  std::unique_ptr<Method> method_;
};

std::vector<MethodInfo> checked(std::vector<MethodInfo> methods) {
  for (MethodInfo& m : methods)
    m.make = [name = m.name, make = std::move(m.make)](const auto& settings) -> std::unique_ptr<Method> {
      return std::make_unique<CheckedMethod>(name, make(settings));
    };
  return methods;
}

}  // namespace

const std::vector<MethodInfo>& all_methods() {
  static const std::vector<MethodInfo> methods = checked(
      {brute_force_info(), instant_radiosity_info(), power_sampling_info(), row_guided_sampling_info(),
       row_column_info(), lightcuts_info(), multidimensional_lightcuts_info(), stochastic_lightcuts_info(),
       lightslice_info(), sampling_recovery_info(), slice_cuts_info(), visibility_completion_info(),
       column_completion_info(), adaptive_lightslice_info(), virtual_ray_lights_info(),
       scalable_virtual_ray_lights_info()});
  return methods;
}

const MethodInfo& find_method(const std::string& name) {
  if (name == kMethodOfShots)
    throw InputError(name + " makes the frames of a shot together, and no single picture",
                     "use it with `lumirank animate`, or choose another method");
  std::string list;
  for (const MethodInfo& m : all_methods()) {
    if (m.name == name) return m;
    list += (list.empty() ? "" : ", ") + m.name;
  }
  throw InputError("there is no method '" + name + "'", "methods: " + list);
}

void require_capabilities(const MethodInfo& method, matrix::Capabilities offered) {
  const matrix::Capabilities missing = method.contract.needs.without(offered);
  if (missing.empty()) return;
  std::string others;
  for (const MethodInfo& m : all_methods())
    if (m.contract.needs.without(offered).empty()) others += (others.empty() ? "" : ", ") + m.name;
  throw InputError(
      "the method '" + method.name + "' needs " + describe(missing) + ", which the scene does not provide",
      others.empty() ? "no method does without" : "methods that do without: " + others);
}

}  // namespace lumirank::methods
