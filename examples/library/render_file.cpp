// A picture of a scene file, with typed settings and a typed report.
//   render_file SCENE PICTURE
#include <cstdio>

#include "lumirank/lumirank.h"

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "render_file SCENE PICTURE\n"), 2;
  try {
    const auto scene = lumirank::Scene::load(argv[1]);
    lumirank::RenderSettings settings;
    settings.view.width = 96, settings.view.height = 72;
    settings.lights.count = 4000;
    settings.traced.rest = lumirank::RestOfPaths::skip;
    lumirank::Sinks sinks;
    sinks.warning = [](const std::string& text) { std::fprintf(stderr, "warning: %s\n", text.c_str()); };
    const lumirank::RenderResult result = lumirank::render(scene, settings, sinks);
    lumirank::write_picture(argv[2], result.picture, {.tonemap = lumirank::ToneMap::agx});
    const lumirank::Report& report = result.report;
    std::printf("%s: %llu receivers, %llu virtual lights, %.2f s\n", report.method.c_str(),
                static_cast<unsigned long long>(report.sizes->receivers),
                static_cast<unsigned long long>(report.sizes->lights), report.seconds.at("total"));
    if (const auto error = report.stated_error()) std::printf("stated error: %.1f %%\n", 100 * *error);
  } catch (const lumirank::InputError& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 2;
  }
}
