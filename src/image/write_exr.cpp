#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <half.h>

#include <stdexcept>
#include <utility>
#include <vector>

#include "base/error.h"
#include "image/exr_file.h"

namespace lumirank::image {
namespace {

// OpenEXR's own stream closes without checking whether the last bytes went out.
class ExrStream final : public Imf::OStream {
 public:
  explicit ExrStream(std::ostream& out) : Imf::OStream("the image"), out_(out) {}

  using Position = decltype(std::declval<Imf::OStream&>().tellp());
  void write(const char* bytes, int count) override {
    out_.write(bytes, count);
    require_good();
  }
  Position tellp() override { return static_cast<Position>(out_.tellp()); }
  void seekp(Position position) override {
    out_.seekp(static_cast<std::streamoff>(position));
    require_good();
  }

 private:
  void require_good() const {
    if (!out_) throw std::runtime_error("not all of it could be written; is the disk full?");
  }
  std::ostream& out_;
};

// One picture's three channels, straight from its pixels, or from their copy in half precision.
class ExrPlanes {
 public:
  ExrPlanes(int width, int height, Precision precision) : header_(width, height), precision_(precision) {
    header_.compression() = Imf::ZIP_COMPRESSION;
  }

  void add(const std::string& prefix, const Image& image) {
    const bool single = precision_ == Precision::single;
    const char* base = reinterpret_cast<const char*>(image.pixels.data());
    if (!single) {
      std::vector<half>& copy = halves_.emplace_back();
      copy.reserve(3 * image.pixels.size());
      for (const Rgb& p : image.pixels)
        for (int c = 0; c < 3; ++c) copy.emplace_back(p[c]);
      base = reinterpret_cast<const char*>(copy.data());
    }
    const Imf::PixelType type = single ? Imf::FLOAT : Imf::HALF;
    const std::size_t sample = single ? sizeof(float) : sizeof(half);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::string name = prefix + "RGB"[c];
      header_.channels().insert(name.c_str(), Imf::Channel(type));
      // The library takes a pointer to what it may not change.
      frame_.insert(name.c_str(), Imf::Slice(type, const_cast<char*>(base) + c * sample, 3 * sample,
                                             3 * sample * static_cast<std::size_t>(image.width)));
    }
  }

  void write(Imf::OStream& out, int height, std::size_t bytes) const {
    Imf::OutputFile file(out, header_, exr_threads(bytes));
    file.setFrameBuffer(frame_);
    file.writePixels(height);
  }

 private:
  Imf::Header header_;
  const Precision precision_;
  Imf::FrameBuffer frame_;
  std::vector<std::vector<half>> halves_;
};

}  // namespace

void write_exr(std::ostream& out, const LayeredImage& image, Precision precision) {
  static_assert(sizeof(Rgb) == 3 * sizeof(float));
  const Image& color = image.color;
  ExrPlanes planes(color.width, color.height, precision);
  planes.add("", color);
  for (const auto& [name, layer] : image.layers) {
    if (layer.width != color.width || layer.height != color.height)
      throw InternalError("layer '" + name + "' differs in size from its picture");
    planes.add(name + ".", layer);
  }
  ExrStream stream(out);
  planes.write(stream, color.height, (1 + image.layers.size()) * color.pixels.size() * sizeof(Rgb));
  out.flush();
  if (!out) throw std::runtime_error("not all of it could be written; is the disk full?");
}

}  // namespace lumirank::image
