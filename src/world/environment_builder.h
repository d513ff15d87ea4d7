// Everything infinitely far away, gathered into one environment emitter (and suns apart).
//
// A scene may have several such emitters: light adds, so their radiance is summed, at the resolution of the
// finest map and in the frame of the first map.
#pragma once

#include <optional>
#include <vector>

#include "emitters/emitter.h"
#include "image/image.h"
#include "scenedesc/schema/scene_desc.h"
#include "world/notes.h"

namespace lumirank::world {

class EnvironmentBuilder {
 public:
  explicit EnvironmentBuilder(Notes& notes) : notes_(notes) {}

  void add_constant(Rgb radiance, const scenedesc::EmitterDesc& from);
  // Reads the file.
  void add_map(const scenedesc::EnvironmentMapDesc& map, const scenedesc::EmitterDesc& from);
  // The sky joins the environment; the sun, if there is one, is returned.
  std::optional<emitters::DirectionalEmitter> add_sun_sky(const scenedesc::SunSkyDesc& d,
                                                          const scenedesc::EmitterDesc& from);

  bool empty() const { return parts_.empty(); }
  const scenedesc::EmitterDesc& first() const { return *first_; }
  emitters::EnvironmentEmitter build();

 private:
  void add_equal_area(const scenedesc::EnvironmentMapDesc& map, image::Image image,
                      const scenedesc::EmitterDesc& from);
  void add(emitters::EnvironmentEmitter part, const scenedesc::EmitterDesc& from);

  Notes& notes_;
  const scenedesc::EmitterDesc* first_ = nullptr;
  std::vector<emitters::EnvironmentEmitter> parts_;
};

}  // namespace lumirank::world
