// Reading of the fields that a BSDF lists (schema/fields.h): all but those of Role::own.
#pragma once

#include <string>
#include <type_traits>

#include "scenedesc/mitsuba/bsdf_kinds.h"
#include "scenedesc/schema/warnings.h"

namespace lumirank::scenedesc::mitsuba {

// An InputError if a constant number is beyond the field's range.
void check_range(Plugin& p, const char* name, const FloatInput& found, Range range);

template <typename Desc, typename Member>
void read_field(Reader& reader, Plugin& p, const Field<Desc, Member>& field, Member& out) {
  if constexpr (std::is_same_v<Member, ColorInput>) {
    if (field.role == Role::reflectance) out = p.reflectance(field.name, out.value);
  } else if constexpr (std::is_same_v<Member, FloatInput>) {
    if (field.role != Role::number) return;
    out = p.scalar(field.name, out.value);
    check_range(p, field.name, out, field.range);
  } else if constexpr (std::is_same_v<Member, float>) {
    if (field.role == Role::index) out = relative_index(p, field.detail);
  } else if constexpr (std::is_same_v<Member, bool>) {
    if (field.role == Role::flag) out = p.flag(field.name, out);
  } else if constexpr (std::is_same_v<Member, FileInput>) {
    const auto found =
        reader.file(p.required_text(field.name), p.where_of(field.name), field.detail, kMissingBsdf);
    out = {found.name, found.missing};
  } else if constexpr (std::is_same_v<Member, int>) {
    if (field.role == Role::nested) out = only_bsdf(reader, p);
  }
}

template <typename Desc>
void read_fields(Reader& reader, Plugin& p, Desc& out) {
  if constexpr (requires {
                  out.alpha_u;
                  out.distribution;
                })
    if (is_rough(p)) {
      const Roughness r = roughness(reader, p, 0.1f);
      out.distribution = r.distribution, out.alpha_u = r.alpha_u, out.alpha_v = r.alpha_v;
    }
  for_each_field(out, [&](const auto& field, auto& value) { read_field(reader, p, field, value); });
}

// A BSDF that is no more than its fields.
template <typename Desc>
BsdfKind plain_bsdf(Reader& reader, Plugin& p) {
  Desc out;
  read_fields(reader, p, out);
  return out;
}

}  // namespace lumirank::scenedesc::mitsuba
