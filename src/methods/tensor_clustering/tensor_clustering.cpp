#include "methods/tensor_clustering/tensor_clustering.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "base/parallel.h"
#include "base/timer.h"
#include "linalg/clustering.h"
#include "linalg/column_sketch.h"
#include "methods/tensor_clustering/row_mapping.h"

namespace lumirank::methods {
namespace {

using linalg::RectangleClustering;
using matrix::Index;

// One row in each of count × count bins of the picture: the nearest to its middle (section 5); rows without
// places on the film: evenly by index.
std::vector<Index> rows_of_bins(const matrix::LightingMatrix& m, std::size_t count) {
  const auto pixel = m.row_features().pixel;
  std::vector<Index> chosen;
  if (pixel.empty()) {
    for (std::size_t k = 0; k < std::min(count, m.rows()); ++k)
      chosen.push_back(static_cast<Index>((2 * k + 1) * m.rows() / (2 * std::min(count, m.rows()))));
    return chosen;
  }
  float width = 0, height = 0;
  for (const Vec2f p : pixel) width = std::max(width, p.x), height = std::max(height, p.y);
  // As many bins as rows are wanted, as square as the picture lets them be.
  const double aspect =
      static_cast<double>(std::max(width, 1.0f)) / static_cast<double>(std::max(height, 1.0f));
  const auto across = std::max(1.0, std::round(std::sqrt(static_cast<double>(count) * aspect)));
  const auto down = std::max(1.0, std::round(static_cast<double>(count) / across));
  std::map<std::pair<int, int>, std::pair<float, Index>> nearest;
  for (std::size_t i = 0; i < pixel.size(); ++i) {
    const double x = static_cast<double>(pixel[i].x / (width + 1)) * across,
                 y = static_cast<double>(pixel[i].y / (height + 1)) * down;
    const double dx = x - std::floor(x) - 0.5, dy = y - std::floor(y) - 0.5;
    const std::pair<float, Index> here{static_cast<float>(dx * dx + dy * dy), static_cast<Index>(i)};
    const auto [found, fresh] = nearest.try_emplace({static_cast<int>(y), static_cast<int>(x)}, here);
    if (!fresh) found->second = std::min(found->second, here);
  }
  for (const auto& [bin, row] : nearest) chosen.push_back(row.second);
  return chosen;
}

class TensorRun {
 public:
  TensorRun(const matrix::LightingTensor& tensor, const TensorClusteringSettings& settings,
            const RunOptions& options)
      : tensor_(tensor), settings_(settings), options_(options) {}

  TensorEstimate run() {
    const Timer timer;
    estimate_.sums.resize(tensor_.frames());
    estimate_.active.assign(tensor_.frames(), 0);
    if (tensor_.frames() == 0) return std::move(estimate_);
    if (!explore()) return interrupted();
    estimate_.trace.numbers["seconds.rows"] = timer.seconds();
    const double begin = timer.seconds();
    cluster();
    estimate_.trace.numbers["seconds.clustering"] = timer.seconds() - begin;
    if (options_.sinks.cancelled()) return interrupted();
    if (!reconstruct()) return interrupted();
    estimate_.trace.numbers["rows.afresh"] = carried_rows_ > 0 ? fresh_rows_ / carried_rows_ : 0.0;
    estimate_.trace.numbers["seconds.columns"] =
        timer.seconds() - begin - estimate_.trace.numbers["seconds.clustering"];
    return std::move(estimate_);
  }

 private:
  TensorEstimate interrupted() {
    estimate_.interrupted = true;
    return std::move(estimate_);
  }

  // The reduced tensor, and a sketch of the lights over all frames for the initial clusters.
  bool explore() {
    const std::size_t frames = tensor_.frames(), columns = tensor_.columns();
    std::vector<std::vector<Index>> rows(frames);
    std::size_t max_rows = 0;
    for (std::size_t k = 0; k < frames; ++k) {
      rows[k] = rows_of_bins(*tensor_.frame(k), settings_.rows);
      max_rows = std::max(max_rows, rows[k].size());
    }
    reduced_ = std::make_unique<linalg::ReducedTensor>(
        linalg::ReducedTensor::Shape{max_rows, columns, frames, settings_.precision});
    const std::size_t all = max_rows * frames;
    const bool projected = settings_.projection > 0 && all > settings_.projection;
    sketch_ = std::make_unique<linalg::ColumnSketch>(
        linalg::ColumnSketch::Shape{columns, projected ? settings_.projection : all, projected},
        options_.seed);
    for (std::size_t k = 0; k < frames; ++k) {
      if (options_.sinks.cancelled()) return false;
      const auto matrix = tensor_.frame(k);
      std::vector<Rgb> entries(max_rows * columns, Rgb(0));  // a frame with fewer rows has rows of zeros
      for (std::size_t i = 0; i < rows[k].size(); ++i) {
        const std::span<Rgb> row(entries.data() + i * columns, columns);
        estimate_.spent += matrix->row(rows[k][i], row);
        sketch_->add_row(k * max_rows + i, 1, {&row[0][0], 3 * columns});
      }
      reduced_->set_frame(k, entries);
      options_.sinks.report("rows", static_cast<double>(k + 1) / static_cast<double>(frames));
    }
    estimate_.trace.numbers["rows"] = static_cast<double>(max_rows);
    estimate_.trace.numbers["memory.tensor_bytes"] = static_cast<double>(reduced_->memory_bytes());
    return true;
  }

