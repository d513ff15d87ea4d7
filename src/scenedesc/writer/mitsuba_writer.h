// A scene description as Mitsuba 3 XML, whatever format it was read from.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenedesc/schema/scene_desc.h"

namespace lumirank::scenedesc {

struct WrittenFile {
  std::string name;  // in the folder of the scene file
  std::string bytes;
};

struct WrittenScene {
  std::string xml;
  std::vector<WrittenFile> files;  // meshes, pictures, volumes and curves that the description itself holds
  // What Mitsuba 3 cannot say, and what is written in its place.
  std::vector<Warning> warnings;
};

// What takes opening pictures, which the writer itself does not do. Each may be empty: then what it would
// make gives way to something else, with a warning.
struct Painter {
  // A picture in place of a texture that is made of pictures (products, mixtures, single channels, …), or
  // nothing if no single picture has its values.
  std::function<std::optional<BitmapTextureDesc>(int texture)> texture;
  // All maps and constants of the scene that surround it, as one map of latitudes and longitudes.
  struct Environment {
    std::string exr;
    Transform to_world;  // +y up, as that of EnvironmentMapDesc
  };
  std::function<Environment()> environment;
  // Mean of the picture of a goniometric light over the sphere.
  std::function<double(const EmitterDesc& light)> mean;
};

// `filename` (OUT.xml) only names: files that the scene refers to are named relative to its folder, and those
// of `files` begin with its stem. Nothing is written. Reads mesh files whose normals are to be made anew, IES
// profiles and volumes; InputError if one cannot be read.
WrittenScene write_mitsuba(const SceneDesc& scene, const std::string& filename, const Painter& painter = {});

// Every file that the description names.
std::vector<std::string> files_of(const SceneDesc& scene);

// A mesh as a binary PLY file: x y z, and as far as it has them nx ny nz, u v, r g b, as floats.
std::string ply_bytes(const MeshData& mesh);

}  // namespace lumirank::scenedesc
