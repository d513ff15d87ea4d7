#include "matrix/entry_reader.h"

#include <algorithm>

#include "base/error.h"

namespace lumirank::matrix {

Cost EntryReader::unoccluded_scalars(Index j, Rgb weights, std::span<float> out) {
  column_.resize(out.size());
  const Cost cost = column(j, column_, Part::unoccluded);
  for (std::size_t a = 0; a < out.size(); ++a)
    out[a] = weights.r * column_[a].r + weights.g * column_[a].g + weights.b * column_[a].b;
  return cost;
}

Cost EntryReader::add_unoccluded(std::span<const ScaledColumn> columns, std::span<const float> shares,
                                 std::span<const std::uint32_t> of, std::span<Rgb> sums) {
  Cost cost;
  if (columns.empty()) return cost;
  if (shares.size() % columns.size() != 0 || of.size() != sums.size())
    throw InternalError("add_unoccluded: as many shares for every column, and one of them for every row");
  const std::size_t each = shares.size() / columns.size();
  column_.resize(sums.size());
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto share = shares.subspan(k * each, each);
    if (std::ranges::all_of(share, [](float s) { return s == 0; })) continue;
    cost += column(columns[k].column, column_, Part::unoccluded);
    for (std::size_t a = 0; a < sums.size(); ++a) sums[a] += columns[k].scale * share[of[a]] * column_[a];
  }
  return cost;
}

}  // namespace lumirank::matrix