  void cluster() {
    const linalg::Points points = sketch_->points();
    const std::vector<double> norms = linalg::own_norms(points);
    std::vector<std::uint32_t> lit;
    for (std::size_t j = 0; j < norms.size(); ++j)
      if (!sketch_->is_zero(j)) lit.push_back(static_cast<std::uint32_t>(j));
    const std::size_t wanted = settings_.columns * tensor_.frames();
    linalg::Partition start;
    if (!lit.empty()) {
      const auto initial = linalg::cluster(points, norms, lit, {},
                                           {linalg::ClusteringAlgorithm::sampling,
                                            std::min(settings_.initial_clusters, wanted), options_.seed});
      start = initial.partition();
    }
    clustering_ =
        std::make_unique<RectangleClustering>(*reduced_, start, options_.seed, settings_.time_weight);
    clustering_->split_to(wanted);
    estimate_.clusters = clustering_->rectangles().size();
    estimate_.cost = clustering_->cost();
    for (const auto& r : clustering_->rectangles())
      for (std::uint32_t k = r.begin; k < r.end; ++k) ++estimate_.active[k];
  }

  struct Representative {
    Index column = 0;
    std::uint32_t frame = 0;
    const RectangleClustering::Rectangle* of = nullptr;
    std::vector<Rgb> scale;  // in each of the rectangle's frames
  };

  // Of the largest norm (section 4.5), and what it is multiplied with in every frame, per channel.
  Representative representative_of(const RectangleClustering::Rectangle& r) const {
    Representative best;
    best.of = &r;
    float largest = -1;
    for (std::uint32_t k = r.begin; k < r.end; ++k)
      for (const std::uint32_t j : r.lights)
        if (reduced_->weight(j, k) > largest)
          largest = reduced_->weight(j, k), best.column = j, best.frame = k;
    best.scale.assign(r.end - r.begin, Rgb(0));
    for (std::uint32_t k = r.begin; k < r.end; ++k) {
      double all = 0, channels[3] = {};
      for (const std::uint32_t j : r.lights) {
        all += static_cast<double>(reduced_->weight(j, k));
        for (std::size_t c = 0; c < 3; ++c) channels[c] += static_cast<double>(reduced_->channel(j, k, c));
      }
      if (!(largest > 0)) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        const float own = reduced_->channel(best.column, best.frame, c);
        // A channel that the representative hardly has cannot be scaled to the cluster's.
        best.scale[k - r.begin][static_cast<int>(c)] = own > kNoChannel * largest
                                                           ? static_cast<float>(channels[c]) / own
                                                           : static_cast<float>(all) / largest;
      }
    }
    return best;
  }

  bool reconstruct() {
    const std::size_t frames = tensor_.frames();
    std::vector<std::vector<Representative>> by_frame(frames);
    for (const auto& r : clustering_->rectangles()) {
      Representative found = representative_of(r);
      by_frame[found.frame].push_back(std::move(found));
    }
    make_mappings();
    for (std::size_t k = 0; k < frames; ++k) estimate_.sums[k].assign(rows_[k], Rgb(0));
    for (std::size_t k = 0; k < frames; ++k) {
      if (options_.sinks.cancelled()) return false;
      add_columns_of(k, by_frame[k]);
      options_.sinks.report("columns", static_cast<double>(k + 1) / static_cast<double>(frames));
    }
    return true;
  }

  // Both ways between neighboring frames.
  void make_mappings() {
    const std::size_t frames = tensor_.frames();
    rows_.resize(frames);
    std::shared_ptr<const matrix::LightingMatrix> before;
    float scale = 0;
    for (std::size_t k = 0; k < frames; ++k) {
      const auto matrix = tensor_.frame(k);
      rows_[k] = matrix->rows();
      if (k == 0) scale = diagonal_of_rows(*matrix);
      if (before) {
        to_later_.push_back(nearest_rows(*matrix, *before, scale));
        to_earlier_.push_back(nearest_rows(*before, *matrix, scale));
      }
      before = matrix;
    }
  }

