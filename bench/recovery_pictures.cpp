// What was found, as pictures and numbers.
#include <algorithm>
#include <filesystem>
#include <limits>

#include "image/pfm.h"
#include "linalg/svd.h"
#include "recovery_inspector.h"

namespace lumirank::bench {

using linalg::Entry;
using matrix::Index;
using methods::RecoverySettings;
using methods::SliceRecovery;

void RecoveryInspector::write(const std::string& name, const image::Image& image) const {
  image::write_pfm((std::filesystem::path(options_.folder) / (name + ".pfm")).string(), image);
}

// A pixel gets the mean of its receivers' slices.
image::Image RecoveryInspector::paint(const std::function<Rgb(const Findings&)>& value) const {
  image::Image image(options_.width, options_.height), count = image;
  const auto pixel = matrix_.row_features().pixel;
  for (std::size_t s = 0; s < slices_.count(); ++s)
    for (const Index i : slices_.slice(s)) {
      const int x = std::clamp(static_cast<int>(pixel[i].x), 0, options_.width - 1);
      const int y = std::clamp(static_cast<int>(pixel[i].y), 0, options_.height - 1);
      image.at(x, y) += value(findings_[s]);
      count.at(x, y) += Rgb(1);
    }
  for (std::size_t k = 0; k < image.pixels.size(); ++k)
    image.pixels[k] = count.pixels[k].r > 0 ? image.pixels[k] * (1.0f / count.pixels[k].r) : Rgb(kNothing);
  return image;
}

namespace {

// Columns by the predictor that was best. Columns that reach hardly any row have no test, and count as
// nearest even where another predictor stands alone: they are left out.
std::array<double, 3> chosen_by_test(const Findings& f, bool equal) {
  auto chosen = (equal ? f.equal : f.adaptive)[3].chosen;
  chosen[0] -= (equal ? f.equal : f.adaptive)[1].chosen[0];
  return chosen;
}

}  // namespace

json RecoveryInspector::write_pictures() const {
  json report = json::object();
  for (std::size_t k = 0; k < kPredictors.size(); ++k)
    for (const bool equal : {false, true}) {
      const std::string name = std::string(equal ? "wrong_equal_" : "wrong_") + kPredictors[k];
      write(name, paint([&](const Findings& f) {
              return Rgb(static_cast<float>((equal ? f.equal : f.adaptive)[k].wrong.share()));
            }));
      Predicted sum;
      double entries = 0, columns = 0, best = 0, tested = 0;
      for (const Findings& f : findings_) {
        const Predicted& p = (equal ? f.equal : f.adaptive)[k];
        sum.wrong += p.wrong, sum.sampled += p.sampled, sum.failed += p.failed;
        const auto chosen = chosen_by_test(f, equal);
        for (std::size_t c = 0; c < 3; ++c) sum.chosen[c] += chosen[c], tested += chosen[c];
        entries += f.entries, columns += f.columns;
        // Slices where it alone is the best of the three.
        const auto& three = equal ? f.equal : f.adaptive;
        if (k < 3 && std::ranges::all_of(std::array<std::size_t, 3>{0, 1, 2}, [&](std::size_t o) {
              return o == k || p.wrong.share() < three[o].wrong.share();
            }))
          best += 1;
      }
      json& j = report[name] = sum.wrong.summary();
      j["sampled"] = sum.sampled / entries;
      j["failed_columns"] = sum.failed / columns;
      j["best_in_slices"] = best / static_cast<double>(findings_.size());
      if (k < 3) continue;
      j["tested_columns"] = tested / columns;
      j["columns"] = {{"nearest", sum.chosen[0] / tested},
                      {"plane", sum.chosen[1] / tested},
                      {"bayes", sum.chosen[2] / tested}};
    }
  write("choice", paint([](const Findings& f) {
          const auto chosen = chosen_by_test(f, false);
          const double tested = chosen[0] + chosen[1] + chosen[2];
          const auto share = [&](std::size_t c) {
            return static_cast<float>(chosen[c] / std::max(tested, 1.0));
          };
          return Rgb{share(0), share(2), share(1)};
        }));
  write("mixed",
        paint([](const Findings& f) { return Rgb(static_cast<float>(f.mixed / std::max(f.entries, 1.0))); }));
  return report;
}

namespace {

// After how many iterations the method's rule (linalg/separation.h) would stop.
std::size_t stop(const std::vector<double>& residuals) {
  const linalg::SeparationSettings s;
  for (std::size_t k = 0; k < residuals.size(); ++k)
    if (residuals[k] < s.tolerance || (k > 2 && residuals[k] > (1 - s.min_progress) * residuals[k - 1]))
      return k + 1;
  return residuals.size();
}

}  // namespace

json RecoveryInspector::summary() const {
  json slices = json::array();
  std::vector<double> residual(kIterations), endless(kIterations), printed(kIterations),
      everywhere(kIterations);
  std::vector<double> stopped(settings_.iterations + 1), stopped_printed(kIterations + 1);
  double counted = 0;
  json sum = json::object();
  const auto add = [&](const char* key, double value) { sum[key] = sum.value(key, 0.0) + value; };
  Wrong drawn, separated;
  for (const Findings& f : findings_) {
    slices.push_back({{"rows", f.rows},
                      {"columns", f.columns},
                      {"hidden", f.hidden / std::max(f.entries, 1.0)},
                      {"mixed", f.mixed / std::max(f.entries, 1.0)},
                      {"rank", f.rank},
                      {"iterations", f.iterations},
                      {"converged", f.converged}});
    for (const auto& [key, value] : {std::pair{"rows", f.rows},
                                     {"columns", f.columns},
                                     {"rank", f.rank},
                                     {"all_entries", f.all_entries},
                                     {"entries", f.entries},
                                     {"hidden", f.hidden},
                                     {"mixed", f.mixed},
                                     {"sampled", f.sampled},
                                     {"uncertain", f.uncertain},
                                     {"corrected", f.corrected},
                                     {"nonzero", f.nonzero},
                                     {"light", f.light},
                                     {"error_drawn", f.error_drawn},
                                     {"error_separated", f.error_separated},
                                     {"error_final", f.error_final},
                                     {"bias_drawn", f.bias_drawn},
                                     {"bias_separated", f.bias_separated},
                                     {"bias_final", f.bias_final},
                                     {"converged", f.converged ? 1.0 : 0.0}})
      add(key, value);
    drawn += f.drawn, separated += f.separated;
    if (f.residuals.empty()) continue;
    counted += 1;
    stopped[f.residuals.size()] += 1;
    stopped_printed[stop(f.printed)] += 1;
    for (std::size_t k = 0; k < kIterations; ++k) {
      residual[k] += f.residuals[std::min(k, f.residuals.size() - 1)];
      endless[k] += f.endless[std::min(k, f.endless.size() - 1)];
      printed[k] += f.printed[std::min(k, f.printed.size() - 1)];
      everywhere[k] += f.everywhere[std::min(k, f.everywhere.size() - 1)];
    }
  }
  for (auto* r : {&residual, &endless, &printed, &everywhere})
    for (double& x : *r) x /= std::max(counted, 1.0);
  return {{"per_slice", slices},
          {"sums", sum},
          {"guesses_drawn", drawn.summary()},
          {"guesses_separated", separated.summary()},
          {"convergence",
           {{"slices", counted},
            {"slices_by_iterations", stopped},
            {"residual", residual},
            {"residual_without_stopping", endless},
            {"residual_as_printed", printed},
            {"residual_with_sparse_everywhere", everywhere},
            {"slices_by_iterations_as_printed", stopped_printed}}}};
}

std::size_t RecoveryInspector::slice_at(double q) const {
  std::vector<std::size_t> order(findings_.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  const auto mixed = [&](std::size_t s) { return findings_[s].mixed / std::max(findings_[s].entries, 1.0); };
  std::ranges::stable_sort(order, {}, mixed);
  return order[static_cast<std::size_t>(q * static_cast<double>(order.size() - 1))];
}

json RecoveryInspector::write_matrices(std::size_t s, const std::string& name) {
  methods::WorkspacePool<Workspace>::Lease lease(pool_);
  Workspace& w = *lease;
  std::vector<Rgb> sums = sums_;
  const auto run_with = [&](bool uncertain, bool correction) {
    RecoverySettings settings = settings_;
    if (!uncertain) settings.uncertain = 0;
    settings.correction = settings_.correction && correction;
    w.recovery.run(settings, slices_.slice(s), methods::slice_key(options_.seed, s), sums);
  };
  // 0: guessed, 1: sampled, 2: because a guess would cost much, 3: by correction.
  std::vector<float> sampled;
  const auto mark = [&](float code) {
    const auto states = w.recovery.states();
    sampled.resize(states.size());
    for (std::size_t at = 0; at < states.size(); ++at)
      if (states[at] == Entry::exact && !(sampled[at] > 0)) sampled[at] = code;
  };
  run_with(false, false), mark(1);
  run_with(true, false), mark(2);
  run_with(true, true), mark(3);
  find_truth(w);
  const auto e = w.recovery.unoccluded();
  const std::size_t rows = w.recovery.entries().rows().size(), columns = w.recovery.clusters().size();
  const auto matrix_picture = [&](const std::string& what, const auto& value) {
    image::Image image(static_cast<int>(columns), static_cast<int>(rows));
    for (std::size_t at = 0; at < e.size(); ++at)
      image.at(static_cast<int>(at / rows), static_cast<int>(at % rows)) =
          e[at] > 0 ? Rgb(value(at)) : Rgb(std::numeric_limits<float>::quiet_NaN());
    write(name + "_" + what, image);
  };
  const SliceRecovery& r = w.recovery;
  matrix_picture("sampled", [&](std::size_t at) { return sampled[at]; });
  matrix_picture("reference", [&](std::size_t at) { return w.truth[at]; });
  matrix_picture("recovered", [&](std::size_t at) { return r.visibility()[at]; });
  matrix_picture("error", [&](std::size_t at) { return r.visibility()[at] - w.truth[at]; });
  matrix_picture("light_reference", [&](std::size_t at) { return e[at] * w.truth[at]; });
  matrix_picture("light_recovered", [&](std::size_t at) { return e[at] * r.visibility()[at]; });
  matrix_picture("light_error", [&](std::size_t at) { return e[at] * (r.visibility()[at] - w.truth[at]); });
  if (settings_.separation) {
    // Of the columns that were separated; the others stay empty.
    std::vector<std::size_t> place(columns, columns);
    for (std::size_t k = 0; k < r.separated().size(); ++k) place[r.separated()[k]] = k;
    const auto of_separated = [&](std::span<const float> values) {
      return [&, values](std::size_t at) {
        const std::size_t k = place[at / rows];
        return k < columns ? values[k * rows + at % rows] : std::numeric_limits<float>::quiet_NaN();
      };
    };
    matrix_picture("predicted", of_separated(r.corrupted().d));
    matrix_picture("low_rank", of_separated(r.separation().low_rank()));
    matrix_picture("sparse", of_separated(r.separation().sparse()));
    if (settings_.correction) matrix_picture("density", of_separated(r.density().density()));
  }
  // Columns after columns are rows of the transposed matrix, which has the same values.
  std::vector<float> seen(e.size()), lit(e.size());
  for (std::size_t at = 0; at < e.size(); ++at)
    seen[at] = std::max(w.truth[at], 0.0f), lit[at] = seen[at] * e[at];
  const Findings& f = findings_[s];
  const double entries = std::max(f.entries, 1.0);
  image::Image where = paint([&](const Findings& g) { return Rgb(&g == &f ? 1.0f : 0.0f); });
  for (Rgb& p : where.pixels)
    if (p.r < 0) p = Rgb(0);
  write(name + "_where", where);
  return {{"slice", s},
          {"rows", rows},
          {"columns", columns},
          {"hidden", f.hidden / entries},
          {"mixed", f.mixed / entries},
          {"rank", f.rank},
          {"iterations", f.iterations},
          {"converged", f.converged},
          {"sampled", f.sampled / entries},
          {"uncertain", f.uncertain / entries},
          {"corrected", f.corrected / entries},
          {"nonzero", f.nonzero / entries},
          {"residuals", f.residuals},
          {"endless_residuals", f.endless},
          {"error_drawn", f.error_drawn / f.light},
          {"error_separated", f.error_separated / f.light},
          {"error_final", f.error_final / f.light},
          {"guesses_drawn", f.drawn.summary()},
          {"guesses_separated", f.separated.summary()},
          {"singular_values",
           {{"visibility", linalg::singular_values(seen, columns, rows)},
            {"light", linalg::singular_values(lit, columns, rows)},
            {"unoccluded", linalg::singular_values(e, columns, rows)}}}};
}

}  // namespace lumirank::bench
