#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>

#include "base/error.h"
#include "image/exr_file.h"
#include "image/exr_header.h"
#include "image/file_end.h"
#include "image/image_builder.h"
#include "image/image_io.h"
#include "image/jpeg_file.h"
#include "image/other_formats.h"
#include "image/pfm.h"
#include "image/png_file.h"
#include "image/radiance_file.h"

namespace lumirank::image {
namespace {
namespace fs = std::filesystem;

enum class Format { pfm, exr, png, jpeg, radiance, webp, other };

// By the first bytes: names lie.
Format format_of(std::string_view start) {
  if (start.starts_with("\x76\x2f\x31\x01")) return Format::exr;
  if (start.starts_with("\x89PNG")) return Format::png;
  if (start.starts_with("\xff\xd8\xff")) return Format::jpeg;
  if (start.starts_with("#?")) return Format::radiance;
  if (start.starts_with("RIFF") && start.substr(std::min<std::size_t>(8, start.size())).starts_with("WEBP"))
    return Format::webp;
  if (start.size() > 2 && start[0] == 'P' && (start[1] == 'F' || start[1] == 'f') &&
      std::isspace(static_cast<unsigned char>(start[2])))
    return Format::pfm;
  return Format::other;
}

[[noreturn]] void fail_reading(const std::string& name, const std::string& why) {
  throw InputError(SourceLocation{name, 0}, "cannot read the image: " + why);
}

// Whatever a decoder throws, as an InputError.
template <typename Read>
LoadedImage guarded(const std::string& name, const Read& read) {
  try {
    return read();
  } catch (const InputError&) {
    throw;
  } catch (const InternalError&) {
    throw;
  } catch (const Cancelled&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw InputError(SourceLocation{name, 0}, "the image needs more memory than there is");
  } catch (const std::exception& failure) {
    fail_reading(name, failure.what());
  }
}

std::string first_bytes(const std::string& filename) {
  std::ifstream in(filename, std::ios::binary);
  if (!in)
    throw InputError(SourceLocation{filename, 0},
                     std::string("cannot open the image: ") + std::strerror(errno));
  std::string start(16, '\0');
  in.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(in.gcount()));
  return start;
}

std::string whole_file(const std::string& filename, std::size_t max_pixels) {
  // No format that is read like this needs more for a pixel; the rest is for headers and profiles.
  constexpr std::uintmax_t kPerPixel = 8, kBesides = 64 << 20;
  const std::uintmax_t size = fs::file_size(filename);
  if (size / kPerPixel > max_pixels + kBesides / kPerPixel)
    fail_reading(filename, "it is longer than an image of " + std::to_string(max_pixels) +
                               " pixels, the limit, can be");
  std::string bytes(static_cast<std::size_t>(size), '\0');
  std::ifstream in(filename, std::ios::binary);
  if (!in.read(bytes.data(), static_cast<std::streamsize>(size)))
    fail_reading(filename, "it cannot be read to its end");
  return bytes;
}

// A file without a place on a disk, for readers that want a name.
class FileInMemory {
 public:
  explicit FileInMemory(std::string_view bytes) : file_(memfd_create("lumirank image", MFD_CLOEXEC)) {
    while (file_ >= 0 && !bytes.empty()) {
      const ssize_t written = write(file_, bytes.data(), bytes.size());
      if (written <= 0) break;
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    if (file_ < 0 || !bytes.empty()) {
      if (file_ >= 0) close(file_);
      throw std::runtime_error(std::string("no memory for a copy of it: ") + std::strerror(errno));
    }
  }
  FileInMemory(const FileInMemory&) = delete;
  FileInMemory& operator=(const FileInMemory&) = delete;
  ~FileInMemory() { close(file_); }
  std::string name() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  int file_;
};

void read_bytes(Format format, std::string_view bytes, PixelSink& sink) {
  if (!has_file_end(bytes))
    throw std::runtime_error(std::string("this ") + (format == Format::png ? "PNG" : "JPEG") +
                             " file is truncated");
  if (format == Format::png) return read_png(bytes, sink);
  if (format == Format::jpeg) return read_jpeg(bytes, sink);
  read_radiance(bytes, sink);
}

}  // namespace

LoadedImage read_image(const std::string& filename, bool raw, std::size_t max_pixels) {
  std::error_code error;
  const fs::file_status status = fs::status(filename, error);
  if (!fs::exists(status))
    throw InputError(SourceLocation{filename, 0}, "the image does not exist", "check its path");
  if (!fs::is_regular_file(status))
    throw InputError(SourceLocation{filename, 0}, "this is not a file, let alone an image");
  const std::string start = first_bytes(filename);
  if (start.empty()) fail_reading(filename, "it is empty");
  const Format format = format_of(start);
  return guarded(filename, [&]() -> LoadedImage {
    if (format == Format::pfm) return {read_pfm(filename, max_pixels), {}};
    ImageBuilder builder(filename, raw, max_pixels);
    if (format == Format::exr) {
      require_sane_exr_header(filename, max_pixels);
      read_exr(filename, builder);
    } else if (format == Format::other || format == Format::webp) {
      read_other_format(filename, builder);
    } else {
      read_bytes(format, whole_file(filename, max_pixels), builder);
    }
    return builder.take();
  });
}

LoadedImage decode_image(const std::string& bytes, const std::string& name, bool raw,
                         std::size_t max_pixels) {
  const Format format = format_of(bytes);
  if (format != Format::png && format != Format::jpeg && format != Format::webp)
    throw InputError(SourceLocation{name, 0}, "an image in memory is neither a PNG, a JPEG nor a WebP file",
                     "embed one of these, or keep the image in a file of its own");
  return guarded(name, [&] {
    ImageBuilder builder(name, raw, max_pixels);
    if (format == Format::webp)
      read_other_format(FileInMemory(bytes).name(), builder);
    else
      read_bytes(format, bytes, builder);
    return builder.take();
  });
}

}  // namespace lumirank::image
