#include "methods/row_column/row_column.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/timer.h"
#include "methods/brute_force/brute_force.h"
#include "methods/column_pass.h"
#include "methods/row_column/exploration.h"
#include "methods/row_column/representatives.h"
#include "methods/row_column/settings.h"

namespace lumirank::methods {

namespace {

class RowColumnSampling final : public Method {
 public:
  explicit RowColumnSampling(const RowColumnSettings& settings) : settings_(settings) {}

  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    RowColumnSettings s = settings_;
    if (s.rows == 0) s.rows = 300;
    if (s.columns == 0) s.columns = 3 * s.rows;
    if (s.columns >= matrix.columns()) return sum_all_columns(matrix, options);
    return run_fixed(matrix, options, s);
  }

 private:
  static Estimate run_fixed(const matrix::LightingMatrix& matrix, const RunOptions& options,
                            const RowColumnSettings& s) {
    const Timer timer;
    Estimate estimate;
    auto& numbers = estimate.trace.numbers;
    estimate.sums.assign(matrix.rows(), Rgb(0));

    const auto rows = RowSampler(matrix, options.seed).stratified(s.rows);
    Exploration exploration(matrix, rows.size() > s.projection ? s.projection : 0, options.seed);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (options.sinks.cancelled()) {
        estimate.interrupted = true;
        return estimate;
      }
      exploration.read(rows[k]);
      options.sinks.report("rows", static_cast<double>(k + 1) / static_cast<double>(rows.size()));
    }
    numbers["seconds.rows"] = timer.seconds();

    std::vector<matrix::Index> lit, zero;
    for (std::size_t j = 0; j < matrix.columns(); ++j)
      (exploration.sketch().is_zero(j) ? zero : lit).push_back(static_cast<matrix::Index>(j));
    const auto features = matrix.column_features();
    const auto points = exploration.sketch().points();
    const auto norms = linalg::own_norms(points);
    const linalg::Splitter splitter =
        linalg::cluster(points, norms, lit, features.group, {s.clustering, s.columns, options.seed});
    const RepresentativeSettings choice{s.colour, options.seed, 0};
    Representatives chosen = choose_representatives(splitter.partition(), exploration.sketch(), choice);
    if (s.zero_columns == ZeroColumns::sample) {
      const double wanted = s.zero_share * static_cast<double>(s.columns);
      add_zero_columns(zero, features.power,
                       std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(wanted))), choice,
                       chosen);
    }
    numbers["seconds.clustering"] = timer.seconds() - numbers["seconds.rows"];
    numbers["predicted_error"] =
        exploration.squared_sum() > 0 ? std::sqrt(splitter.cost() / exploration.squared_sum()) : 0.0;

    double total_energy = 0;
    for (double e : chosen.energy) total_energy += e;
    const auto share_done = [&](std::size_t done) {
      double e = 0;
      for (std::size_t k = 0; k < done; ++k) e += chosen.energy[k];
      return e > 0 ? static_cast<float>(total_energy / e) : 1.0f;
    };
    PassControl control{options, timer, options.time_seconds, {}};
    if (options.on_estimate)
      control.on_block = [&](std::span<const Rgb> sums, std::size_t done) {
        options.on_estimate(scaled_sums(sums, share_done(done)));
      };
    const PassResult pass = render_columns(matrix, chosen.columns, control, estimate.sums);
    if (pass.done < chosen.columns.size()) {
      estimate.sums = scaled_sums(estimate.sums, share_done(pass.done));
      estimate.interrupted = pass.cancelled;
      estimate.trace.notes["stopped"] = pass.cancelled ? "cancelled" : "time budget";
    }
    if (options.on_estimate) options.on_estimate(estimate.sums);
    std::set<matrix::Index> distinct;
    for (std::size_t k = 0; k < pass.done; ++k) distinct.insert(chosen.columns[k].column);
    numbers["seconds.columns"] = pass.seconds;
    numbers["rows"] = static_cast<double>(exploration.rows());
    numbers["columns"] = static_cast<double>(distinct.size());
    numbers["clusters"] = static_cast<double>(splitter.clusters());
    numbers["zero_columns"] = static_cast<double>(zero.size());
    numbers["zero_columns_drawn"] = static_cast<double>(chosen.zero_columns);
    numbers["sampled_rows_error"] = exploration.measured_error(estimate.sums);
    const double m = static_cast<double>(matrix.rows()), n = static_cast<double>(matrix.columns());
    numbers["sampling_rate"] = numbers["rows"] / m + static_cast<double>(pass.done) / n;
    return estimate;
  }

  RowColumnSettings settings_;
};

}  // namespace

MethodInfo row_column_info() {
  const std::string name = "row-column-sampling";
  return {name,
          "Reads a few rows, clusters the columns by them, and renders one representative of each cluster.",
          "Hašan, Pellacini, Bala 2007, Matrix row-column sampling for the many-light problem",
          parameters_of(row_column_fields()),
          [=](const SettingsMap& settings) -> std::unique_ptr<Method> {
            return std::make_unique<RowColumnSampling>(read_settings(name, row_column_fields(), settings));
          },
          [](const SettingsMap&) -> std::size_t { return 0; }};
}

}  // namespace lumirank::methods
