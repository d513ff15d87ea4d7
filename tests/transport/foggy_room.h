// A scene with all that entries in participating media depend on, its rows and its columns.
#pragma once

#include <memory>

#include "support/scenes.h"
#include "transport/cpu/media_matrix.h"
#include "transport/matrix_fixture.h"

namespace lumirank::transport {

// A room with a lamp, blocks, a glass pane and a cut-out, all in a colored fog that scatters forwards, and a
// ball of uneven smoke behind a null surface.
inline scenedesc::SceneDesc foggy_room() {
  using namespace scenedesc;
  SceneDesc desc = testing::room_with_blocks();
  MediumDesc fog;
  fog.extinction.value = {0.2f, 0.3f, 0.5f}, fog.albedo.value = Rgb(0.8f);
  PhaseLobeDesc ahead;
  ahead.g = Rgb(0.4f), ahead.weight = 0.7f;
  PhaseLobeDesc back;
  back.kind = PhaseLobeDesc::Kind::schlick, back.g = {-0.3f, 0, 0.2f}, back.weight = 0.3f;
  fog.phase = {ahead, back};
  MediumDesc smoke;
  smoke.extinction = {Rgb(2), 0}, smoke.albedo.value = {0.9f, 0.7f, 0.5f};
  desc.media = {fog, smoke};
  auto grid = std::make_shared<GridData>();
  grid->size = {5, 6, 7};
  Rng rng(3, Stage::test);
  for (int k = 0; k < 5 * 6 * 7; ++k) grid->values.push_back(rng.next_float());
  VolumeDesc volume;
  volume.to_world = Transform::translate(0.5, 0.5, -0.9) * Transform::translate(-0.5, -0.5, -0.5);
  volume.kind = std::shared_ptr<const GridData>(grid);
  desc.volumes.push_back(volume);
  testing::add_shape(desc, SphereDesc{},
                     Transform::translate(0.5, 0.5, -0.9) * Transform::scale(0.45, 0.45, 0.45),
                     testing::add_bsdf(desc, NullBsdfDesc{}));
  desc.shapes.back().media = {true, 1, 0};
  ThinDielectricDesc glass;
  glass.specular_transmittance.value = {0.9f, 0.8f, 0.7f};
  testing::add_shape(desc, RectangleDesc{},
                     Transform::translate(-0.9, -0.9, 0.8) * Transform::scale(0.4, 0.4, 0.4),
                     testing::add_bsdf(desc, glass));
  MaskDesc holes;
  holes.nested = testing::add_bsdf(desc, DiffuseDesc{});
  testing::add_shape(desc, RectangleDesc{},
                     Transform::translate(0.9, -0.1, 1.2) * Transform::scale(0.3, 0.3, 0.3),
                     testing::add_bsdf(desc, holes));
  PhongDesc shiny;
  shiny.diffuse_reflectance.value = Rgb(0.3f);
  testing::add_shape(desc, CubeDesc{},
                     Transform::translate(-1.2, -1.5, -1.2) * Transform::scale(0.5, 0.5, 0.5),
                     testing::add_bsdf(desc, shiny));
  testing::add_shape(
      desc, RectangleDesc{},
      Transform::translate(0, 1.9, 0) * Transform::rotate(1, 0, 0, 90) * Transform::scale(0.6, 0.6, 0.6));
  ColorInput radiance;
  radiance.value = {8, 7, 5};
  desc.shapes.back().emitter = AreaEmitterDesc{radiance, "lamp", {}};
  EmitterDesc sun;
  sun.kind = DirectionalLightDesc{};
  desc.emitters.push_back(sun);
  EmitterDesc bulb;
  PointLightDesc point;
  point.position = {-1.5, 1.2, 1.0};
  bulb.kind = point;
  desc.emitters.push_back(bulb);
  return desc;
}

struct FoggyRoom {
  world::World world = testing::build_world(foggy_room());
  Receivers rows;
  LightsInMedia lights;

  FoggyRoom() {
    ReceiverSettings settings;
    settings.spp = 1, settings.eye_medium = 0, settings.segments = 4;
    scenedesc::SensorDesc sensor = test::sensor({0.1f, 0.2f, 1.9f}, {0, -0.2f, 0}, {0, 1, 0}, 80, 7, 5);
    sensor.medium = 0;
    rows = trace_receivers(world, world::Camera(sensor), settings);
    MediaLightSettings light_settings;
    light_settings.count = 150, light_settings.eye_medium = 0;
    lights = trace_lights_in_media(world, light_settings);
  }
  MediaMatrix matrix(bool shared, std::uint64_t seed = 5) const {
    MediaMatrixSettings settings;
    settings.scene.seed = seed, settings.scene.clamp = 0, settings.scene.max_depth = 7;
    settings.shared_places = shared;
    return {world, rows, lights, settings};
  }
};

inline const FoggyRoom& room() {
  static const FoggyRoom built;
  return built;
}

}  // namespace lumirank::transport
