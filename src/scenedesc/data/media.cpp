#include "scenedesc/data/media.h"

#include <array>
#include <utility>

namespace lumirank::scenedesc {
namespace {

const std::array<std::pair<const char*, NamedMedium>, 6> kNamedMedia = {{
    {"drink", {{0.04f, 0.04f, 0.06f}, {0.02f, 0.02f, 0.009f}, {0.93f, 0.93f, 0.94f}}},
    {"jade", {{1, 1, 1}, {0.002f, 0.004f, 0.007f}, {0.9f, 0.9f, 0.9f}}},
    {"soap", {{0.2f, 0.2f, 0.22f}, {0.001f, 0.001f, 0.002f}, {0.96f, 0.95f, 0.94f}}},
    {"juice", {{0.15f, 0.15f, 0.16f}, {0.03f, 0.17f, 0.48f}, {0.93f, 0.93f, 0.93f}}},
    {"skin", {{0.74f, 0.88f, 1}, {0.03f, 0.17f, 0.48f}, {0, 0, 0}}},
    {"milk", {{1, 1, 1}, {0.0026f, 0.005f, 0.01f}, {0.82f, 0.8f, 0.75f}}},
}};

}  // namespace

std::optional<NamedMedium> named_medium(const std::string& name) {
  for (const auto& [known, medium] : kNamedMedia)
    if (name == known) return medium;
  return std::nullopt;
}

std::string medium_names() {
  std::string out;
  for (const auto& [known, medium] : kNamedMedia) out += (out.empty() ? "" : ", ") + std::string(known);
  return out;
}

}  // namespace lumirank::scenedesc
