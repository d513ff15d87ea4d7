#include "methods/tensor_clustering/temporal_filter.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace lumirank::methods {
namespace {

using matrix::Index;

constexpr std::size_t kFilteredAtOnce = 1 << 12;

// One frame of the shot: looks along the mappings to both sides of it.
class FilteredFrame {
 public:
  FilteredFrame(const FilteredShot& shot, const TemporalFilter& filter, std::size_t frame)
      : shot_(shot),
        filter_(filter),
        frame_(frame),
        radius_(std::min({filter.radius, frame, shot.sums.size() - 1 - frame})) {}

  Rgb at(Index row) const {
    const Rgb own = shot_.sums[frame_][row];
    Index earlier = row, later = row;
    Rgb change(0);
    std::size_t pairs = 0;
    for (std::size_t j = 1; j <= radius_; ++j) {
      if (!step(shot_.mappings.to_later[frame_ - j], earlier) ||
          !step(shot_.mappings.to_earlier[frame_ + j - 1], later))
        break;
      const Rgb mean = 0.5f * (seen(frame_ - j, earlier, row) + seen(frame_ + j, later, row));
      if (!close(mean, own)) break;
      change += 2.0f * (mean - own), ++pairs;
    }
    // As a change, so that where nothing changes light stays as it is to the last bit.
    return own + change / static_cast<float>(2 * pairs + 1);
  }

 private:
  bool step(const RowMapping& mapping, Index& row) const {
    const float distance = mapping.distance[row];
    if (!std::isfinite(distance)) return false;
    if (filter_.max_distance > 0 && static_cast<double>(distance) > filter_.max_distance) return false;
    row = mapping.from[row];
    return true;
  }
  bool close(const Rgb& mean, const Rgb& own) const {
    if (!(filter_.max_change > 0)) return true;
    float difference = 0;
    for (int c = 0; c < 3; ++c) difference = std::max(difference, std::abs(mean[c] - own[c]));
    return difference <= static_cast<float>(filter_.max_change) * (max_component(own) + shot_.unseen[frame_]);
  }
  // The light of a row of another frame, at `row` of this one.
  Rgb seen(std::size_t frame, Index there, Index row) const {
    const Rgb light = shot_.sums[frame][there];
    const auto from = shot_.albedo[frame], to = shot_.albedo[frame_];
    return from.empty() || to.empty() ? light : relight(light, from[there], to[row]);
  }

  const FilteredShot& shot_;
  const TemporalFilter& filter_;
  std::size_t frame_, radius_;  // as many frames as there are on both sides
};

}  // namespace

std::vector<std::vector<Rgb>> filter_in_time(const FilteredShot& shot, const TemporalFilter& filter) {
  std::vector<std::vector<Rgb>> filtered(shot.sums.size());
  for (std::size_t k = 0; k < shot.sums.size(); ++k) {
    filtered[k].resize(shot.sums[k].size());
    const FilteredFrame frame(shot, filter, k);
    parallel_for(filtered[k].size(), kFilteredAtOnce, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) filtered[k][i] = frame.at(static_cast<Index>(i));
    });
  }
  return filtered;
}

}  // namespace lumirank::methods
