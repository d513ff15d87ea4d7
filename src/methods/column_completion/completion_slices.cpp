#include "methods/column_completion/completion_slices.h"

#include <algorithm>
#include <numeric>

namespace lumirank::methods {

using matrix::Index;

namespace {

Slices stretches(std::size_t rows, std::size_t max_rows) {
  Slices out;
  out.rows.resize(rows);
  std::iota(out.rows.begin(), out.rows.end(), Index{0});
  const std::size_t count = (rows + max_rows - 1) / max_rows;
  for (std::size_t s = 0; s <= count; ++s)
    out.first.push_back(static_cast<std::uint32_t>(count > 0 ? s * rows / count : 0));
  return out;
}

// Slices by place of some of the rows.
Slices of_some(const matrix::RowFeatures& features, std::span<const Index> some, std::size_t max_rows) {
  std::vector<Vec3f> position, normal;
  for (const Index i : some) {
    if (!features.position.empty()) position.push_back(features.position[i]);
    if (!features.normal.empty()) normal.push_back(features.normal[i]);
  }
  matrix::RowFeatures own{};
  own.position = position, own.normal = normal;
  Slices out = make_slices(own, some.size(), max_rows);
  for (Index& i : out.rows) i = some[i];
  return out;
}

void append(Slices& to, const Slices& more) {
  if (to.first.empty()) to.first.push_back(0);
  const auto offset = static_cast<std::uint32_t>(to.rows.size());
  to.rows.insert(to.rows.end(), more.rows.begin(), more.rows.end());
  for (std::size_t s = 0; s < more.count(); ++s) to.first.push_back(offset + more.first[s + 1]);
}

}  // namespace

Slices completion_slices(const matrix::RowFeatures& features, std::size_t rows, std::size_t max_rows,
                         RowPartition partition) {
  if (partition == RowPartition::stretches) return stretches(rows, max_rows);
  if (partition == RowPartition::places || features.slice.size() != rows)
    return make_slices(features, rows, max_rows);
  std::vector<Index> others, given;
  for (Index i = 0; i < rows; ++i) (features.slice[i] == matrix::kNoSlice ? others : given).push_back(i);
  Slices out;
  if (!others.empty()) append(out, of_some(features, others, max_rows));
  std::stable_sort(given.begin(), given.end(),
                   [&](Index a, Index b) { return features.slice[a] < features.slice[b]; });
  Slices own;
  own.rows = std::move(given);
  for (std::size_t k = 0; k < own.rows.size(); ++k)
    if (k == 0 || features.slice[own.rows[k]] != features.slice[own.rows[k - 1]])
      own.first.push_back(static_cast<std::uint32_t>(k));
  own.first.push_back(static_cast<std::uint32_t>(own.rows.size()));
  append(out, own);
  return out;
}

}  // namespace lumirank::methods
