// Description of a scene: what its file says, after parsing and before anything is built: plain values,
// printable, rewritable, and the same for every file format. Names are resolved to indices; files are named
// (absolute paths) but not opened, except that a reader may check that they exist.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "base/photometry.h"
#include "scenedesc/schema/bsdfs.h"
#include "scenedesc/schema/emitters.h"
#include "scenedesc/schema/media.h"
#include "scenedesc/schema/sensor.h"
#include "scenedesc/schema/shapes.h"
#include "scenedesc/schema/textures.h"

namespace lumirank::scenedesc {

struct Warning {
  SourceLocation where;
  std::string what;          // names the thing that Lumirank does not have
  std::string used_instead;  // "" if it is left out
  bool harmless = false;     // only a note: no picture shows the difference, so --strict lets it pass
};

// What of the scene moves, and when.
struct Motion {
  double begin = 0, end = 0;        // seconds: the first and the last key; equal: nothing moves
  std::vector<std::string> moving;  // for listings: "nodes[3] (Fox): rotation"
  std::vector<std::string> clips;   // names that ReadOptions::clip may have
};

struct SceneDesc {
  std::string source_file;
  std::string format;  // "mitsuba 0.6", "mitsuba 3.0", …
  // Photometric value of a radiometric quantity whose luminance() is 1: cd/m² of radiance, lux of irradiance,
  // cd of intensity. The default: units of W/nm (base/photometry.h); 1: the scene is in photometric units.
  double lumens_per_unit = kLumensPerUnit;
  std::vector<TextureDesc> textures;
  std::vector<BsdfDesc> bsdfs;
  std::vector<VolumeDesc> volumes;
  std::vector<MediumDesc> media;
  std::vector<ShapeDesc> shapes;
  std::vector<EmitterDesc> emitters;
  std::vector<SensorDesc> sensors;  // at least one after a successful read
  int max_depth = -1;               // Mitsuba's count; -1: unlimited
  std::string integrator;           // as named in the file
  // The eye looks straight through what shines, into a black background; mirrors and glass show it.
  bool hide_emitters = false;
  Motion motion;
  std::vector<Warning> warnings;
};

}  // namespace lumirank::scenedesc
