// A scene without a file: made of meshes, materials and lights, changed, and rendered again.
//   scene_in_memory PICTURE
#include <cstdio>

#include "room.h"

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "scene_in_memory PICTURE\n"), 2;
  try {
    lumirank::SceneBuilder builder = room();
    lumirank::RenderSettings settings;
    settings.lights.count = 3000;
    const auto mean = [](const lumirank::Picture& picture) {
      double sum = 0;
      for (const float x : picture.planes[0].rgb) sum += x;
      return sum / static_cast<double>(picture.planes[0].rgb.size());
    };
    const auto before = lumirank::render(builder.build(), settings);
    builder.add_point_light({1, 2, 1}, {3, 3, 3}, "one more");
    const auto after = lumirank::render(builder.build(), settings);
    lumirank::write_picture(argv[1], after.picture);
    std::printf("mean radiance %.3f, with one more light %.3f\n", mean(before.picture), mean(after.picture));
    return mean(after.picture) > mean(before.picture) ? 0 : 1;
  } catch (const lumirank::InputError& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 2;
  }
}
