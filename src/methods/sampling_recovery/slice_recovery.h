// One slice from its clusters to the sums of its receivers: reduced matrix, sampled and predicted visibility,
// separation, correction, gathering (Huo et al. 2015, sections 4 to 6).
#pragma once

#include <span>
#include <vector>

#include "linalg/density_map.h"
#include "linalg/separation.h"
#include "methods/sampling_recovery/prediction.h"
#include "methods/sampling_recovery/settings.h"
#include "methods/slice_cuts/slice_drawings.h"
#include "methods/slice_cuts/slice_tally.h"

namespace lumirank::methods {

// Sums over slices.
struct RecoveryTally : SliceTally {
  double seconds_separation = 0, seconds_correction = 0;
  std::uint64_t uncertain = 0;  // entries that were sampled because a guess would have cost much
  std::uint64_t corrected = 0;  // entries that were sampled by correction
  std::uint64_t rank = 0, iterations = 0, converged = 0;
  std::vector<std::uint64_t> converged_after;  // slices by the number of their iterations
  std::vector<double> residual;  // Σ over slices after each iteration; converged ones keep theirs
  PredictionTally prediction;

  RecoveryTally& operator+=(const RecoveryTally& o);
};

// Work space of one thread.
class SliceRecovery {
 public:
  SliceRecovery(const LightTree& tree, const matrix::LightingMatrix& matrix)
      : slice_(tree, matrix), drawings_(matrix.row_features()) {}

  // Writes the sums of the slice's receivers. Random numbers are keyed by `key`.
  void run(const RecoverySettings& settings, std::span<const matrix::Index> slice, std::uint64_t key,
           std::span<Rgb> sums);

  // Of the last slice, for those who inspect it: column after column, rows × columns.
  const SliceEntries& entries() const { return slice_.entries(); }
  std::span<const ReducedColumn> clusters() const { return slice_.columns(); }
  const SliceCut& cut() const { return slice_.cut(); }
  std::span<const float> unoccluded() const { return e_; }
  // Which columns were separated, and what of them was: the predicted matrix.
  std::span<const std::uint32_t> separated() const { return separated_; }
  linalg::CorruptedMatrix corrupted() const {
    return {entries().rows().size(), separated_.size(), d_, separated_state_, whole_};
  }
  std::span<const linalg::Entry> states() const { return state_; }  // after correction
  const linalg::Separation& separation() const { return separation_; }
  const linalg::DensityMap& density() const { return density_; }
  std::span<const float> visibility() const { return visibility_; }  // recovered, 0 … 1

  const RecoveryTally& tally() const { return tally_; }

 private:
  void assemble();
  void choose_separated();
  void recover(std::uint64_t key, std::span<Rgb> sums);
  void separate();
  void tally_separation();
  void resolve();
  void request_where_dense();
  void request_where_uncertain();
  void request_chosen(std::size_t column);
  void recover_visibility();

  RecoverySettings settings_;
  SliceColumns slice_;
  SliceDrawings drawings_;
  Prediction prediction_;
  linalg::Separation separation_;
  linalg::DensityMap density_;
  // What a visible entry of the separated matrix would be.
  std::vector<float> e_, d_, whole_, visibility_;
  std::vector<std::uint32_t> separated_;  // columns, ascending
  std::vector<linalg::Entry> separated_state_;
  std::vector<linalg::Entry> state_;
  std::vector<std::uint8_t> wrong_;   // by the separation
  std::vector<std::uint8_t> chosen_;  // of a column's entries: to be requested
  std::vector<float> row_sums_;
  std::vector<std::uint32_t> requested_;  // entries, until they are resolved
  RecoveryTally tally_;
};

}  // namespace lumirank::methods
