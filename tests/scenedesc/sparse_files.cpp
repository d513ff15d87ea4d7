#include "sparse_files.h"

// As in openvdb_file.cpp.
#pragma GCC visibility push(default)
#define NANOVDB_USE_ZIP
#define NANOVDB_USE_OPENVDB
#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#pragma GCC visibility pop

#include <fstream>
#include <stdexcept>

namespace lumirank::scenedesc::test_files {
namespace {

template <typename T>
struct Value {
  static T of(float v) { return static_cast<T>(v); }
};
template <typename T>
struct Value<openvdb::math::Vec3<T>> {
  static openvdb::math::Vec3<T> of(float v) {
    return {static_cast<T>(v), static_cast<T>(2 * v), static_cast<T>(3 * v)};
  }
};

openvdb::Coord coord(const std::array<int, 3>& at) { return {at[0], at[1], at[2]}; }

template <typename Made>
openvdb::GridBase::Ptr made(const Grid& grid) {
  using Of = Value<typename Made::ValueType>;
  typename Made::Ptr out = Made::create(Of::of(grid.background));
  if (grid.last[0] >= grid.first[0]) out->fill({coord(grid.first), coord(grid.last)}, Of::of(grid.value));
  for (const Voxel& voxel : grid.voxels) out->tree().setValue(coord(voxel.at), Of::of(voxel.value));
  out->setName(grid.name);
  out->setGridClass(grid.level_set ? openvdb::GRID_LEVEL_SET : openvdb::GRID_FOG_VOLUME);
  openvdb::Mat4d matrix;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      matrix(column, row) = grid.to_file.m[static_cast<std::size_t>(4 * row + column)];
  out->setTransform(grid.frustum
                        ? openvdb::math::Transform::createFrustumTransform({{0, 0, 0}, {9, 9, 9}}, 0.5, 10)
                        : openvdb::math::Transform::createLinearTransform(matrix));
  return out;
}

openvdb::GridBase::Ptr made(const Grid& grid) {
  openvdb::initialize();
  switch (grid.kind) {
    case Kind::f64:
      return made<openvdb::DoubleGrid>(grid);
    case Kind::color:
      return made<openvdb::Vec3SGrid>(grid);
    case Kind::color64:
      return made<openvdb::Vec3DGrid>(grid);
    case Kind::whole:
      return made<openvdb::Int32Grid>(grid);
    default: {
      const openvdb::GridBase::Ptr out = made<openvdb::FloatGrid>(grid);
      out->setSaveFloatAsHalf(grid.kind == Kind::half);
      return out;
    }
  }
}

template <typename Packed>
nanovdb::GridHandle<> packed(const openvdb::GridBase::Ptr& grid) {
  nanovdb::OpenToNanoVDB<float, Packed> converter;
  if constexpr (std::is_same_v<Packed, nanovdb::FpN>) converter.oracle() = nanovdb::AbsDiff(0.05f);
  return converter(*openvdb::gridPtrCast<openvdb::FloatGrid>(grid));
}

template <typename Tree>
nanovdb::GridHandle<> as_it_is(const openvdb::GridBase::Ptr& grid) {
  return nanovdb::openToNanoVDB<nanovdb::HostBuffer, Tree>(*openvdb::gridPtrCast<openvdb::Grid<Tree>>(grid));
}

// Of each kind by itself: what takes a grid of any kind compiles for a minute.
nanovdb::GridHandle<> made_nano(const Grid& grid) {
  const openvdb::GridBase::Ptr from = made(grid);
  switch (grid.kind) {
    case Kind::fp4:
      return packed<nanovdb::Fp4>(from);
    case Kind::fp8:
      return packed<nanovdb::Fp8>(from);
    case Kind::fp16:
      return packed<nanovdb::Fp16>(from);
    case Kind::fpn:
      return packed<nanovdb::FpN>(from);
    case Kind::f64:
      return as_it_is<openvdb::DoubleTree>(from);
    case Kind::color:
      return as_it_is<openvdb::Vec3STree>(from);
    case Kind::color64:
      return as_it_is<openvdb::Vec3DTree>(from);
    case Kind::whole:
      return as_it_is<openvdb::Int32Tree>(from);
    default:
      return as_it_is<openvdb::FloatTree>(from);
  }
}

}  // namespace

void write_vdb(const std::string& filename, const std::vector<Grid>& grids, bool as_stream) {
  openvdb::GridPtrVec all;
  for (const Grid& grid : grids) {
    all.push_back(made(grid));
    for (const openvdb::GridBase::Ptr& other : all)
      if (!grid.shares_with.empty() && other->getName() == grid.shares_with)
        all.back()->setTree(other->baseTreePtr());
  }
  if (as_stream) {
    std::ofstream out(filename, std::ios::binary);
    openvdb::io::Stream(out).write(all);
  } else {
    openvdb::io::File(filename).write(all);
  }
}

void write_nvdb(const std::string& filename, const std::vector<Grid>& grids, Packing packing) {
  std::vector<nanovdb::GridHandle<>> all;
  for (const Grid& grid : grids) all.push_back(made_nano(grid));
  nanovdb::io::writeGrids<nanovdb::HostBuffer, std::vector>(
      filename, all, packing == Packing::zip ? nanovdb::io::Codec::ZIP : nanovdb::io::Codec::NONE);
}

}  // namespace lumirank::scenedesc::test_files
