// Descriptions of emitters → prepared emitters with unique names.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "emitters/emitter.h"
#include "geometry/mesh.h"
#include "scatter/material.h"
#include "scatter/texture.h"
#include "scenedesc/schema/scene_desc.h"
#include "world/notes.h"
#include "world/units.h"

namespace lumirank::world {

// Gives emitters unique names; those that ask for the same name share a group.
class EmitterNames {
 public:
  void name(emitters::Emitter& emitter, const std::string& wanted, const SourceLocation& where);

 private:
  std::map<std::string, std::uint16_t> groups_;
  std::map<std::string, int> asked_;  // how often a name was asked for
  std::set<std::string> taken_;
  std::size_t count_ = 0;
};

// The triangles of a mesh as a light. The outside of triangle t is outside_normal(mesh, t) (so placements
// that shine are baked into world space); triangle t of the emitter is triangle t of the mesh, degenerate
// ones included.
emitters::AreaEmitter make_area_emitter(const geometry::TriangleMesh& mesh, std::uint32_t placement,
                                        const scatter::ColorInput& radiance,
                                        const scatter::TextureSet& textures);

// The greatest radiance, irradiance, or intensity (in the world's units): methods add the squares of entries
// of the matrix, and 10⁶ of this one's are the range of 32-bit numbers. The sun, seen directly, has 2·10⁷
// W/(m² sr) or 2·10⁹ cd/m².
inline constexpr float kMaxLight = 1e16f;
// InputError if `value` exceeds that; `what` names it.
void check_light(float value, const char* what, const SourceLocation& where);

// Point, spot, directional light and everything infinitely far; environments are summed into one emitter,
// which comes last. Returns its index, or -1 if there is none.
//
// `pictures`: of the emitters that throw one, by their number; of the finished set.
int add_lights(const scenedesc::SceneDesc& desc, const std::vector<scatter::ColorInput>& pictures,
               const scatter::TextureSet& textures, EmitterNames& names, const Units& units, Notes& notes,
               std::vector<emitters::Emitter>& out);

}  // namespace lumirank::world
