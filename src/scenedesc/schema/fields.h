// The fields of a description, listed once beside its struct: what readers, the writer, listings, walks over
// textures and nested BSDFs, and the world's materials do with every field alike is made from the list.
#pragma once

#include <cstdint>
#include <tuple>

#include "scenedesc/schema/textures.h"

namespace lumirank::scenedesc {

// What a field is to those who treat all of one role alike.
enum class Role : std::uint8_t {
  reflectance,  // a color of a surface, within [0, 1]
  number,       // a number or a texture, within `range`
  index,        // a relative index of refraction; `detail` names the inside where the scene does not
  roughness,    // of microfacets; distribution, alpha_u and alpha_v come together
  flag,
  file,     // `detail` says in messages what the file is
  nested,   // index of a BSDF
  texture,  // index of a texture
  own,      // read and written by code of its own; `detail` names a float in messages
};

// In which a constant number must lie; `index`: a relative index of refraction, positive and finite.
enum class Range : std::uint8_t { any, not_negative, to_1, to_2, index };

template <typename Desc, typename Member>
struct Field {
  const char* name;  // as Mitsuba has it, if it has it
  Member Desc::*member;
  Role role;
  Range range;
  const char* detail;

  // Written out so that clang 14 deduces the types.
  constexpr Field(const char* name_, Member Desc::*member_, Role role_, Range range_ = Range::any,
                  const char* detail_ = nullptr)
      : name(name_), member(member_), role(role_), range(range_), detail(detail_) {}
};

// Calls visit(field, desc's member) for all fields of `desc`, in order.
template <typename Desc, typename Visit>
void for_each_field(Desc& desc, Visit&& visit) {
  std::apply([&](const auto&... field) { (visit(field, desc.*field.member), ...); }, Desc::fields());
}

}  // namespace lumirank::scenedesc
