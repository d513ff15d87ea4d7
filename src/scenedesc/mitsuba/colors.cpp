// <rgb>, <srgb>, <spectrum> and <blackbody> as linear RGB.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/spectrum.h"
#include "scenedesc/mitsuba/values.h"
#include "scenedesc/schema/files.h"

namespace lumirank::scenedesc::mitsuba {

namespace {

constexpr std::size_t kMaxSamples = 100'000;  // of a spectrum

// "#rrggbb" as fractions of 255; false if the text is no such thing.
bool parse_hex(const std::string& text, Rgb& out) {
  const auto start = text.find_first_not_of(" \t");
  if (start == std::string::npos || text[start] != '#' || text.size() < start + 7) return false;
  if (text.find_first_not_of(" \t", start + 7) != std::string::npos) return false;
  const std::string digits = text.substr(start + 1, 6);
  if (digits.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos) return false;
  for (int i = 0; i < 3; ++i)
    out[i] = static_cast<float>(std::stoi(digits.substr(static_cast<std::size_t>(2 * i), 2), nullptr, 16)) /
             255.0f;
  return true;
}

Rgb parse_triple(const Element& element) {
  const std::string& text = element.require("value");
  const bool encoded = element.tag == "srgb";
  Rgb rgb;
  // A hexadecimal code is what a color picker shows: it is sRGB in either element.
  if (parse_hex(text, rgb)) return srgb_to_linear(rgb);
  const auto list = parse_list(text, element.where, "value of <" + element.tag + ">");
  if (list.size() != 1 && list.size() != 3)
    throw InputError(element.where, "<" + element.tag + "> has " + std::to_string(list.size()) +
                                        " numbers; 3 (or 1) are needed");
  rgb = list.size() == 1
            ? Rgb(static_cast<float>(list[0]))
            : Rgb(static_cast<float>(list[0]), static_cast<float>(list[1]), static_cast<float>(list[2]));
  return encoded ? srgb_to_linear(rgb) : rgb;
}

Rgb convert(const SampledSpectrum& spectrum, Intent intent) {
  return intent == Intent::emission ? emission_to_rgb(spectrum) : reflectance_to_rgb(spectrum);
}

void add_sample(SampledSpectrum& spectrum, double wavelength, double value, const SourceLocation& where) {
  if (!spectrum.wavelengths.empty() && !(static_cast<float>(wavelength) > spectrum.wavelengths.back()))
    throw InputError(
        where, "the wavelengths of the spectrum do not increase at " + std::to_string(wavelength) + " nm");
  if (spectrum.wavelengths.size() >= kMaxSamples)
    throw InputError(where, "the spectrum has more than 100,000 samples");
  spectrum.wavelengths.push_back(static_cast<float>(wavelength));
  spectrum.values.push_back(static_cast<float>(value));
}

// "400:0.1, 500:0.2 …"
SampledSpectrum parse_pairs(const std::string& text, const SourceLocation& where) {
  SampledSpectrum spectrum;
  std::string spaced = text;
  std::replace(spaced.begin(), spaced.end(), ',', ' ');
  std::istringstream in(spaced);
  for (std::string pair; in >> pair;) {
    const auto colon = pair.find(':');
    if (colon == std::string::npos)
      throw InputError(where, "\"" + pair.substr(0, 40) + "\" in <spectrum> is not wavelength:value",
                       "write 400:0.1, 500:0.2, …");
    add_sample(spectrum, parse_double(pair.substr(0, colon), where, "a wavelength of <spectrum>"),
               parse_double(pair.substr(colon + 1), where, "a value of <spectrum>"), where);
  }
  return spectrum;
}

// Lines "wavelength value"; # starts a comment.
SampledSpectrum read_spd(const std::string& filename, const SourceLocation& asked_at) {
  std::istringstream in(read_file(filename, asked_at));
  SampledSpectrum spectrum;
  SourceLocation where{filename, 0};
  for (std::string line; std::getline(in, line);) {
    ++where.line;
    line = line.substr(0, line.find('#'));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const auto pair = parse_list(line, where, "a sample of the spectrum");
    if (pair.size() != 2) throw InputError(where, "a line of a spectrum file needs a wavelength and a value");
    add_sample(spectrum, pair[0], pair[1], where);
  }
  if (spectrum.wavelengths.empty())
    throw InputError(asked_at, "the spectrum file " + filename + " holds no samples");
  return spectrum;
}

Rgb parse_spectrum(const Element& element, Intent intent) {
  if (const std::string* file = element.find("filename"))
    return convert(read_spd(resolve_path(*file, element.where.file), element.where), intent);
  const std::string& text = element.require("value");
  Rgb hex;
  if (parse_hex(text, hex)) return srgb_to_linear(hex);
  if (text.find(':') == std::string::npos) {
    const auto list = parse_list(text, element.where, "value of <spectrum>");
    if (list.size() == 1) return Rgb(static_cast<float>(list[0]));
    if (list.size() == 3)
      return {static_cast<float>(list[0]), static_cast<float>(list[1]), static_cast<float>(list[2])};
    throw InputError(element.where,
                     "<spectrum> has " + std::to_string(list.size()) + " values without wavelengths",
                     "write one value, or 400:0.1, 500:0.2, …");
  }
  return convert(parse_pairs(text, element.where), intent);
}

Rgb parse_blackbody(const Element& element) {
  std::string text = element.require("temperature");
  while (!text.empty() && (text.back() == 'K' || text.back() == 'k' || text.back() == ' ')) text.pop_back();
  const float kelvin = parse_float(text, element.where, "temperature of <blackbody>");
  if (!(kelvin > 0)) throw InputError(element.where, "the temperature of <blackbody> is not positive");
  const std::string* scale = element.find("scale");
  return blackbody_to_rgb(kelvin) *
         (scale ? parse_float(*scale, element.where, "scale of <blackbody>") : 1.0f);
}

}  // namespace

bool is_color_tag(const std::string& tag) {
  return tag == "rgb" || tag == "srgb" || tag == "spectrum" || tag == "blackbody" || tag == "float" ||
         tag == "integer" || tag == "color";
}

bool is_even_spectrum(const Element& element) {
  const std::string* value = element.tag == "spectrum" ? element.find("value") : nullptr;
  return value && !element.find("filename") && value->find_first_of(":#") == std::string::npos &&
         parse_list(*value, element.where, "value of <spectrum>").size() == 1;
}

Rgb parse_color(const Element& element, Intent intent) {
  Rgb value;
  if (element.tag == "rgb" || element.tag == "srgb" || element.tag == "color")
    value = parse_triple(element);
  else if (element.tag == "spectrum")
    value = parse_spectrum(element, intent);
  else if (element.tag == "blackbody")
    value = parse_blackbody(element);
  else
    value = Rgb(parse_float(element.require("value"), element.where, "the color"));
  if (!is_finite(value)) throw InputError(element.where, "the color overflows");
  // Spectra of saturated colors lie outside Rec. 709: their negative parts are cut off, as Mitsuba does.
  const bool from_spectrum =
      element.tag == "blackbody" || element.find("filename") ||
      (element.tag == "spectrum" && element.require("value").find(':') != std::string::npos);
  if (from_spectrum && (value.r < 0 || value.g < 0 || value.b < 0) && max_component(value) > 0)
    value = {std::max(value.r, 0.0f), std::max(value.g, 0.0f), std::max(value.b, 0.0f)};
  return value;
}

}  // namespace lumirank::scenedesc::mitsuba
