// The BSDF plugins that are more than a list of fields, one function each; the table in bsdfs.cpp names them.
#pragma once

#include "scenedesc/mitsuba/plugin.h"

namespace lumirank::scenedesc::mitsuba {

BsdfKind diffuse(Reader& reader, Plugin& p);
BsdfKind rough_diffuse(Reader& reader, Plugin& p);
BsdfKind conductor(Reader& reader, Plugin& p);
BsdfKind plastic(Reader& reader, Plugin& p);
BsdfKind polarized_plastic(Reader& reader, Plugin& p);
BsdfKind ward(Reader& reader, Plugin& p);
BsdfKind principled(Reader& reader, Plugin& p);
BsdfKind principled_thin(Reader& reader, Plugin& p);
BsdfKind hair(Reader& reader, Plugin& p);

BsdfKind coating(Reader& reader, Plugin& p);
BsdfKind two_sided(Reader& reader, Plugin& p);
BsdfKind bump_map(Reader& reader, Plugin& p);
BsdfKind normal_map(Reader& reader, Plugin& p);
BsdfKind mixture(Reader& reader, Plugin& p);
BsdfKind blend(Reader& reader, Plugin& p);

// Shared by the files of BSDFs (bsdfs_plain.cpp, bsdfs_nested.cpp).
// int_ior over ext_ior, each a number or the name of a material.
float relative_index(Plugin& p, const std::string& interior);
struct Roughness {
  Distribution distribution = Distribution::beckmann;
  FloatInput alpha_u, alpha_v;
};
// "distribution", "alpha", "alpha_u" and "alpha_v" of a rough… plugin.
Roughness roughness(Reader& reader, Plugin& p, float fallback);
// The index of the one BSDF nested in a plugin; InputError if there is none.
int only_bsdf(Reader& reader, Plugin& p);
// Whether the plugin's name begins with "rough".
bool is_rough(const Plugin& p);

}  // namespace lumirank::scenedesc::mitsuba
