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

// What light meets at a mesh: nothing that it could enter; an inside; an inside with a medium of its own.
enum class Inside : std::uint8_t { none, clear, medium };

// Moves vertices of `meshes`, along the normals and by no more than five of the steps by which rays leave
// surfaces (World::offset_origin), at sharp edges farther. `inside`: of each placement. Only meshes that
// enclose a volume have an outside to which their faces may go: into what has no inside; and of two that
// touch the one with a medium, or the smaller one, into the other. Two media side by side stay as they are.
// Returns how many triangles were moved. Places are asked of each triangle of either kind, so a face that is
// touched by a small part of a large one, and nowhere near the middle or a corner of either, may be
// overlooked.
std::size_t sink_touching_faces(std::vector<geometry::TriangleMesh>& meshes,
                                std::span<const geometry::Placement> placements,
                                std::span<const Inside> inside);

// Lamps that lie flush in a ceiling or on a wall: faces that shine are moved out of the plane of what is
// opaque, to the side on which they shine, as far as glass is moved behind it.
std::size_t lift_touching_lamps(std::vector<geometry::TriangleMesh>& meshes,
                                std::span<const geometry::Placement> placements,
                                std::span<const Inside> inside, const std::vector<bool>& shines);

}  // namespace lumirank::world
