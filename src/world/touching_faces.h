// Faces of glass, water and fog that lie in the plane of something else: a glass block on a table, water in a
// basin or in a glass, a box of fog as large as its room. Both faces are met at the same distance, in any
// order, and a ray that has passed the first steps over the second: what stands there is lost. So one of both
// goes behind the other by a hair, as if they were glued: what is opaque is met first, and the glass around
// water is entered before the water is left.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/ray_scene.h"

namespace lumirank::world {

// What a placement is to light: something opaque, a lamp, or something that it can enter, without and with a
// medium of its own.
enum class Part : std::uint8_t { opaque, lamp, clear, medium };

// Moves vertices of `meshes`, along the normals and by no more than five of the steps by which rays leave
// surfaces (World::offset_origin), at sharp edges farther. `parts`: of each placement. Lamps come out of the
// planes of what is opaque, to the side on which they shine: one flush with a ceiling would be behind it in
// every second place. What light can enter goes behind opaque faces and lamps; and of two such that touch the
// one with a medium, or the smaller one, into the other. Two media side by side stay as they are, and so do
// meshes that enclose no volume: they have no outside to which they could go. Returns how many triangles were
// moved. Places are asked of each triangle of either kind, so a face that is touched by a small part of a
// large one, and nowhere near the middle or a corner of either, may be overlooked.
std::size_t part_touching_faces(std::vector<geometry::TriangleMesh>& meshes,
                                std::span<const geometry::Placement> placements, std::span<const Part> parts);

}  // namespace lumirank::world
