// One slice from its clusters to the sums of its receivers: reduced matrix, sampled and predicted visibility,
// separation, correction, gathering (Huo et al. 2015, sections 4 to 6).
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "linalg/density_map.h"
#include "linalg/separation.h"
#include "methods/sampling_recovery/prediction.h"
#include "methods/sampling_recovery/settings.h"
#include "methods/sampling_recovery/slice_cut.h"
#include "methods/sampling_recovery/slice_entries.h"

namespace lumirank::methods {

// Sums over slices.
struct RecoveryTally {
  static constexpr std::array<const char*, 6> kSteps{"cut",        "splitting",  "prediction",
                                                     "separation", "correction", "gather"};
  std::array<double, kSteps.size()> seconds{};
  std::uint64_t slices = 0, rows = 0, columns = 0, columns_most = 0;
  std::uint64_t shades = 0;     // unoccluded entries, per receiver
  std::uint64_t entries = 0;    // of the reduced matrices
  std::uint64_t sampled = 0;    // of these, exactly evaluated visibilities; with those of splitting
  std::uint64_t uncertain = 0;  // of these, because a guess would have cost much
  std::uint64_t corrected = 0;  // of these, by correction
  std::uint64_t rank = 0, iterations = 0, converged = 0;
  std::vector<std::uint64_t> converged_after;  // slices by the number of their iterations
  std::vector<double> residual;  // Σ over slices after each iteration; converged ones keep theirs
  PredictionTally prediction;

  RecoveryTally& operator+=(const RecoveryTally& o);
};

// Work space of one thread.
class SliceRecovery {
 public:
  // tree: for those who leave the choice of columns to it.
  SliceRecovery(const RecoverySettings& settings, const LightTree* tree, const matrix::LightingMatrix& matrix)
      : settings_(settings), entries_(matrix) {
    if (!tree) return;
    cut_.emplace(*tree, matrix);
    scouts_.emplace(matrix);
  }

  void use(const RecoverySettings& settings) { settings_ = settings; }
  // Writes the sums of the slice's receivers. Random numbers are keyed by `key`.
  void run(std::span<const matrix::Index> slice, std::uint64_t key, std::span<Rgb> sums);
  // With these columns instead of its own choice.
  void run(std::span<const matrix::Index> slice, std::span<const matrix::ScaledColumn> columns,
           std::uint64_t key, std::span<Rgb> sums);

  // Of the last slice, for those who look into it: column after column, rows × columns.
  const SliceEntries& entries() const { return entries_; }
  std::span<const ReducedColumn> clusters() const { return reduced_; }
  const SliceCut& cut() const { return *cut_; }  // where the columns are its own choice
  std::span<const float> unoccluded() const { return e_; }
  // Which columns were separated, and what of them was: the predicted matrix.
  std::span<const std::uint32_t> separated() const { return separated_; }
  linalg::CorruptedMatrix corrupted() const {
    return {entries_.rows().size(), separated_.size(), d_, separated_state_, whole_};
  }
  std::span<const linalg::Entry> states() const { return state_; }  // after correction
  const linalg::Separation& separation() const { return separation_; }
  const linalg::DensityMap& density() const { return density_; }
  std::span<const float> visibility() const { return visibility_; }  // recovered, 0 … 1

  const RecoveryTally& tally() const { return tally_; }

 private:
  class Steps;
  void recover(Steps& steps, std::uint64_t key, std::span<Rgb> sums);
  void choose_columns(std::uint64_t key);
  void evaluate();
  void trace();
  void assemble();
  void choose_separated();
  void separate();
  void look();
  void ask_where_dense();
  void ask_where_uncertain();
  void ask_chosen(std::size_t column);
  void recover_visibility();
  void gather(std::span<Rgb> sums);

  RecoverySettings settings_;
  SliceEntries entries_;
  // Few of the slice's rows, by which its columns are chosen.
  std::optional<SliceEntries> scouts_;
  std::vector<matrix::Index> scout_receivers_;
  bool scouted_ = false;
  std::optional<SliceCut> cut_;
  Prediction prediction_;
  linalg::Separation separation_;
  linalg::DensityMap density_;
  // What a visible entry of the separated matrix would be.
  std::vector<float> e_, d_, whole_, visibility_;
  std::vector<std::uint32_t> separated_;  // columns, ascending
  std::vector<linalg::Entry> separated_state_;
  std::vector<linalg::Entry> state_;
  std::vector<std::uint8_t> wrong_;   // by the separation
  std::vector<std::uint8_t> chosen_;  // of a column's entries: to be asked for
  std::vector<float> row_sums_;
  std::vector<std::uint32_t> asked_;  // entries that correction asked for
  std::vector<ReducedColumn> reduced_;
  std::vector<matrix::ScaledColumn> columns_;
  std::vector<Rgb> gathered_;
  RecoveryTally tally_;
};

}  // namespace lumirank::methods
