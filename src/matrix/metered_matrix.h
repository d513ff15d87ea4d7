// A matrix that adds up what is spent on another one: for reports, comparisons, and clocks that go by the
// entry.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include "matrix/lighting_matrix.h"

namespace lumirank::matrix {

// Forwards every call and gives the same numbers. Any number of threads may call it, and ask for the total,
// which holds every call that has returned. The counts of a total are exact; its energies are added in the
// order in which calls return, so their last bits may differ from run to run: what decides a picture takes
// the cost of its own calls. The other matrix must outlive it, and it must outlive its readers.
class MeteredMatrix final : public LightingMatrix {
 public:
  explicit MeteredMatrix(const LightingMatrix& matrix);
  ~MeteredMatrix() override;

  Cost total() const;

  std::size_t rows() const override { return matrix_.rows(); }
  std::size_t columns() const override { return matrix_.columns(); }
  Cost row(Index i, std::span<Rgb> out, Part part = Part::value) const override;
  Cost column(Index j, std::span<Rgb> out, Part part = Part::value) const override;
  Cost block(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
             Part part = Part::value) const override;
  Cost entries(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
               Part part = Part::value) const override;
  Cost accumulate(std::span<const ScaledColumn> columns, std::span<Rgb> sums,
                  const Sinks& sinks = {}) const override;
  std::unique_ptr<EntryReader> reader() const override;
  Capabilities capabilities() const override { return matrix_.capabilities(); }
  ColumnSet column_set(Index j) const override { return matrix_.column_set(j); }
  std::unique_ptr<RowBounds> row_bounds() const override { return matrix_.row_bounds(); }
  RowFeatures row_features() const override { return matrix_.row_features(); }
  ColumnFeatures column_features() const override { return matrix_.column_features(); }

 private:
  // What one reader has spent so far: written by its thread alone, so that readers do not wait for each
  // other.
  struct alignas(64) Meter {
    std::array<std::atomic<std::uint64_t>, 3> counts{};
    std::array<std::atomic<double>, 3> energies{};
    void add(const Cost& cost);
    Cost read() const;
  };
  class Reader;

  Cost spend(const Cost& cost) const;

  const LightingMatrix& matrix_;
  mutable std::mutex mutex_;
  mutable Cost spent_;                                  // by calls, and by readers that have gone
  mutable std::vector<std::unique_ptr<Meter>> meters_;  // of readers that are there
};

}  // namespace lumirank::matrix
