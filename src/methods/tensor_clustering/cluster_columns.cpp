#include "methods/tensor_clustering/cluster_columns.h"

namespace lumirank::methods {
namespace {

using linalg::RectangleClustering;
using linalg::ReducedTensor;
using matrix::Index;

constexpr float kNoChannel = 1e-3f;     // of a column's norm
constexpr float kBrightEnough = 0.25f;  // of the brightest

// What column (j, computed_in) is multiplied with to stand for all lights of the rectangle in a frame.
Rgb scale_of(const ReducedTensor& reduced, const RectangleClustering::Rectangle& rectangle,
             std::uint32_t frame, Index j, std::uint32_t computed_in) {
  const float own_norm = reduced.weight(j, computed_in);
  if (!(own_norm > 0)) return Rgb(0);
  double all = 0, channels[3] = {};
  for (const std::uint32_t light : rectangle.lights) {
    all += static_cast<double>(reduced.weight(light, frame));
    for (std::size_t c = 0; c < 3; ++c) channels[c] += static_cast<double>(reduced.channel(light, frame, c));
  }
  Rgb scale(0);
  for (std::size_t c = 0; c < 3; ++c) {
    const float own = reduced.channel(j, computed_in, c);
    // A channel that the representative hardly has cannot be scaled to the cluster's.
    scale[static_cast<int>(c)] = own > kNoChannel * own_norm ? static_cast<float>(channels[c]) / own
                                                             : static_cast<float>(all) / own_norm;
  }
  return scale;
}

}  // namespace

ClusterColumn column_of(const ReducedTensor& reduced, const RectangleClustering::Rectangle& rectangle) {
  ClusterColumn best;
  best.of = &rectangle;
  float largest = -1;
  for (std::uint32_t k = rectangle.begin; k < rectangle.end; ++k)
    for (const std::uint32_t j : rectangle.lights)
      if (reduced.weight(j, k) > largest) largest = reduced.weight(j, k), best.column = j, best.frame = k;
  for (std::uint32_t k = rectangle.begin; k < rectangle.end; ++k)
    best.scale.push_back(scale_of(reduced, rectangle, k, best.column, best.frame));
  return best;
}

matrix::ScaledColumn column_in_frame(const ReducedTensor& reduced, const ClusterColumn& of,
                                     std::uint32_t frame) {
  Index brightest = of.column;
  for (const std::uint32_t j : of.of->lights)
    if (reduced.weight(j, frame) > reduced.weight(brightest, frame)) brightest = j;
  const bool stays = reduced.weight(of.column, frame) >= kBrightEnough * reduced.weight(brightest, frame);
  const Index column = stays ? of.column : brightest;
  return {column, scale_of(reduced, *of.of, frame, column, frame), 0};
}

}  // namespace lumirank::methods
