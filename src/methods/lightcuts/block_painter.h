// The receivers of a square of the picture, most of them by reconstruction cuts between few cuts of their own
// (Walter et al. 2005, section 5).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "methods/lightcuts/answers.h"
#include "methods/lightcuts/image_blocks.h"
#include "methods/lightcuts/receiver_cuts.h"
#include "methods/lightcuts/reconstruction.h"

namespace lumirank::methods {

// Work space of one thread.
class BlockPainter {
 public:
  // Fewer samples than this tell too little of shadows between them.
  static constexpr std::size_t kFewestSamples = 3;

  // `likeness`: least cosine of the answers of receivers that learn from each other; see answers.h.
  BlockPainter(const matrix::LightingMatrix& matrix, const LightTree& tree, double agreement, double likeness)
      : tree_(tree),
        features_(matrix.row_features()),
        least_likeness_(static_cast<float>(likeness)),
        answers_(tree),
        found_(tree, agreement) {}

  // sums[i] of all rows of the unit.
  void paint(const ImageBlocks& blocks, std::size_t unit, ReceiverCuts& cuts, matrix::EntryReader& reader,
             std::span<Rgb> sums);

  std::uint64_t shaded() const { return shaded_; }              // entries with rays
  std::uint64_t interpolated() const { return interpolated_; }  // entries without
  double seconds() const { return seconds_; }                   // of both and of finding them

 private:
  using SampleList = std::array<std::uint16_t, ReconstructionCut::kMostSamples>;
  static constexpr std::uint16_t kNoSample = 0xffff;
  // With its place among the unit's rows, which are followed by its corners.
  struct Receiver {
    matrix::Index row;
    std::size_t place;
  };
  struct Pending {
    SampleList samples;  // by number within the block
    matrix::Index row;
  };

  void cut_corners(const ImageBlocks& blocks, std::size_t unit, ReceiverCuts& cuts,
                   matrix::EntryReader& reader);
  void choose_samples(const ImageBlocks::Block& block, std::size_t first_place, std::size_t corner_place);
  bool alike_in_all(const Receiver& a, const Receiver& b) const;
  SampleList samples_for(const Receiver& receiver, std::size_t& count) const;
  void reconstruct(std::span<const Pending> rows, matrix::EntryReader& reader, std::span<Rgb> sums);
  void weigh(std::span<const Pending> rows, std::span<const CutSample* const> samples);

  const LightTree& tree_;
  matrix::RowFeatures features_;
  float least_likeness_;
  Answers answers_;
  ReconstructionCut found_;
  std::vector<matrix::Index> corner_rows_;   // of the unit, ascending
  std::vector<CutSample> corners_, extras_;  // extras: of the block; kept beyond it for their space
  std::vector<Receiver> sample_rows_;        // of the block: its corners, then its extras
  std::vector<const CutSample*> samples_;    // likewise
  std::vector<Pending> pending_;
  std::vector<matrix::Index> rows_, extra_rows_;
  std::vector<float> weights_;  // kMostSamples for each row
  std::vector<Rgb> values_;
  std::uint64_t shaded_ = 0, interpolated_ = 0;
  double seconds_ = 0;
};

}  // namespace lumirank::methods
