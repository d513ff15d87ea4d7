#include "methods/lightslice/lightslice.h"

#include <algorithm>

#include "base/timer.h"
#include "matrix/entry_reader.h"
#include "methods/known_rows.h"
#include "methods/slices/slice_lights.h"
#include "methods/unit_pass.h"

namespace lumirank::methods {

namespace {

const Fields<SliceLightSettings>& fields() {
  static const Fields<SliceLightSettings> all = slice_light_fields<SliceLightSettings>();
  return all;
}

struct Workspace {
  explicit Workspace(const matrix::LightingMatrix& matrix) : reader(matrix.reader()) {}
  std::unique_ptr<matrix::EntryReader> reader;
  SliceLights::Workspace lights;
  std::vector<Rgb> entries;
  double seconds_clustering = 0, seconds_columns = 0;
  std::uint64_t spent = 0;  // entries
};

class LightSlice final : public Method {
 public:
  explicit LightSlice(const SliceLightSettings& settings) : settings_(settings) {}

  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    const Timer timer;
    Estimate estimate;
    estimate.sums.assign(matrix.rows(), Rgb(0));
    auto& numbers = estimate.trace.numbers;
    const SliceLights lights(matrix, options, settings_, estimate.sums);
    numbers["seconds.rows"] = lights.seconds_rows();
    numbers["seconds.clustering"] = lights.seconds_clustering();
    numbers["rows"] = static_cast<double>(lights.known().size());
    numbers["slices"] = static_cast<double>(lights.slices().count());
    numbers["memory.reduced_bytes"] = static_cast<double>(lights.memory_bytes());
    UnitResult result;
    WorkspacePool<Workspace> pool([&] { return std::make_unique<Workspace>(matrix); });
    if (lights.ready()) {
      if (options.on_estimate) options.on_estimate(estimate.sums);
      const UnitRows units(lights.slices().rows, lights.slices().first);
      result = run_units(units, {options, timer, options.time_seconds, "columns"}, estimate.sums, pool,
                         [&](std::size_t s, Workspace& w) { render(lights, s, w, estimate.sums); });
    } else {
      result.cancelled = true;
    }
    std::uint64_t spent = 0;
    double clustering = 0, columns = 0;
    pool.for_each([&](const Workspace& w) {
      spent += w.spent, clustering += w.seconds_clustering, columns += w.seconds_columns;
    });
    const double all = static_cast<double>(matrix.rows()) * static_cast<double>(matrix.columns());
    numbers["seconds.columns"] = result.seconds;
    numbers["cpu_seconds.clustering"] = clustering;
    numbers["cpu_seconds.columns"] = columns;
    numbers["columns"] =
        matrix.rows() > 0 ? static_cast<double>(spent) / static_cast<double>(matrix.rows()) : 0;
    numbers["sampling_rate"] =
        all > 0 ? (static_cast<double>(spent) + numbers["rows"] * static_cast<double>(matrix.columns())) / all
                : 1.0;
    note_stop(result, estimate);
    if (lights.ready())
      write_error_of_lights({{}, lights.known().lights(), lights.known().clamping()}, estimate.trace);
    if (!estimate.interrupted)
      look_at_rows(matrix, options, estimate.sums, numbers["columns"] + numbers["rows"], estimate.trace);
    if (options.on_estimate && !estimate.interrupted) options.on_estimate(estimate.sums);
    return estimate;
  }

 private:
  static void render(const SliceLights& lights, std::size_t s, Workspace& w, std::span<Rgb> sums) {
    const Timer timer;
    lights.choose(s, w.lights);
    const double chosen = timer.seconds();
    const auto rows = lights.slices().slice(s);
    w.entries.resize(rows.size());
    w.reader->set_rows(rows);
    for (const matrix::Index i : rows) sums[i] = Rgb(0);
    for (const matrix::ScaledColumn& c : w.lights.chosen) {
      w.reader->column(c.column, w.entries);
      for (std::size_t a = 0; a < rows.size(); ++a) sums[rows[a]] += c.scale * w.entries[a];
    }
    w.spent += rows.size() * w.lights.chosen.size();
    w.seconds_clustering += chosen;
    w.seconds_columns += timer.seconds() - chosen;
  }

  SliceLightSettings settings_;
};

}  // namespace

MethodInfo lightslice_info() {
  const std::string name = "lightslice";
  return {name,
          "Clusters columns for every slice of receivers on their own.",
          "Ou, Pellacini 2011, LightSlice: matrix slice sampling for the many-lights problem",
          parameters_of(fields()),
          [=](const SettingsMap& settings) -> std::unique_ptr<Method> {
            return std::make_unique<LightSlice>(read_settings(name, fields(), settings));
          },
          [](const SettingsMap&) -> std::size_t { return 0; }};
}

}  // namespace lumirank::methods
