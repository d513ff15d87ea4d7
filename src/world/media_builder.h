// Descriptions of participating media → media in the units of the world; every grid file is read once.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "media/medium.h"
#include "scenedesc/schema/scene_desc.h"
#include "scenedesc/volumes/grid_file.h"
#include "world/notes.h"
#include "world/units.h"

namespace lumirank::world {

class MediaBuilder {
 public:
  MediaBuilder(const scenedesc::SceneDesc& desc, Notes& notes) : desc_(desc), notes_(notes) {}

  // One for each of the description's. InputError, at the volume, for a file that cannot be read; numbers
  // that make no sense (negative ones, albedos above 1) are warned about.
  std::vector<media::Medium> build(const Units& units);
  std::size_t memory_bytes() const { return memory_bytes_; }  // of the grids, after build()

 private:
  struct Volume {
    std::shared_ptr<const media::Grid> grid;
    float least = 0, most = 0;  // of its numbers
    Transform box;              // from the unit cube to what VolumeDesc::to_world is applied to
  };
  const Volume& volume(int index, const SourceLocation& user);
  enum class Meaning { coefficient, albedo };
  media::Field field(const scenedesc::VolumeInput& input, Meaning meaning,
                     const scenedesc::MediumDesc& medium, const char* name, const Units& units);

  const scenedesc::SceneDesc& desc_;
  Notes& notes_;
  std::map<int, Volume> volumes_;
  std::map<std::pair<std::string, std::string>, scenedesc::GridFile> files_;  // by name and grid
  std::size_t memory_bytes_ = 0;
};

}  // namespace lumirank::world
