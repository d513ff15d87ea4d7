#include "scenedesc/schema/files.h"

#include <zlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace lumirank::scenedesc {

namespace fs = std::filesystem;

namespace {
constexpr const char* kMissing = "does not exist";
thread_local FilesRead* t_files_read = nullptr;

std::string too_large(std::uintmax_t max_bytes) {
  return "is larger than " + std::to_string(max_bytes >> 20) + " MiB";
}

bool packed(const std::string& filename, const std::string& bytes) {
  return filename.ends_with(".gz") && bytes.starts_with("\x1f\x8b");
}

// The members of a gzip file, one after the other; what follows them that is none is left out, as gzip does.
// Memory grows with what comes out, up to `max_bytes`. "" or what is wrong.
std::string unpack(std::string& bytes, std::uintmax_t max_bytes) {
  struct Stream : z_stream {
    Stream() : z_stream{} {
      if (inflateInit2(this, 15 + 16) != Z_OK) throw InternalError("zlib does not start");  // 16: gzip
    }
    ~Stream() { inflateEnd(this); }
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;
  } stream;
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  std::string out;
  std::size_t at = 0;
  for (;;) {
    if (stream.avail_in == 0) {
      if (at == bytes.size()) return "is packed, and cut off";
      const std::size_t piece = std::min<std::size_t>(bytes.size() - at, 1u << 30);
      stream.next_in = reinterpret_cast<Bytef*>(bytes.data() + at);
      stream.avail_in = static_cast<uInt>(piece);
      at += piece;
    }
    const std::size_t old = out.size(), room = std::max(kPiece, old / 2);
    out.resize(old + std::min<std::size_t>(room, 1u << 30));
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + old);
    stream.avail_out = static_cast<uInt>(out.size() - old);
    const int status = inflate(&stream, Z_NO_FLUSH);
    out.resize(out.size() - stream.avail_out);
    if (out.size() > max_bytes) return too_large(max_bytes) + " when it is unpacked";
    if (status == Z_STREAM_END) {
      const std::size_t next = at - stream.avail_in;
      if (!std::string_view(bytes).substr(next).starts_with("\x1f\x8b")) break;
      if (inflateReset(&stream) != Z_OK) throw InternalError("zlib does not start again");
    } else if (status != Z_OK && status != Z_BUF_ERROR) {
      return "is packed, and broken";
    }
  }
  bytes = std::move(out);
  return {};
}
}  // namespace

FilesRead::FilesRead() : outer_(t_files_read) { t_files_read = this; }
FilesRead::~FilesRead() { t_files_read = outer_; }

std::string resolve_path(const std::string& name, const std::string& file) {
  fs::path path(name);
  if (path.is_relative()) path = fs::path(file).parent_path() / path;
  std::error_code error;
  const fs::path full = fs::absolute(path, error);
  return (error ? path : full).lexically_normal().string();
}

std::string try_read_file(const std::string& filename, std::string& bytes, std::uintmax_t max_bytes) {
  std::error_code error;
  if (t_files_read) t_files_read->names_.push_back(filename);
  const fs::file_status status = fs::status(filename, error);
  if (!fs::exists(status)) return kMissing;
  if (fs::is_directory(status)) return "is a folder";
  if (!fs::is_regular_file(status)) return "is a device or a pipe, not a file";
  const std::uintmax_t size = fs::file_size(filename, error);
  if (!error && size > max_bytes) return too_large(max_bytes);
  std::ifstream in(filename, std::ios::binary);
  if (error || !in) return "cannot be opened";
  bytes.resize(static_cast<std::size_t>(size));
  if (!in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) return "cannot be read";
  return packed(filename, bytes) ? unpack(bytes, max_bytes) : "";
}

std::string read_file(const std::string& filename, const SourceLocation& where, std::uintmax_t max_bytes) {
  const std::string name = where.file == filename ? "this file" : filename;
  std::string bytes;
  const std::string problem = try_read_file(filename, bytes, max_bytes);
  if (problem == kMissing && where.file != filename)
    throw InputError(where, "file not found: " + filename, "check the name");
  if (problem.starts_with("is larger"))
    throw InputError(where, name + " " + problem, "put geometry into mesh files beside the scene");
  if (problem.starts_with("is packed")) throw InputError(where, name + " " + problem, "get the whole file");
  if (!problem.empty()) throw InputError(where, name + " " + problem, "check the name");
  return bytes;
}

}  // namespace lumirank::scenedesc
