#include <algorithm>
#include <locale>
#include <sstream>

#include "scenedesc/mitsuba/plugin.h"
#include "scenedesc/schema/warnings.h"

namespace lumirank::scenedesc::mitsuba {

namespace {

// Mitsuba's v runs down the picture (v = 0 is its top row), Lumirank's up: applied after everything else.
UvTransform flip_v(UvTransform t) {
  for (int i = 3; i < 6; ++i) t.m[i] = 0.0f - t.m[i];
  t.m[5] += 1;
  return t;
}

// "to_uv" (x and y of an affine transform), or 0.6's uoffset, voffset, uscale, vscale.
UvTransform uv_transform(Plugin& p) {
  const Transform t = p.transform("to_uv");
  UvTransform out;
  for (int row = 0; row < 2; ++row) {
    const auto at = static_cast<std::size_t>(4 * row);
    out.m[3 * row] = static_cast<float>(t.m[at]);
    out.m[3 * row + 1] = static_cast<float>(t.m[at + 1]);
    out.m[3 * row + 2] = static_cast<float>(t.m[at + 3]);
  }
  const float scale[2] = {p.number("uscale", 1), p.number("vscale", 1)};
  const float offset[2] = {p.number("uoffset", 0), p.number("voffset", 0)};
  for (int row = 0; row < 2; ++row) {
    for (int i = 0; i < 3; ++i) out.m[3 * row + i] *= scale[row];
    out.m[3 * row + 2] += offset[row];
  }
  return out;
}

WrapMode wrap_mode(Reader& reader, Plugin& p, const std::string& name, WrapMode fallback) {
  const auto text = p.text(name);
  if (!text) return fallback;
  if (*text == "repeat") return WrapMode::repeat;
  if (*text == "mirror") return WrapMode::mirror;
  if (*text == "clamp") return WrapMode::clamp;
  if (*text != "zero" && *text != "one" && *text != "black" && *text != "white")
    throw InputError(p.where_of(name), "\"" + name + "\" of " + p.title() + " is \"" + *text + "\"",
                     "repeat, mirror and clamp are known");
  reader.warn(p.where_of(name), "the wrap mode \"" + *text + "\"", "clamp");
  return WrapMode::clamp;
}

// 0.6: one channel as a gray texture; masks are made so from the alpha of a picture.
TextureChannel channel(Plugin& p) {
  const auto name = p.text("channel");
  if (!name) return TextureChannel::rgb;
  if (*name == "r") return TextureChannel::red;
  if (*name == "g") return TextureChannel::green;
  if (*name == "b") return TextureChannel::blue;
  if (*name == "a") return TextureChannel::alpha;
  throw InputError(p.where_of("channel"), "the channel \"" + *name + "\" of " + p.title() + " is not known",
                   "r, g, b and a are");
}

BitmapTextureDesc bitmap(Reader& reader, Plugin& p) {
  BitmapTextureDesc out;
  const std::string name = p.required_text("filename");
  const auto file = reader.file(name, p.where_of("filename"), "texture", kMissingPicture);
  out.filename = file.name, out.missing = file.missing;
  out.raw = p.flag("raw", false);
  // 0.6: gamma 1 says that the values are linear, -1 and "sRGB" that the file knows; 8-bit files then are
  // sRGB.
  if (const auto gamma = p.number("gamma")) {
    out.raw = *gamma == 1;
    if (*gamma != 1 && *gamma != -1)
      reader.warn(p.where_of("gamma"), "a texture gamma of its own", "the sRGB curve");
  }
  out.channel = channel(p);
  if (const auto filter = p.text("filter_type")) {
    if (*filter == "nearest")
      out.filter = FilterMode::nearest;
    else if (*filter == "trilinear" || *filter == "ewa")
      reader.warn(p.where_of("filter_type"), "the texture filter \"" + *filter + "\"", "bilinear");
    else if (*filter != "bilinear")
      throw InputError(p.where_of("filter_type"),
                       "the filter \"" + *filter + "\" of " + p.title() + " is not known",
                       "nearest and bilinear are");
  }
  const WrapMode both = wrap_mode(reader, p, "wrap_mode", WrapMode::repeat);
  out.wrap_u = wrap_mode(reader, p, "wrap_mode_u", both);
  out.wrap_v = wrap_mode(reader, p, "wrap_mode_v", both);
  out.to_uv = flip_v(uv_transform(p));
  p.ignore({"cache", "max_anisotropy", "accel", "format"});
  return out;
}

// Mitsuba 3's "regular" and "irregular" as its <spectrum value="wavelength:value, …">.
Element tabulated(Plugin& p, const Element& element) {
  const auto list = [&](const char* name) {
    return parse_list(p.required_text(name), p.where_of(name),
                      "\"" + std::string(name) + "\" of " + p.title());
  };
  const std::vector<double> values = list("values");
  std::vector<double> wavelengths;
  if (p.type() == "irregular") {
    wavelengths = list("wavelengths");
  } else {
    const double first = static_cast<double>(p.number("wavelength_min", 360)),
                 last = static_cast<double>(p.number("wavelength_max", 830));
    for (std::size_t k = 0; k < values.size(); ++k)
      wavelengths.push_back(first + (last - first) * static_cast<double>(k) /
                                        static_cast<double>(std::max<std::size_t>(1, values.size() - 1)));
  }
  if (values.size() < 2 || wavelengths.size() != values.size())
    throw InputError(element.where,
                     p.title() + " has " + std::to_string(wavelengths.size()) + " wavelengths and " +
                         std::to_string(values.size()) + " values",
                     "give as many of both, two at least");
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(9);
  for (std::size_t k = 0; k < values.size(); ++k)
    text << (k > 0 ? ", " : "") << wavelengths[k] << ':' << values[k];
  Element spectrum;
  spectrum.tag = "spectrum", spectrum.where = element.where;
  spectrum.attributes.emplace_back("value", text.str());
  return spectrum;
}

}  // namespace

bool Reader::constant_texture(const Element& element, Intent intent, Rgb& value) {
  const std::string* type = element.find("type");
  if (!type) return false;
  for (const char* known : {"uniform", "srgb", "rgb", "blackbody", "regular", "irregular", "d65", "constant"})
    if (*type == known) {
      Plugin p(*this, element);
      if (*type == "blackbody") {
        Element body;
        body.tag = "blackbody";
        body.where = element.where;
        body.attributes.emplace_back("temperature", std::to_string(p.positive("temperature", 5000)));
        value = parse_color(body, intent) * p.number("scale", 1);
      } else if (*type == "d65") {
        value = Rgb(1) * p.number("scale", 1);
      } else if (*type == "regular" || *type == "irregular") {
        value = parse_color(tabulated(p, element), intent);
      } else {
        const auto color = p.color_if(*type == "uniform" || *type == "constant" ? "value" : "color", intent);
        if (!color) throw InputError(element.where, p.title() + " has no value");
        if (color->texture != kNone)
          throw InputError(element.where, p.title() + " holds a texture, not a value");
        value = color->value;
      }
      p.finish();
      return true;
    }
  return false;
}

int Reader::build_texture(const Element& element) {
  if (const auto found = textures_.find(&element); found != textures_.end()) return found->second;
  const OpenGuard guard(*this, element);
  Plugin p(*this, element);
  int index = kNone;
  Rgb constant;
  if (p.type() == "bitmap") {
    index = add_texture(p.id(), p.where(), bitmap(*this, p));
  } else if (p.type() == "checkerboard") {
    CheckerboardTextureDesc out;
    out.to_uv = uv_transform(p);
    out.color0 = p.color("color0", Rgb(0.4f), Intent::reflectance);
    out.color1 = p.color("color1", Rgb(0.2f), Intent::reflectance);
    index = add_texture(p.id(), p.where(), out);
  } else if (p.type() == "scale") {
    ScaleTextureDesc out;
    out.scale = p.constant_color("scale", Rgb(1), Intent::index);
    if (p.has("value")) {
      out.input = p.color("value", Rgb(1), Intent::reflectance);
    } else if (const Element* nested = p.take_one("texture")) {
      out.input.texture = build_texture(*nested);
    } else {
      throw InputError(p.where(), p.title() + " has no texture in it", "nest a <texture>");
    }
    index = add_texture(p.id(), p.where(), out);
  } else if (p.type() == "vertexcolors" || p.type() == "mesh_attribute") {
    VertexColorTextureDesc out;
    if (const auto name = p.text("name")) out.attribute = *name;
    if (out.attribute != "vertex_color" && out.attribute != "vertex_Color")
      warn(p.where(), "the mesh attribute \"" + out.attribute + "\"", "the vertex colors");
    const Rgb scale = p.constant_color("scale", Rgb(1), Intent::index);
    index = add_texture(p.id(), p.where(), out);
    if (!(scale == Rgb(1))) index = add_texture(p.id(), p.where(), ScaleTextureDesc{{Rgb(0), index}, scale});
  } else if (constant_texture(element, Intent::reflectance, constant)) {
    p.ignore_all();
    index = add_texture(p.id(), p.where(), ScaleTextureDesc{{constant, kNone}, Rgb(1)});
  } else {
    // The mean of the two colors that most procedural textures have, if they are given.
    Rgb gray(0.5f);
    if (p.has("color0") && p.has("color1"))
      gray = lerp(p.constant_color("color0", gray, Intent::reflectance),
                  p.constant_color("color1", gray, Intent::reflectance), 0.5f);
    warn(p.where(), "the texture \"" + p.type() + "\"",
         p.has("color0") && p.has("color1") ? "the mean of its colors" : "the gray 0.5");
    p.ignore_all();
    index = add_texture(p.id(), p.where(), ScaleTextureDesc{{gray, kNone}, Rgb(1)});
  }
  p.finish();
  textures_[&element] = index;
  return index;
}

}  // namespace lumirank::scenedesc::mitsuba
