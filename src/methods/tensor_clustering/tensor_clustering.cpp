#include "methods/tensor_clustering/tensor_clustering.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "base/parallel.h"
#include "base/timer.h"
#include "linalg/clustering.h"
#include "linalg/column_sketch.h"
#include "methods/tensor_clustering/changed_rows.h"
#include "methods/tensor_clustering/cluster_columns.h"
#include "methods/tensor_clustering/cluster_reader.h"
#include "methods/tensor_clustering/row_mapping.h"
#include "methods/tensor_clustering/slice_columns.h"
#include "methods/tensor_clustering/spread_changes.h"
#include "methods/tensor_clustering/temporal_filter.h"
#include "methods/tensor_clustering/test_rows.h"

namespace lumirank::methods {
namespace {

using linalg::RectangleClustering;
using matrix::Index;

// One row in each of count × count bins of the picture: the nearest to its middle (section 5); with
// `others_too` and where several rows have that place, one more of them, each in its turn. Rows without
// places on the film: evenly by index.
std::vector<Index> rows_of_bins(const matrix::LightingMatrix& m, std::size_t count, bool others_too = false) {
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
  struct Nearest {
    float distance;
    std::vector<Index> rows;
  };
  std::map<std::pair<int, int>, Nearest> nearest;
  for (std::size_t i = 0; i < pixel.size(); ++i) {
    const double x = static_cast<double>(pixel[i].x / (width + 1)) * across,
                 y = static_cast<double>(pixel[i].y / (height + 1)) * down;
    const double dx = x - std::floor(x) - 0.5, dy = y - std::floor(y) - 0.5;
    const auto distance = static_cast<float>(dx * dx + dy * dy);
    Nearest& best =
        nearest.try_emplace({static_cast<int>(y), static_cast<int>(x)}, Nearest{distance, {}}).first->second;
    if (distance < best.distance) best = {distance, {}};
    if (distance == best.distance) best.rows.push_back(static_cast<Index>(i));
  }
  std::size_t turn = 0;
  for (const auto& [bin, best] : nearest) {
    chosen.push_back(best.rows.front());
    if (others_too && best.rows.size() > 1) chosen.push_back(best.rows[1 + turn++ % (best.rows.size() - 1)]);
  }
  return chosen;
}

// With a target error: rows of each frame that are kept from the clusterings, and how columns grow until it
// is reached. Rows grow where twice the columns leave more than this part of the error.
constexpr std::size_t kTestRows = 25;
constexpr std::size_t kFirstColumns = 25;
constexpr double kColumnGrowth = 1.4142, kTooFewRows = 0.9;
// What is too dark to be seen may change: this part of a frame's mean light.
constexpr float kUnseen = 0.05f;

// Clusters that last for fewer frames on average (or for less than half of all there are) are not carried:
// what that saves is spent on mappings, on the search for changes and on rows that are shaded afresh.
constexpr double kWorthCarrying = 5;

// A filtered pair of frames loses a fifth of its weight where it differs by this times what may be carried
// unchanged: what passes evenly through three frames errs less than what is carried through many.
constexpr double kFilteredChange = 2;
constexpr std::size_t kCarriedAtOnce = 1 << 12;

float unseen(std::span<const Rgb> sums) {
  double all = 0;
  for (const Rgb& light : sums) all += static_cast<double>(max_component(light));
  return kUnseen * static_cast<float>(all / static_cast<double>(std::max<std::size_t>(1, sums.size())));
}

// Of so many rows of entries.
float mean_light_of(std::span<const Rgb> entries, std::size_t rows) {
  if (rows == 0) return 0;
  const std::size_t columns = entries.size() / rows;
  double all = 0;
  for (std::size_t i = 0; i < rows; ++i) {
    Rgb sum(0);
    for (const Rgb& entry : entries.subspan(i * columns, columns)) sum += entry;
    all += static_cast<double>(max_component(sum));
  }
  return static_cast<float>(all / static_cast<double>(rows));
}

class TensorRun {
 public:
  TensorRun(const matrix::LightingTensor& tensor, const TensorClusteringSettings& settings,
            const RunOptions& options)
      : tensor_(tensor), settings_(settings), options_(options), test_(tensor) {}

