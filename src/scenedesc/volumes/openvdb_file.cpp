// Alone includes OpenVDB, whose headers take as long to compile as many files of ours.
#include "scenedesc/volumes/openvdb_file.h"

// OpenVDB's templates share variables with its library. Were ours hidden, the library would fill in those of
// ours and find its own empty: std::call_once, which it does that by, has one instance for both.
#pragma GCC visibility push(default)
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>
#pragma GCC visibility pop

#include <filesystem>
#include <fstream>
#include <utility>

#include "base/error.h"
#include "scenedesc/volumes/sparse_box.h"

namespace lumirank::scenedesc {
namespace {

namespace vdb = openvdb;

// OpenVDB's own classes for files go on with whatever is in memory when a file ends early, up to billions of
// nodes; here the stream throws.
class Archive : public vdb::io::Archive {
 public:
  explicit Archive(const std::string& filename) : in_(filename, std::ios::binary) {
    in_.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
    readHeader(in_);
    vdb::io::setStreamMetadataPtr(in_, metadata_, false);
    vdb::io::setVersion(in_, libraryVersion(), fileVersion());
    vdb::io::setDataCompression(in_, compression());
    vdb::MetaMap().readMeta(in_);
    const auto size = static_cast<std::int64_t>(std::filesystem::file_size(filename));
    const std::int32_t count = readGridCount(in_);
    for (std::int32_t k = 0; k < count; ++k) {
      Entry& entry = entries_.emplace_back();
      entry.grid = entry.at.read(in_);
      names_.push_back(entry.at.gridName());
      if (!inputHasGridOffsets()) {
        // Written to a stream that could not go back: what comes next lies behind the whole grid.
        readGrid(entry.grid, entry.at, in_);
        entry.read = true;
        continue;
      }
      if (entry.at.getEndPos() > size || entry.at.getEndPos() < in_.tellg())
        throw InputError({filename, 0}, "the file ends before its grid \"" + entry.at.gridName() + "\" does",
                         "it was cut off: copy or export it again");
      if (k + 1 < count) entry.at.seekToEnd(in_);
    }
  }

  const std::vector<std::string>& names() const { return names_; }

  vdb::GridBase::Ptr grid(std::size_t k) {
    read(k);
    if (entries_[k].at.isInstance())
      for (std::size_t other = 0; other < entries_.size(); ++other)
        if (other != k && entries_[other].at.uniqueName() == entries_[k].at.instanceParentName()) {
          read(other);
          entries_[k].grid->setTree(entries_[other].grid->baseTreePtr());
        }
    return entries_[k].grid;
  }

 private:
  struct Entry {
    vdb::io::GridDescriptor at;
    vdb::GridBase::Ptr grid;
    bool read = false;
  };

  void read(std::size_t k) {
    Entry& entry = entries_[k];
    if (std::exchange(entry.read, true)) return;
    entry.at.seekToGrid(in_);
    readGrid(entry.grid, entry.at, in_);
  }

  vdb::io::StreamMetadata::Ptr metadata_ =
      std::make_shared<vdb::io::StreamMetadata>();  // the stream only points to it
  std::ifstream in_;
  std::vector<Entry> entries_;
  std::vector<std::string> names_;
};

std::vector<float> numbers(float v) { return {v}; }
std::vector<float> numbers(double v) { return {static_cast<float>(v)}; }
template <typename T>
std::vector<float> numbers(const vdb::math::Vec3<T>& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

SparseBox::Index index(const vdb::Coord& c) { return {c.x(), c.y(), c.z()}; }

template <typename Grid>
GridFile dense(const Grid& grid, const std::string& filename, const Transform& to_file, std::uint64_t most) {
  const vdb::CoordBBox active = grid.evalActiveVoxelBoundingBox();
  SparseBox box(filename, index(active.min()), index(active.max()), numbers(grid.background()), most);
  // What a cube of voxels has in common, and then the leaves.
  auto tile = grid.tree().cbeginValueAll();
  tile.setMaxDepth(tile.getLeafDepth() - 1);
  for (; tile; ++tile) {
    vdb::CoordBBox cube;
    if (tile.getValue() == grid.background() || !tile.getBoundingBox(cube)) continue;
    box.fill(index(cube.min()), cube.dim().x(), numbers(tile.getValue()).data());
  }
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
    const SparseBox::Index lo = index(leaf->origin());
    if (!box.meets(lo, 8)) continue;
    for (std::int64_t n = 0; n < 512; ++n)
      box.fill({lo[0] + n / 64, lo[1] + n / 8 % 8, lo[2] + n % 8}, 1,
               numbers(leaf->getValue(static_cast<vdb::Index>(n))).data());
  }
  return std::move(box).finish(to_file);
}

// OpenVDB multiplies rows from the left.
Transform index_to_file(const vdb::GridBase& grid, const std::string& filename) {
  if (!grid.transform().isLinear())
    throw InputError(
        {filename, 0},
        "the voxels of the grid \"" + grid.getName() + "\" get larger with the distance (a frustum)",
        "resample it to voxels of one size");
  const vdb::Mat4d matrix = grid.transform().baseMap()->getAffineMap()->getMat4();
  Transform out;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      out.m[static_cast<std::size_t>(4 * row + column)] = matrix(column, row);
  return out;
}

GridFile dense(const vdb::GridBase::Ptr& grid, const std::string& filename, std::uint64_t most) {
  if (grid->getGridClass() == vdb::GRID_LEVEL_SET) refuse_level_set(filename, grid->getName());
  const Transform to_file = index_to_file(*grid, filename);
  if (const auto floats = vdb::gridConstPtrCast<vdb::FloatGrid>(grid))
    return dense(*floats, filename, to_file, most);
  if (const auto doubles = vdb::gridConstPtrCast<vdb::DoubleGrid>(grid))
    return dense(*doubles, filename, to_file, most);
  if (const auto vectors = vdb::gridConstPtrCast<vdb::Vec3SGrid>(grid))
    return dense(*vectors, filename, to_file, most);
  if (const auto vectors = vdb::gridConstPtrCast<vdb::Vec3DGrid>(grid))
    return dense(*vectors, filename, to_file, most);
  refuse_type(filename, grid->getName(), grid->valueType());
}

// Whatever OpenVDB says, as an InputError.
template <typename Work>
auto guarded(const std::string& filename, const Work& work) {
  try {
    static const bool ready = (vdb::initialize(), true);
    (void)ready;
    return work();
  } catch (const InputError&) {
    throw;
  } catch (const std::ios_base::failure&) {
    throw InputError({filename, 0}, "the file ends in the middle of a grid",
                     "it was cut off or damaged: copy or export it again");
  } catch (const std::exception& error) {
    throw InputError({filename, 0}, std::string("OpenVDB cannot read the file (") + error.what() + ")",
                     "it may be damaged, or of a later version: export it again");
  }
}

}  // namespace

bool looks_like_openvdb(std::string_view first_bytes) {
  return first_bytes == std::string_view(" BDV\0\0\0\0", 8);
}

GridFile read_openvdb(const std::string& filename, const std::string& grid, std::uint64_t most) {
  return guarded(filename, [&] {
    Archive archive(filename);
    return dense(archive.grid(choose_grid(archive.names(), grid, filename)), filename, most);
  });
}

std::vector<std::string> openvdb_grid_names(const std::string& filename) {
  return guarded(filename, [&] { return Archive(filename).names(); });
}

}  // namespace lumirank::scenedesc
