// Tensor clustering: the row sums of all frames of a shot from few columns, each used in many frames (Hašan,
// Velázquez-Armendáriz, Pellacini, Bala 2008).
//
// 1. Some rows of every frame are read whole: the reduced tensor.
// 2. Light-frame pairs are clustered into rectangles of lights × frames: at first in lights alone, then by
//    splitting the costliest in lights or in time (linalg/rectangle_clustering.h).
// 3. In each one pair is the representative. Its column is computed in its frame, scaled per channel to the
//    cluster's lights in every frame of the rectangle, and carried there by mappings of rows
//    (cluster_columns.h, row_mapping.h).
//
// Ours: columns of one frame that are carried to the same other frame are added up before they are carried,
// since that is linear, so each pair of frames is mapped once. Light is divided by the diffuse reflectance on
// the way. What must not be carried is shaded afresh: rows that were hidden, and rows whose light has changed
// (changed_rows.h). Where a representative stands too close, its cluster's lights are summed one by one
// (cluster_reader.h). At last each frame is averaged with its neighbors where light changes evenly
// (temporal_filter.h). Rows that no clustering knows tell the error (test_rows.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "linalg/rectangle_clustering.h"
#include "matrix/lighting_tensor.h"
#include "methods/method.h"
#include "methods/tensor_clustering/cluster_columns.h"

namespace lumirank::methods {

// Whether a cluster is computed once, and its column carried to its other frames along the mappings (the
// paper), or computed in each of its frames. Carried light is cheap where clusters last for many frames;
// where the camera moves they last for few, and light comes from the nearest row, which shows another place.
enum class Carrying {
  automatic,  // ours: carried unless clusters last for so few frames on average that it saves little
  always,
  never,
};

struct TensorClusteringSettings {
  std::size_t rows = 100;       // of every frame
  bool two_of_a_place = false;  // where several rows have one place on the film (pieces of an eye ray)
  std::size_t columns = 200;    // clusters per frame, in the mean; never carried: that act in a frame
  // Of lights, in all frames; at most a quarter of all clusters, so that there is something to split. The
  // paper has 100.
  std::size_t initial_clusters = 1000;
  std::size_t projection = 50;  // dimensions of the initial clustering; 0: none
  double time_weight = 1;       // see RectangleClustering
  // With a target error light is always carried.
  Carrying carrying = Carrying::automatic;
  // Rows whose mapping is longer than so many distances of neighboring rows (in large pictures of more, see
  // reaches()) show something that was hidden: they are shaded afresh, by each cluster as its own frame has
  // it. Ours; 0: mappings carry everything.
  double max_distance = 10;
  // By how large a part of a row's light that which is carried may differ from what is found in its own
  // frame; else the row and those around it are shaded afresh. Ours; 0: mappings carry everything.
  double max_change = 0.05;
  // Beyond which part of a frame's mean light a cluster is summed light by light, where it is a peak
  // (cluster_reader.h). Ours; 0: nowhere.
  double max_peak = 0.02;
  // Passes that average light with one frame on either side along the mappings, so that errors do not flicker
  // (temporal_filter.h). Ours; 0: none.
  std::size_t filter = 1;
  // Relative error of the rows that no clustering knows, over all frames: the number of columns (up to
  // `max_columns` for each frame) and of rows (up to `max_rows`) is found for it. 0: as given.
  double target_error = 0;
  std::size_t max_columns = 2000, max_rows = 400;
  RepresentativeRule representatives = RepresentativeRule::central;
  linalg::ReducedTensor::Precision precision = linalg::ReducedTensor::Precision::bits16;
  bool keep_rectangles = false;  // TensorEstimate::rectangles
};

struct TensorEstimate {
  std::vector<std::vector<Rgb>> sums;  // of every frame, one per row of it
  std::size_t clusters = 0;
  std::vector<std::size_t> active;  // clusters that contribute to each frame: the effective number
  bool carried = true;              // from frame to frame; else every frame was shaded by itself
  double predicted_error = -1;      // with a target error: that of the test rows; below 0: not known
  double cost = 0;                  // of the clustering
  std::vector<linalg::RectangleClustering::Rectangle> rectangles;  // the clusters, if they are to be kept
  matrix::Cost spent;
  Trace trace;
  bool interrupted = false;
};

TensorEstimate estimate_tensor(const matrix::LightingTensor& tensor, const TensorClusteringSettings& settings,
                               const RunOptions& options);

}  // namespace lumirank::methods
