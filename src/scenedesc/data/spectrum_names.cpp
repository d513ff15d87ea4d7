// The spectra that pbrt knows by name.
#include "scenedesc/data/named_spectra.h"

#include <array>
#include <map>

#include "scenedesc/data/ior.h"

namespace lumirank::scenedesc {

Rgb from_chromaticity(double x, double y) {
  const double X = x / y, Z = (1 - x - y) / y;
  return {static_cast<float>(3.2404542 * X - 1.5371385 - 0.4985314 * Z),
          static_cast<float>(-0.9692660 * X + 1.8760108 + 0.0415560 * Z),
          static_cast<float>(0.0556434 * X - 0.2040259 + 1.0572252 * Z)};
}

std::optional<Rgb> named_illuminant(const std::string& name) {
  // Chromaticities of the CIE's illuminants for the 2° observer (CIE 15:2004, tables T.3 and T.8); F1 to F12
  // are fluorescent lamps. D60 is that of ACES (SMPTE ST 2065-1).
  static const std::map<std::string, std::array<double, 2>> known = {
      {"stdillum-A", {0.44757, 0.40745}},   {"stdillum-D50", {0.34567, 0.35850}},
      {"stdillum-D55", {0.33242, 0.34743}}, {"stdillum-D65", {0.31272, 0.32903}},
      {"stdillum-D75", {0.29902, 0.31485}}, {"illum-acesD60", {0.32168, 0.33767}},
      {"stdillum-F1", {0.3131, 0.3371}},    {"stdillum-F2", {0.3721, 0.3751}},
      {"stdillum-F3", {0.4091, 0.3941}},    {"stdillum-F4", {0.4402, 0.4031}},
      {"stdillum-F5", {0.3138, 0.3452}},    {"stdillum-F6", {0.3779, 0.3882}},
      {"stdillum-F7", {0.3129, 0.3292}},    {"stdillum-F8", {0.3458, 0.3586}},
      {"stdillum-F9", {0.3741, 0.3727}},    {"stdillum-F10", {0.3458, 0.3588}},
      {"stdillum-F11", {0.3805, 0.3769}},   {"stdillum-F12", {0.4370, 0.4042}}};
  if (name == "stdillum-D65") return Rgb(1);  // the white of Rec. 709 itself
  const auto found = known.find(name);
  if (found == known.end()) return std::nullopt;
  return from_chromaticity(found->second[0], found->second[1]);
}

std::optional<float> named_glass(const std::string& name) {
  // Indices at the d line from the catalogs of Schott and Hikari.
  static const std::map<std::string, float> known = {
      {"glass-BK7", 1.5168f}, {"glass-BAF10", 1.6700f}, {"glass-FK51A", 1.4866f}, {"glass-LASF9", 1.8503f},
      {"glass-F5", 1.6034f},  {"glass-SF5", 1.6727f},   {"glass-SF10", 1.7283f},  {"glass-SF11", 1.7847f}};
  const auto found = known.find(name);
  if (found == known.end()) return std::nullopt;
  return found->second;
}

std::optional<SampledSpectrum> named_metal(const std::string& name) {
  if (name.rfind("metal-", 0) != 0) return std::nullopt;
  const std::size_t dash = name.rfind('-');
  const std::string metal = name.substr(6, dash < 6 ? 0 : dash - 6), part = name.substr(dash + 1);
  if (part != "eta" && part != "k") return std::nullopt;
  const auto measured = metal_spectra(metal);
  if (!measured || metal.find('_') != std::string::npos) return std::nullopt;
  return part == "eta" ? measured->n : measured->k;
}

}  // namespace lumirank::scenedesc