  TensorEstimate run() {
    estimate_.sums.resize(tensor_.frames());
    estimate_.active.assign(tensor_.frames(), 0);
    if (tensor_.frames() == 0) return std::move(estimate_);
    const bool by_error = settings_.target_error > 0;
    const auto map_rows = [&] { return timed("mappings", [&] { return make_mappings(); }); };
    if (by_error && !(map_rows() && find_clusters())) return interrupted();
    if (!by_error) {
      if (!make_clusters()) return interrupted();
      estimate_.carried = carries();
      if (estimate_.carried && !map_rows()) return interrupted();
    }
    for (const ClusterColumn& c : clusters_)
      for (std::uint32_t k = c.of->begin; k < c.of->end; ++k) ++estimate_.active[k];
    estimate_.clusters = clusters_.size();
    estimate_.cost = clustering_->cost();
    if (settings_.keep_rectangles) estimate_.rectangles = clustering_->rectangles();
    timed("clustering", [&] {
      const ClusterColumns columns_of(*reduced_, settings_.representatives);
      parallel_for(clusters_.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) columns_of.find_in_frames(clusters_[c]);
      });
      return true;
    });
    if (!estimate_.carried) {
      if (!timed("columns", [&] { return compute_frames(); })) return interrupted();
      estimate_.trace.numbers["rows.afresh"] = 1;
      return std::move(estimate_);
    }
    if (!timed("columns", [&] { return compute_columns(); })) return interrupted();
    if (!timed("changes", [&] { return shade_changes(); })) return interrupted();
    if (!timed("filter", [&] { return filter(); })) return interrupted();
    auto& numbers = estimate_.trace.numbers;
    double all = 0;
    for (const std::size_t rows : rows_) all += static_cast<double>(rows);
    numbers["rows.afresh"] = carried_rows_ > 0 ? fresh_rows_ / carried_rows_ : 0.0;
    numbers["rows.changed"] = all > 0 ? changed_rows_ / all : 0.0;
    return std::move(estimate_);
  }

 private:
  TensorEstimate interrupted() {
    estimate_.interrupted = true;
    return std::move(estimate_);
  }
  template <typename Stage>
  bool timed(const char* name, const Stage& stage) {
    const Timer timer;
    const bool whole = stage();
    estimate_.trace.numbers[std::string("seconds.") + name] += timer.seconds();
    return whole && !options_.sinks.cancelled();
  }

  // ------------------------------------------------------------------------------------------- clusters

  bool make_clusters() {
    if (!timed("rows", [&] { return explore(settings_.rows); })) return false;
    return timed("clustering", [&] {
      start_clusters();
      if (settings_.carrying == Carrying::never)
        split_to_shaded(settings_.columns);
      else
        split_to(settings_.columns);
      return true;
    });
  }

  bool carries() const {
    if (settings_.carrying != Carrying::automatic) return settings_.carrying == Carrying::always;
    double lasts = 0;
    for (const ClusterColumn& c : clusters_) lasts += static_cast<double>(c.of->end - c.of->begin);
    return lasts >= static_cast<double>(clusters_.size()) *
                        std::min(kWorthCarrying, static_cast<double>(tensor_.frames()) / 2);
  }

