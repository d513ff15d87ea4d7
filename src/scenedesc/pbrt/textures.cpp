#include <algorithm>

#include "scenedesc/pbrt/reader.h"
#include "scenedesc/schema/warnings.h"

namespace lumirank::scenedesc::pbrt {

namespace {

UvTransform uv_mapping(Params& p) {
  const std::string mapping = p.text("mapping", "uv");
  if (mapping == "spherical" || mapping == "cylindrical" || mapping == "planar") {
    p.reader().warn(p.where_of("mapping"), "the texture mapping \"" + mapping + "\"", "uv");
    p.ignore({"v1", "v2", "udelta", "vdelta", "uscale", "vscale"});
    return {};
  }
  if (mapping != "uv")
    p.fail("mapping", "is " + in_quotes(mapping), "uv, spherical, cylindrical and planar are known");
  UvTransform out;
  out.m[0] = p.number("uscale", 1), out.m[2] = p.number("udelta", 0);
  out.m[4] = p.number("vscale", 1), out.m[5] = p.number("vdelta", 0);
  return out;
}

BitmapTextureDesc image_map(Reader& reader, Params& p, bool spectrum) {
  BitmapTextureDesc out;
  const std::string name = p.required_text("filename");
  const auto file = reader.file(name, p.where_of("filename"), "texture", kMissingPicture);
  out.filename = file.name, out.missing = file.missing;
  if (!spectrum) out.channel = TextureChannel::scalar;
  const std::string filter = p.text("filter", "bilinear");
  if (filter == "point")
    out.filter = FilterMode::nearest;
  else if (filter == "trilinear" || filter == "ewa" || filter == "EWA")
    reader.warn_once(p.where_of("filter"), "the texture filter \"" + filter + "\"", "bilinear");
  else if (filter != "bilinear")
    p.fail("filter", "is " + in_quotes(filter), "bilinear, point, trilinear and ewa are known");
  const std::string wrap = p.text("wrap", "repeat");
  if (wrap == "clamp" || wrap == "black" || wrap == "octahedralsphere")
    out.wrap_u = out.wrap_v = WrapMode::clamp;
  else if (wrap != "repeat")
    p.fail("wrap", "is " + in_quotes(wrap), "repeat, clamp and black are known");
  if (wrap == "black" || wrap == "octahedralsphere")
    reader.warn(p.where_of("wrap"), "the wrap mode \"" + wrap + "\"", "clamp");
  const std::string encoding = p.text("encoding", "sRGB");
  if (encoding == "linear")
    out.raw = true;
  else if (encoding.rfind("gamma", 0) == 0)
    reader.warn(p.where_of("encoding"), "a texture gamma of its own", "the sRGB curve for 8-bit files");
  else if (encoding != "sRGB")
    p.fail("encoding", "is " + in_quotes(encoding), "sRGB, linear and gamma are known");
  p.ignore({"maxanisotropy"});
  out.to_uv = uv_mapping(p);
  return out;
}

constexpr std::size_t kParts = 1'000;  // look-ups of one texture

template <typename... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <typename... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

}  // namespace

std::size_t Reader::parts_of(const ColorInput& input) const {
  return input.texture == kNone ? 0 : texture_parts_[static_cast<std::size_t>(input.texture)];
}

int Reader::add_texture(const std::string& id, const Place& where, decltype(TextureDesc::kind) kind) {
  const std::size_t parts =
      1 + std::visit(Overloaded{[&](const CheckerboardTextureDesc& x) {
                                  return std::max(parts_of(x.color0), parts_of(x.color1));
                                },
                                [&](const ScaleTextureDesc& x) { return parts_of(x.input); },
                                [&](const ProductTextureDesc& x) { return parts_of(x.a) + parts_of(x.b); },
                                [&](const MixTextureDesc& x) {
                                  return parts_of(x.a) + parts_of(x.b) + parts_of(x.amount);
                                },
                                [&](const RootTextureDesc& x) { return parts_of(x.input); },
                                [](const auto&) { return std::size_t{0}; }},
                     kind);
  if (parts > kParts)
    throw InputError(where, "the texture " + in_quotes(id) + " is made of more than 1,000 others",
                     "textures of textures multiply; simplify them");
  texture_parts_.push_back(parts);
  return SceneReader::add_texture(id, where, std::move(kind));
}

ColorInput Reader::color(Params& p, const char* name, ColorInput fallback, Intent intent) {
  if (const auto constant = constant_color(p, name, intent)) return {*constant, kNone};
  const Parameter* parameter = p.find(name);
  if (!parameter) return fallback;
  if (parameter->texts.size() != 1) p.fail(name, "names no texture");
  const auto found = color_textures_.find(parameter->texts[0]);
  if (found != color_textures_.end()) return found->second;
  p.fail(name, "is the texture " + in_quotes(parameter->texts[0]) + ", which is not defined",
         float_textures_.count(parameter->texts[0])
             ? "it is a float texture, and a spectrum texture is needed"
             : "define it with Texture before its use");
}

FloatInput Reader::scalar(Params& p, const char* name, FloatInput fallback) {
  if (!p.is_texture(name)) return p.has(name) ? FloatInput{p.number(name, 0)} : (p.find(name), fallback);
  const Parameter* parameter = p.find(name);
  if (parameter->texts.size() != 1) p.fail(name, "names no texture");
  const auto found = float_textures_.find(parameter->texts[0]);
  if (found != float_textures_.end()) return found->second;
  p.fail(name, "is the texture " + in_quotes(parameter->texts[0]) + ", which is not defined",
         color_textures_.count(parameter->texts[0])
             ? "it is a spectrum texture, and a float texture is needed"
             : "define it with Texture before its use");
}

namespace {

// One code for both types of textures: a float is the gray of a color.
class TextureMaker {
 public:
  TextureMaker(Reader& reader, Params& p, const std::string& name, bool spectrum)
      : reader_(reader), p_(p), name_(name), spectrum_(spectrum) {}

