#include "denoise/denoiser.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "denoise/turning.h"

namespace lumirank::denoise {
namespace {

using image::Image;

static_assert(sizeof(Rgb) == 3 * sizeof(float), "the library reads pixels as three floats without gaps");

std::string size_of(const Image& image) {
  return std::to_string(image.width) + "×" + std::to_string(image.height);
}

// What is not finite spreads over the whole picture in there, and comes back as black or worse.
void check_image(const Image& image, const Image& noisy, const std::string& name) {
  if (image.width != noisy.width || image.height != noisy.height)
    throw InputError("the picture to denoise has " + size_of(noisy) + " pixels and its " + name + " " +
                     size_of(image));
  const auto bad =
      std::find_if_not(image.pixels.begin(), image.pixels.end(), [](Rgb c) { return is_finite(c); });
  if (bad == image.pixels.end()) return;
  const auto at = bad - image.pixels.begin();
  throw InputError("what is to be denoised is not finite everywhere: the " + name + " at column " +
                   std::to_string(at % image.width) + ", row " + std::to_string(at / image.width) +
                   " is NaN or infinite");
}

void check_input(const Image& noisy, const Image* albedo, const Image* normal) {
  if (noisy.pixels.empty()) throw InputError("the picture to denoise has no pixels");
  if (normal && !albedo) throw InputError("normals help to denoise only together with an albedo");
  check_image(noisy, noisy, "picture");
  if (albedo) check_image(*albedo, noisy, "albedo");
  if (normal) check_image(*normal, noisy, "normal");
}

Rgb into_albedo(Rgb c) {
  return {std::clamp(c.r, 0.0f, 1.0f), std::clamp(c.g, 0.0f, 1.0f), std::clamp(c.b, 0.0f, 1.0f)};
}

// Shorter ones stay: they say that the pixel sees several directions.
Rgb into_normal(Rgb n) {
  const Rgb scaled =
      n / std::max({std::abs(n.r), std::abs(n.g), std::abs(n.b), 1.0f});  // its square is finite
  const float length = norm2(scaled);
  return scaled == n && length <= 1 ? n : scaled / length;
}

Image cut(const Image* feature, Rgb (*into)(Rgb)) {
  Image cut;
  if (feature) cut = *feature;
  for (Rgb& c : cut.pixels) c = into(c);
  return cut;
}

// One device with its errors. They belong to the device, so that each call has one of its own.
class Device {
 public:
  explicit Device(const Oidn& oidn) : oidn_(oidn), device_(oidn.new_device(kOidnCpu), oidn.release_device) {
    check();
    oidn_.set_device_int(device_.get(), "numThreads", current_threads());
    // Threads that are pinned to cores would stay there for what is rendered next.
    oidn_.set_device_bool(device_.get(), "setAffinity", false);
    oidn_.commit_device(device_.get());
    check();
  }

  // The filter for ray-traced pictures, of inputs with their names: "color" and features without noise, or
  // one feature alone. The output may be one of the inputs.
  void filter(const std::vector<std::pair<const char*, const Image*>>& inputs, Image& output, bool color,
              bool clean) const {
    const std::unique_ptr<OidnFilter, void (*)(OidnFilter*)> f(oidn_.new_filter(device_.get(), "RT"),
                                                               oidn_.release_filter);
    check();
    for (const auto& [name, image] : inputs) set_image(f.get(), name, *image);
    set_image(f.get(), "output", output);
    if (color) {
      oidn_.set_filter_bool(f.get(), "hdr", true);
      oidn_.set_filter_bool(f.get(), "cleanAux", clean && inputs.size() > 1);
    }
    oidn_.commit_filter(f.get());
    check();
    oidn_.execute_filter(f.get());
    check();
  }

 private:
  // Inputs are not written to, though the interface cannot say so.
  void set_image(OidnFilter* f, const char* name, const Image& image) const {
    oidn_.set_filter_image(f, name, const_cast<Rgb*>(image.pixels.data()), kOidnThreeFloats,
                           static_cast<std::size_t>(image.width), static_cast<std::size_t>(image.height), 0,
                           0, 0);
  }

  void check() const {
    const char* message = nullptr;
    const int error = oidn_.get_device_error(device_.get(), &message);
    if (error == kOidnOutOfMemory) throw std::bad_alloc();
    if (error != kOidnNoError || !device_)
      throw InternalError("Open Image Denoise failed: " +
                          std::string(message ? message : "it does not say why"));
  }

  const Oidn& oidn_;
  std::unique_ptr<OidnDevice, void (*)(OidnDevice*)> device_;
};

}  // namespace

Denoiser::Denoiser(const Oidn& functions, std::string version)
    : oidn_(functions), version_(std::move(version)) {}

Image Denoiser::denoise(const Image& noisy, const Image* albedo, const Image* normal, Features features,
                        int orientations) const {
  check_input(noisy, albedo, normal);
  constexpr std::array kQuarters = {0, 2, 1, 3};  // first those that differ most
  if (orientations < 1 || orientations > static_cast<int>(kQuarters.size()))
    throw InputError("a picture is denoised in 1 to 4 orientations, not in " + std::to_string(orientations));
  Image clean_albedo = cut(albedo, into_albedo);
  Image clean_normal = cut(normal, into_normal);
  Image output(noisy.width, noisy.height);
  const Device device(oidn_);
  std::vector<std::pair<const char*, const Image*>> inputs = {{"color", &noisy}};
  const auto add = [&](const char* name, Image& feature) {
    if (feature.pixels.empty()) return;
    if (features == Features::prefiltered) device.filter({{name, &feature}}, feature, false, false);
    inputs.emplace_back(name, &feature);
  };
  add("albedo", clean_albedo);
  add("normal", clean_normal);
  device.filter(inputs, output, true, features != Features::noisy);
  if (orientations == 1) return output;
  for (int k = 1; k < orientations; ++k) {
    const int quarters = kQuarters[static_cast<std::size_t>(k)];
    std::vector<Image> turned_images;
    turned_images.reserve(inputs.size());  // they are pointed at
    std::vector<std::pair<const char*, const Image*>> turned_inputs;
    turned_inputs.reserve(inputs.size());
    for (const auto& [name, image] : inputs)
      turned_inputs.emplace_back(name, &turned_images.emplace_back(turned(*image, quarters)));
    Image turned_output(turned_images[0].width, turned_images[0].height);
    device.filter(turned_inputs, turned_output, true, features != Features::noisy);
    image::add_to(output, turned(turned_output, -quarters));
  }
  for (Rgb& c : output.pixels) c = c / static_cast<float>(orientations);
  return output;
}

}  // namespace lumirank::denoise
