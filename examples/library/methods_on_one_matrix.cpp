// What is prepared once serves any number of methods, and a second view of the same world takes over what it
// can.
//   methods_on_one_matrix
#include <cmath>
#include <cstdio>

#include "lumirank/session.h"
#include "room.h"

namespace {

double relative_l1(const std::vector<lumirank::Rgb>& a, const std::vector<lumirank::Rgb>& b) {
  double difference = 0, whole = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      difference += std::abs(static_cast<double>(a[i][c]) - static_cast<double>(b[i][c]));
      whole += static_cast<double>(b[i][c]);
    }
  return difference / whole;
}

}  // namespace

int main() {
  try {
    const lumirank::Scene scene = room().build();
    lumirank::RenderSettings settings;
    settings.lights.count = 4000;
    settings.view.spp = 1;
    const lumirank::Prepared prepared = lumirank::prepare(scene, settings);
    const lumirank::Matrix matrix = prepared.matrix();
    std::printf("%zu receivers × %zu virtual lights\n", matrix.rows(), matrix.columns());

    const auto exact = lumirank::estimate_sums(prepared, {.name = "brute-force"});
    int bad = 0;
    for (const char* name : {"power-sampling", "row-column-sampling", "lightcuts", "slice-cuts"}) {
      const auto estimate = lumirank::estimate_sums(prepared, {.name = name});
      const double error = relative_l1(estimate.sums, exact.sums);
      std::printf("%-20s %5.1f %% error, %5.1f %% of all entries\n", name, 100 * error,
                  100 * static_cast<double>(estimate.cost.entries) /
                      (static_cast<double>(matrix.rows()) * static_cast<double>(matrix.columns())));
      bad += error > 0.4;
    }

    settings.lights.count = 2000;  // the world and the receivers are taken over
    const lumirank::Prepared fewer = lumirank::prepare(scene, settings, {}, prepared);
    bad += fewer.matrix().rows() != matrix.rows();
    return bad;
  } catch (const lumirank::InputError& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 2;
  }
}
