#include "api/paint.h"

#include <algorithm>

#include "base/parallel.h"
#include "image/image_io.h"
#include "world/environment_builder.h"
#include "world/texture_builder.h"

namespace lumirank::api {

namespace sd = scenedesc;

namespace {

// The pictures that the texture reads; false if it reads anything that no picture can hold.
bool collect(const sd::SceneDesc& scene, int index, std::vector<const sd::BitmapTextureDesc*>& pictures) {
  if (index == sd::kNone) return true;
  const auto& kind = scene.textures[static_cast<std::size_t>(index)].kind;
  const auto all = [&](auto&... inputs) { return (collect(scene, inputs.texture, pictures) && ...); };
  if (const auto* bitmap = std::get_if<sd::BitmapTextureDesc>(&kind)) {
    pictures.push_back(bitmap);
    return true;
  }
  if (const auto* scale = std::get_if<sd::ScaleTextureDesc>(&kind)) return all(scale->input);
  if (const auto* product = std::get_if<sd::ProductTextureDesc>(&kind)) return all(product->a, product->b);
  if (const auto* mix = std::get_if<sd::MixTextureDesc>(&kind)) return all(mix->a, mix->b, mix->amount);
  if (const auto* root = std::get_if<sd::RootTextureDesc>(&kind)) return all(root->input);
  if (const auto* cut = std::get_if<sd::ThresholdTextureDesc>(&kind)) return all(cut->input);
  return false;
}

bool mapped_alike(const sd::BitmapTextureDesc& a, const sd::BitmapTextureDesc& b) {
  return a.to_uv == b.to_uv && a.wrap_u == b.wrap_u && a.wrap_v == b.wrap_v && a.filter == b.filter;
}

}  // namespace

std::optional<sd::BitmapTextureDesc> paint_texture(const sd::SceneDesc& scene, int texture) {
  std::vector<const sd::BitmapTextureDesc*> pictures;
  if (!collect(scene, texture, pictures) || pictures.empty()) return std::nullopt;
  const sd::BitmapTextureDesc& first = *pictures[0];
  for (const auto* other : pictures)
    if (!mapped_alike(first, *other)) return std::nullopt;

  const sd::TextureDesc& desc = scene.textures[static_cast<std::size_t>(texture)];
  world::TextureBuilder builder(scene);
  const int built = builder.use(texture, desc.where);
  scatter::TextureSet set = builder.finish();
  image::Image image;
  for (scatter::Texture& t : set.textures)
    if (auto* bitmap = std::get_if<scatter::BitmapTexture>(&t)) {
      constexpr float kIdentity[6] = {1, 0, 0, 0, 1, 0};
      std::copy(std::begin(kIdentity), std::end(kIdentity), bitmap->to_uv);
      image.width = std::max(image.width, bitmap->pixels->width);
      image.height = std::max(image.height, bitmap->pixels->height);
    }
  image = image::Image(image.width, image.height);
  parallel_for(static_cast<std::size_t>(image.height), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y)
      for (int x = 0; x < image.width; ++x) {
        const Vec2f uv{(static_cast<float>(x) + 0.5f) / static_cast<float>(image.width),
                       1 - (static_cast<float>(y) + 0.5f) / static_cast<float>(image.height)};
        image.at(x, static_cast<int>(y)) = set.lookup(built, {uv, Rgb(1)});
      }
  });

  sd::BitmapTextureDesc out = first;
  out.bytes = std::make_shared<const std::string>(image::encode_exr(image, image::Precision::half));
  out.filename = desc.id;
  out.raw = std::all_of(pictures.begin(), pictures.end(), [](const auto* p) { return p->raw; });
  out.channel = sd::TextureChannel::rgb;
  return out;
}

sd::Painter::Environment paint_environment(const sd::SceneDesc& scene, world::Notes& notes) {
  world::EnvironmentBuilder builder(notes);
  for (const sd::EmitterDesc& e : scene.emitters) {
    if (const auto* constant = std::get_if<sd::ConstantEnvironmentDesc>(&e.kind))
      builder.add_constant(constant->radiance, e);
    if (const auto* map = std::get_if<sd::EnvironmentMapDesc>(&e.kind)) builder.add_map(*map, e);
  }
  emitters::EnvironmentEmitter all = builder.build();
  image::Image image(all.width, all.height);
  image.pixels = std::move(all.radiance);
  sd::Painter::Environment out;
  out.exr = image::encode_exr(image, image::Precision::single);
  for (std::size_t row = 0; row < 3; ++row) {
    const auto k = static_cast<int>(row);
    out.to_world.m[4 * row] = all.to_world.s[k], out.to_world.m[4 * row + 1] = all.to_world.t[k];
    out.to_world.m[4 * row + 2] = all.to_world.n[k];
  }
  return out;
}

}  // namespace lumirank::api
