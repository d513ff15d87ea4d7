#include "scenedesc/writer/writer.h"

namespace lumirank::scenedesc {
namespace {

const char* wrap_name(WrapMode mode) {
  return mode == WrapMode::repeat ? "repeat" : (mode == WrapMode::mirror ? "mirror" : "clamp");
}

Transform spread(const UvTransform& uv) {
  Transform t;
  for (std::size_t row = 0; row < 2; ++row) {
    t.m[4 * row] = uv.m[3 * row], t.m[4 * row + 1] = uv.m[3 * row + 1];
    t.m[4 * row + 3] = uv.m[3 * row + 2];
  }
  return t;
}

bool is_plain(const TextureDesc& t) {
  const auto* bitmap = std::get_if<BitmapTextureDesc>(&t.kind);
  return bitmap && bitmap->channel == TextureChannel::rgb;
}

// Mitsuba's v runs down the picture: the reader's flip, undone.
UvTransform unflip_v(UvTransform t) {
  for (int i = 3; i < 6; ++i) t.m[i] = 0.0f - t.m[i];
  t.m[5] += 1;
  return t;
}

}  // namespace

MitsubaWriter::Input MitsubaWriter::resolve(const ColorInput& input) {
  return input.texture == kNone ? Input{input.value, kNone} : resolve(input.texture);
}

bool MitsubaWriter::painted(int index) {
  if (!painter_.texture) return false;
  const auto [it, fresh] = painted_.try_emplace(index);
  if (fresh) it->second = painter_.texture(index);
  return it->second.has_value();
}

// Mitsuba 3 has pictures, checkerboards and vertex colors; what is made of pictures alone is painted, and
// what is made of others is followed to one of these.
MitsubaWriter::Input MitsubaWriter::resolve(int index) {
  const TextureDesc& t = scene_.textures[static_cast<std::size_t>(index)];
  const auto* scale = std::get_if<ScaleTextureDesc>(&t.kind);
  if (scale && scale->scale == Rgb(1)) return resolve(scale->input);
  if (std::holds_alternative<CheckerboardTextureDesc>(t.kind) ||
      std::holds_alternative<VertexColorTextureDesc>(t.kind) || is_plain(t) || painted(index))
    return {Rgb(0), index};
  if (scale) {
    const Input in = resolve(scale->input);
    if (in.texture == kNone) return {in.value * scale->scale, kNone};
    warn(t.where, "a texture scaled by a number", "the texture itself");
    return in;
  }
  if (const auto* product = std::get_if<ProductTextureDesc>(&t.kind)) {
    const Input a = resolve(product->a), b = resolve(product->b);
    if (a.texture == kNone && b.texture == kNone) return {a.value * b.value, kNone};
    const Input& one = a.texture != kNone ? a : b;
    const Input& other = a.texture != kNone ? b : a;
    if (other.texture != kNone)
      warn(t.where, "a product of two textures", "the first of them");
    else if (!(other.value == Rgb(1)))
      warn(t.where, "a texture scaled by a number", "the texture itself");
    return one;
  }
  if (const auto* mix = std::get_if<MixTextureDesc>(&t.kind)) {
    const Input a = resolve(mix->a), b = resolve(mix->b), amount = resolve(mix->amount);
    if (a.texture == kNone && b.texture == kNone && amount.texture == kNone)
      return {a.value + (b.value - a.value) * amount.value, kNone};
    warn(t.where, "a mixture of textures", "the heavier of them");
    return amount.texture == kNone && luminance(amount.value) > 0.5f ? b : a;
  }
  if (const auto* root = std::get_if<RootTextureDesc>(&t.kind)) {
    const Input in = resolve(root->input);
    if (in.texture == kNone) return {sqrt(in.value), kNone};
    warn(t.where, "the square root of a texture", "the texture itself");
    return in;
  }
  if (const auto* threshold = std::get_if<ThresholdTextureDesc>(&t.kind)) {
    const Input in = resolve(threshold->input);
    if (in.texture == kNone) return {Rgb(luminance(in.value) >= threshold->threshold ? 1.0f : 0.0f), kNone};
    warn(t.where, "a texture with a threshold", "the texture itself");
    return in;
  }
  return {Rgb(0), index};  // a single channel that is not painted
}

void MitsubaWriter::color(const char* name, const ColorInput& input) {
  const Input in = resolve(input);
  if (in.texture == kNone)
    xml_.color(name, in.value);
  else
    reference(in.texture, name);
}

void MitsubaWriter::scalar(const char* name, const FloatInput& input) {
  const Input in = input.texture == kNone ? Input{Rgb(input.value), kNone} : resolve(input.texture);
  if (in.texture == kNone)
    xml_.number(name, input.texture == kNone ? input.value : luminance(in.value));
  else
    reference(in.texture, name);
}

void MitsubaWriter::constant(const char* name, const FloatInput& input, const SourceLocation& where,
                             const char* what) {
  float value = input.value;
  if (input.texture != kNone) {
    const Input in = resolve(input.texture);
    value = in.texture == kNone ? luminance(in.value) : 0.2f;
    if (in.texture != kNone) warn(where, what, "0.2 everywhere");
  }
  xml_.number(name, value);
}

std::string MitsubaWriter::picture_of(const BitmapTextureDesc& bitmap) {
  if (!bitmap.bytes) return relative(bitmap.filename);
  std::string& name = stored_[bitmap.bytes.get()];
  if (name.empty()) {
    const bool png = bitmap.bytes->starts_with("\x89PNG"),
               exr = bitmap.bytes->starts_with("\x76\x2f\x31\x01");
    name = add_file("picture_" + std::to_string(out_.files.size()), png ? ".png" : (exr ? ".exr" : ".jpg"),
                    *bitmap.bytes);
  }
  return name;
}

void MitsubaWriter::bitmap(const BitmapTextureDesc& desc, const SourceLocation& where,
                           const std::string& id) {
  if (desc.channel != TextureChannel::rgb)
    warn(where, "a single channel of a picture", "the luminance of all");
  xml_.open("texture", {{"type", "bitmap"}, {"id", id}});
  xml_.string("filename", picture_of(desc));
  xml_.flag("raw", desc.raw);
  xml_.string("filter_type", desc.filter == FilterMode::nearest ? "nearest" : "bilinear");
  if (desc.wrap_u != desc.wrap_v)
    warn(where, "two different wrap modes of a picture", wrap_name(desc.wrap_u));
  xml_.string("wrap_mode", wrap_name(desc.wrap_u));
  xml_.transform("to_uv", spread(unflip_v(desc.to_uv)));
  xml_.close();
}

void MitsubaWriter::reference(int texture, const char* name) {
  asked_.push_back(texture);
  xml_.reference(texture_ids_[static_cast<std::size_t>(texture)], name);
}

std::string MitsubaWriter::asked_textures() {
  for (std::size_t k = 0; k < asked_.size(); ++k) texture(asked_[k]);  // more may be asked for meanwhile
  return xml_.take();
}

void MitsubaWriter::texture(int index) {
  if (!written_.insert(index).second) return;
  const TextureDesc& t = scene_.textures[static_cast<std::size_t>(index)];
  const std::string& id = texture_ids_[static_cast<std::size_t>(index)];
  if (const auto made = painted_.find(index); made != painted_.end() && made->second) {
    bitmap(*made->second, t.where, id);
  } else if (const auto* picture = std::get_if<BitmapTextureDesc>(&t.kind)) {
    bitmap(*picture, t.where, id);
  } else if (const auto* board = std::get_if<CheckerboardTextureDesc>(&t.kind)) {
    // What it refers to comes before it.
    for (const ColorInput& part : {board->color0, board->color1})
      if (const Input in = resolve(part); in.texture != kNone) texture(in.texture);
    xml_.open("texture", {{"type", "checkerboard"}, {"id", id}});
    color("color0", board->color0), color("color1", board->color1);
    xml_.transform("to_uv", spread(board->to_uv));
    xml_.close();
  } else {
    xml_.open("texture", {{"type", "mesh_attribute"}, {"id", id}});
    xml_.string("name", "vertex_color");
    xml_.close();
  }
}

}  // namespace lumirank::scenedesc
