// What clusters of lights are at rows: what their representatives are, but where one of these stands so close
// to a row, or in so sharp a lobe of it, that it is bright as nowhere that was read (ours; the paper takes
// the representative everywhere). There the cluster's lights are summed one by one, or its light would be a
// spot.
//
// Only what is too bright is found: what the same light lacks, spread thinly over rows that are close to its
// cluster's other lights, stays missing.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "matrix/entry_reader.h"
#include "methods/tensor_clustering/cluster_columns.h"

namespace lumirank::methods {

struct ClusterLight {
  matrix::Index column = 0;  // of the representative
  Rgb own{1};                // with which it stands for all the lights in the frame where it is computed,
  Rgb scale{1};              // and in the frame that it is for
  std::span<const std::uint32_t> lights;
  float most = kInfinity;  // of `own` times an entry: beyond, lights are summed one by one
};

// How bright clusters are expected to be.
class ClusterPeaks {
 public:
  // `mean_light`: of each frame. `max_peak`: the part of it that a cluster may add anywhere, whatever it is
  // at the rows that were read; 0: any.
  ClusterPeaks(const linalg::ReducedTensor& reduced, std::vector<float> mean_light, double max_peak)
      : reduced_(reduced), mean_light_(std::move(mean_light)), max_peak_(max_peak) {}

  // As its column is computed for its own frame.
  ClusterLight light(const ClusterColumn& cluster) const;
  // Computed in `frame` by `own`, to be scaled for another one.
  ClusterLight light(const ClusterColumn& cluster, const matrix::ScaledColumn& own, std::uint32_t frame,
                     const Rgb& scale) const;

 private:
  const linalg::ReducedTensor& reduced_;
  std::vector<float> mean_light_;
  double max_peak_;
};

// For one thread. What it says of a row does not depend on which others are set.
class ClusterReader {
 public:
  // `rows`: those that the reader has set, of `all` in the matrix.
  ClusterReader(matrix::EntryReader& reader, std::span<const matrix::Index> rows, std::size_t all)
      : reader_(reader), set_(rows), all_(all) {}

  // The representative's column, not scaled; at peaks, and near them where it is not much dimmer, the sum of
  // all lights over `own` instead.
  matrix::Cost read(const ClusterLight& cluster, std::span<Rgb> column);

 private:
  matrix::Cost find_peaks(const ClusterLight& cluster, std::span<const Rgb> column);
  bool has_peak(const ClusterLight& cluster, std::span<const Rgb> column, std::size_t place,
                matrix::Cost& cost);
  matrix::Cost sum_lights(const ClusterLight& cluster, std::span<Rgb> column);

  matrix::EntryReader& reader_;
  std::span<const matrix::Index> set_;
  std::size_t all_;
  std::vector<std::uint32_t> peaks_, rows_;
  std::vector<matrix::Index> columns_;
  std::vector<Rgb> sums_, entries_;
};

}  // namespace lumirank::methods
