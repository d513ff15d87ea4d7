// Point lights whose intensity a file states → prepared emitters.
#pragma once

#include "emitters/emitter.h"
#include "emitters/profile.h"
#include "scenedesc/schema/scene_desc.h"
#include "world/notes.h"

namespace lumirank::world {

// Opens the file. InputError if it is not what the description says. lumens_per_unit: the scene's.
emitters::ProfileEmitter make_profile_light(const scenedesc::ProfileLightDesc& light,
                                            const SourceLocation& where, double lumens_per_unit,
                                            Notes& notes);

// The axes of a light in the world, mirrored where the transform mirrors. InputError if it is singular.
Frame axes_of(const Transform& to_world, const SourceLocation& where);

// From a square equal-area octahedral picture of values to a table over the polar angle from +z and the
// azimuth from +x: (size + 1) × (2·size + 1) entries, read bilinearly from the picture.
emitters::AngularProfile profile_from_octahedral(int size, const std::vector<float>& picture);

}  // namespace lumirank::world
