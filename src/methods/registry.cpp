// The list of methods.
#include "base/error.h"
#include "methods/brute_force/brute_force.h"
#include "methods/instant_radiosity/instant_radiosity.h"
#include "methods/lightcuts/lightcuts.h"
#include "methods/lightslice/lightslice.h"
#include "methods/method.h"
#include "methods/multidimensional_lightcuts/multidimensional_lightcuts.h"
#include "methods/power_sampling/power_sampling.h"
#include "methods/row_column/row_column.h"
#include "methods/sampling_recovery/sampling_recovery.h"
#include "methods/slice_cuts/slice_cuts.h"
#include "methods/stochastic_lightcuts/stochastic_lightcuts.h"
#include "methods/visibility_completion/visibility_completion.h"

namespace lumirank::methods {

const std::vector<MethodInfo>& all_methods() {
  static const std::vector<MethodInfo> methods{brute_force_info(),
                                               instant_radiosity_info(),
                                               power_sampling_info(),
                                               row_column_info(),
                                               lightcuts_info(),
                                               multidimensional_lightcuts_info(),
                                               stochastic_lightcuts_info(),
                                               lightslice_info(),
                                               sampling_recovery_info(),
                                               slice_cuts_info(),
                                               visibility_completion_info()};
  return methods;
}

const MethodInfo& find_method(const std::string& name) {
  std::string list;
  for (const MethodInfo& m : all_methods()) {
    if (m.name == name) return m;
    list += (list.empty() ? "" : ", ") + m.name;
  }
  throw InputError("there is no method '" + name + "'", "methods: " + list);
}

}  // namespace lumirank::methods
