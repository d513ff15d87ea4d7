#include "methods/tensor_clustering/test_rows.h"

#include <cmath>

#include "methods/tensor_clustering/slice_columns.h"

namespace lumirank::methods {
namespace {

using matrix::Index;

Rgb albedo_of(const matrix::RowFeatures& features, std::size_t row) {
  return features.albedo.empty() ? Rgb(0) : features.albedo[row];
}

}  // namespace

void TestRows::read(std::size_t frame, std::vector<Index> rows, matrix::Cost& spent) {
  const auto matrix = tensor_.frame(frame);
  std::vector<Rgb> entries(matrix->columns());
  Frame& f = frames_[frame];
  for (const Index row : rows) {
    spent += matrix->row(row, entries);
    Rgb sum(0);
    for (const Rgb& e : entries) sum += e;
    f.truth.push_back(sum);
  }
  f.rows.insert(f.rows.end(), rows.begin(), rows.end());
}

double TestRows::error(std::span<const ClusterColumn> clusters, const FrameMappings& mappings,
                       const ClusterPeaks& peaks, matrix::Cost& spent) const {
  const std::size_t frames = frames_.size();
  std::vector<std::vector<const ClusterColumn*>> of_frame(frames);
  for (const ClusterColumn& c : clusters) of_frame[c.frame].push_back(&c);
  std::vector<std::vector<Rgb>> estimates(frames);
  for (std::size_t f = 0; f < frames; ++f) estimates[f].assign(frames_[f].rows.size(), Rgb(0));
  for (std::size_t k = 0; k < frames; ++k) {
    if (of_frame[k].empty()) continue;
    std::uint32_t first = static_cast<std::uint32_t>(k), last = first;
    for (const ClusterColumn* c : of_frame[k])
      first = std::min(first, c->of->begin), last = std::max(last, c->of->end - 1);
    const auto matrix = tensor_.frame(k);
    const matrix::RowFeatures here = matrix->row_features();
    for (std::uint32_t f = first; f <= last; ++f) {
      // Where the test rows of frame f are in frame k.
      std::vector<Index> at = frames_[f].rows;
      if (matrix->rows() == 0) break;
      for (std::uint32_t step = f; step > k; --step)
        for (Index& i : at) i = mappings.to_later[step - 1].from[i];
      for (std::uint32_t step = f; step < k; ++step)
        for (Index& i : at) i = mappings.to_earlier[step].from[i];
      std::vector<ClusterLight> lights;
      for (const ClusterColumn* c : of_frame[k])
        if (f >= c->of->begin && f < c->of->end) {
          lights.push_back(peaks.light(*c));
          lights.back().scale = c->scale[f - c->of->begin];
        }
      const std::vector<Rgb> sums = sums_at(*matrix, at, lights, spent);
      const auto there_matrix = tensor_.frame(f);
      const matrix::RowFeatures there = there_matrix->row_features();
      for (std::size_t a = 0; a < at.size(); ++a)
        estimates[f][a] += relight(sums[a], albedo_of(here, at[a]), albedo_of(there, frames_[f].rows[a]));
    }
  }
  double difference = 0, all = 0;
  for (std::size_t f = 0; f < frames; ++f)
    for (std::size_t a = 0; a < estimates[f].size(); ++a)
      for (int c = 0; c < 3; ++c) {
        const auto want = static_cast<double>(frames_[f].truth[a][c]);
        const double off = static_cast<double>(estimates[f][a][c]) - want;
        difference += off * off;
        all += want * want;
      }
  return all > 0 ? std::sqrt(difference / all) : 0;
}

}  // namespace lumirank::methods
