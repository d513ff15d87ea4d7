// A shot whose frames do not flicker: tensor clustering of a scene that moves. What is finished stays, so the
// program can be stopped and started again.
//   render_shot scene.xml frames
#include <cstdio>

#include "lumirank/animate.h"

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: %s SCENE FOLDER\n", argv[0]), 2;
  try {
    const lumirank::Scene scene = lumirank::Scene::load(argv[1]);
    lumirank::AnimateSettings settings;
    settings.render.view.width = 64;
    settings.render.view.height = 64;
    settings.render.view.spp = 1;
    settings.render.lights.count = 1000;
    settings.tensor = lumirank::TensorSettings{.chunk = 4, .overlap = 1, .columns = 50};
    settings.frames_per_second = 12;
    settings.first = 0, settings.last = 5;
    settings.endings = {".png"};
    lumirank::Sinks sinks;
    sinks.progress = [](const char* stage, double done) { std::printf("%s: %.0f %%\n", stage, 100 * done); };
    const lumirank::AnimationResult made = lumirank::animate(scene, settings, argv[2], sinks);
    const lumirank::AnimationResult again = lumirank::animate(scene, settings, argv[2], sinks);
    std::printf("%d frames rendered, then %d kept\n", made.rendered, again.kept);
    return made.rendered == 6 && again.rendered == 0 && again.kept == 6 ? 0 : 1;
  } catch (const lumirank::InputError& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 2;
  }
}
