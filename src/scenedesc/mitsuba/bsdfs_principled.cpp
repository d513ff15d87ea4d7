// The two BSDFs after Burley.
#include <cmath>

#include "scenedesc/mitsuba/bsdf_kinds.h"

namespace lumirank::scenedesc::mitsuba {

namespace {

struct Input {
  const char* name;
  FloatInput* value;
  float most = 1;
};

void read(Plugin& p, std::initializer_list<Input> inputs) {
  for (const Input& input : inputs) {
    *input.value = p.scalar(input.name, input.value->value);
    const FloatInput& found = *input.value;
    if (found.texture == kNone && !(found.value >= 0 && found.value <= input.most))
      throw InputError(p.where_of(input.name), std::string("\"") + input.name + "\" of " + p.title() +
                                                   " is not between 0 and " + (input.most == 1 ? "1" : "2"));
  }
}

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

BsdfKind principled(Reader&, Plugin& p) {
  PrincipledDesc out;
  out.base_color = p.reflectance("base_color", Rgb(0.5f));
  read(p, {{"roughness", &out.roughness},
           {"anisotropic", &out.anisotropic},
           {"metallic", &out.metallic},
           {"spec_trans", &out.spec_trans},
           {"spec_tint", &out.spec_tint},
           {"sheen", &out.sheen},
           {"sheen_tint", &out.sheen_tint},
           {"clearcoat", &out.clearcoat},
           {"clearcoat_gloss", &out.clearcoat_gloss},
           {"flatness", &out.flatness}});
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

BsdfKind principled_thin(Reader&, Plugin& p) {
  PrincipledThinDesc out;
  out.base_color = p.reflectance("base_color", Rgb(0.5f));
  read(p, {{"roughness", &out.roughness},
           {"anisotropic", &out.anisotropic},
           {"spec_trans", &out.spec_trans},
           {"spec_tint", &out.spec_tint},
           {"sheen", &out.sheen},
           {"sheen_tint", &out.sheen_tint},
           {"flatness", &out.flatness},
           {"diff_trans", &out.diff_trans, 2}});
  out.eta = eta_of(p).value_or(1.5f);
  ignore_sampling(p);
  return out;
}

}  // namespace lumirank::scenedesc::mitsuba
