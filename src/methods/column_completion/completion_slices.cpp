#include "methods/column_completion/completion_slices.h"

#include <algorithm>
#include <numeric>
#include <unordered_set>

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

// Rows that are clustered together: their clusters are few, whatever the picture's size.
constexpr std::size_t kClusteredRows = 16384;
constexpr int kIterations = 12;

// Lloyd's algorithm; `cluster` gets the number of each place's. Begins at places that are evenly spread over
// their order.
void cluster_places(std::span<const Vec3f> places, std::size_t clusters, std::span<std::uint32_t> cluster) {
  std::vector<Vec3f> center(clusters);
  for (std::size_t c = 0; c < clusters; ++c) center[c] = places[(2 * c + 1) * places.size() / (2 * clusters)];
  for (int k = 0; k < kIterations; ++k) {
    std::vector<Vec3f> sum(clusters);
    std::vector<float> count(clusters, 0.0f);
    for (std::size_t a = 0; a < places.size(); ++a) {
      const auto nearest =
          std::ranges::min_element(center, {}, [&](Vec3f c) { return length_squared(places[a] - c); });
      cluster[a] = static_cast<std::uint32_t>(nearest - center.begin());
      sum[cluster[a]] += places[a], count[cluster[a]] += 1;
    }
    for (std::size_t c = 0; c < clusters; ++c)
      if (count[c] > 0) center[c] = sum[c] / count[c];
  }
}

// As many clusters as there are slices in `slice`, in order of the rows.
std::vector<std::uint32_t> k_means(const matrix::RowFeatures& features, std::span<const Index> rows) {
  std::vector<std::uint32_t> out(rows.size());
  std::uint32_t first = 0;
  for (std::size_t begin = 0; begin < rows.size(); begin += kClusteredRows) {
    const std::size_t count = std::min(kClusteredRows, rows.size() - begin);
    std::vector<Vec3f> places;
    std::unordered_set<std::uint32_t> slices;
    for (const Index i : rows.subspan(begin, count))
      places.push_back(features.position[i]), slices.insert(features.slice[i]);
    const std::span own(out.data() + begin, count);
    cluster_places(places, slices.size(), own);
    for (std::uint32_t& c : own) c += first;
    first += static_cast<std::uint32_t>(slices.size());
  }
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
  std::vector<std::uint32_t> slice(features.slice.begin(), features.slice.end());
  if (partition == RowPartition::k_means && !features.position.empty()) {
    const auto cluster = k_means(features, given);
    for (std::size_t a = 0; a < given.size(); ++a) slice[given[a]] = cluster[a];
  }
  std::stable_sort(given.begin(), given.end(), [&](Index a, Index b) { return slice[a] < slice[b]; });
  Slices own;
  own.rows = std::move(given);
  for (std::size_t k = 0; k < own.rows.size(); ++k)
    if (k == 0 || slice[own.rows[k]] != slice[own.rows[k - 1]])
      own.first.push_back(static_cast<std::uint32_t>(k));
  own.first.push_back(static_cast<std::uint32_t>(own.rows.size()));
  append(out, own);
  return out;
}

}  // namespace lumirank::methods
