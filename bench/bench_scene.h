// What programs that time a scene share: settings from the environment, and the scene with its receivers.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <string>
#include <vector>

#include "scenedesc/readers.h"
#include "transport/lights/virtual_lights.h"
#include "transport/rows/receivers.h"
#include "world/world.h"

namespace lumirank::bench {

inline int setting(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text ? std::atoi(text) : otherwise;
}

// BENCH_WIDTH × BENCH_HEIGHT pixels (else width × height) of BENCH_SPP receivers (else 4).
class BenchScene {
 public:
  BenchScene(const std::string& file, int width, int height)
      : desc_(sized(file, width, height)),
        world(world::World::build(desc_, {}, warnings_)),
        receivers(transport::trace_receivers(world, world::Camera(desc_.sensors.at(0)),
                                             {1, setting("BENCH_SPP", 4)})) {}

  // BENCH_LIGHTS of them, else `count`.
  transport::VirtualLights lights(int count, transport::LightSettings settings = {},
                                  bool aimed = true) const {
    settings.count = static_cast<std::size_t>(setting("BENCH_LIGHTS", count));
    if (aimed) settings.receivers = &receivers;
    return transport::trace_virtual_lights(world, settings);
  }

 private:
  static scenedesc::SceneDesc sized(const std::string& file, int width, int height) {
    scenedesc::SceneDesc desc = scenedesc::read_scene(file);
    desc.sensors.at(0).film.width = setting("BENCH_WIDTH", width);
    desc.sensors.at(0).film.height = setting("BENCH_HEIGHT", height);
    return desc;
  }
  scenedesc::SceneDesc desc_;
  std::vector<scenedesc::Warning> warnings_;

 public:
  const world::World world;
  const transport::Receivers receivers;
};

}  // namespace lumirank::bench
