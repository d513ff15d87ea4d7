// The lighting matrix: one row per receiver, one column per virtual light, entries on demand and in bulk
// only.
//
// A(i,j) = E(i,j)·V(i,j): E the unoccluded contribution (RGB), V the visibility, from 0 to 1; 0 or 1 alone
// where the matrix says so (Ability::binary_visibility). An entry is a pure function of (seed, receiver id,
// light id): the same number whether it comes in a row, a column, a block or a list. Implemented by
// transport's SceneMatrix and by the synthetic matrices of the tests; methods see nothing else.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/bounds.h"
#include "base/rgb.h"
#include "base/sinks.h"
#include "base/vec.h"
#include "matrix/capabilities.h"
#include "matrix/cost.h"
#include "matrix/entry_bounds.h"

namespace lumirank::matrix {

class EntryReader;

// Plain numbers about rows, for methods that use geometry. Arrays of length rows(); may be empty if unknown.
struct RowFeatures {
  std::span<const Vec2f> pixel;  // film position
  std::span<const Vec3f> position;
  std::span<const Vec3f> normal;
  std::span<const float> weight;  // ≥ 0; what the row's sum is multiplied with in the image
  // Who a row is, whatever its index: unique, and the same in every matrix that has it. Random choices that
  // are keyed by it survive another order, and other rows beside it.
  std::span<const std::uint64_t> id{};
  std::span<const Rgb> albedo{};  // reflectance towards the eye, in [0, 1]
  // Moment that it belongs to, by number, where a picture is of several; empty: all of one. Entries of rows
  // and columns of different instants are 0 (block_diagonal.h).
  std::span<const std::uint16_t> instant{};
  // Rows of one number were found to be alike by whoever made them; kNoSlice: not told.
  std::span<const std::uint32_t> slice{};
};
inline constexpr std::uint32_t kNoSlice = 0xffffffffu;

// Plain numbers about columns. Arrays of length columns(); may be empty if unknown.
struct ColumnFeatures {
  std::span<const Vec3f> position;
  std::span<const Vec3f> normal;  // zero for omni lights
  std::span<const float> power;   // scalar, ≥ 0; proportional to the light's emitted power
  std::span<const std::uint16_t>
      group;  // clusters never cross groups; all 0 unless the image is split by light
  std::span<const std::uint8_t> indirect;  // 0: stands for an emitter; 1: particle-traced
  // Columns are often random samples of what infinitely many would add up to. 1 and 2: member of one of two
  // independent halves, twice the sum over either of which estimates the same; 0: no sample, but exact.
  std::span<const std::uint8_t> half;
  std::span<const Rgb>
      emitted;  // what `power` is a scalar of: entries of like columns are in this proportion
  std::span<const std::uint64_t> id{};       // as of rows
  std::span<const std::uint16_t> instant{};  // as of rows
  // Place in a binary tree that whoever made the columns found: from the highest bit on, 0 is left and 1 is
  // right. Columns of the same number are together in a leaf; kNoBranch: in no tree.
  std::span<const std::uint64_t> branch{};
};
inline constexpr std::uint64_t kNoBranch = ~std::uint64_t{0};

// The key of a row's or a column's random numbers: its id, or its index where ids are unknown.
inline std::uint64_t id_of(std::span<const std::uint64_t> ids, std::size_t index) {
  return ids.empty() ? index : ids[index];
}

// Which part of an entry.
enum class Part { value, unoccluded, visibility };

// A column that stands for a cluster: its entries are multiplied per channel by `scale`.
struct ScaledColumn {
  Index column;
  Rgb scale{1};
  // If > 0, a matrix that knows how large a part of the surroundings a column stands for keeps its scaled
  // entries from showing more than this share of what fills the whole hemisphere; others ignore it.
  float max_contribution = 0;
};

// Required: sizes and entries. Optional: features, bounds, and what capabilities() tells of them. A call's
// cost is what it spent itself; whoever wants a total asks a MeteredMatrix.
class LightingMatrix {
 public:
  virtual ~LightingMatrix() = default;

  virtual std::size_t rows() const = 0;
  virtual std::size_t columns() const = 0;

  // Entries of one row for all columns: out[j], j < columns(). Part::visibility fills all three channels
  // with V.
  virtual Cost row(Index i, std::span<Rgb> out, Part part = Part::value) const = 0;
  // Entries of one column for all rows.
  virtual Cost column(Index j, std::span<Rgb> out, Part part = Part::value) const = 0;
  // The sub-matrix rows × columns, row-major: out[a·columns.size() + b].
  virtual Cost block(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
                     Part part = Part::value) const = 0;
  // Single entries: out[k] = A(rows[k], columns[k]).
  virtual Cost entries(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
                       Part part = Part::value) const = 0;
  // sums[i] += Σ_k scale_k · A(i, column_k), without storing a column. The order of the sum is the order of
  // `columns`. Most of a render's time is spent here. Checks `sinks.cancel` and reports progress between
  // blocks.
  virtual Cost accumulate(std::span<const ScaledColumn> columns, std::span<Rgb> sums,
                          const Sinks& sinks = {}) const = 0;

  // Entries for one thread at a time.
  virtual std::unique_ptr<EntryReader> reader() const;

  // What it can tell, which does not change. By itself: the features whose lengths are those of the matrix.
  virtual Capabilities capabilities() const;

  // Bounds (Ability::bounds; without it InternalError): what column j is by itself, and a work space for
  // questions about rows.
  virtual ColumnSet column_set(Index j) const;
  virtual std::unique_ptr<RowBounds> row_bounds() const;

  virtual RowFeatures row_features() const { return {}; }
  virtual ColumnFeatures column_features() const { return {}; }
};

}  // namespace lumirank::matrix
