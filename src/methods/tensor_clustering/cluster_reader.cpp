#include "methods/tensor_clustering/cluster_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace lumirank::methods {
namespace {

// Over the root mean square at the rows that were read. If these are like the others one row in kPeak² at
// most is so bright (Chebyshev); rows near peaks come on top of that.
constexpr float kPeak = 10;
// Rows with numbers next to each other lie next to each other: around a peak, so many have the same answer
// as long as they are not dimmer than this part of what makes a peak.
constexpr std::size_t kBlock = 32;
constexpr float kNearPeak = 0.25f;
constexpr std::size_t kEntriesAtOnce = 1 << 12;

float light(const ClusterLight& cluster, const Rgb& entry) { return max_component(cluster.own * entry); }

}  // namespace

ClusterLight ClusterPeaks::light(const ClusterColumn& cluster) const {
  const Rgb own = cluster.scale[cluster.frame - cluster.of->begin];
  return light(cluster, {cluster.column, own, 0}, cluster.frame, own);
}

ClusterLight ClusterPeaks::light(const ClusterColumn& cluster, const matrix::ScaledColumn& own,
                                 std::uint32_t frame, const Rgb& scale) const {
  ClusterLight made{own.column, own.scale, scale, cluster.of->lights};
  if (max_peak_ > 0 && cluster.of->lights.size() > 1) {
    const float usual = max_component(own.scale) * reduced_.weight(own.column, frame) /
                        std::sqrt(static_cast<float>(reduced_.rows()));
    made.most = std::max(kPeak * usual, static_cast<float>(max_peak_) * mean_light_[frame]);
  }
  return made;
}

matrix::Cost ClusterReader::read(const ClusterLight& cluster, std::span<Rgb> column) {
  matrix::Cost cost = reader_.column(cluster.column, column);
  if (cluster.most == kInfinity) return cost;
  cost += find_peaks(cluster, column);
  if (!peaks_.empty()) cost += sum_lights(cluster, column);
  return cost;
}

matrix::Cost ClusterReader::find_peaks(const ClusterLight& cluster, std::span<const Rgb> column) {
  matrix::Cost cost;
  peaks_.clear();
  std::size_t known = std::numeric_limits<std::size_t>::max();  // block
  bool peak = false;                                            // in it
  for (std::size_t i = 0; i < column.size(); ++i) {
    if (light(cluster, column[i]) <= kNearPeak * cluster.most) continue;
    if (const std::size_t block = set_[i] / kBlock; block != known)
      known = block, peak = has_peak(cluster, column, i, cost);
    if (peak) peaks_.push_back(static_cast<std::uint32_t>(i));
  }
  return cost;
}

// Whether any row of the block is one, set or not.
bool ClusterReader::has_peak(const ClusterLight& cluster, std::span<const Rgb> column, std::size_t place,
                             matrix::Cost& cost) {
  const std::size_t begin = set_[place] / kBlock * kBlock, end = std::min(all_, begin + kBlock);
  const auto inside = [&](std::size_t i) { return set_[i] >= begin && set_[i] < end; };
  rows_.resize(end - begin);
  std::iota(rows_.begin(), rows_.end(), static_cast<std::uint32_t>(begin));
  std::size_t first = place, last = place;
  while (first > 0 && inside(first - 1)) --first;
  for (; last < set_.size() && inside(last); ++last)
    if (light(cluster, column[last]) > cluster.most) return true;
  if (last - first >= end - begin) return false;
  columns_.assign(rows_.size(), cluster.column), entries_.resize(rows_.size());
  cost += reader_.entries(rows_, columns_, entries_);
  return std::any_of(entries_.begin(), entries_.end(),
                     [&](const Rgb& entry) { return light(cluster, entry) > cluster.most; });
}

matrix::Cost ClusterReader::sum_lights(const ClusterLight& cluster, std::span<Rgb> column) {
  matrix::Cost cost;
  const std::size_t peaks = peaks_.size(), at_once = std::max<std::size_t>(1, kEntriesAtOnce / peaks);
  sums_.assign(peaks, Rgb(0));
  for (std::size_t first = 0; first < cluster.lights.size(); first += at_once) {
    const auto some = cluster.lights.subspan(first, std::min(at_once, cluster.lights.size() - first));
    rows_.clear(), columns_.clear();
    for (const std::uint32_t light : some) {
      rows_.insert(rows_.end(), peaks_.begin(), peaks_.end());
      columns_.insert(columns_.end(), peaks, light);
    }
    entries_.resize(rows_.size());
    cost += reader_.entries_at(rows_, columns_, entries_);
    for (std::size_t k = 0; k < entries_.size(); ++k) sums_[k % peaks] += entries_[k];
  }
  for (std::size_t p = 0; p < peaks; ++p)
    for (int c = 0; c < 3; ++c)
      column[peaks_[p]][c] = cluster.own[c] > 0 ? sums_[p][c] / cluster.own[c] : 0.0f;
  return cost;
}

}  // namespace lumirank::methods
