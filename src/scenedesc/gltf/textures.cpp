// Images, samplers and texture transforms.
#include <cmath>
#include <filesystem>

#include "scenedesc/gltf/reader.h"
#include "scenedesc/gltf/uri.h"
#include "scenedesc/schema/warnings.h"

namespace lumirank::scenedesc::gltf {
namespace {

WrapMode wrap_mode(const Element& sampler, const char* key) {
  const auto value = sampler.find(key);
  if (!value) return WrapMode::repeat;
  switch (value->integer(0, 1 << 20)) {
    case 10497:
      return WrapMode::repeat;
    case 33648:
      return WrapMode::mirror;
    case 33071:
      return WrapMode::clamp;
    default:
      value->fail("is no wrapping mode", "33071 (clamp), 33648 (mirror) and 10497 (repeat) are");
  }
}

// uv' = translation · rotation · scale · uv (KHR_texture_transform; counter-clockwise where v runs down),
// then v upwards.
UvTransform uv_transform(const Element& info) {
  double offset[2] = {0, 0}, scale[2] = {1, 1}, angle = 0;
  if (const auto transform = info.extension("KHR_texture_transform")) {
    const auto pair = [&](const char* key, double out[2]) {
      if (const auto given = transform->find(key)) {
        const auto v = given->numbers(2);
        out[0] = v[0], out[1] = v[1];
      }
    };
    pair("offset", offset);
    pair("scale", scale);
    angle = transform->real("rotation", 0);
  }
  const double c = std::cos(angle), s = std::sin(angle);
  const double u[3] = {c * scale[0], s * scale[1], offset[0]},
               v[3] = {-s * scale[0], c * scale[1], offset[1]};
  UvTransform out;
  for (int k = 0; k < 3; ++k) {
    out.m[k] = static_cast<float>(u[k]);
    out.m[3 + k] = static_cast<float>((k == 2 ? 1 : 0) - v[k]);
  }
  return out;
}

}  // namespace

int Reader::add_texture(const Element& at, decltype(TextureDesc::kind) kind) {
  return SceneReader::add_texture(at.path(), at.where(), std::move(kind));
}

int Reader::build_texture(const Element& info, bool raw, TextureChannel channel) {
  const Element index = info.at("index");
  const Element& texture = textures_[index_of(index, textures_.size(), "texture")];
  auto source = texture.find("source");
  if (const auto webp = texture.extension("EXT_texture_webp")) source = webp->find("source");
  if (!source) {
    warn(texture, "a texture that is neither PNG, JPEG nor WebP", "its factor alone");
    return kNone;
  }
  const std::size_t slot = index_of(*source, images_.size(), "image");
  const auto [image, fresh] = built_images_.try_emplace(slot);
  if (fresh) {
    const Element& element = images_[slot];
    const auto uri = element.find("uri"), view = element.find("bufferView");
    if (uri.has_value() == view.has_value())
      element.fail(uri ? "has both \"uri\" and \"bufferView\"" : "has neither \"uri\" nor \"bufferView\"",
                   "give one of them");
    try {
      if (view) {
        const std::string_view bytes = buffers_.view(view->integer(0, kMaxBytes), *view).bytes;
        buffers_.budget().take(static_cast<double>(bytes.size()), *view);
        image->second.bytes = std::make_shared<const std::string>(bytes);
      } else {
        Resource resource = resolve_uri(*uri);
        image->second.filename = resource.filename;
        std::error_code error;
        if (resource.embedded)
          image->second.bytes = std::make_shared<const std::string>(std::move(resource.bytes));
        else if (!std::filesystem::exists(resource.filename, error))
          throw MissingFile(uri->where(),
                            uri->path() + " names an image that does not exist: " + resource.filename,
                            "check the name, or let a stand-in be shown (--allow-missing)");
        else if (!std::filesystem::is_regular_file(resource.filename, error))
          uri->fail("names " + resource.filename + ", which is no file", "check the name");
      }
    } catch (const MissingFile& error) {
      if (!options_.allow_missing) throw;
      missing_file(error.where(), what_is_missing(error), kMissingPicture);
      if (image->second.filename.empty()) image->second.filename = scene_.source_file;
      image->second.missing = true;
    }
    if (image->second.bytes) image->second.filename = scene_.source_file + " (" + element.path() + ")";
  }
  BitmapTextureDesc out = image->second;
  out.raw = raw;
  out.channel = channel;
  out.alpha_may_lack = true;
  out.to_uv = uv_transform(info);
  if (const auto given = texture.find("sampler")) {
    const Element& sampler = samplers_[index_of(*given, samplers_.size(), "sampler")];
    out.wrap_u = wrap_mode(sampler, "wrapS");
    out.wrap_v = wrap_mode(sampler, "wrapT");
    const auto filter = sampler.find("magFilter");
    if (filter && filter->integer(0, 1 << 20) == 9728) out.filter = FilterMode::nearest;
  }
  std::vector<float> numbers(out.to_uv.m, out.to_uv.m + 6);
  const auto [built, made] =
      built_textures_.try_emplace({texture.path(), raw, static_cast<int>(channel), std::move(numbers)}, 0);
  if (made) built->second = add_texture(texture, std::move(out));
  return built->second;
}

bool Reader::without_alpha(int texture) const {
  const auto& bitmap = std::get<BitmapTextureDesc>(scene_.textures[static_cast<std::size_t>(texture)].kind);
  if (bitmap.bytes) return bitmap.bytes->starts_with("\xff\xd8\xff");
  return bitmap.filename.ends_with(".jpg") || bitmap.filename.ends_with(".jpeg");
}

int Reader::scaled(const Element& at, int texture, Rgb scale) {
  return scale == Rgb(1) ? texture : add_texture(at, ScaleTextureDesc{{Rgb(0), texture}, scale});
}

int Reader::product(const Element& at, ColorInput a, ColorInput b) {
  return add_texture(at, ProductTextureDesc{a, b});
}

FloatInput Reader::squared(const Element& at, FloatInput input) {
  if (input.texture == kNone) return {input.value * input.value};
  const ColorInput factor{Rgb(0), input.texture};
  return {0, product(at, factor, factor)};
}

FloatInput Reader::complement(const Element& at, FloatInput input) {
  if (input.texture == kNone) return {1 - input.value};
  return {0, add_texture(at, MixTextureDesc{{Rgb(1)}, {Rgb(0)}, {Rgb(0), input.texture}})};
}

FloatInput Reader::float_input(const Element& object, const std::string& factor, float fallback,
                               const std::string& texture, TextureChannel channel, float max_value) {
  const float value = object.real(factor, fallback, 0, max_value);
  const auto info = object.find(texture);
  if (!info || value == 0) return {value};
  const int built = build_texture(*info, true, channel);
  if (built == kNone) return {value};
  return {0, scaled(*info, built, Rgb(value))};
}

ColorInput Reader::color_input(const Element& object, const std::string& factor, Rgb fallback,
                               const std::string& texture) {
  Rgb value = fallback;
  if (const auto given = object.find(factor)) {
    const std::size_t count = given->size();
    if (count != 3 && count != 4)
      given->fail("has " + std::to_string(count) + " numbers", "a color has 3, or 4");
    for (int k = 0; k < 3; ++k) {
      const Element channel = given->item(static_cast<std::size_t>(k));
      value[k] = channel.real();
      if (value[k] < 0) channel.fail("is negative", "give 0 or more");
    }
  }
  const auto info = object.find(texture);
  if (!info || value == Rgb(0)) return {value};
  const int built = build_texture(*info, false, TextureChannel::rgb);
  if (built == kNone) return {value};
  return {Rgb(0), scaled(*info, built, value)};
}

}  // namespace lumirank::scenedesc::gltf
