#include "methods/tensor_clustering/cluster_columns.h"

#include <cmath>

namespace lumirank::methods {
namespace {

using linalg::RectangleClustering;
using matrix::Index;
using FrameRange = ClusterColumns::FrameRange;

constexpr double kNoChannel = 1e-3;  // of a column
// Of the mean weight in the cluster: what a representative has at least, and what it keeps in other frames.
constexpr double kLeastWeight = 0.5, kWeightKept = 0.25;

// body(light, frame, weight) for all pairs that are not black.
template <typename Body>
void each_pair(const linalg::ReducedTensor& reduced, const RectangleClustering::Rectangle& rectangle,
               const FrameRange& frames, const Body& body) {
  for (std::uint32_t k = frames.begin; k < frames.end; ++k)
    for (const std::uint32_t j : rectangle.lights)
      if (const float w = reduced.weight(j, k); w > 0) body(j, k, static_cast<double>(w));
}

}  // namespace

ClusterColumns::Pair ClusterColumns::largest(const RectangleClustering::Rectangle& rectangle,
                                             FrameRange frames) const {
  Pair best{rectangle.lights.front(), frames.begin};
  double largest = 0;
  each_pair(reduced_, rectangle, frames, [&](Index j, std::uint32_t k, double w) {
    if (w > largest) largest = w, best = {j, k};
  });
  return best;
}

ClusterColumns::Pair ClusterColumns::central(const RectangleClustering::Rectangle& rectangle,
                                             FrameRange frames) const {
  std::vector<double> sum(reduced_.rows(), 0.0);
  std::vector<float> x(reduced_.rows());
  double weights = 0, pairs = 0;
  each_pair(reduced_, rectangle, frames, [&](Index j, std::uint32_t k, double w) {
    reduced_.information(j, k, x.data());
    for (std::size_t i = 0; i < x.size(); ++i) sum[i] += w * static_cast<double>(x[i]);
    weights += w, pairs += 1;
  });
  Pair best{rectangle.lights.front(), frames.begin};
  double nearest = -1;
  each_pair(reduced_, rectangle, frames, [&](Index j, std::uint32_t k, double w) {
    if (w < kLeastWeight * weights / pairs) return;
    reduced_.information(j, k, x.data());
    double along = 0;
    for (std::size_t i = 0; i < x.size(); ++i) along += sum[i] * static_cast<double>(x[i]);
    if (along > nearest) nearest = along, best = {j, k};
  });
  return best;
}

ClusterColumns::Pair ClusterColumns::representative(const RectangleClustering::Rectangle& rectangle,
                                                    FrameRange frames) const {
  return how_ == RepresentativeRule::central ? central(rectangle, frames) : largest(rectangle, frames);
}

// What is to add up: the column's sum over the rows that were read, or its norm.
double ClusterColumns::amount(Pair pair, std::size_t channel) const {
  return static_cast<double>(how_ == RepresentativeRule::central
                                 ? reduced_.sum(pair.column, pair.frame, channel)
                                 : reduced_.channel(pair.column, pair.frame, channel));
}

// What the computed column is multiplied with to stand for all lights of the rectangle in a frame.
Rgb ClusterColumns::scale(const RectangleClustering::Rectangle& rectangle, std::uint32_t frame,
                          Pair computed) const {
  double own[3], all[3] = {}, own_all = 0, all_all = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    own[c] = amount(computed, c);
    for (const std::uint32_t light : rectangle.lights) all[c] += amount({light, frame}, c);
    own_all += own[c], all_all += all[c];
  }
  if (!(own_all > 0)) return Rgb(0);
  Rgb scale(0);
  for (std::size_t c = 0; c < 3; ++c)  // a channel that it hardly has cannot be scaled to the cluster's
    scale[static_cast<int>(c)] =
        static_cast<float>(own[c] > kNoChannel * own_all ? all[c] / own[c] : all_all / own_all);
  return scale;
}

ClusterColumn ClusterColumns::column_of(const RectangleClustering::Rectangle& rectangle) const {
  const Pair best = representative(rectangle, {rectangle.begin, rectangle.end});
  ClusterColumn column{best.column, best.frame, &rectangle, {}, {}};
  for (std::uint32_t k = rectangle.begin; k < rectangle.end; ++k)
    column.scale.push_back(scale(rectangle, k, best));
  return column;
}

void ClusterColumns::find_in_frames(ClusterColumn& of) const {
  of.in_frame.clear();
  for (std::uint32_t k = of.of->begin; k < of.of->end; ++k) of.in_frame.push_back(in_frame(of, k));
}

matrix::ScaledColumn ClusterColumns::in_frame(const ClusterColumn& of, std::uint32_t frame) const {
  double weights = 0, pairs = 0;
  each_pair(reduced_, *of.of, {frame, frame + 1},
            [&](Index, std::uint32_t, double w) { weights += w, pairs += 1; });
  const auto own = static_cast<double>(reduced_.weight(of.column, frame));
  const bool stays = own > 0 && own * pairs >= kWeightKept * weights;
  const Pair best = stays ? Pair{of.column, frame} : representative(*of.of, {frame, frame + 1});
  return {best.column, scale(*of.of, frame, best), 0};
}

}  // namespace lumirank::methods
