// Readers of scene and mesh files. With images and volumes, the only code that opens files.
// Every function throws InputError with file, line and remedy, whatever the bytes are; none prints or exits.
#pragma once

#include <map>
#include <string>

#include "base/sinks.h"
#include "scenedesc/schema/mesh.h"
#include "scenedesc/schema/scene_desc.h"

namespace lumirank::scenedesc {

struct ReadOptions {
  std::map<std::string, std::string> defines;  // --define NAME=VALUE: win over <default>
  bool strict = false;                         // the first warning becomes an error
  std::string environment = {};  // read_scene: an image that replaces whatever environment the scene has
  // Pictures, meshes and profiles that do not exist are a warning, and something visible stands in for them.
  bool allow_missing = false;
};

// Any supported format, chosen by the file's extension. A glTF scene without any light gets a white
// environment, with a warning.
SceneDesc read_scene(const std::string& filename, const ReadOptions& options = {});

// Mitsuba XML, 0.6 and 3.x (by the version attribute).
SceneDesc read_mitsuba(const std::string& filename, const ReadOptions& options = {});
// The same from memory (tests, fuzzing); relative names are taken from the folder of `filename`.
SceneDesc parse_mitsuba(const std::string& text, const std::string& filename,
                        const ReadOptions& options = {});

// glTF 2.0, .gltf or .glb (by the first bytes).
SceneDesc read_gltf(const std::string& filename, const ReadOptions& options = {});
// The same from memory; other files are taken from the folder of `filename`.
SceneDesc parse_gltf(const std::string& bytes, const std::string& filename, const ReadOptions& options = {});

// pbrt-v4. Names of files are relative to the folder of `filename`.
SceneDesc read_pbrt(const std::string& filename, const ReadOptions& options = {});
SceneDesc parse_pbrt(const std::string& text, const std::string& filename, const ReadOptions& options = {});

MeshData read_mesh(const MeshFileDesc& file);
// From memory; `filename` only names the source in messages. Indices are validated, non-finite vertices are
// an error, degenerate triangles are left out, and all that was mended is noted. A mesh that has no triangle,
// or none with an area, comes out empty: the world leaves it out.
MeshData parse_obj(const std::string& bytes, const std::string& filename);
MeshData parse_ply(const std::string& bytes, const std::string& filename);
MeshData parse_serialized(const std::string& bytes, const std::string& filename, int shape_index);

// For readers whose scene files hold meshes themselves: what parse_* do to every mesh. Lists that are not as
// long as the positions and indices beyond them are an error at `where`, as is a vertex that is not finite;
// the rest is mended and noted, and there may be no triangle left.
MeshData check_mesh(MeshData mesh, const SourceLocation& where);

// The image (latitude-longitude, +y up) in place of every environment that the scene has. InputError if there
// is no such file.
void replace_environment(SceneDesc& scene, const std::string& filename);
// A scene without any emitter gets an environment of radiance 1, and a warning; an InputError if that is
// strict.
void light_if_dark(SceneDesc& scene, const ReadOptions& options = {});

// An InputError, at its place, for the first BSDF or texture that is made of more others than any picture
// could mean (each use counts: mixtures of mixtures double), or of itself, and for groups of shapes that are
// placed more often than any memory could hold. Every reader ends with it.
void check_expansion(const SceneDesc& scene);

// The points of curves, from their file where they have one; none if it holds no curve. Text: "x y z radius"
// in every line, or "x y z" where file_radius is given; empty lines part the curves. With file_radius also
// the binary form of Mitsuba 0.6. InputError also where a curve has fewer points than its basis needs.
CurvesDesc read_curves(const CurvesDesc& curves);
CurvesDesc parse_curves(const std::string& bytes, const CurvesDesc& curves);

// Human-readable listing, for `lumirank info` and debugging.
std::string describe(const SceneDesc& scene);

}  // namespace lumirank::scenedesc