  // What the representatives of frame k add to all frames: to its own at once; to others their sums, carried
  // there.
  void add_columns_of(std::size_t k, const std::vector<Representative>& representatives) {
    if (representatives.empty()) return;
    const auto matrix = tensor_.frame(k);
    std::uint32_t first = static_cast<std::uint32_t>(k), last = first;
    for (const Representative& r : representatives)
      first = std::min(first, r.of->begin), last = std::max(last, r.of->end - 1);
    std::vector<std::vector<Rgb>> to(last - first + 1);
    std::vector<Rgb> column(matrix->rows());
    for (const Representative& r : representatives) {
      estimate_.spent += matrix->column(r.column, column);
      for (std::uint32_t f = r.of->begin; f < r.of->end; ++f) {
        std::vector<Rgb>& sums = to[f - first];
        if (sums.empty()) sums.assign(matrix->rows(), Rgb(0));
        const Rgb scale = r.scale[f - r.of->begin];
        parallel_for(sums.size(), 16384, [&](std::size_t b, std::size_t e) {
          for (std::size_t i = b; i < e; ++i) sums[i] += scale * column[i];
        });
      }
    }
    const auto carry = [&](std::uint32_t f, const RowMapping& mapping) {
      const std::vector<Rgb>& from = to[f - first];
      if (from.empty()) return;
      std::vector<Index> hidden;
      for (std::size_t i = 0; i < mapping.from.size(); ++i)
        if (settings_.max_distance > 0 && static_cast<double>(mapping.distance[i]) > settings_.max_distance)
          hidden.push_back(static_cast<Index>(i));
        else
          estimate_.sums[f][i] += from[mapping.from[i]];
      shade_afresh(f, hidden, representatives);
      if (f != k) carried_rows_ += static_cast<double>(mapping.from.size());
    };
    RowMapping mapping = RowMapping::identity(matrix->rows());
    carry(static_cast<std::uint32_t>(k), mapping);
    for (std::uint32_t f = static_cast<std::uint32_t>(k) + 1; f <= last; ++f) {
      mapping = mapping.then(to_later_[f - 1]);
      carry(f, mapping);
    }
    mapping = RowMapping::identity(matrix->rows());
    for (std::uint32_t f = static_cast<std::uint32_t>(k); f-- > first;) {
      mapping = mapping.then(to_earlier_[f]);
      carry(f, mapping);
    }
  }

  // Rows of frame f that cannot be told by another frame: the clusters of `representatives` that act there,
  // each by its brightest light in that frame.
  void shade_afresh(std::uint32_t f, std::span<const Index> rows,
                    const std::vector<Representative>& representatives) {
    if (rows.empty()) return;
    std::vector<Index> columns;
    std::vector<Rgb> scales;
    for (const Representative& r : representatives) {
      if (f < r.of->begin || f >= r.of->end) continue;
      RectangleClustering::Rectangle now{r.of->lights, f, f + 1, 0};
      const Representative here = representative_of(now);
      if (is_black(here.scale[0])) continue;
      columns.push_back(here.column), scales.push_back(here.scale[0]);
    }
    const auto matrix = tensor_.frame(f);
    constexpr std::size_t kRowsAtOnce = 256;
    std::vector<Rgb> values;
    for (std::size_t begin = 0; begin < rows.size(); begin += kRowsAtOnce) {
      const auto some = rows.subspan(begin, std::min(kRowsAtOnce, rows.size() - begin));
      values.resize(some.size() * columns.size());
      estimate_.spent += matrix->block(some, columns, values, matrix::Part::value);
      for (std::size_t a = 0; a < some.size(); ++a)
        for (std::size_t b = 0; b < columns.size(); ++b)
          estimate_.sums[f][some[a]] += scales[b] * values[a * columns.size() + b];
    }
    fresh_rows_ += static_cast<double>(rows.size());
  }

  static constexpr float kNoChannel = 1e-3f;  // of a column's norm

  const matrix::LightingTensor& tensor_;
  const TensorClusteringSettings& settings_;
  const RunOptions& options_;
  TensorEstimate estimate_;
  std::unique_ptr<linalg::ReducedTensor> reduced_;
  std::unique_ptr<linalg::ColumnSketch> sketch_;
  std::unique_ptr<RectangleClustering> clustering_;
  std::vector<std::size_t> rows_;  // of each frame
  double fresh_rows_ = 0, carried_rows_ = 0;
  // Rows of frame k + 1 to those of frame k, and the other way.
  std::vector<RowMapping> to_later_, to_earlier_;
};

}  // namespace

TensorEstimate estimate_tensor(const matrix::LightingTensor& tensor, const TensorClusteringSettings& settings,
                               const RunOptions& options) {
  return TensorRun(tensor, settings, options).run();
}

}  // namespace lumirank::methods
