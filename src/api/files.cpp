// Pictures and small text files, written whole or not at all.
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "image/atomic_file.h"
#include "image/file_identity.h"
#include "image/image_io.h"
#include "image/metrics.h"
#include "image/scale_bar.h"
#include "lumirank/lumirank.h"

namespace lumirank {
namespace {

image::LayeredImage to_layers(const Picture& picture) {
  image::LayeredImage layers;
  for (const Plane& plane : picture.planes) {
    image::Image image(picture.width, picture.height);
    for (std::size_t p = 0; p < image.pixels.size(); ++p)
      image.pixels[p] = {plane.rgb[3 * p], plane.rgb[3 * p + 1], plane.rgb[3 * p + 2]};
    if (plane.name.empty())
      layers.color = std::move(image);
    else
      layers.layers.emplace_back(plane.name, std::move(image));
  }
  return layers;
}

image::DisplayOptions to_display_options(const Picture& picture, const DisplaySettings& display) {
  image::DisplayOptions options;
  options.exposure = static_cast<float>(display.exposure.value_or(exposure_for(picture)));
  if (display.tonemap == ToneMap::reinhard) options.tonemap = image::ToneMap::reinhard;
  if (display.tonemap == ToneMap::agx) options.tonemap = image::ToneMap::agx;
  return options;
}

}  // namespace

void write_picture(const std::string& filename, const Picture& picture, const DisplaySettings& display) {
  image::write_image(filename, to_layers(picture), to_display_options(picture, display));
}

double exposure_for(const Picture& picture) {
  for (const Plane& plane : picture.planes)
    if (plane.name.empty()) return image::exposure_to_see(plane.rgb);
  return 0;
}

void write_illuminance(const std::string& filename, const Picture& picture, const DisplaySettings& display) {
  for (const auto& [name, image] : to_layers(picture).layers) {
    if (name != "illuminance") continue;
    image::Range range = image::round_range(image);
    if (display.lux_high > display.lux_low)
      range = {static_cast<float>(display.lux_low), static_cast<float>(display.lux_high)};
    return image::write_image(filename, {image::with_scale(image, range, "lux"), {}});
  }
  throw InputError({filename, 0}, "the picture has no illuminance", "render it with --aov illuminance");
}

void check_writable(const std::string& filename) { image::check_writable(filename); }

void write_text(const std::string& filename, const std::string& text) {
  image::write_whole_file(filename, text);
}

void check_text_writable(const std::string& filename) { const image::AtomicFile probe(filename); }

void check_distinct(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
  image::require_distinct(outputs, inputs);
}

struct FilesTogether::Impl {
  image::FilesTogether files;
};
FilesTogether::FilesTogether() : impl_(std::make_unique<Impl>()) {}
FilesTogether::~FilesTogether() = default;
void FilesTogether::commit() { impl_->files.commit(); }

void remove_temporary_files() noexcept { image::remove_temporary_files(); }

PictureError error_of_file(const std::string& image_file, const std::string& reference_file) {
  const auto picture = image::read_image(image_file), reference = image::read_image(reference_file);
  return image::compare(picture.color, reference.color);
}

std::string PictureError::json() const {
  return nlohmann::ordered_json{{"relative_l1", relative_l1},
                                {"relative_l2", relative_l2},
                                {"rmse", rmse},
                                {"relmse", relmse},
                                {"bias", bias},
                                {"flip", flip}}
             .dump() +
         "\n";
}

}  // namespace lumirank
