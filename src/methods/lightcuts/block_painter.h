// The receivers of a square of the picture, most of them by reconstruction cuts between few cuts of their own
// (Walter et al. 2005, section 5).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "methods/lightcuts/image_blocks.h"
#include "methods/lightcuts/receiver_cuts.h"
#include "methods/lightcuts/reconstruction.h"

namespace lumirank::methods {

// Work space of one thread.
class BlockPainter {
 public:
  // Fewer samples than this tell too little of shadows between them.
  static constexpr std::size_t kFewestSamples = 3;

  BlockPainter(const matrix::LightingMatrix& matrix, const LightTree& tree, double agreement)
      : tree_(tree), features_(matrix.row_features()), found_(tree, agreement) {}

  // sums[i] of all rows of the unit.
  void paint(const ImageBlocks& blocks, std::size_t unit, ReceiverCuts& cuts, matrix::EntryReader& reader,
             std::span<Rgb> sums);

  std::uint64_t shaded() const { return shaded_; }              // entries with rays
  std::uint64_t interpolated() const { return interpolated_; }  // entries without
  double seconds() const { return seconds_; }                   // of both and of finding them

 private:
  using SampleList = std::array<std::uint16_t, ReconstructionCut::kMostSamples>;
  static constexpr std::uint16_t kNoSample = 0xffff;
  struct Pending {
    SampleList samples;  // by number within the block
    matrix::Index row;
  };

  void cut_corners(const ImageBlocks& blocks, std::size_t unit, ReceiverCuts& cuts,
                   matrix::EntryReader& reader);
  void choose_samples(const ImageBlocks::Block& block);
  SampleList samples_for(matrix::Index row, std::size_t& count) const;
  void reconstruct(std::span<const Pending> rows, matrix::EntryReader& reader, std::span<Rgb> sums);
  void weigh(std::span<const Pending> rows, std::span<const CutSample* const> samples);

  const LightTree& tree_;
  matrix::RowFeatures features_;
  ReconstructionCut found_;
  std::vector<matrix::Index> corner_rows_;   // of the unit, ascending
  std::vector<CutSample> corners_, extras_;  // extras: of the block; kept beyond it for their space
  std::vector<matrix::Index> sample_rows_;   // of the block: its corners, then its extras
  std::vector<const CutSample*> samples_;    // likewise
  std::vector<Pending> pending_;
  std::vector<matrix::Index> rows_;
  std::vector<float> weights_;  // kMostSamples for each row
  std::vector<Rgb> values_;
  std::uint64_t shaded_ = 0, interpolated_ = 0;
  double seconds_ = 0;
};

}  // namespace lumirank::methods