  ColorInput make(const std::string& kind) {
    if (kind == "constant") return input("value", 1);
    if (kind == "imagemap") return image();
    if (kind == "scale") return product(input("tex", 1), factor());
    if (kind == "mix")
      return mix(input("tex1", 0), input("tex2", 1), gray(reader_.scalar(p_, "amount", {0.5f})));
    if (kind == "directionmix") {
      reader_.warn(p_.where(), "the texture \"directionmix\"", "the mean of its two textures");
      p_.ignore({"dir", "amount"});
      return mix(input("tex1", 0), input("tex2", 1), {Rgb(0.5f), kNone});
    }
    if (kind == "checkerboard") return checkerboard();
    const bool known = (reader_.version3() && kind == "uv") || kind == "bilerp" || kind == "dots" ||
                       kind == "fbm" || kind == "wrinkled" || kind == "windy" || kind == "marble" ||
                       kind == "ptex";
    if (!known)
      throw InputError(p_.where(), "the texture class " + in_quotes(kind) + " is not known",
                       "constant, imagemap, scale, mix, directionmix, checkerboard, bilerp, dots, fbm, "
                       "wrinkled, windy, marble and ptex are");
    reader_.warn(p_.where(), "the texture \"" + kind + "\"", "the gray 0.5");
    p_.ignore_all();
    return {Rgb(0.5f), kNone};
  }

