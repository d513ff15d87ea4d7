// Runs matrix sampling and recovery slice by slice and compares what happens inside with the truth, for
// inspect_recovery.cpp.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "image/image.h"
#include "matrix/entry_reader.h"
#include "methods/common/row_group_pass.h"
#include "methods/common/slices/slices.h"
#include "methods/sampling_recovery/settings.h"
#include "methods/sampling_recovery/slice_recovery.h"
#include "methods/slice_cuts/slice_run.h"

namespace lumirank::bench {

using json = nlohmann::json;

inline constexpr std::array<const char*, 4> kPredictors{"nearest", "plane", "bayes", "all"};
inline constexpr std::size_t kIterations = 20;
inline constexpr float kNothing = -1;  // no receiver in a pixel, no light at an entry

struct InspectOptions {
  std::string scene, folder;
  int width = 400, height = 300, spp = 4, threads = 0;
  std::size_t lights = 20000;
  std::uint64_t seed = 1;
  methods::SettingsMap settings{{"parameters", "given"}};
};

// Shares of entries and of light: an entry weighs what it would bring if it were visible.
struct Wrong {
  double entries = 0, wrong = 0, light = 0, wrong_light = 0;
  void add(double error, float e) {
    entries += 1, wrong += error, light += static_cast<double>(e);
    wrong_light += error * static_cast<double>(e);
  }
  void operator+=(const Wrong& o) {
    entries += o.entries, wrong += o.wrong, light += o.light, wrong_light += o.wrong_light;
  }
  double share() const { return entries > 0 ? wrong / entries : 0; }
  json summary() const {
    return {{"entries", entries}, {"wrong", share()}, {"wrong_light", light > 0 ? wrong_light / light : 0}};
  }
};

struct Predicted {
  Wrong wrong;  // of what was not sampled
  double sampled = 0;
  std::array<double, 3> chosen{};  // columns
  double failed = 0;
};

// What is found of one slice. Entries: those that light would reach if nothing were in the way.
struct Findings {
  double rows = 0, columns = 0, all_entries = 0, entries = 0, hidden = 0, mixed = 0;
  std::array<Predicted, 4> adaptive, equal;
  double sampled = 0, uncertain = 0, corrected = 0;  // entries
  double rank = 0, iterations = 0, nonzero = 0;      // Z ≠ 0 by half an entry
  bool converged = false;
  // ‖XY + Z − D‖ / ‖D‖: as the method stops; through all iterations; the same with the fit as printed; the
  // same as the method is set, but for Z, which entries that were sampled may have, too.
  std::vector<double> residuals, endless, printed, everywhere;
  Wrong drawn, separated;                                                   // guesses, before and after
  double light = 0, error_drawn = 0, error_separated = 0, error_final = 0;  // Σ over rows of |sum − truth|
  double bias_drawn = 0, bias_separated = 0, bias_final = 0;                // of sum − truth
};

// One thread's.
struct Workspace {
  methods::SliceRecovery recovery;
  std::unique_ptr<matrix::EntryReader> reader;
  linalg::Separation endless;
  std::vector<std::uint32_t> places;
  std::vector<matrix::Index> columns;
  std::vector<Rgb> answers;
  std::vector<float> truth, drawn, separated;
};

class RecoveryInspector {
 public:
  // The matrix must outlive it.
  RecoveryInspector(const InspectOptions& options, const matrix::LightingMatrix& matrix);

  // All slices, on all threads.
  void inspect();
  const std::vector<Rgb>& sums() const { return sums_; }  // of the method as it is set
  // Of predictors; numbers about them.
  json write_pictures() const;
  // Numbers about slices, separations and what recovery brings.
  json summary() const;
  // The slice at the quantile q of the share of entries in the minority of their column.
  std::size_t slice_at(double q) const;
  // One slice's matrices as pictures NAME_…; numbers about it.
  json write_matrices(std::size_t s, const std::string& name);

 private:
  methods::RecoverySettings alone(std::size_t predictor, bool equal) const;
  void run(const methods::RecoverySettings& settings, std::size_t s, Workspace& w);
  void find_truth(Workspace& w) const;
  void judge(std::size_t s, Workspace& w, const methods::RecoverySettings& settings, Predicted& out);
  void separate_endlessly(Workspace& w, Findings& f) const;
  void compare_rows(Workspace& w, Findings& f, std::vector<double>& right) const;
  void inspect_slice(std::size_t s, Workspace& w);
  image::Image paint(const std::function<Rgb(const Findings&)>& value) const;
  void write(const std::string& name, const image::Image& image) const;

  InspectOptions options_;
  methods::RecoverySettings settings_;
  const matrix::LightingMatrix& matrix_;
  methods::LightTree tree_;
  methods::Slices slices_;
  std::vector<Rgb> sums_;
  methods::WorkspacePool<Workspace> pool_;
  std::vector<Findings> findings_;
};

}  // namespace lumirank::bench
