// The receivers of a square of the picture, most of them by reconstruction cuts between few cuts of their own
// (Walter et al. 2005, section 5).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "methods/lightcuts/image_blocks.h"
#include "methods/lightcuts/probe_responses.h"
#include "methods/lightcuts/receiver_cuts.h"
#include "methods/lightcuts/reconstruction.h"

namespace lumirank::methods {

// Work space of one thread.
class BlockPainter {
 public:
  // Fewer samples than this tell too little of shadows between them.
  static constexpr std::size_t kMinSamples = 3;

  // similarity: least cosine of the probe responses of receivers that learn from each other; see
  // probe_responses.h.
  BlockPainter(const matrix::LightingMatrix& matrix, const LightTree& tree, double tolerance,
               double similarity)
      : tree_(tree),
        features_(matrix.row_features()),
        min_similarity_(static_cast<float>(similarity)),
        responses_(tree),
        found_(tree, tolerance) {}

  // sums[i] of all rows of the row group.
  void paint(const ImageBlocks& blocks, std::size_t group, ReceiverCuts& cuts, matrix::EntryReader& reader,
             std::span<Rgb> sums);

  std::uint64_t shaded() const { return shaded_; }              // entries with rays
  std::uint64_t interpolated() const { return interpolated_; }  // entries without
  double seconds() const { return seconds_; }                   // of both and of finding them

 private:
  // Samples of the row group by number: its corners, then its extras.
  using Number = std::uint32_t;
  using SampleList = std::array<Number, ReconstructionCut::kMaxSamples>;
  static constexpr Number kNoSample = 0xffffffffu;
  // With its place among the row group's rows, which are followed by its corners.
  struct Receiver {
    matrix::Index row;
    std::size_t place;
  };
  struct Pending {
    SampleList samples;
    matrix::Index row;
  };

  // The corners of all blocks, and as many of their receivers as it takes until each of the others has enough
  // samples that are like it.
  void choose_samples(const ImageBlocks& blocks, std::size_t group, matrix::EntryReader& reader);
  void cut_samples(ReceiverCuts& cuts, matrix::EntryReader& reader);
  // For each receiver of the block its samples, or its own number if it is one.
  void assign(const ImageBlocks::Block& block, std::size_t first_place);
  // Whom receivers of a block may learn from: its corners, for the time being.
  void find_candidates(const ImageBlocks::Block& block);
  SampleList samples_for(const Receiver& receiver, std::size_t& count) const;
  void reconstruct(std::span<const Pending> rows, matrix::EntryReader& reader, std::span<Rgb> sums);
  void weigh(std::span<const Pending> rows, std::span<const CutSample* const> samples);

  const LightTree& tree_;
  matrix::RowFeatures features_;
  float min_similarity_;
  ProbeResponses responses_;
  ReconstructionCut found_;
  std::size_t corner_count_ = 0;
  std::vector<Receiver> receivers_;       // of the samples
  std::vector<CutSample> samples_;        // kept for their space: there may be more than receivers_
  std::vector<bool> used_;                // samples from which others learn; of others only sums are kept
  std::vector<std::uint32_t> block_end_;  // in pending_
  std::vector<Number> candidates_;
  std::vector<std::uint32_t> order_;  // in which a block's rows are visited
  std::vector<Pending> pending_;      // receivers that learn from samples, block by block
  struct Own {
    matrix::Index row;
    Number sample;
  };
  std::vector<Own> own_;  // receivers that are samples
  std::vector<matrix::Index> rows_;
  std::vector<float> weights_;  // kMaxSamples for each row
  std::vector<Rgb> values_;
  std::uint64_t shaded_ = 0, interpolated_ = 0;
  double seconds_ = 0;
};

}  // namespace lumirank::methods
