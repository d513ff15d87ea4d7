#include "methods/visibility_completion/visibility_completion.h"

#include <algorithm>

#include "base/random.h"
#include "base/timer.h"
#include "matrix/entry_reader.h"
#include "methods/common/slices/slice_pass.h"
#include "methods/visibility_completion/completion.h"

namespace lumirank::methods {

namespace {

struct Settings : SliceLightSettings, CompletionSettings {
  // A fifth of the rays per column, so twice as many of them.
  Settings() { columns = 600; }
};

const Fields<Settings>& fields() {
  static const Fields<Settings> all = with_slice_light_fields<Settings>(
      {count_field<Settings>(
           {"spacing", "receivers", "One of so many receivers of a slice is tested against all its columns."},
           &Settings::spacing, 1, kMaxRows),
       number_field<Settings>(
           {"checks", "",
            "Share of the entries on which neighbors agree that gets a shadow ray all the same."},
           &Settings::checks, 0, 1)});
  return all;
}

struct CompletionWorkspace {
  explicit CompletionWorkspace(const matrix::LightingMatrix& matrix)
      : reader(matrix.reader()), completion(*reader) {}
  std::unique_ptr<matrix::EntryReader> reader;
  SliceLights::Workspace lights;
  SliceCosts costs;
  Completion completion;
  std::vector<linalg::NestedLevels::Point> points;
  std::vector<matrix::Index> columns, list_rows, list_columns;
  std::vector<std::uint32_t> seen;  // rows of one column
  struct Place {
    std::uint32_t row, column;
  };
  std::vector<Place> places;
  std::vector<Rgb> entries;
  double seconds_visibility = 0, seconds_shading = 0;
};

class VisibilityCompletion final : public Method {
 public:
  explicit VisibilityCompletion(const Settings& settings) : settings_(settings) {}

  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    const SlicePoints points(matrix.row_features(), matrix.rows());
    WorkspacePool<CompletionWorkspace> pool([&] { return std::make_unique<CompletionWorkspace>(matrix); });
    Estimate estimate =
        run_slices(matrix, options, settings_, pool,
                   [&](const SliceLights& lights, std::size_t s, CompletionWorkspace& w,
                       std::span<Rgb> sums) { render(lights, points, options.seed, s, w, sums); });
    Completion::Counts all;
    double visibility = 0, shading = 0;
    pool.for_each([&](const CompletionWorkspace& w) {
      const Completion::Counts& c = w.completion.counts();
      all.entries += c.entries, all.sampled += c.sampled, all.checks += c.checks, all.wrong += c.wrong;
      visibility += w.seconds_visibility, shading += w.seconds_shading;
    });
    auto& numbers = estimate.trace.numbers;
    const auto ratio = [](std::uint64_t a, std::uint64_t b) {
      return b > 0 ? static_cast<double>(a) / static_cast<double>(b) : 0.0;
    };
    numbers["completion.sampled"] = ratio(all.sampled, all.entries);
    numbers["completion.checks"] = ratio(all.checks, all.entries);
    numbers["completion.wrong_checks"] = ratio(all.wrong, all.checks);
    numbers["cpu_seconds.visibility"] = visibility;
    numbers["cpu_seconds.shading"] = shading;
    return estimate;
  }

 private:
  void render(const SliceLights& lights, const SlicePoints& points, std::uint64_t seed, std::size_t s,
              CompletionWorkspace& w, std::span<Rgb> sums) const {
    const Timer timer;
    const auto rows = lights.slices().slice(s);
    w.reader->set_rows(rows);
    const auto& chosen = w.lights.chosen;
    w.points.clear(), w.columns.clear();
    for (const matrix::Index i : rows) w.points.push_back(points[i]);
    for (const matrix::ScaledColumn& c : chosen) w.columns.push_back(c.column);
    const Completion::Slice slice{rows, w.points, w.columns, hash_ids(seed, Stage::method, 2, s)};
    w.completion.complete(slice, settings_);
    const double seen = timer.seconds();
    w.seconds_visibility += seen;
    shade(chosen, rows, w, sums);
    w.seconds_shading += timer.seconds() - seen;
  }

  // Σ scale · E · V; where few rows see a column, E of these alone.
  static void shade(std::span<const matrix::ScaledColumn> chosen, std::span<const matrix::Index> rows,
                    CompletionWorkspace& w, std::span<Rgb> sums) {
    for (const matrix::Index i : rows) sums[i] = Rgb(0);
    w.places.clear(), w.list_rows.clear(), w.list_columns.clear();
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      w.seen.clear();
      for (std::size_t a = 0; a < rows.size(); ++a)
        if (w.completion.visible(a, k)) w.seen.push_back(static_cast<std::uint32_t>(a));
      if (4 * w.seen.size() < rows.size()) {
        for (const std::uint32_t a : w.seen) {
          w.places.push_back({a, static_cast<std::uint32_t>(k)});
          w.list_rows.push_back(rows[a]);
          w.list_columns.push_back(chosen[k].column);
        }
        continue;
      }
      w.entries.resize(rows.size());
      w.reader->column(chosen[k].column, w.entries, matrix::Part::unoccluded);
      for (const std::uint32_t a : w.seen) sums[rows[a]] += w.lights.added(chosen[k], w.entries[a]);
    }
    w.entries.resize(w.places.size());
    w.reader->entries(w.list_rows, w.list_columns, w.entries, matrix::Part::unoccluded);
    for (std::size_t p = 0; p < w.places.size(); ++p)
      sums[rows[w.places[p].row]] += w.lights.added(chosen[w.places[p].column], w.entries[p]);
  }

  Settings settings_;
};

}  // namespace

MethodInfo visibility_completion_info() {
  return method_info<VisibilityCompletion>(
      {"visibility-completion",
       "Columns of slices as in lightslice, with few of their shadow rays.",
       "Wang, Holzschuch 2020, Adaptive matrix completion for fast visibility computations with many lights "
       "rendering",
       "columns or spacing",
       {{matrix::Ability::binary_visibility}}},
      fields());
}

}  // namespace lumirank::methods
