// The format, little endian. A file is segments: "NanoVDB0" (2 since version 32.6), the version, how many
// grids there are and how they are compressed; for each 176 bytes about it and its name; then the grids. A
// grid is what NanoVDB has in memory: 672 bytes about it, 64 about its tree, the tree: a root with a list of
// cubes of 4096³ voxels, nodes of 32³ cubes of 128³ voxels, nodes of 16³ cubes of 8³ voxels, and leaves of
// these. All refer to each other by distances in bytes, which NanoVDB's own accessors follow wherever they
// lead.
#include "scenedesc/volumes/nanovdb_file.h"

#include <zlib.h>

#include <bit>
#include <cstring>
#include <set>

#include "base/error.h"
#include "scenedesc/volumes/sparse_box.h"

namespace lumirank::scenedesc {
namespace {

static_assert(std::endian::native == std::endian::little, "the format is read as it lies in memory");

constexpr std::uint64_t kSegmentHead = 16, kAboutGrid = 176;  // bytes
constexpr std::uint32_t kMajorVersion = 32;
constexpr std::uint16_t kPlain = 0, kZip = 1, kBlosc = 2;  // compression
constexpr std::uint32_t kLevelSet = 1;                     // the class of a grid

// Within a grid.
constexpr std::uint64_t kMatrix = 384, kTranslation = 528, kGridClass = 632, kGridType = 636, kTree = 672;
constexpr std::uint64_t kRootTile = 32, kChild = 8;  // a tile's size, and where it has its node
constexpr std::uint64_t kLeafMinimum = 80, kLeafQuantum = 84;

// A level of nodes with children: cubes of `edge` voxels with 2^bits cubes along each axis.
struct Level {
  int bits;
  std::int64_t edge;
  std::uint64_t children, table;  // where its bits and its children or values are
};
constexpr Level kUpper{5, 4096, 4128, 8256}, kLower{4, 128, 544, 1088};

// What values are, and where in nodes they are.
struct Type {
  std::uint32_t number;
  enum class Value { f32, f64, color, packed } value;
  int bits;  // of a packed number; 0: a leaf says how many
  std::uint64_t background, root_size, tile_value, table_stride, leaf_table;
};
constexpr Type kTypes[] = {
    {1, Type::Value::f32, 32, 28, 64, 20, 8, 96},     {2, Type::Value::f64, 64, 32, 96, 24, 8, 128},
    {6, Type::Value::color, 96, 28, 96, 20, 16, 128}, {13, Type::Value::packed, 4, 28, 64, 20, 8, 96},
    {14, Type::Value::packed, 8, 28, 64, 20, 8, 96},  {15, Type::Value::packed, 16, 28, 64, 20, 8, 96},
    {16, Type::Value::packed, 0, 28, 64, 20, 8, 96}};

std::string type_name(std::uint32_t number) {
  constexpr const char* kNames[] = {"unknown", "float", "double", "int16",  "int32", "int64", "Vec3f",
                                    "Vec3d",   "mask",  "half",   "uint32", "bool",  "RGBA8", "Fp4",
                                    "Fp8",     "Fp16",  "FpN",    "Vec4f",  "Vec4d", "index", "on-index"};
  return number < std::size(kNames) ? kNames[number] : "number " + std::to_string(number);
}

// Nothing is read but through this.
class Bytes {
 public:
  Bytes(std::string_view bytes, const std::string& filename) : bytes_(bytes), filename_(&filename) {}

  // `at` may be any sum of what the file says.
  std::string_view range(std::uint64_t at, std::uint64_t count) const {
    if (at > bytes_.size() || count > bytes_.size() - at)
      refuse("the file refers to bytes beyond its end", "it was cut off or damaged: copy or export it again");
    return bytes_.substr(at, count);
  }
  template <typename T>
  T at(std::uint64_t offset) const {
    T value;
    std::memcpy(&value, range(offset, sizeof(T)).data(), sizeof(T));
    return value;
  }
  std::uint64_t size() const { return bytes_.size(); }
  const std::string& filename() const { return *filename_; }
  [[noreturn]] void refuse(const std::string& message, const std::string& remedy) const {
    throw InputError({*filename_, 0}, message, remedy);
  }

