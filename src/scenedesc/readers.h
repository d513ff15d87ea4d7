// Readers of scene and mesh files. With images and volumes, the only code that opens files.
// Every function throws InputError with file, line and remedy, whatever the bytes are; none prints or exits.
#pragma once

#include <string>

#include "scenedesc/gltf/read_gltf.h"
#include "scenedesc/meshes/mesh_reader.h"
#include "scenedesc/mitsuba/read_mitsuba.h"
#include "scenedesc/pbrt/read_pbrt.h"
#include "scenedesc/schema/describe.h"
#include "scenedesc/schema/expansion.h"
#include "scenedesc/schema/read_options.h"
#include "scenedesc/schema/scene_desc.h"

namespace lumirank::scenedesc {

// Any supported format, chosen by the file's extension. A glTF scene without any light gets a white
// environment, with a warning.
SceneDesc read_scene(const std::string& filename, const ReadOptions& options = {});

// The image (latitude-longitude, +y up) in place of every environment that the scene has. InputError if there
// is no such file.
void replace_environment(SceneDesc& scene, const std::string& filename);
// A scene without any emitter gets an environment of radiance 1, and a warning; an InputError if that is
// strict.
void light_if_dark(SceneDesc& scene, const ReadOptions& options = {});

}  // namespace lumirank::scenedesc
