// Visibility of a slice's entries from few samples: predictors are trained, tested on new samples, and the
// best of each column fills in the rest (Huo et al. 2015, section 5 and algorithm 2).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "linalg/separation.h"
#include "methods/common/visibility_predictors.h"
#include "methods/sampling_recovery/calibration.h"
#include "methods/sampling_recovery/settings.h"
#include "methods/slice_cuts/slice_entries.h"

namespace lumirank::methods {

// Sums over columns: what the trace tells.
struct PredictionTally {
  std::array<std::uint64_t, 3> chosen{};  // columns by predictor: nearest, plane, bayes
  std::uint64_t failed = 0;               // columns whose prediction passed no test
  double error = 0;                       // Σ over columns of their best predictor's last error
  std::uint64_t rounds = 0;               // Σ over columns

  PredictionTally& operator+=(const PredictionTally& o);
};

class Prediction {
 public:
  // `e`: unoccluded scalars, column after column. Writes the state of every entry. Errors are judged by
  // probabilities: a draw with probability p is wrong with |p − v|.
  void run(const RecoverySettings& settings, std::span<const ReducedColumn> clusters,
           std::span<const float> e, std::uint64_t key, SliceEntries& entries,
           std::span<linalg::Entry> state);
  // P(visible) of every entry: predicted, or 0 or 1 where it is known. Until the next run.
  std::span<const float> probabilities() const { return probabilities_; }
  // Whether samples of a column differ.
  bool mixed(std::size_t c) const {
    return columns_[c].visible > 0 && columns_[c].visible < columns_[c].known;
  }
  const PredictionTally& tally() const { return tally_; }

 private:
  enum Kind : std::size_t { nearest, plane, bayes };
  struct Column {
    std::uint32_t slot;
    std::uint32_t trained = 0;  // samples of the pattern that predictors know
    Kind best = nearest;
    float error = 0;
    float allowed = 0;                     // error
    std::uint32_t known = 0, visible = 0;  // of these
    std::size_t tested = 0;                // kind of its last test (Calibration)
    PlaneSums plane = {};
  };

  void learn(std::size_t c, std::size_t begin, std::size_t end, SliceEntries& entries);
  bool validate(const RecoverySettings& settings, std::size_t c, std::span<const float> e,
                SliceEntries& entries);
  void predict(std::size_t c, SliceEntries& entries, std::span<float> out);
  void fill(const RecoverySettings& settings, std::uint64_t key, std::span<const float> e,
            SliceEntries& entries, std::span<linalg::Entry> state);

  std::vector<Column> columns_;
  std::vector<std::uint32_t> active_, still_active_;
  BayesCounts counts_;
  std::vector<std::uint32_t> sample_rows_;
  std::vector<std::uint8_t> sample_visible_, drawn_;
  std::vector<float> probabilities_, stretch_probability_;
  std::vector<double> column_sums_;  // of e
  Calibration calibration_;
  PredictionTally tally_;
};

}  // namespace lumirank::methods
