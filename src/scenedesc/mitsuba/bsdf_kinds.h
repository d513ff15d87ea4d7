// The BSDF plugins, one function each; the table in bsdfs.cpp names them.
#pragma once

#include "scenedesc/mitsuba/plugin.h"

namespace lumirank::scenedesc::mitsuba {

using BsdfKind = decltype(BsdfDesc::kind);

BsdfKind diffuse(Reader& reader, Plugin& p);
BsdfKind rough_diffuse(Reader& reader, Plugin& p);
BsdfKind dielectric(Reader& reader, Plugin& p);
BsdfKind thin_dielectric(Reader& reader, Plugin& p);
BsdfKind conductor(Reader& reader, Plugin& p);
BsdfKind plastic(Reader& reader, Plugin& p);
BsdfKind phong(Reader& reader, Plugin& p);
BsdfKind ward(Reader& reader, Plugin& p);
BsdfKind principled(Reader& reader, Plugin& p);

BsdfKind mask(Reader& reader, Plugin& p);
BsdfKind two_sided(Reader& reader, Plugin& p);
BsdfKind bump_map(Reader& reader, Plugin& p);
BsdfKind normal_map(Reader& reader, Plugin& p);
BsdfKind mixture(Reader& reader, Plugin& p);
BsdfKind blend(Reader& reader, Plugin& p);

}  // namespace lumirank::scenedesc::mitsuba
