// The two BSDFs after Burley.
#include <cmath>

#include "scenedesc/mitsuba/bsdf_fields.h"

namespace lumirank::scenedesc::mitsuba {

namespace {

std::optional<float> eta_of(Plugin& p) {
  const auto eta = p.number("eta");
  if (eta && !(*eta > 1)) throw InputError(p.where_of("eta"), "\"eta\" of " + p.title() + " is not above 1");
  return eta;
}

void ignore_sampling(Plugin& p) {
  p.ignore({"main_specular_sampling_rate", "clearcoat_sampling_rate", "diffuse_reflectance_sampling_rate",
            "main_specular_sampling", "clearcoat_sampling", "diffuse_sampling", "spec_reflect_sampling_rate",
            "spec_trans_sampling_rate", "diff_trans_sampling_rate"});
}

}  // namespace

BsdfKind principled(Reader& reader, Plugin& p) {
  PrincipledDesc out;
  read_fields(reader, p, out);
  if (const auto eta = eta_of(p)) {
    if (p.has("specular"))
      throw InputError(p.where_of("specular"), p.title() + " has both \"eta\" and \"specular\"",
                       "keep one of them");
    out.eta = *eta;
  } else {
    // Reflectance at normal incidence is 0.08·specular.
    const float specular = p.number("specular", 0.5f);
    if (!(specular > 0 && specular <= 1))
      throw InputError(p.where_of("specular"), "\"specular\" of " + p.title() + " is not in (0, 1]");
    out.eta = 2 / (1 - std::sqrt(0.08f * specular)) - 1;
  }
  ignore_sampling(p);
  return out;
}

BsdfKind principled_thin(Reader& reader, Plugin& p) {
  PrincipledThinDesc out;
  read_fields(reader, p, out);
  out.eta = eta_of(p).value_or(1.5f);
  ignore_sampling(p);
  return out;
}

}  // namespace lumirank::scenedesc::mitsuba
