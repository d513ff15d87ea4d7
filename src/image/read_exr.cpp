#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfThreading.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "base/parallel.h"
#include "image/exr_channels.h"
#include "image/exr_file.h"

namespace lumirank::image {
namespace {

// A channel that is read, and the sample of a pixel where it goes.
struct ExrSample {
  std::string name;
  bool whole = false;  // 32-bit whole numbers, which are fractions of the largest
};

class ExrReader {
 public:
  explicit ExrReader(const std::string& filename)
      : file_(filename.c_str(), exr_threads(std::filesystem::file_size(filename))) {}

  void read(PixelSink& sink) {
    const Imf::Header& header = file_.header(0);
    if (header.hasType() && Imf::isDeepData(header.type()))
      throw std::runtime_error("volumes and deep images are not pictures");
    const Imath::Box2i window = header.dataWindow();
    PixelLayout layout = choose(header.channels());
    layout.width = window.max.x - window.min.x + 1, layout.height = window.max.y - window.min.y + 1;
    sink.begin(layout);

    Imf::InputPart part(file_, 0);
    const int rows = strip_rows(layout);
    std::vector<float> strip(static_cast<std::size_t>(layout.channels) *
                             static_cast<std::size_t>(layout.width) * static_cast<std::size_t>(rows));
    for (int y = 0; y < layout.height; y += rows) {
      const int count = std::min(rows, layout.height - y);
      Imath::Box2i lines = window;
      lines.min.y = window.min.y + y, lines.max.y = lines.min.y + count - 1;
      part.setFrameBuffer(frame(lines, strip));
      part.readPixels(lines.min.y, lines.max.y);
      const std::size_t pixels = static_cast<std::size_t>(layout.width) * static_cast<std::size_t>(count);
      to_fractions(strip, pixels);
      sink.add(strip.data(), pixels);
    }
  }

 private:
  // Each channel once, even if it is read as gray.
  int sample(const std::string& name, const Imf::ChannelList& channels) {
    for (std::size_t k = 0; k < samples_.size(); ++k)
      if (samples_[k].name == name) return static_cast<int>(k);
    const Imf::Channel* channel = channels.findChannel(name.c_str());
    if (!channel) throw std::runtime_error("its list of channels is damaged");
    if (channel->xSampling != 1 || channel->ySampling != 1)
      throw std::runtime_error("its channel " + name +
                               " has fewer pixels than the picture (save it as RGB instead)");
    samples_.push_back({name, channel->type == Imf::UINT});
    return static_cast<int>(samples_.size()) - 1;
  }

  PixelLayout choose(const Imf::ChannelList& channels) {
    std::vector<std::string> names;
    bool only_whole = true;
    for (auto c = channels.begin(); c != channels.end(); ++c) {
      names.emplace_back(c.name());
      only_whole = only_whole && c.channel().type == Imf::UINT;
    }
    if (names.empty()) throw std::runtime_error("it has no channels");
    const ExrChannels chosen = choose_exr_channels(names);
    PixelLayout layout;
    layout.encoded = only_whole;
    for (std::size_t c = 0; c < 3; ++c) layout.color[c] = sample(chosen.color[c], channels);
    if (!chosen.alpha.empty()) layout.alpha = sample(chosen.alpha, channels);
    layout.channels = static_cast<int>(samples_.size());
    return layout;
  }

  Imf::FrameBuffer frame(const Imath::Box2i& lines, std::vector<float>& strip) const {
    Imf::FrameBuffer buffer;
    const std::size_t pixel = samples_.size() * sizeof(float);
    const std::size_t row = pixel * static_cast<std::size_t>(lines.max.x - lines.min.x + 1);
    for (std::size_t k = 0; k < samples_.size(); ++k)
      buffer.insert(samples_[k].name.c_str(), Imf::Slice::Make(samples_[k].whole ? Imf::UINT : Imf::FLOAT,
                                                               strip.data() + k, lines, pixel, row));
    return buffer;
  }

  void to_fractions(std::vector<float>& strip, std::size_t pixels) const {
    for (std::size_t k = 0; k < samples_.size(); ++k) {
      if (!samples_[k].whole) continue;
      for (std::size_t i = 0; i < pixels; ++i) {
        float& v = strip[i * samples_.size() + k];
        v = static_cast<float>(std::bit_cast<std::uint32_t>(v)) * (1 / 4294967295.0f);
      }
    }
  }

  Imf::MultiPartInputFile file_;
  std::vector<ExrSample> samples_;
};

}  // namespace

int exr_threads(std::size_t bytes) {
  if (bytes < (1 << 20)) return 0;
  static const int threads = [] {
    const int count = current_threads();
    if (count > 1) Imf::setGlobalThreadCount(count);
    return count > 1 ? count : 0;
  }();
  return threads;
}

void read_exr(const std::string& filename, PixelSink& sink) { ExrReader(filename).read(sink); }

}  // namespace lumirank::image