 private:
  static ColorInput gray(FloatInput f) { return {Rgb(f.value), f.texture}; }
  // A number where a color is meant is its gray.
  ColorInput input(const char* name, float fallback) {
    return spectrum_ && !is_number(name) ? reader_.color(p_, name, {Rgb(fallback), kNone}, Intent::unbounded)
                                         : gray(reader_.scalar(p_, name, {fallback}));
  }
  bool is_number(const char* name) {
    const Parameter* p = p_.find(name);
    return p && (p->type == ParamType::number || p->type == ParamType::integer);
  }
  // "scale" of the class "scale" is a float or a float texture, for both types of textures
  // (SpectrumScaledTexture::Create of pbrt-v4). Colors, which pbrt passes over, are taken at their word.
  ColorInput factor() {
    const Parameter* p = p_.find("scale");
    const bool texture = p && p->type == ParamType::texture;
    if (texture && p->texts.size() == 1 && reader_.is_float_texture(p->texts[0]))
      return gray(reader_.scalar(p_, "scale", {1}));
    const ColorInput out = input("scale", 1);
    // A bump's height may be turned over; a color below 0 is none.
    if (spectrum_ && out.texture == kNone && (out.value.r < 0 || out.value.g < 0 || out.value.b < 0))
      p_.fail("scale", "is negative", "give 0 or more");
    return out;
  }
  ColorInput add(decltype(TextureDesc::kind) kind) {
    return {Rgb(0), reader_.add_texture(name_, p_.where(), std::move(kind))};
  }
  ColorInput product(ColorInput a, ColorInput b) {
    if (a.texture == kNone) std::swap(a, b);
    if (a.texture == kNone) return {a.value * b.value, kNone};
    if (b.texture != kNone) return add(ProductTextureDesc{a, b});
    return b.value == Rgb(1) ? a : add(ScaleTextureDesc{a, b.value});
  }
  ColorInput mix(const ColorInput& a, const ColorInput& b, const ColorInput& amount) {
    if (amount.texture == kNone && amount.value == Rgb(0)) return a;
    if (amount.texture == kNone && amount.value == Rgb(1)) return b;
    if (a.texture == kNone && b.texture == kNone && amount.texture == kNone)
      return {a.value * (Rgb(1) - amount.value) + b.value * amount.value, kNone};
    return add(MixTextureDesc{a, b, amount});
  }

  ColorInput image() {
    const bool invert = p_.flag("invert", false);
    // A "scale" may itself be a float texture in pbrt's grammar only for the class "scale".
    const float scale = p_.number("scale", 1);
    if (scale < 0) p_.fail("scale", "is negative");
    const ColorInput picture = product(add(image_map(reader_, p_, spectrum_)), {Rgb(scale), kNone});
    return invert ? mix({Rgb(1), kNone}, {Rgb(0), kNone}, picture) : picture;
  }

  ColorInput checkerboard() {
    const int dimension = p_.integer("dimension", 2);
    if (dimension != 2 && dimension != 3) p_.fail("dimension", "is neither 2 nor 3");
    const ColorInput first = input("tex1", 1), second = input("tex2", 0);
    if (dimension == 3) {
      reader_.warn(p_.where_of("dimension"), "checkerboards in space", "the mean of the two textures");
      p_.ignore_all();
      return mix(first, second, {Rgb(0.5f), kNone});
    }
    CheckerboardTextureDesc out{first, second, uv_mapping(p_)};
    // A unit of pbrt's uv is one field, half of what Mitsuba's pattern repeats in.
    for (float& m : out.to_uv.m) m *= 0.5f;
    return add(out);
  }

  Reader& reader_;
  Params& p_;
  const std::string& name_;
  const bool spectrum_;
};

}  // namespace

void Reader::read_texture(Params& p, const std::string& name, const std::string& type,
                          const std::string& kind) {
  const bool spectrum = type == "spectrum" || (version3_ && type == "color");
  if (!spectrum && type != "float")
    throw InputError(p.where(), "the texture " + in_quotes(name) + " is of type " + in_quotes(type),
                     "float and spectrum are known");
  // In pbrt-v3 the name means the new one from there on.
  if (!version3_ && (spectrum ? color_textures_.count(name) > 0 : float_textures_.count(name) > 0))
    throw InputError(p.where(), "the " + type + " texture " + in_quotes(name) + " is defined twice",
                     "rename one");
  const ColorInput made = TextureMaker(*this, p, name, spectrum).make(kind);
  if (spectrum)
    color_textures_[name] = made;
  else
    float_textures_[name] = {made.value.r, made.texture};
}

}  // namespace lumirank::scenedesc::pbrt
