// Indices of refraction of transparent materials by name.
#include <algorithm>
#include <cctype>
#include <utility>

#include "scenedesc/data/ior.h"

namespace lumirank::scenedesc {

namespace {

// Near 589 nm, at room temperature.
constexpr std::pair<const char*, float> kDielectrics[] = {
    {"vacuum", 1.0f},      {"helium", 1.000036f},        {"hydrogen", 1.000132f},
    {"air", 1.000277f},    {"carbon dioxide", 1.00045f}, {"water", 1.3330f},
    {"acetone", 1.36f},    {"ethanol", 1.361f},          {"carbon tetrachloride", 1.461f},
    {"glycerol", 1.4729f}, {"benzene", 1.501f},          {"silicone oil", 1.52045f},
    {"bromine", 1.661f},   {"water ice", 1.31f},         {"fused quartz", 1.458f},
    {"pyrex", 1.470f},     {"acrylic glass", 1.49f},     {"polypropylene", 1.49f},
    {"bk7", 1.5046f},      {"sodium chloride", 1.544f},  {"amber", 1.55f},
    {"pet", 1.5750f},      {"diamond", 2.419f}};

}  // namespace

std::optional<float> dielectric_index(const std::string& name) {
  std::string lower = name;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return c == '_' ? ' ' : static_cast<char>(std::tolower(c)); });
  for (const auto& [known, index] : kDielectrics)
    if (lower == known) return index;
  return std::nullopt;
}

std::string dielectric_names() {
  std::string names;
  for (const auto& [known, index] : kDielectrics) names += (names.empty() ? "" : ", ") + std::string(known);
  return names;
}

}  // namespace lumirank::scenedesc
