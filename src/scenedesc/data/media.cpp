#include "scenedesc/data/media.h"

#include <array>
#include <cmath>
#include <utility>

namespace lumirank::scenedesc {
namespace {

const std::array<std::pair<const char*, NamedMedium>, 18> kNamedMedia = {{
    {"drink", {{0.04f, 0.04f, 0.06f}, {0.02f, 0.02f, 0.009f}, {0.93f, 0.93f, 0.94f}}},
    {"jade", {{1, 1, 1}, {0.002f, 0.004f, 0.007f}, {0.9f, 0.9f, 0.9f}}},
    {"soap", {{0.2f, 0.2f, 0.22f}, {0.001f, 0.001f, 0.002f}, {0.96f, 0.95f, 0.94f}}},
    {"juice", {{0.15f, 0.15f, 0.16f}, {0.03f, 0.17f, 0.48f}, {0.93f, 0.93f, 0.93f}}},
    {"skin", {{0.74f, 0.88f, 1}, {0.03f, 0.17f, 0.48f}, {0, 0, 0}}},
    {"milk", {{1, 1, 1}, {0.0026f, 0.005f, 0.01f}, {0.82f, 0.8f, 0.75f}}},
    {"Apple", {{2.29f, 2.39f, 1.97f}, {0.003f, 0.0034f, 0.046f}, Rgb(0)}},
    {"Chicken1", {{0.15f, 0.21f, 0.38f}, {0.015f, 0.077f, 0.19f}, Rgb(0)}},
    {"Chicken2", {{0.19f, 0.25f, 0.32f}, {0.018f, 0.088f, 0.2f}, Rgb(0)}},
    {"Cream", {{7.38f, 5.47f, 3.15f}, {0.0002f, 0.0028f, 0.0163f}, Rgb(0)}},
    {"Ketchup", {{0.18f, 0.07f, 0.03f}, {0.061f, 0.97f, 1.45f}, Rgb(0)}},
    {"Marble", {{2.19f, 2.62f, 3}, {0.0021f, 0.0041f, 0.0071f}, Rgb(0)}},
    {"Potato", {{0.68f, 0.7f, 0.55f}, {0.0024f, 0.009f, 0.12f}, Rgb(0)}},
    {"Skimmilk", {{0.7f, 1.22f, 1.9f}, {0.0014f, 0.0025f, 0.0142f}, Rgb(0)}},
    {"Skin1", {{0.74f, 0.88f, 1.01f}, {0.032f, 0.17f, 0.48f}, Rgb(0)}},
    {"Skin2", {{1.09f, 1.59f, 1.79f}, {0.013f, 0.07f, 0.145f}, Rgb(0)}},
    {"Spectralon", {{11.6f, 20.4f, 14.9f}, {0, 0, 0}, Rgb(0)}},
    {"Wholemilk", {{2.55f, 3.21f, 3.77f}, {0.0011f, 0.0024f, 0.014f}, Rgb(0)}},
}};

}  // namespace

std::optional<NamedMedium> named_medium(const std::string& name) {
  for (const auto& [known, medium] : kNamedMedia)
    if (name == known) return medium;
  return std::nullopt;
}

Rgb albedo_of_depth(Rgb scattering, Rgb absorption, float mean_cosine) {
  Rgb out;
  for (int c = 0; c < 3; ++c) {
    const float extinction = scattering[c] + absorption[c];
    const float single = extinction > 0 ? scattering[c] / extinction : 0;
    const float s = std::sqrt((1 - single) / (1 - single * mean_cosine));
    out[c] = (1 - s) * (1 - 0.139f * s) / (1 + 1.17f * s);
  }
  return out;
}

std::string medium_names() {
  std::string out;
  for (const auto& [known, medium] : kNamedMedia) out += (out.empty() ? "" : ", ") + std::string(known);
  return out;
}

}  // namespace lumirank::scenedesc
