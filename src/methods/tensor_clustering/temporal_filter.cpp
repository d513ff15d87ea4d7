#include "methods/tensor_clustering/temporal_filter.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/parallel.h"

namespace lumirank::methods {
namespace {

using matrix::Index;

constexpr std::size_t kFilteredAtOnce = 1 << 10;
constexpr float kNoWeight = 3;  // times max_change

// A frame between two others, and how its rows look to both sides.
class FilteredFrame {
 public:
  struct Side {
    std::size_t frame;
    const RowMapping& mapping;
    const FrameRows& rows;
  };
  FilteredFrame(const FilteredShot& shot, const TemporalFilter& filter, std::size_t frame,
                const FrameRows& rows)
      : shot_(shot), filter_(filter), frame_(frame), rows_(rows) {}

  Rgb at(Index row, const Side& earlier, const Side& later) const {
    const Rgb own = shot_.sums[frame_][row];
    if (!within_reach(earlier, row) || !within_reach(later, row)) return own;
    const Seen before = seen(earlier, row), after = seen(later, row);
    const Rgb change = 0.5f * (before.light + after.light) - own;
    // As a change, so that where nothing changes light stays as it is to the last bit.
    return own + weight(change, std::max(before.spread, after.spread), own) * (2.0f / 3) * change;
  }

 private:
  struct Seen {
    Rgb light;
    float spread = 0;  // by how much the rows differ that it is interpolated between
  };

  bool within_reach(const Side& side, Index row) const {
    return reaches(side.mapping.distance[row], filter_.max_distance, side.mapping.distance.size());
  }
  float weight(const Rgb& change, float spread, const Rgb& own) const {
    if (!(filter_.max_change > 0)) return 1;
    const float most =
        kNoWeight * static_cast<float>(filter_.max_change) * (max_component(own) + shot_.unseen[frame_]);
    const float by = std::max({std::abs(change.r), std::abs(change.g), std::abs(change.b), spread});
    if (by >= most) return 0;
    const float left = 1 - (by / most) * (by / most);
    return left * left;
  }
  // The light of the other frame where it shows what `row` shows here.
  Seen seen(const Side& side, Index row) const {
    if (side.mapping.distance[row] == 0) return {relit(side, side.mapping.from[row], row)};
    const RowBlend blend = rows_.blend(row, side.rows);
    Rgb sum(0), least(kInfinity), most(0);
    for (std::size_t a = 0; a < RowBlend::kRows; ++a) {
      if (blend.weight[a] == 0) continue;
      const Rgb light = relit(side, blend.from[a], row);
      sum += blend.weight[a] * light;
      for (int c = 0; c < 3; ++c)
        least[c] = std::min(least[c], light[c]), most[c] = std::max(most[c], light[c]);
    }
    return {{std::max(sum.r, 0.0f), std::max(sum.g, 0.0f), std::max(sum.b, 0.0f)},
            max_component(most - least)};
  }
  Rgb relit(const Side& side, Index there, Index row) const {
    const Rgb light = shot_.sums[side.frame][there];
    const auto from = shot_.features[side.frame].albedo, to = shot_.features[frame_].albedo;
    return from.empty() || to.empty() ? light : relight(light, from[there], to[row]);
  }

  const FilteredShot& shot_;
  const TemporalFilter& filter_;
  std::size_t frame_;
  const FrameRows& rows_;
};

std::vector<std::vector<Rgb>> filtered_once(const FilteredShot& shot, const TemporalFilter& filter) {
  const std::size_t frames = shot.sums.size();
  const auto rows_of = [&](std::size_t k) {
    return std::make_unique<const FrameRows>(shot.features[k], shot.sums[k].size(), shot.scale);
  };
  std::vector<std::vector<Rgb>> filtered = shot.sums;  // the first and the last frame stay
  std::unique_ptr<const FrameRows> before = rows_of(0), now = rows_of(1);
  for (std::size_t k = 1; k + 1 < frames; ++k) {
    auto after = rows_of(k + 1);
    const FilteredFrame frame(shot, filter, k, *now);
    const FilteredFrame::Side earlier{k - 1, shot.mappings.to_later[k - 1], *before},
        later{k + 1, shot.mappings.to_earlier[k], *after};
    parallel_for(filtered[k].size(), kFilteredAtOnce, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        filtered[k][i] = frame.at(static_cast<Index>(i), earlier, later);
    });
    before = std::move(now), now = std::move(after);
  }
  return filtered;
}

}  // namespace

std::vector<std::vector<Rgb>> filter_in_time(FilteredShot shot, const TemporalFilter& filter) {
  if (shot.sums.size() < 3) return std::move(shot.sums);
  for (std::size_t pass = 0; pass < filter.passes; ++pass) shot.sums = filtered_once(shot, filter);
  return std::move(shot.sums);
}

}  // namespace lumirank::methods
