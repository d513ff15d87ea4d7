// A matrix of low rank out of one of which many entries are wrong: D = X·Y + Z with Z sparse, by the
// augmented Lagrangian alternating direction method with low-rank factors (Shen, Wen and Zhang 2014, section
// 2; applied to lighting matrices by Huo et al. 2015, section 6).
//
// Matrices lie column after column: entry (i, j) is at j·rows + i.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lumirank::linalg {

// What is known of an entry of D.
enum class Entry : std::uint8_t {
  exact,              // D is right
  predicted_visible,  // D = E is a guess: the truth may be 0
  predicted_hidden,   // D = 0 is a guess: the truth may be E
  free,               // D says nothing
};

struct SeparationSettings {
  std::size_t max_rank = 16;    // at most kMaxRank
  std::size_t iterations = 20;  // at most
  // Stops when ‖XY + Z − D‖ is below this share of ‖D‖, …
  double tolerance = 0.01;
  // … or, after four iterations, falls by less than this share of itself. 0: only the first.
  double min_progress = 0.1;
  // The soft threshold in units of the root mean square of D (the solver's 1/β).
  double threshold = 0.5;
  // Equation 12 of 2015: Z/E is 0 or ±1 by what was predicted, so H = 2·s·Z/E − 1 is ±1. Relaxed to the
  // Frobenius norm over the entries where Z ≠ 0 (where Z = 0 it holds by itself).
  bool constraint = true;
  // The paper prints the fit on exact entries alone, which may then err by a sparse Z, while predictions mean
  // nothing; by default all entries are fitted, exact ones without Z.
  enum class Fit { all, exact_only } fit = Fit::all;
  std::uint64_t seed = 1;
};

// All spans have rows × columns elements. `e` is what a visible entry would be, ≥ 0; needed for the
// constraint only.
struct CorruptedMatrix {
  std::size_t rows = 0, columns = 0;
  std::span<const float> d;
  std::span<const Entry> state;
  std::span<const float> e;
};

// Work space for one separation after another, one thread at a time: once it has grown to the largest matrix
// it allocates nothing.
class Separation {
 public:
  static constexpr std::size_t kMaxRank = 24;

  void run(const CorruptedMatrix& matrix, const SeparationSettings& settings);

  // Until the next run.
  std::size_t rank() const { return rank_; }
  std::size_t iterations() const { return residuals_.size(); }
  std::span<const double> residuals() const { return residuals_; }  // ‖XY + Z − D‖ / ‖D‖ after each iteration
  bool converged() const { return converged_; }
  std::span<const float> low_rank() const { return low_rank_; }  // X·Y
  std::span<const float> sparse() const { return z_; }           // Z; 0 at exact entries if all are fitted
  // Leading singular values as the rank was found from, descending.
  std::span<const double> leading_values() const { return values_; }

 private:
  void start(const CorruptedMatrix& matrix, const SeparationSettings& settings);
  double iterate(const CorruptedMatrix& matrix, const SeparationSettings& settings, float threshold);
  void project(const CorruptedMatrix& matrix, std::size_t at, std::size_t columns);
  void finish(const CorruptedMatrix& matrix);

  std::size_t rank_ = 0;
  bool converged_ = false;
  double norm_ = 0;    // ‖D‖
  float stretch_ = 1;  // of H, towards its sphere
  std::vector<double> residuals_, values_;
  std::vector<float> x_;         // rank × rows, orthonormal
  std::vector<float> gathered_;  // rank × rows: B·Yᵀ
  std::vector<float> y_;         // of a block of columns: columns × rank
  std::vector<float> block_, product_, scratch_;
  std::vector<float> z_, multiplier_, low_rank_;
};

}  // namespace lumirank::linalg