  // As few columns as the test rows say that the error needs.
  bool find_clusters() {
    if (!timed("rows", [&] { return read_test_rows(); })) return false;
    double columns = static_cast<double>(kFirstColumns), before = kInfinity;
    for (std::size_t rows = settings_.rows;;) {
      if (!timed("rows", [&] { return explore(rows); })) return false;
      timed("clustering", [&] {
        start_clusters();
        return true;
      });
      bool more_rows = false;
      while (!more_rows) {
        const double limit = static_cast<double>(std::min(settings_.max_columns, tensor_.columns()));
        columns = std::min(columns, limit);
        timed("clustering", [&] {
          split_to(static_cast<std::size_t>(columns));
          estimate_.predicted_error = test_.error(clusters_, mappings_, *peaks_, estimate_.spent);
          return true;
        });
        if (options_.sinks.cancelled()) return false;
        if (estimate_.predicted_error <= settings_.target_error || columns >= limit) return true;
        more_rows = estimate_.predicted_error > kTooFewRows * before && 2 * rows <= settings_.max_rows;
        before = more_rows ? kInfinity : estimate_.predicted_error;
        if (!more_rows) columns *= kColumnGrowth;
      }
      rows *= 2;
    }
  }

  bool read_test_rows() {
    for (std::size_t k = 0; k < tensor_.frames(); ++k) {
      if (options_.sinks.cancelled()) return false;
      test_.read(k, rows_of_bins(*tensor_.frame(k), kTestRows), estimate_.spent);
    }
    return true;
  }

