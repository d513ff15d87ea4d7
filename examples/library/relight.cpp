// A finished picture under other lights: the estimate is one combination of columns, and every column knows
// its emitter.
//   relight PICTURE
#include <cmath>
#include <cstdio>

#include "lumirank/session.h"
#include "room.h"

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "relight PICTURE\n"), 2;
  try {
    lumirank::RenderSettings settings;
    settings.lights.count = 3000;
    settings.layers = {"light:*"};  // columns of one emitter are clustered among themselves
    const lumirank::Prepared prepared = lumirank::prepare(room().build(), settings);
    // A bound on single columns is not linear in their scale; without it the parts add up to the whole.
    const auto estimate = lumirank::estimate_sums(
        prepared, {.name = "row-column-sampling", .parameters = {{"max-contribution", "0"}}});
    const lumirank::Relighting relighting(prepared, estimate);
    for (const auto& name : relighting.lights()) std::printf("light: %s\n", name.c_str());

    // With all lights as they are it is the picture itself.
    const auto whole = lumirank::develop(prepared, estimate), same = relighting.picture({});
    double difference = 0, light = 0;
    for (std::size_t k = 0; k < same.planes[0].rgb.size(); ++k) {
      difference +=
          std::abs(static_cast<double>(same.planes[0].rgb[k]) - static_cast<double>(whole.planes[0].rgb[k]));
      light += static_cast<double>(whole.planes[0].rgb[k]);
    }
    std::printf("unchanged lights differ by %.2g of the light\n", difference / light);

    const auto evening = relighting.picture({{"lamp", {0.1f, 0.08f, 0.05f}}, {"blue", lumirank::Rgb(3)}});
    lumirank::write_picture(argv[1], evening);
    return difference < 1e-4 * light ? 0 : 1;
  } catch (const lumirank::InputError& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 2;
  }
}
