#include "matrix/dense_matrix.h"

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"

namespace lumirank::matrix {

DenseMatrix::DenseMatrix(std::size_t rows, std::size_t columns, std::vector<Rgb> unoccluded,
                         std::vector<float> visibility)
    : rows_(rows), columns_(columns), unoccluded_(std::move(unoccluded)), visibility_(std::move(visibility)) {
  if (unoccluded_.size() != rows * columns) throw InternalError("dense matrix: wrong number of entries");
  if (!visibility_.empty() && visibility_.size() != rows * columns)
    throw InternalError("dense matrix: wrong number of visibilities");
  binary_ = std::ranges::all_of(visibility_, [](float v) { return v == 0 || v == 1; });
}

DenseMatrix::DenseMatrix(DenseMatrix&& other) noexcept
    : pixel(std::move(other.pixel)),
      row_position(std::move(other.row_position)),
      row_normal(std::move(other.row_normal)),
      row_weight(std::move(other.row_weight)),
      column_position(std::move(other.column_position)),
      column_normal(std::move(other.column_normal)),
      power(std::move(other.power)),
      group(std::move(other.group)),
      indirect(std::move(other.indirect)),
      half(std::move(other.half)),
      emitted(std::move(other.emitted)),
      row_albedo(std::move(other.row_albedo)),
      row_id(std::move(other.row_id)),
      column_id(std::move(other.column_id)),
      rows_(other.rows_),
      columns_(other.columns_),
      unoccluded_(std::move(other.unoccluded_)),
      visibility_(std::move(other.visibility_)),
      binary_(other.binary_) {}

Rgb DenseMatrix::at(std::size_t i, std::size_t j, Part part) const {
  const Rgb e = unoccluded_[i * columns_ + j];
  const float v = visibility_.empty() ? 1.0f : visibility_[i * columns_ + j];
  switch (part) {
    case Part::unoccluded:
      return e;
    case Part::visibility:
      return Rgb(v);
    case Part::value:
      break;
  }
  return e * v;
}

void DenseMatrix::add_to(Cost& cost, std::size_t i, std::size_t j) const {
  ++cost.entries;
  ++(is_black(unoccluded_[i * columns_ + j]) ? cost.culled : cost.rays);
}

Cost DenseMatrix::row(Index i, std::span<Rgb> out, Part part) const {
  Cost cost;
  for (std::size_t j = 0; j < columns_; ++j) {
    add_to(cost, i, j);
    out[j] = at(i, j, part);
  }
  return cost;
}

Cost DenseMatrix::column(Index j, std::span<Rgb> out, Part part) const {
  Cost cost;
  for (std::size_t i = 0; i < rows_; ++i) {
    add_to(cost, i, j);
    out[i] = at(i, j, part);
  }
  return cost;
}

Cost DenseMatrix::block(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
                        Part part) const {
  Cost cost;
  for (std::size_t a = 0; a < rows.size(); ++a)
    for (std::size_t b = 0; b < columns.size(); ++b) {
      add_to(cost, rows[a], columns[b]);
      out[a * columns.size() + b] = at(rows[a], columns[b], part);
    }
  return cost;
}

Cost DenseMatrix::entries(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
                          Part part) const {
  Cost cost;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    add_to(cost, rows[k], columns[k]);
    out[k] = at(rows[k], columns[k], part);
  }
  return cost;
}

Cost DenseMatrix::accumulate(std::span<const ScaledColumn> columns, std::span<Rgb> sums,
                             const Sinks& sinks) const {
  if (sums.size() != rows_) throw InternalError("dense matrix: sums of the wrong length");
  if (sinks.cancelled()) throw Cancelled();
  const Cost all = parallel_sum(rows_, 64, Cost{}, [&](std::size_t begin, std::size_t end) {
    Cost cost;
    for (std::size_t i = begin; i < end; ++i)
      for (const ScaledColumn& c : columns) {
        add_to(cost, i, c.column);
        sums[i] += c.scale * at(i, c.column);
      }
    return cost;
  });
  sinks.report("columns", 1.0);
  return all;
}

Capabilities DenseMatrix::capabilities() const {
  Capabilities out = LightingMatrix::capabilities().with({Ability::bounds});
  if (binary_) out = out.with({Ability::binary_visibility});
  return out;
}

ColumnSet DenseMatrix::column_set(Index j) const {
  std::call_once(max_entries_known_, [&] {
    max_entries_.assign(columns_, Rgb(0));
    for (std::size_t i = 0; i < rows_; ++i)
      for (std::size_t k = 0; k < columns_; ++k)
        for (int c = 0; c < 3; ++c)
          max_entries_[k][c] = std::max(max_entries_[k][c], unoccluded_[i * columns_ + k][c]);
  });
  ColumnSet set;
  set.intensity = max_entries_[j];
  set.box.extend(column_position.empty() ? Vec3f{} : column_position[j]);
  set.ceiling = set.intensity;
  return set;
}

namespace {
class MaxEntries final : public RowBounds {
  void set_rows(std::span<const Index>) override {}
  Rgb bound(const ColumnSet& set) const override { return set.intensity; }
};
}  // namespace

std::unique_ptr<RowBounds> DenseMatrix::row_bounds() const { return std::make_unique<MaxEntries>(); }

RowFeatures DenseMatrix::row_features() const {
  return {pixel, row_position, row_normal, row_weight, row_id, row_albedo, row_instant};
}

ColumnFeatures DenseMatrix::column_features() const {
  return {column_position, column_normal, power, group, indirect, half, emitted, column_id, column_instant};
}

std::vector<Rgb> DenseMatrix::exact_sums() const {
  std::vector<Rgb> sums(rows_);
  for (std::size_t i = 0; i < rows_; ++i) {
    double s[3] = {0, 0, 0};
    for (std::size_t j = 0; j < columns_; ++j) {
      const Rgb v = at(i, j);
      for (int c = 0; c < 3; ++c) s[c] += static_cast<double>(v[c]);
    }
    sums[i] = {static_cast<float>(s[0]), static_cast<float>(s[1]), static_cast<float>(s[2])};
  }
  return sums;
}

}  // namespace lumirank::matrix