 private:
  std::string_view bytes_;
  const std::string* filename_;
};

struct Entry {
  std::string name;
  std::uint32_t grid_class, type;
  std::uint16_t compression;
  std::uint64_t size;  // not compressed
  std::string_view stored;
};

std::vector<Entry> entries(const Bytes& file) {
  std::vector<Entry> out;
  std::uint64_t at = 0;
  while (at < file.size()) {
    if (file.size() - at < kSegmentHead || !looks_like_nanovdb(file.range(at, 8)))
      file.refuse(
          at == 0 ? "this is not a NanoVDB file" : "after the grids there is something else in the file",
          "export the grid again");
    if (file.range(at, 8)[7] == '1')
      file.refuse("the file is a grid as it lies in memory, without what should come before it",
                  "write it by nanovdb::io::writeGrid");
    const auto version = file.at<std::uint32_t>(at + 8);
    if (version >> 21 != kMajorVersion)
      file.refuse("version " + std::to_string(version >> 21) + " of NanoVDB is not known",
                  "version 32 is: convert the file by nanovdb_convert");
    const auto grids = file.at<std::uint16_t>(at + 12), compression = file.at<std::uint16_t>(at + 14);
    at += kSegmentHead;
    const std::size_t first = out.size();
    std::vector<std::uint64_t> sizes;
    for (int k = 0; k < grids; ++k) {
      const auto name_size = file.at<std::uint32_t>(at + 136);
      const std::string_view name = file.range(at + kAboutGrid, name_size);
      out.push_back({std::string(name.substr(0, name.find('\0'))),
                     file.at<std::uint32_t>(at + 36),
                     file.at<std::uint32_t>(at + 32),
                     compression,
                     file.at<std::uint64_t>(at),
                     {}});
      sizes.push_back(file.at<std::uint64_t>(at + 8));
      at += kAboutGrid + name_size;
    }
    for (std::size_t k = first; k < out.size(); ++k) {
      out[k].stored = file.range(at, sizes[k - first]);
      at += sizes[k - first];
    }
  }
  if (at == 0) file.refuse("the file is empty", "copy or export it again");
  return out;
}

std::vector<std::string> names_of(const std::vector<Entry>& grids) {
  std::vector<std::string> out;
  out.reserve(grids.size());
  for (const Entry& grid : grids) out.push_back(grid.name);
  return out;
}

// `room` holds what has to be unpacked.
std::string_view unpacked(const Bytes& file, const Entry& grid, std::string& room) {
  if (grid.compression == kPlain) return grid.stored;
  if (grid.compression != kZip)
    file.refuse("the grid \"" + grid.name + "\" is compressed by " +
                    (grid.compression == kBlosc ? "Blosc" : "method " + std::to_string(grid.compression)),
                "write it without compression or with zip (nanovdb_convert --zip), or as .vdb");
  const Bytes stored(grid.stored, file.filename());
  const std::string_view packed = stored.range(8, stored.at<std::uint64_t>(0));
  // zlib makes at most 1032 bytes of one: more cannot be meant.
  if (grid.size / 1040 > packed.size())
    file.refuse("the grid \"" + grid.name + "\" says that it is larger than its compressed bytes can hold",
                "the file is damaged: copy or export it again");
  room.resize(grid.size);
  uLongf size = grid.size;
  if (uncompress(reinterpret_cast<Bytef*>(room.data()), &size, reinterpret_cast<const Bytef*>(packed.data()),
                 packed.size()) != Z_OK ||
      size != grid.size)
    file.refuse("the grid \"" + grid.name + "\" cannot be decompressed",
                "the file is damaged: copy or export it again");
  return room;
}

// Goes down the tree of a grid into what its box holds.
class Walk {
 public:
  using Index = SparseBox::Index;

  Walk(const Bytes& grid, const Type& type, std::uint64_t most)
      : grid_(grid),
        type_(type),
        root_(kTree + grid.at<std::uint64_t>(kTree + 24)),
        box_(grid.filename(), corner(root_), corner(root_ + 12), value(root_ + type.background), most) {}

  GridFile run() && {
    const auto tiles = grid_.at<std::uint32_t>(root_ + 24);
    std::set<std::uint64_t> known;
    for (std::uint32_t k = 0; k < tiles; ++k) {
      const std::uint64_t tile = root_ + type_.root_size + kRootTile * k;
      const auto key = grid_.at<std::uint64_t>(tile);
      const Index lo{origin(key >> 42), origin(key >> 21), origin(key)};
      if (!box_.meets(lo, kUpper.edge)) continue;
      if (!known.insert(key).second)
        grid_.refuse("a part of the grid is there twice", "the file is damaged: copy or export it again");
      const auto child = grid_.at<std::uint64_t>(tile + kChild);
      if (child != 0)
        node(root_ + child, lo, kUpper);
      else
        fill(lo, kUpper.edge, tile + type_.tile_value);
    }
    return std::move(box_).finish(to_file());
  }

 private:
  // Of a voxel: 20 bits of each coordinate are in a key, without the 12 lowest ones.
  static std::int64_t origin(std::uint64_t key) {
    const std::int64_t coordinate = static_cast<std::int64_t>(key & 0xfffff) << 12;
    return coordinate < std::int64_t{1} << 31 ? coordinate : coordinate - (std::int64_t{1} << 32);
  }
  Index corner(std::uint64_t at) const {
    return {grid_.at<std::int32_t>(at), grid_.at<std::int32_t>(at + 4), grid_.at<std::int32_t>(at + 8)};
  }
  std::vector<float> value(std::uint64_t at) const {
    if (type_.value == Type::Value::f64) return {static_cast<float>(grid_.at<double>(at))};
    if (type_.value == Type::Value::color)
      return {grid_.at<float>(at), grid_.at<float>(at + 4), grid_.at<float>(at + 8)};
    return {grid_.at<float>(at)};
  }
  void fill(const Index& lo, std::int64_t edge, std::uint64_t at) {
    const std::vector<float> here = value(at);
    if (here != box_.background()) box_.fill(lo, edge, here.data());
  }

