#include "scenedesc/pbrt/spectra.h"

#include <algorithm>
#include <cmath>

#include "scenedesc/data/named_spectra.h"
#include "scenedesc/pbrt/reader.h"

namespace lumirank::scenedesc::pbrt {

namespace {

struct Matrix {
  float m[9];
  Rgb operator*(Rgb c) const {
    return {m[0] * c.r + m[1] * c.g + m[2] * c.b, m[3] * c.r + m[4] * c.g + m[5] * c.b,
            m[6] * c.r + m[7] * c.g + m[8] * c.b};
  }
};
// To linear Rec. 709, from the primaries and whites of the spaces: DCI-P3 with the white D65 (SMPTE RP 431-2,
// display P3), ITU-R BT.2020, ACES 2065-1 (white D60, kept here).
constexpr Matrix kP3{
    {1.2249402f, -0.2249402f, 0, -0.0420570f, 1.0420570f, 0, -0.0196376f, -0.0786361f, 1.0982736f}};
constexpr Matrix kRec2020{{1.6604910f, -0.5876411f, -0.0728499f, -0.1245505f, 1.1328999f, -0.0083494f,
                           -0.0181508f, -0.1005789f, 1.1187297f}};
constexpr Matrix kAces{{2.5583842f, -1.1194727f, -0.3917618f, -0.2779865f, 1.3660063f, -0.0934874f,
                        -0.0171709f, -0.1485237f, 1.0810826f}};

Rgb not_negative(Rgb c) { return {std::max(c.r, 0.0f), std::max(c.g, 0.0f), std::max(c.b, 0.0f)}; }

Rgb unit_luminance(Params& p, const char* name, Rgb c) {
  const float y = luminance(c);
  if (!(y > 0) || !std::isfinite(y)) p.fail(name, "has no luminance", "give a spectrum that is seen");
  return c / y;
}

SampledSpectrum pairs(Params& p, const char* name, const std::vector<double>& numbers) {
  SampledSpectrum out;
  for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
    if (i > 0 && !(numbers[i] > numbers[i - 2]))
      p.fail(name, "has wavelengths that do not increase", "sort them; none may be there twice");
    out.wavelengths.push_back(static_cast<float>(numbers[i]));
    out.values.push_back(static_cast<float>(numbers[i + 1]));
  }
  if (out.values.empty()) p.fail(name, "has no values", "give pairs of wavelength (nm) and value");
  return out;
}

// What the files of pbrt-v3's scenes have, "spds/Au.eta.spd", say.
std::optional<SampledSpectrum> metal_of_file(const std::string& file) {
  std::string name = file.substr(file.find_last_of('/') + 1);
  if (!name.ends_with(".eta.spd") && !name.ends_with(".k.spd")) return std::nullopt;
  name.erase(name.size() - 4);
  const std::size_t dot = name.rfind('.');
  return named_metal("metal-" + name.substr(0, dot) + "-" + name.substr(dot + 1));
}

// A spectrum parameter that is not the name of an illuminant or a glass.
SampledSpectrum sampled(Params& p, const char* name, const Parameter& parameter) {
  if (parameter.texts.empty()) return pairs(p, name, parameter.numbers);
  if (const auto metal = named_metal(parameter.texts[0])) return *metal;
  if (p.reader().version3() && p.reader().resolve(parameter.texts[0], p.where_of(name)).empty())
    if (const auto metal = metal_of_file(parameter.texts[0])) return *metal;
  return spectrum_file(p, name, parameter.texts[0]);
}

// pbrt-v3 takes the nearest color that there is.
Rgb in_range_of_version3(Rgb c, Intent intent) {
  return intent == Intent::albedo ? clamp_below(not_negative(c), 1) : not_negative(c);
}

void check_range(Params& p, const char* name, Rgb c, Intent intent) {
  for (int i = 0; i < 3; ++i) {
    if (c[i] < 0) p.fail(name, "is negative", "give 0 or more");
    if (intent == Intent::albedo && c[i] > 1) p.fail(name, "is above 1", "reflectances lie between 0 and 1");
  }
}

}  // namespace

std::optional<ColorSpace> color_space(const std::string& name) {
  if (name == "srgb") return ColorSpace::srgb;
  if (name == "dci-p3") return ColorSpace::dci_p3;
  if (name == "rec2020") return ColorSpace::rec2020;
  if (name == "aces2065-1") return ColorSpace::aces;
  return std::nullopt;
}

Rgb from_space(Rgb rgb, ColorSpace space, Intent intent) {
  switch (space) {
    case ColorSpace::srgb:
      return rgb;
    case ColorSpace::dci_p3:
      return not_negative(kP3 * rgb);
    case ColorSpace::rec2020:
      return not_negative(kRec2020 * rgb);
    case ColorSpace::aces: {
      // Reflectances of 1 reflect everything: the white is divided out.
      const Rgb white = intent == Intent::illuminant ? Rgb(1) : kAces * Rgb(1);
      return not_negative(kAces * rgb) / white;
    }
  }
  return rgb;
}

SampledSpectrum spectrum_file(Params& p, const char* name, const std::string& file) {
  Reader& reader = p.reader();
  if (reader.resolve(file, p.where_of(name)).empty())
    p.fail(name, "is " + in_quotes(file) + ", which is neither a spectrum that is known nor a file",
           "known are metal-{Ag,Al,Au,Cu,CuZn,MgO,TiO2,…}-{eta,k}, glass-…, stdillum-…");
  std::vector<double> numbers;
  const std::string path = reader.existing_file(file, p.where_of(name), "spectrum");
  const File text{path, reader.file_text(path, p.where_of(name))};
  Tokens tokens(text);
  while (tokens.peek().kind != Token::Kind::end) {
    const Token token = tokens.take();
    if (token.kind != Token::Kind::word)
      throw InputError(tokens.place(token), "this is no file of wavelengths and values");
    numbers.push_back(parse_number(token.value, tokens.place(token)));
  }
  if (numbers.size() % 2 != 0)
    throw InputError({path, 1}, "an odd count of numbers", "give pairs of wavelength (nm) and value");
  return pairs(p, name, numbers);
}

