// Mitsuba's serialized meshes, versions 3 and 4: for each mesh a header of 4 bytes and a zlib stream; at the
// end of the file their offsets and their number. Little endian throughout.
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/error.h"
#include "scenedesc/meshes/mesh_parts.h"
#include "scenedesc/meshes/mesh_reader.h"

namespace lumirank::scenedesc {
namespace {

static_assert(std::endian::native == std::endian::little, "the format is read as it lies in memory");

constexpr std::uint16_t kMagic = 0x041C;

enum Flag : std::uint32_t {
  kNormals = 0x0001,
  kTexcoords = 0x0002,
  kTangents = 0x0004,
  kColors = 0x0008,
  kFaceNormals = 0x0010,
  kSingle = 0x1000,
  kDouble = 0x2000,
};

[[noreturn]] void fail(const std::string& filename, const std::string& message) {
  throw InputError({filename, 0}, message, "export the file again");
}

template <typename T>
T load(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

struct Part {
  std::size_t begin, end;  // of the zlib stream
  std::uint16_t version;
};

std::uint16_t version_at(const std::string& bytes, std::size_t at, const std::string& filename) {
  if (load<std::uint16_t>(bytes, at) != kMagic)
    fail(filename, "this is not a serialized mesh (wrong magic number)");
  const auto version = load<std::uint16_t>(bytes, at + 2);
  if (version != 3 && version != 4) fail(filename, "unknown version " + std::to_string(version));
  return version;
}

Part locate(const std::string& bytes, const std::string& filename, int shape_index) {
  if (bytes.size() < 8) fail(filename, "the file is too short");
  const std::uint16_t version = version_at(bytes, 0, filename);
  const std::size_t count_at = bytes.size() - 4, width = version == 4 ? 8 : 4;
  const std::size_t count = load<std::uint32_t>(bytes, count_at);
  if (count == 0 || count > (count_at - 4) / width)
    fail(filename, "the table of meshes at the end is broken");
  const std::size_t table = count_at - count * width;
  if (shape_index < 0 || static_cast<std::size_t>(shape_index) >= count)
    throw InputError({filename, 0},
                     "there is no mesh " + std::to_string(shape_index) + ": the file holds " +
                         std::to_string(count) + (count == 1 ? " mesh" : " meshes"),
                     "give a shape index from 0 to " + std::to_string(count - 1));
  auto offset = [&](std::size_t k) -> std::uint64_t {
    return version == 4 ? load<std::uint64_t>(bytes, table + k * width)
                        : load<std::uint32_t>(bytes, table + k * width);
  };
  const auto k = static_cast<std::size_t>(shape_index);
  const std::uint64_t begin = offset(k);
  const std::uint64_t end = k + 1 < count ? offset(k + 1) : table;
  if (begin + 4 > table || begin > table || end > table || end < begin + 4)
    fail(filename, "the offset of mesh " + std::to_string(shape_index) + " is out of range");
  return {static_cast<std::size_t>(begin) + 4, static_cast<std::size_t>(end),
          version_at(bytes, begin, filename)};
}

// Inflates on demand. Memory grows with what really comes out of the stream, never with what its header
// promises.
class Inflater {
 public:
  Inflater(const char* data, std::size_t size, const std::string& filename)
      : next_(data), left_(size), filename_(filename) {
    if (inflateInit(&stream_) != Z_OK) throw InternalError("zlib does not start");
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  void read(void* out, std::size_t size) {
    auto* to = static_cast<Bytef*>(out);
    while (size > 0) {
      const std::size_t piece = std::min<std::size_t>(size, 1u << 30);
      stream_.next_out = to;
      stream_.avail_out = static_cast<uInt>(piece);
      while (stream_.avail_out > 0) step();
      to += piece;
      size -= piece;
    }
  }
  template <typename T>
  T read() {
    T value;
    read(&value, sizeof value);
    return value;
  }
  template <typename T>
  std::vector<T> read_array(std::uint64_t n) {
    constexpr std::size_t kChunk = (std::size_t{4} << 20) / sizeof(T);
    std::vector<T> all;
    while (all.size() < n) {
      const std::size_t old = all.size();
      all.resize(old + static_cast<std::size_t>(std::min<std::uint64_t>(n - old, std::max(kChunk, old))));
      read(all.data() + old, (all.size() - old) * sizeof(T));
    }
    return all;
  }

 private:
  void step() {
    if (stream_.avail_in == 0) {
      const std::size_t piece = std::min<std::size_t>(left_, 1u << 30);
      stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(next_));
      stream_.avail_in = static_cast<uInt>(piece);
      next_ += piece;
      left_ -= piece;
    }
    const int status = inflate(&stream_, Z_NO_FLUSH);
    if (status == Z_STREAM_END && stream_.avail_out > 0) fail(filename_, "the mesh ends too early");
    if (status == Z_BUF_ERROR) fail(filename_, "the compressed data is cut off");
    if (status != Z_OK && status != Z_STREAM_END)
      fail(filename_, std::string("the compressed data is broken") +
                          (stream_.msg ? std::string(": ") + stream_.msg : ""));
  }

  z_stream stream_{};
  const char* next_;
  std::size_t left_;
  const std::string& filename_;
};

// n vectors of `T`, which consists of floats only.
template <typename T>
std::vector<T> read_vectors(Inflater& in, std::uint64_t n, bool is_double) {
  if (!is_double) return in.read_array<T>(n);
  constexpr std::size_t kWidth = sizeof(T) / sizeof(float);
  const std::vector<double> wide = in.read_array<double>(n * kWidth);
  std::vector<T> out(static_cast<std::size_t>(n));
  for (std::size_t k = 0; k < out.size(); ++k) {
    float values[kWidth];
    for (std::size_t c = 0; c < kWidth; ++c) values[c] = static_cast<float>(wide[k * kWidth + c]);
    std::memcpy(static_cast<void*>(&out[k]), values, sizeof values);
  }
  return out;
}

}  // namespace

MeshData parse_serialized(const std::string& bytes, const std::string& filename, int shape_index,
                          bool& face_normals) {
  const Part part = locate(bytes, filename, shape_index);
  Inflater in(bytes.data() + part.begin, part.end - part.begin, filename);
  const auto flags = in.read<std::uint32_t>();
  if (part.version == 4) {
    std::size_t length = 0;
    while (in.read<char>() != 0)
      if (++length > 65535) fail(filename, "the name of a mesh does not end");
  }
  const auto vertices = in.read<std::uint64_t>(), triangles = in.read<std::uint64_t>();
  const bool is_double = flags & kDouble;
  if (is_double == static_cast<bool>(flags & kSingle))
    fail(filename, "the mesh is neither in single nor in double precision");
  if (flags & kTangents)
    fail(filename, "the mesh has tangents, which this version of the format does not have");
  if (vertices > 0xffffffffu) fail(filename, "the mesh has more than 4,294,967,295 vertices");
  // DEFLATE shrinks to no less than 1/1032.
  const std::uint64_t max_bytes = 1032 * static_cast<std::uint64_t>(part.end - part.begin);
  if (vertices > max_bytes / 12 || triangles > max_bytes / 12)
    fail(filename, "the mesh claims " + std::to_string(vertices) + " vertices and " +
                       std::to_string(triangles) + " triangles, but the file is too short for them");
  MeshData mesh;
  if (is_double) {
    const std::vector<double> wide = in.read_array<double>(3 * vertices);
    std::vector<Vec3d> places(static_cast<std::size_t>(vertices));
    for (std::size_t k = 0; k < places.size(); ++k)
      places[k] = {wide[3 * k], wide[3 * k + 1], wide[3 * k + 2]};
    auto [positions, origin] = near_positions(places);
    mesh.positions = std::move(positions), mesh.origin = origin;
  } else {
    mesh.positions = in.read_array<Vec3f>(vertices);
  }
  if (flags & kNormals) mesh.normals = read_vectors<Vec3f>(in, vertices, is_double);
  if (flags & kTexcoords) mesh.uvs = read_vectors<Vec2f>(in, vertices, is_double);
  if (flags & kColors) mesh.colors = read_vectors<Rgb>(in, vertices, is_double);
  mesh.indices = in.read_array<std::uint32_t>(3 * triangles);
  for (std::size_t k = 0; k < mesh.indices.size(); ++k)
    if (mesh.indices[k] >= vertices)
      fail(filename, "triangle " + std::to_string(k / 3) + ": no vertex " + std::to_string(mesh.indices[k]) +
                         ": there are " + std::to_string(vertices));
  face_normals = flags & kFaceNormals;
  return checked(std::move(mesh), filename);
}

MeshData parse_serialized(const std::string& bytes, const std::string& filename, int shape_index) {
  bool face_normals = false;
  return parse_serialized(bytes, filename, shape_index, face_normals);
}

}  // namespace lumirank::scenedesc
