// The lighting matrix from outside: one row per receiver (a point that the film sees), one column per virtual
// light, A(i, j) = E(i, j)·V(i, j): what light j adds to the radiance that receiver i sends to the eye. A
// picture is made of its row sums.
//
//   auto prepared = lumirank::prepare(scene, settings);
//   lumirank::Matrix matrix = prepared.matrix();
//   std::vector<lumirank::Rgb> column(matrix.rows());
//   matrix.column(0, column);
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "lumirank/export.h"
#include "lumirank/sinks.h"
#include "lumirank/values.h"

namespace lumirank {

using Index = std::uint32_t;  // of a row or a column

// Which part of an entry: E·V, E, or V in all three channels.
enum class MatrixPart { value, unoccluded, visibility };

// What a call evaluated.
struct MatrixCost {
  std::uint64_t entries = 0, culled = 0, shadow_rays = 0;
};

// A column with a factor per channel: one term of an estimate that is a combination of columns.
struct WeightedColumn {
  Index column = 0;
  Rgb scale{1};
  // If > 0, its entries times `scale` are kept from showing more than this share of what fills the whole
  // hemisphere: a bound on columns that stand for many others.
  float max_contribution = 0;
};

// Arrays of length rows(), valid as long as the matrix.
struct MatrixRows {
  std::span<const Vec2f> pixel;     // position on the film
  std::span<const Vec3f> position;  // in the scene's own frame (see docs/conventions.md)
  std::span<const Vec3f> normal;    // shading normal, unit
  std::span<const float> weight;    // ≥ 0: what the row's sum is multiplied with in the picture
};

// Arrays of length columns(), valid as long as the matrix.
struct MatrixColumns {
  std::span<const Vec3f> position;
  std::span<const Vec3f> normal;           // zero for lights without a direction
  std::span<const float> power;            // ≥ 0, proportional to the light's power
  std::span<const Rgb> emitted;            // what `power` is a scalar of
  std::span<const std::uint8_t> indirect;  // 0: stands for an emitter; 1: for a bounce
};

// A view that shares what it refers to: cheap to copy, never changes, may be used by many threads at once.
// Spans of a wrong length or indices out of range throw InputError.
class LUMIRANK_API Matrix {
 public:
  std::size_t rows() const;
  std::size_t columns() const;
  MatrixRows row_features() const;
  MatrixColumns column_features() const;

  // out[j] = A(i, j) for all columns.
  MatrixCost row(Index i, std::span<Rgb> out, MatrixPart part = MatrixPart::value) const;
  // out[i] = A(i, j) for all rows.
  MatrixCost column(Index j, std::span<Rgb> out, MatrixPart part = MatrixPart::value) const;
  // The sub-matrix, row-major: out[a·columns.size() + b] = A(rows[a], columns[b]).
  MatrixCost block(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
                   MatrixPart part = MatrixPart::value) const;
  // out[k] = A(rows[k], columns[k]).
  MatrixCost entries(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
                     MatrixPart part = MatrixPart::value) const;
  // sums[i] += Σ_k scale_k·A(i, column_k), without storing a column; the order of each sum is that of
  // `columns`. Throws Cancelled.
  MatrixCost accumulate(std::span<const WeightedColumn> columns, std::span<Rgb> sums,
                        const Sinks& sinks = {}) const;

  struct Impl;
  explicit Matrix(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

 private:
  std::shared_ptr<const Impl> impl_;
};

}  // namespace lumirank