std::optional<Rgb> constant_color(Params& p, const char* name, Intent intent) {
  const Parameter* parameter = p.is_texture(name) ? nullptr : p.find(name);
  if (!parameter) return std::nullopt;
  if (parameter->type == ParamType::rgb) {
    const auto& v = parameter->numbers;
    if (v.size() != 3) p.fail(name, "has " + std::to_string(v.size()) + " numbers; 3 are needed");
    Rgb c{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
    if (p.reader().version3()) c = in_range_of_version3(c, intent);
    check_range(p, name, c, intent);
    return from_space(c, p.reader().state().space, intent);
  }
  if (parameter->type == ParamType::blackbody) {
    // In pbrt-v3 with a factor behind it.
    const bool scaled = p.reader().version3() && parameter->numbers.size() == 2;
    if ((parameter->numbers.size() != 1 && !scaled) || !(parameter->numbers[0] > 0))
      p.fail(name, "is not one temperature above 0", "give it in kelvin");
    const float factor = scaled ? std::max(0.0f, static_cast<float>(parameter->numbers[1])) : 1.0f;
    if (intent != Intent::illuminant) p.fail(name, "is a blackbody, and not of a light", "give an rgb color");
    return unit_luminance(p, name,
                          not_negative(blackbody_to_rgb(static_cast<float>(parameter->numbers[0])))) *
           factor;
  }
  if (parameter->type != ParamType::spectrum)
    p.fail(name, "is declared as " + parameter->type_name + ", and a color is needed",
           std::string("write \"rgb ") + name + "\" or \"spectrum " + name + "\"");
  if (!parameter->texts.empty() && intent == Intent::illuminant)
    if (const auto known = named_illuminant(parameter->texts[0])) return not_negative(*known);
  const SampledSpectrum spectrum = sampled(p, name, *parameter);
  for (const float v : spectrum.values) check_range(p, name, Rgb(v), intent);
  if (intent == Intent::illuminant) {
    const Rgb light = not_negative(emission_to_rgb(spectrum));
    return p.reader().version3() ? light : unit_luminance(p, name, light);
  }
  const Rgb c = not_negative(reflectance_to_rgb(spectrum));
  return intent == Intent::albedo ? clamp_below(c, 1) : c;
}

float dielectric_eta(Params& p, const char* name, float fallback) {
  const Parameter* parameter = p.find(name);
  if (!parameter) return fallback;
  float eta = fallback;
  if (parameter->type == ParamType::spectrum) {
    const auto glass = parameter->texts.empty() ? std::nullopt : named_glass(parameter->texts[0]);
    constexpr float kYellow = 587.6f;  // the d line of helium, in nm
    eta = glass ? *glass : sampled(p, name, *parameter).at(kYellow);
    p.reader().warn_once(p.where_of(name), "dispersion (\"" + std::string(name) + "\" of " + p.title() + ")",
                         "the index at 587.6 nm");
  } else {
    eta = p.number(name, fallback);
  }
  if (!(eta > 0)) p.fail(name, "is not positive", "indices of refraction are 1 or more");
  return eta;
}

ConductorIndex conductor_index(Params& p, const char* eta, const char* k) {
  const auto spectral = [&](const char* name) -> std::optional<SampledSpectrum> {
    const Parameter* parameter = p.has(name) ? p.find(name) : nullptr;
    if (!parameter) return named_metal(std::string("metal-Cu-") + (name == eta ? "eta" : "k"));
    if (parameter->type != ParamType::spectrum) return std::nullopt;
    return sampled(p, name, *parameter);
  };
  const auto constant = [&](const char* name, const std::optional<SampledSpectrum>& spectrum) {
    return spectrum ? not_negative(reflectance_to_rgb(*spectrum))
                    : *constant_color(p, name, Intent::unbounded);
  };
  for (const char* name : {eta, k})
    if (p.is_texture(name)) p.fail(name, "is a texture", "give a color or a spectrum");
  p.find(eta), p.find(k);
  const auto n_of = spectral(eta), k_of = spectral(k);
  ConductorIndex out{constant(eta, n_of), constant(k, k_of)};
  if (!n_of || !k_of) return out;
  // Reflectance at normal incidence, wavelength by wavelength.
  SampledSpectrum reflectance;
  for (int nm = 380; nm <= 780; nm += 5) {
    const float at = static_cast<float>(nm), n = n_of->at(at), kk = k_of->at(at) * k_of->at(at);
    reflectance.wavelengths.push_back(at);
    reflectance.values.push_back(((n - 1) * (n - 1) + kk) / ((n + 1) * (n + 1) + kk));
  }
  const Rgb r = reflectance_to_rgb(reflectance);
  for (int i = 0; i < 3; ++i) {
    const float want = std::clamp(r[i], 0.0f, 0.9999f);
    const float n = out.eta[i], kk = (want * (n + 1) * (n + 1) - (n - 1) * (n - 1)) / (1 - want);
    if (kk < 0) out.eta[i] = (1 + std::sqrt(want)) / (1 - std::sqrt(want));
    out.k[i] = std::sqrt(std::max(kk, 0.0f));
  }
  return out;
}

}  // namespace lumirank::scenedesc::pbrt