  void node(std::uint64_t at, const Index& lo, const Level& level) {
    const std::int64_t side = std::int64_t{1} << level.bits, edge = level.edge / side;
    for (std::int64_t n = 0; n < side * side * side; ++n) {
      const Index here{lo[0] + (n >> 2 * level.bits) * edge, lo[1] + (n >> level.bits) % side * edge,
                       lo[2] + n % side * edge};
      if (!box_.meets(here, edge)) continue;
      const auto k = static_cast<std::uint64_t>(n);
      const std::uint64_t entry = at + level.table + type_.table_stride * k;
      if (!(grid_.at<std::uint64_t>(at + level.children + k / 64 * 8) >> k % 64 & 1))
        fill(here, edge, entry);
      else if (level.bits == kUpper.bits)
        node(at + grid_.at<std::uint64_t>(entry), here, kLower);
      else
        leaf(at + grid_.at<std::uint64_t>(entry), here);
    }
  }

  void leaf(std::uint64_t at, const Index& lo) {
    const int bits = type_.bits != 0 ? type_.bits : 1 << (grid_.at<std::uint8_t>(at + 15) >> 5);
    const bool packed = type_.value == Type::Value::packed;
    if (packed && bits > 16)
      grid_.refuse("a leaf of the grid has packed numbers of " + std::to_string(bits) + " bits",
                   "the file is damaged: copy or export it again");
    const std::uint64_t size = 512 / 8 * static_cast<std::uint64_t>(bits);
    const Bytes numbers(grid_.range(at + type_.leaf_table, size), grid_.filename());
    const float least = packed ? grid_.at<float>(at + kLeafMinimum) : 0,
                step = packed ? grid_.at<float>(at + kLeafQuantum) : 0;
    for (std::int64_t n = 0; n < 512; ++n) {
      const Index here{lo[0] + n / 64, lo[1] + n / 8 % 8, lo[2] + n % 8};
      float values[3] = {};
      const auto k = static_cast<std::uint64_t>(n);
      switch (type_.value) {
        case Type::Value::f32:
          values[0] = numbers.at<float>(4 * k);
          break;
        case Type::Value::f64:
          values[0] = static_cast<float>(numbers.at<double>(8 * k));
          break;
        case Type::Value::color:
          for (std::uint64_t c = 0; c < 3; ++c) values[c] = numbers.at<float>(12 * k + 4 * c);
          break;
        case Type::Value::packed:
          values[0] = least + step * static_cast<float>(code(numbers, k, bits));
          break;
      }
      box_.fill(here, 1, values);
    }
  }

  // The k-th of numbers of so many bits.
  static std::uint32_t code(const Bytes& numbers, std::uint64_t k, int bits) {
    if (bits == 16) return numbers.at<std::uint16_t>(2 * k);
    const std::uint64_t bit = k * static_cast<std::uint64_t>(bits);
    return numbers.at<std::uint8_t>(bit / 8) >> bit % 8 & ((1u << bits) - 1);
  }

  Transform to_file() const {
    Transform out;
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column < 3; ++column)
        out.m[4 * row + column] = grid_.at<double>(kMatrix + 8 * (3 * row + column));
      out.m[4 * row + 3] = grid_.at<double>(kTranslation + 8 * row);
    }
    return out;
  }

  const Bytes& grid_;
  const Type& type_;
  std::uint64_t root_;
  SparseBox box_;
};

}  // namespace

bool looks_like_nanovdb(std::string_view first_bytes) {
  return first_bytes.size() == 8 && first_bytes.starts_with("NanoVDB") && first_bytes[7] >= '0' &&
         first_bytes[7] <= '2';
}

GridFile parse_nanovdb(std::string_view bytes, const std::string& filename, const std::string& grid,
                       std::uint64_t most) {
  const Bytes file(bytes, filename);
  const std::vector<Entry> all = entries(file);
  const Entry& entry = all[choose_grid(names_of(all), grid, filename)];
  if (entry.grid_class == kLevelSet) refuse_level_set(filename, entry.name);
  const Type* type = nullptr;
  for (const Type& known : kTypes)
    if (known.number == entry.type) type = &known;
  if (!type) refuse_type(filename, entry.name, type_name(entry.type));
  std::string room;
  const Bytes body(unpacked(file, entry, room), filename);
  if (body.size() < kTree || body.range(0, 7) != "NanoVDB" || body.at<std::uint32_t>(kGridType) != entry.type)
    file.refuse("the grid \"" + entry.name + "\" is not what the head of the file says",
                "the file is damaged: copy or export it again");
  if (body.at<std::uint32_t>(kGridClass) == kLevelSet) refuse_level_set(filename, entry.name);
  return Walk(body, *type, most).run();
}

std::vector<std::string> nanovdb_grid_names(std::string_view bytes, const std::string& filename) {
  return names_of(entries(Bytes(bytes, filename)));
}

}  // namespace lumirank::scenedesc
