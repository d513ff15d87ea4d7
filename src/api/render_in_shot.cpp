#include "api/render_in_shot.h"

#include "api/build_world.h"
#include "api/scene.h"
#include "base/parallel.h"
#include "pipeline/memory.h"

namespace lumirank::api {
namespace {

constexpr int kMoments = 5;

}  // namespace

std::shared_ptr<const pipeline::ShotLights> plan_lights_of_motion(const Scene& scene,
                                                                  const RenderSettings& settings,
                                                                  const Sinks& sinks) {
  // With a time budget each frame chooses its number of lights, and an open shutter's instants have others.
  if (settings.lights.placement != LightPlacement::gather || settings.time > 0 || settings.view.is_open())
    return nullptr;
  const scenedesc::Motion& motion = scene.impl().desc.motion;
  std::shared_ptr<const pipeline::ShotLights> lights;
  pipeline::within_memory(pipeline::kSmallerPicture, [&] {
    with_threads(settings.threads, [&] {
      Sinks silent;
      silent.cancel = sinks.cancel;
      std::vector<pipeline::ShotMoment> moments;
      const int count = motion.end > motion.begin ? kMoments : 1;
      for (int k = 0; k < count; ++k) {
        const double part = count > 1 ? static_cast<double>(k) / (count - 1) : 0.0;
        const Scene now = scene.at(motion.begin + (motion.end - motion.begin) * part, silent);
        moments.push_back({build_world(now, silent), pipeline::make_view(now.impl().desc, settings.view)});
      }
      lights = pipeline::plan_shot_lights(moments, pipeline::make_recipe(settings, moments.front().view),
                                          pipeline::lights_for(pipeline::chosen_method(settings), settings),
                                          silent);
    });
  });
  return lights;
}

}  // namespace lumirank::api