  // The reduced tensor, and a sketch of the lights over all frames for the initial clusters.
  bool explore(std::size_t wanted) {
    const std::size_t frames = tensor_.frames(), columns = tensor_.columns();
    std::vector<std::vector<Index>> rows(frames);
    std::size_t max_rows = 0;
    for (std::size_t k = 0; k < frames; ++k) {
      rows[k] = rows_of_bins(*tensor_.frame(k), wanted, settings_.two_of_a_place);
      max_rows = std::max(max_rows, rows[k].size());
    }
    reduced_ = std::make_unique<linalg::ReducedTensor>(
        linalg::ReducedTensor::Shape{max_rows, columns, frames, settings_.precision});
    std::vector<float> mean_light;
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
      mean_light.push_back(mean_light_of(std::span(entries).first(rows[k].size() * columns), rows[k].size()));
      options_.sinks.report("rows", static_cast<double>(k + 1) / static_cast<double>(frames));
    }
    peaks_ = std::make_unique<const ClusterPeaks>(*reduced_, std::move(mean_light), settings_.max_peak);
    estimate_.trace.numbers["rows"] = static_cast<double>(max_rows);
    estimate_.trace.numbers["memory.tensor_bytes"] = static_cast<double>(reduced_->memory_bytes());
    return true;
  }

  void start_clusters() {
    const linalg::Points points = sketch_->points();
    const std::vector<double> norms = linalg::own_norms(points);
    const std::size_t least = settings_.target_error > 0 ? kFirstColumns : settings_.columns;
    std::vector<std::uint32_t> lit;
    for (std::size_t j = 0; j < norms.size(); ++j)
      if (!sketch_->is_zero(j)) lit.push_back(static_cast<std::uint32_t>(j));
    linalg::Partition start;
    if (!lit.empty()) {
      // Of clusters that are shaded in every frame so many fit into a frame, of others into all of them.
      const std::size_t all = settings_.carrying == Carrying::never ? least : least * tensor_.frames();
      const std::size_t wanted = std::min(settings_.initial_clusters, std::max<std::size_t>(1, all / 4));
      const auto initial = linalg::cluster(points, norms, lit, {},
                                           {linalg::ClusteringAlgorithm::sampling, wanted, options_.seed});
      start = initial.partition();
    }
    clustering_ =
        std::make_unique<RectangleClustering>(*reduced_, start, options_.seed, settings_.time_weight);
  }

  void split_to(std::size_t columns) {
    clustering_->split_to(columns * tensor_.frames());
    find_columns();
  }

  // Until so many clusters act in each frame in the mean, for each of which every cluster is computed: a
  // split in time costs nothing then.
  void split_to_shaded(std::size_t columns) {
    const std::size_t frames = tensor_.frames(), wanted = columns * frames;
    for (bool more = true; more;) {
      std::size_t shaded = 0;
      for (const auto& r : clustering_->rectangles()) shaded += r.end - r.begin;
      const std::size_t missing = wanted > shaded ? (wanted - shaded) / frames : 0;
      more = missing > 0 && clustering_->split_to(clustering_->rectangles().size() + missing);
    }
    find_columns();
  }

  void find_columns() {
    const auto& rectangles = clustering_->rectangles();
    clusters_.assign(rectangles.size(), {});
    const ClusterColumns columns_of(*reduced_, settings_.representatives);
    parallel_for(rectangles.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c) clusters_[c] = columns_of.column_of(rectangles[c]);
    });
  }

  // -------------------------------------------------------------------------------------------- columns

  // Both ways between neighboring frames.
  bool make_mappings() {
    std::unique_ptr<const FrameRows> before;
    for (std::size_t k = 0; k < tensor_.frames(); ++k) {
      if (options_.sinks.cancelled()) return false;
      const auto matrix = tensor_.frame(k);
      rows_.push_back(matrix->rows());
      if (k == 0) scale_ = diagonal_of_rows(matrix->row_features());
      auto now = std::make_unique<const FrameRows>(*matrix, scale_);
      if (before) {
        mappings_.to_later.push_back(now->nearest(*before));
        mappings_.to_earlier.push_back(before->nearest(*now));
      }
      before = std::move(now);
    }
    return true;
  }

  // Each by all clusters that act in it, as they are in that very frame.
  bool compute_frames() {
    for (std::uint32_t f = 0; f < tensor_.frames(); ++f) {
      if (options_.sinks.cancelled()) return false;
      const auto matrix = tensor_.frame(f);
      std::vector<Index> rows(matrix->rows());
      std::iota(rows.begin(), rows.end(), Index{0});
      estimate_.sums[f] =
          sums_at(*matrix, rows, in_own_frame(f, [](const ClusterColumn&) { return true; }), estimate_.spent);
      options_.sinks.report("columns", static_cast<double>(f + 1) / static_cast<double>(tensor_.frames()));
    }
    return true;
  }

  bool compute_columns() {
    const std::size_t frames = tensor_.frames();
    std::vector<std::vector<const ClusterColumn*>> of_frame(frames);
    for (const ClusterColumn& c : clusters_) of_frame[c.frame].push_back(&c);
    own_.resize(frames), carried_.resize(frames);
    for (std::size_t k = 0; k < frames; ++k) {
      own_[k].assign(rows_[k], Rgb(0));
      carried_[k].assign(rows_[k], Rgb(0));
    }
    for (std::size_t k = 0; k < frames; ++k) {
      if (options_.sinks.cancelled()) return false;
      add_columns_of(k, of_frame[k]);
      options_.sinks.report("columns", static_cast<double>(k + 1) / static_cast<double>(frames));
    }
    return true;
  }

  // What the columns of frame k add to all frames: to its own at once; to others their sums, carried there.
  void add_columns_of(std::size_t k, const std::vector<const ClusterColumn*>& clusters) {
    if (clusters.empty()) return;
    const auto matrix = tensor_.frame(k);
    std::uint32_t first = static_cast<std::uint32_t>(k), last = first;
    for (const ClusterColumn* c : clusters)
      first = std::min(first, c->of->begin), last = std::max(last, c->of->end - 1);
    std::vector<std::vector<Rgb>> to(last - first + 1);
    const auto sums_of = [&](std::uint32_t f) -> std::vector<Rgb>& {
      return f == k ? own_[k] : to[f - first];
    };
    for (const ClusterColumn* c : clusters)
      for (std::uint32_t f = c->of->begin; f < c->of->end; ++f) sums_of(f).resize(matrix->rows(), Rgb(0));
    std::vector<Index> rows(matrix->rows());
    std::iota(rows.begin(), rows.end(), Index{0});
    std::vector<ClusterLight> lights;
    lights.reserve(clusters.size());
    for (const ClusterColumn* c : clusters) lights.push_back(peaks_->light(*c));
    estimate_.spent +=
        each_slice(*matrix, rows, [&](matrix::EntryReader& reader, std::size_t begin, std::size_t end) {
          matrix::Cost cost;
          ClusterReader read_clusters(reader, std::span(rows).subspan(begin, end - begin), rows.size());
          std::vector<Rgb> column(end - begin);
          for (std::size_t n = 0; n < clusters.size(); ++n) {
            const ClusterColumn* const c = clusters[n];
            cost += read_clusters.read(lights[n], column);
            for (std::uint32_t f = c->of->begin; f < c->of->end; ++f) {
              const Rgb scale = c->scale[f - c->of->begin];
              Rgb* const sums = sums_of(f).data() + begin;
              for (std::size_t i = 0; i < column.size(); ++i) sums[i] += scale * column[i];
            }
          }
          return cost;
        });
    RowMapping mapping = RowMapping::identity(matrix->rows());
    for (std::uint32_t f = static_cast<std::uint32_t>(k) + 1; f <= last; ++f) {
      mapping = mapping.then(mappings_.to_later[f - 1]);
      carry(static_cast<std::uint32_t>(k), *matrix, to[f - first], f, mapping);
    }
    mapping = RowMapping::identity(matrix->rows());
    for (std::uint32_t f = static_cast<std::uint32_t>(k); f-- > first;) {
      mapping = mapping.then(mappings_.to_earlier[f]);
      carry(static_cast<std::uint32_t>(k), *matrix, to[f - first], f, mapping);
    }
  }

  // Sums of the columns of frame `from` that are meant for frame f.
  void carry(std::uint32_t from, const matrix::LightingMatrix& source, const std::vector<Rgb>& sums,
             std::uint32_t f, const RowMapping& mapping) {
    if (sums.empty()) return;
    const auto target = tensor_.frame(f);
    const auto here = source.row_features().albedo, there = target->row_features().albedo;
    const bool relit = !here.empty() && !there.empty();
    const auto within_reach = [&](std::size_t i) {
      return reaches(mapping.distance[i], settings_.max_distance, mapping.from.size());
    };
    parallel_for(mapping.from.size(), kCarriedAtOnce, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (!within_reach(i)) continue;
        const Index at = mapping.from[i];
        carried_[f][i] += relit ? relight(sums[at], here[at], there[i]) : sums[at];
      }
    });
    std::vector<Index> hidden;
    for (std::size_t i = 0; i < mapping.from.size(); ++i)
      if (!within_reach(i)) hidden.push_back(static_cast<Index>(i));
    if (!hidden.empty()) {
      const std::vector<Rgb> found =
          sums_at(*target, hidden, in_own_frame(f, [&](const ClusterColumn& c) { return c.frame == from; }),
                  estimate_.spent);
      for (std::size_t a = 0; a < hidden.size(); ++a) carried_[f][hidden[a]] += found[a];
    }
    carried_rows_ += static_cast<double>(mapping.from.size());
    fresh_rows_ += static_cast<double>(hidden.size());
  }

  // -------------------------------------------------------------------------------------------- changes

  // Of the clusters that act in frame f and are wanted: what they are in that very frame.
  template <typename Wanted>
  std::vector<ClusterLight> in_own_frame(std::uint32_t f, const Wanted& wanted) const {
    std::vector<ClusterLight> out;
    for (const ClusterColumn& c : clusters_) {
      if (f < c.of->begin || f >= c.of->end || !wanted(c)) continue;
      const matrix::ScaledColumn& own = c.in_frame[f - c.of->begin];
      if (!is_black(own.scale)) out.push_back(peaks_->light(c, own, f, own.scale));
    }
    return out;
  }

  bool shade_changes() {
    for (std::uint32_t f = 0; f < tensor_.frames(); ++f) {
      if (options_.sinks.cancelled()) return false;
      if (settings_.max_change > 0) shade_changes(f);
      estimate_.sums[f] = std::move(own_[f]);
      for (std::size_t i = 0; i < carried_[f].size(); ++i) estimate_.sums[f][i] += carried_[f][i];
      carried_[f] = {};
      options_.sinks.report("changes", static_cast<double>(f + 1) / static_cast<double>(tensor_.frames()));
    }
    return true;
  }

  void shade_changes(std::uint32_t f) {
    const std::vector<ClusterLight> carried =
        in_own_frame(f, [&](const ClusterColumn& c) { return c.frame != f; });
    if (carried.empty()) return;
    const auto matrix = tensor_.frame(f);
    std::vector<Rgb> both = own_[f];
    for (std::size_t i = 0; i < both.size(); ++i) both[i] += carried_[f][i];
    const float too_dark = unseen(both);
    std::vector<bool> known(rows_[f], false);
    FoundChanges slight;  // of rows that have not changed by as much as counts
    const auto changed = [&](std::span<const Index> rows) {
      const std::vector<Rgb> found = sums_at(*matrix, rows, carried, estimate_.spent);
      std::vector<bool> said(rows.size());
      for (std::size_t a = 0; a < rows.size(); ++a) {
        Rgb& there = carried_[f][rows[a]];
        const Rgb change = found[a] - there;
        const float difference = std::max({std::abs(change.r), std::abs(change.g), std::abs(change.b)});
        const float light = max_component(own_[f][rows[a]] + found[a]);
        said[a] = difference > static_cast<float>(settings_.max_change) * (light + too_dark);
        known[rows[a]] = true;
        if (!said[a]) slight.rows.push_back(rows[a]), slight.change.push_back(change);
        there = found[a];
      }
      return said;
    };
    const auto features = matrix->row_features();
    changed_rows_ += static_cast<double>(ask_for_changes(features.pixel, rows_[f], changed).size());
    const std::vector<Rgb> spread = spread_changes(features, slight, known);
    for (std::size_t i = 0; i < spread.size(); ++i)
      for (int c = 0; c < 3; ++c) carried_[f][i][c] = std::max(carried_[f][i][c] + spread[i][c], 0.0f);
  }

  // --------------------------------------------------------------------------------------------- filter

  bool filter() {
    if (settings_.filter == 0) return true;
    std::vector<std::shared_ptr<const matrix::LightingMatrix>> matrices;
    FilteredShot shot{{}, mappings_, {}, {}, scale_};
    for (std::size_t k = 0; k < tensor_.frames(); ++k) {
      matrices.push_back(tensor_.frame(k));
      shot.features.push_back(matrices.back()->row_features());
      shot.unseen.push_back(unseen(estimate_.sums[k]));
    }
    shot.sums = std::move(estimate_.sums);
    double bound = kFilteredChange * settings_.max_change;
    // Nor may it leave more than an error that was asked for.
    if (settings_.target_error > 0 && !(bound > 0 && bound < settings_.target_error))
      bound = settings_.target_error;
    estimate_.sums = filter_in_time(std::move(shot), {settings_.filter, settings_.max_distance, bound});
    return true;
  }

  const matrix::LightingTensor& tensor_;
  const TensorClusteringSettings& settings_;
  const RunOptions& options_;
  TensorEstimate estimate_;
  TestRows test_;
  std::unique_ptr<linalg::ReducedTensor> reduced_;
  std::unique_ptr<const ClusterPeaks> peaks_;
  std::unique_ptr<linalg::ColumnSketch> sketch_;
  std::unique_ptr<RectangleClustering> clustering_;
  std::vector<ClusterColumn> clusters_;
  FrameMappings mappings_;
  float scale_ = 0;                              // of the mappings
  std::vector<std::size_t> rows_;                // of each frame
  std::vector<std::vector<Rgb>> own_, carried_;  // sums: of columns computed in the frame, and in others
  double fresh_rows_ = 0, carried_rows_ = 0, changed_rows_ = 0;
};

}  // namespace

TensorEstimate estimate_tensor(const matrix::LightingTensor& tensor, const TensorClusteringSettings& settings,
                               const RunOptions& options) {
  return TensorRun(tensor, settings, options).run();
}

}  // namespace lumirank::methods
