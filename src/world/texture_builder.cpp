#include "world/texture_builder.h"

#include <algorithm>
#include <exception>

#include "base/error.h"
#include "base/parallel.h"
#include "image/image_io.h"

namespace lumirank::world {

namespace {

constexpr int kTextureNotBuilt = -1, kTextureInProgress = -2;

scatter::TexWrap convert(scenedesc::WrapMode mode) {
  switch (mode) {
    case scenedesc::WrapMode::mirror:
      return scatter::TexWrap::mirror;
    case scenedesc::WrapMode::clamp:
      return scatter::TexWrap::clamp;
    case scenedesc::WrapMode::repeat:
      break;
  }
  return scatter::TexWrap::repeat;
}

void copy(const scenedesc::UvTransform& from, float to[6]) {
  for (int i = 0; i < 6; ++i) to[i] = from.m[i];
}

void check_uv(const scenedesc::UvTransform& to_uv, const SourceLocation& where) {
  for (float v : to_uv.m)
    if (!std::isfinite(v))
      throw InputError(where, "the texture's uv transform is not finite", "give finite numbers");
}

// The pixels of `image`, or one channel of it as gray.
std::vector<Rgb> take_pixels(image::LoadedImage& image, scenedesc::TextureChannel channel,
                             bool alpha_may_lack) {
  using enum scenedesc::TextureChannel;
  std::vector<Rgb> pixels = std::move(image.color.pixels);
  if (channel == alpha) {
    if (image.alpha.empty() && alpha_may_lack) image.alpha.assign(pixels.size(), 1.0f);
    if (image.alpha.empty())
      throw InputError("the picture has no alpha channel", "give one that has, or another channel");
    std::transform(image.alpha.begin(), image.alpha.end(), pixels.begin(), [](float a) { return Rgb(a); });
  } else if (channel == scalar) {
    const bool cut = std::any_of(image.alpha.begin(), image.alpha.end(), [](float a) { return a != 1; });
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = Rgb(cut ? image.alpha[i] : mean(pixels[i]));
  } else if (channel != rgb) {
    const int k = channel == red ? 0 : (channel == green ? 1 : 2);
    for (Rgb& c : pixels) c = Rgb(c[k]);
  }
  return pixels;
}

// In place of a picture that is missing: nobody takes it for one that is meant.
void draw_stand_in(scatter::TexturePixels& pixels) {
  constexpr int kSquares = 8;
  pixels.width = pixels.height = kSquares;
  pixels.rgb.clear();
  for (int y = 0; y < kSquares; ++y)
    for (int x = 0; x < kSquares; ++x)
      pixels.rgb.push_back((x + y) % 2 == 0 ? Rgb(0.9f, 0, 0.9f) : Rgb(0.3f));
}

// What went wrong with a picture, with the texture's place and who needs it.
InputError broken_picture(const scenedesc::TextureDesc& texture, const scenedesc::ShapeDesc* shape,
                          const InputError& error) {
  std::string who = "the picture of the texture";
  if (!texture.id.empty()) who += " \"" + texture.id + "\"";
  if (shape) {
    who += ", which the shape";
    if (!shape->id.empty()) who += " \"" + shape->id + "\"";
    const std::string place = to_string(shape->where);
    who += (place.empty() ? "" : " at " + place) + std::string(" needs");
  }
  const std::string what = error.what();
  // A message that names no way out gets one.
  return InputError(texture.where, who + ": " + what,
                    what.find("; ") == std::string::npos ? "give a whole picture" : "");
}

}  // namespace

TextureBuilder::TextureBuilder(const scenedesc::SceneDesc& desc)
    : desc_(desc), index_(desc.textures.size(), kTextureNotBuilt), missing_(desc.textures.size()) {}

int TextureBuilder::add(scatter::Texture texture) {
  set_.textures.push_back(std::move(texture));
  return static_cast<int>(set_.textures.size()) - 1;
}

int TextureBuilder::operand(const scenedesc::ColorInput& input, const SourceLocation& user) {
  const scatter::ColorInput c = color(input, user);
  return c.texture >= 0 ? c.texture : add(scatter::ConstantTexture{c.value});
}

int TextureBuilder::use(int texture, const SourceLocation& user) {
  if (texture < 0 || static_cast<std::size_t>(texture) >= desc_.textures.size())
    throw InputError(user, "a texture is referred to that the scene does not have", "define it");
  const auto slot = static_cast<std::size_t>(texture);
  const auto& t = desc_.textures[slot];
  if (index_[slot] >= 0) return index_[slot];
  if (index_[slot] == kTextureInProgress)
    throw InputError(t.where, "the texture '" + t.id + "' is, through others, its own input",
                     "break the cycle");
  index_[slot] = kTextureInProgress;
  int built = 0;
  if (const auto* bitmap = std::get_if<scenedesc::BitmapTextureDesc>(&t.kind)) {
    check_uv(bitmap->to_uv, t.where);
    File& file =
        files_[{bitmap->filename, bitmap->bytes.get(), bitmap->raw, bitmap->channel, bitmap->alpha_may_lack}];
    if (!file.pixels) file = {&t, shape_, bitmap->missing, std::make_shared<scatter::TexturePixels>()};
    scatter::BitmapTexture out;
    out.pixels = file.pixels;
    out.filter = bitmap->filter == scenedesc::FilterMode::nearest || bitmap->missing
                     ? scatter::TexFilter::nearest
                     : scatter::TexFilter::bilinear;
    out.wrap_u = convert(bitmap->wrap_u), out.wrap_v = convert(bitmap->wrap_v);
    copy(bitmap->to_uv, out.to_uv);
    built = add(std::move(out));
  } else if (const auto* board = std::get_if<scenedesc::CheckerboardTextureDesc>(&t.kind)) {
    check_uv(board->to_uv, t.where);
    scatter::CheckerboardTexture out;
    out.color0 = operand(board->color0, t.where);
    out.color1 = operand(board->color1, t.where);
    copy(board->to_uv, out.to_uv);
    built = add(out);
  } else if (const auto* scale = std::get_if<scenedesc::ScaleTextureDesc>(&t.kind)) {
    if (!is_finite(scale->scale))
      throw InputError(t.where, "the texture's scale is not finite", "give a number");
    const int input = operand(scale->input, t.where);
    built = add(scatter::ScaleTexture{input, scale->scale});
  } else if (const auto* product = std::get_if<scenedesc::ProductTextureDesc>(&t.kind)) {
    const int a = operand(product->a, t.where);
    built = add(scatter::ProductTexture{a, operand(product->b, t.where)});
  } else if (const auto* mix = std::get_if<scenedesc::MixTextureDesc>(&t.kind)) {
    const int a = operand(mix->a, t.where), second = operand(mix->b, t.where);
    built = add(scatter::MixTexture{a, second, operand(mix->amount, t.where)});
  } else if (const auto* root = std::get_if<scenedesc::RootTextureDesc>(&t.kind)) {
    built = add(scatter::RootTexture{operand(root->input, t.where)});
  } else if (const auto* cut = std::get_if<scenedesc::ThresholdTextureDesc>(&t.kind)) {
    if (!std::isfinite(cut->threshold))
      throw InputError(t.where, "the texture's threshold is not finite", "give a number");
    const int input = operand(cut->input, t.where);
    built = add(scatter::ThresholdTexture{input, cut->threshold});
  } else {
    built = add(scatter::VertexColorTexture{});
  }
  missing_[slot] = lacks_file(t);
  return index_[slot] = built;
}

scatter::ColorInput TextureBuilder::color(const scenedesc::ColorInput& input, const SourceLocation& user) {
  if (input.texture != scenedesc::kNone) return {input.value, use(input.texture, user)};
  if (!is_finite(input.value)) throw InputError(user, "a color is not finite", "give finite numbers");
  if (input.value.r < 0 || input.value.g < 0 || input.value.b < 0)
    throw InputError(user, "a color has a negative component", "give numbers of 0 or more");
  return {input.value, -1};
}

// Its inputs are built, so they need not be followed: they may share theirs many times over.
bool TextureBuilder::lacks_file(const scenedesc::TextureDesc& texture) const {
  const auto& kind = texture.kind;
  const auto any = [&](const auto&... inputs) {
    return ((inputs.texture != scenedesc::kNone && is_missing(inputs.texture)) || ...);
  };
  if (const auto* t = std::get_if<scenedesc::BitmapTextureDesc>(&kind)) return t->missing;
  if (const auto* t = std::get_if<scenedesc::CheckerboardTextureDesc>(&kind))
    return any(t->color0, t->color1);
  if (const auto* t = std::get_if<scenedesc::ScaleTextureDesc>(&kind)) return any(t->input);
  if (const auto* t = std::get_if<scenedesc::ProductTextureDesc>(&kind)) return any(t->a, t->b);
  if (const auto* t = std::get_if<scenedesc::MixTextureDesc>(&kind)) return any(t->a, t->b, t->amount);
  if (const auto* t = std::get_if<scenedesc::RootTextureDesc>(&kind)) return any(t->input);
  if (const auto* t = std::get_if<scenedesc::ThresholdTextureDesc>(&kind)) return any(t->input);
  return false;
}

scatter::FloatInput TextureBuilder::number(const scenedesc::FloatInput& input, const SourceLocation& user,
                                           float stand_in) {
  if (input.texture != scenedesc::kNone) {
    const int built = use(input.texture, user);
    return is_missing(input.texture) ? scatter::FloatInput{stand_in, -1}
                                     : scatter::FloatInput{input.value, built};
  }
  if (!std::isfinite(input.value))
    throw InputError(user, "a parameter is not finite", "give a finite number");
  if (input.value < 0) throw InputError(user, "a parameter is negative", "give 0 or more");
  return {input.value, -1};
}

scatter::TextureSet TextureBuilder::finish() {
  std::vector<std::pair<const FileKey, File>*> files;
  for (auto& f : files_) files.push_back(&f);
  std::vector<std::exception_ptr> failures(files.size());
  parallel_for(files.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) try {
        if (files[i]->second.missing) {
          draw_stand_in(*files[i]->second.pixels);
          continue;
        }
        const auto& [name, bytes, raw, channel, alpha_may_lack] = files[i]->first;
        image::LoadedImage image =
            bytes ? image::decode_image(*bytes, name, raw) : image::read_image(name, raw);
        auto& pixels = *files[i]->second.pixels;
        pixels.width = image.color.width, pixels.height = image.color.height;
        pixels.rgb = take_pixels(image, channel, alpha_may_lack);
        for (Rgb& c : pixels.rgb)
          for (int k = 0; k < 3; ++k)
            if (!std::isfinite(c[k])) throw InputError(name, "has pixels that are not finite");
      } catch (const InputError& e) {
        const File& file = files[i]->second;
        failures[i] = std::make_exception_ptr(broken_picture(*file.texture, file.shape, e));
      } catch (...) {
        failures[i] = std::current_exception();
      }
  });
  for (const auto& failure : failures)
    if (failure) std::rethrow_exception(failure);
  return std::move(set_);
}

std::size_t TextureBuilder::memory_bytes() const {
  std::size_t bytes = 0;
  for (const auto& [key, file] : files_) bytes += file.pixels->rgb.size() * sizeof(Rgb);
  return bytes;
}

}  // namespace lumirank::world
