#include "methods/lightcuts/block_painter.h"

#include <algorithm>
#include <cmath>

#include "base/timer.h"

namespace lumirank::methods {

using matrix::Index;
using matrix::Part;

namespace {
constexpr std::size_t kMost = ReconstructionCut::kMostSamples;
// Of a sample as far away as a block is wide, so that no receiver is left without weights.
constexpr float kLeastWeight = 0.01f;
}  // namespace

void BlockPainter::paint(const ImageBlocks& blocks, std::size_t unit, ReceiverCuts& cuts,
                         matrix::EntryReader& reader, std::span<Rgb> sums) {
  cut_corners(blocks, unit, cuts, reader);
  for (std::size_t which = 0; which < blocks.blocks(unit); ++which) {
    const ImageBlocks::Block block = blocks.block(unit, which);
    choose_samples(block);
    const auto corners = static_cast<std::size_t>(block.corner_count);
    const auto extra_rows = std::span(sample_rows_).subspan(corners);
    if (extras_.size() < extra_rows.size()) extras_.resize(extra_rows.size());
    cuts.cut(extra_rows, reader, [&](std::size_t k, const Cut& cut) { extras_[k].set(cut, tree_); });
    samples_.clear();
    for (std::size_t s = 0; s < sample_rows_.size(); ++s) {
      const auto corner = std::lower_bound(corner_rows_.begin(), corner_rows_.end(), sample_rows_[s]);
      samples_.push_back(s < corners ? &corners_[static_cast<std::size_t>(corner - corner_rows_.begin())]
                                     : &extras_[s - corners]);
    }
    const Timer timer;
    pending_.clear();
    for (const Index i : block.rows) {
      const auto own = std::find(sample_rows_.begin(), sample_rows_.end(), i);
      std::size_t count = 0;
      if (own != sample_rows_.end())
        sums[i] = samples_[static_cast<std::size_t>(own - sample_rows_.begin())]->sum;
      else
        pending_.push_back({samples_for(i, count), i});
    }
    std::sort(pending_.begin(), pending_.end(), [](const Pending& a, const Pending& b) {
      return a.samples != b.samples ? a.samples < b.samples : a.row < b.row;
    });
    for (std::size_t begin = 0, end = 0; begin < pending_.size(); begin = end) {
      while (end < pending_.size() && pending_[end].samples == pending_[begin].samples) ++end;
      reconstruct(std::span(pending_).subspan(begin, end - begin), reader, sums);
    }
    seconds_ += timer.seconds();
  }
}

void BlockPainter::cut_corners(const ImageBlocks& blocks, std::size_t unit, ReceiverCuts& cuts,
                               matrix::EntryReader& reader) {
  corner_rows_.clear();
  for (std::size_t which = 0; which < blocks.blocks(unit); ++which) {
    const ImageBlocks::Block block = blocks.block(unit, which);
    corner_rows_.insert(corner_rows_.end(), block.corners.begin(),
                        block.corners.begin() + block.corner_count);
  }
  std::sort(corner_rows_.begin(), corner_rows_.end());
  corner_rows_.erase(std::unique(corner_rows_.begin(), corner_rows_.end()), corner_rows_.end());
  if (corners_.size() < corner_rows_.size()) corners_.resize(corner_rows_.size());
  cuts.cut(corner_rows_, reader, [&](std::size_t k, const Cut& cut) { corners_[k].set(cut, tree_); });
}

// The block's corners, and as many of its receivers as it takes until each of the others has enough samples
// that are like it.
void BlockPainter::choose_samples(const ImageBlocks::Block& block) {
  sample_rows_.assign(block.corners.begin(), block.corners.begin() + block.corner_count);
  for (const std::uint32_t k : coarse_to_fine(block.rows.size())) {
    std::size_t count = 0;
    samples_for(block.rows[k], count);
    if (count < kFewestSamples &&
        std::find(sample_rows_.begin(), sample_rows_.end(), block.rows[k]) == sample_rows_.end())
      sample_rows_.push_back(block.rows[k]);
  }
}

BlockPainter::SampleList BlockPainter::samples_for(Index row, std::size_t& count) const {
  SampleList list;
  list.fill(kNoSample);
  count = 0;
  for (std::size_t s = 0; s < sample_rows_.size() && count < kMost; ++s)
    if (alike(features_, row, sample_rows_[s])) list[count++] = static_cast<std::uint16_t>(s);
  return list;
}

// Bilinear where the samples are the block's corners.
void BlockPainter::weigh(std::span<const Pending> rows, std::span<const CutSample* const> samples) {
  weights_.assign(kMost * rows.size(), 0);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    float sum = 0;
    float* w = &weights_[kMost * k];
    for (std::size_t s = 0; s < samples.size(); ++s) {
      const Vec2f a = features_.pixel[rows[k].row], b = features_.pixel[samples[s]->row];
      const auto tent = [](float x) { return std::max(0.0f, 1 - std::abs(x) / ImageBlocks::kSide); };
      w[s] = kLeastWeight + tent(a.x - b.x) * tent(a.y - b.y);
      sum += w[s];
    }
    for (std::size_t s = 0; s < samples.size(); ++s) w[s] /= sum;
  }
}

void BlockPainter::reconstruct(std::span<const Pending> rows, matrix::EntryReader& reader,
                               std::span<Rgb> sums) {
  std::array<const CutSample*, kMost> list;
  std::size_t count = 0;
  for (const std::uint16_t s : rows.front().samples)
    if (s != kNoSample) list[count++] = samples_[s];
  const auto samples = std::span<const CutSample* const>(list).first(count);
  found_.find(samples);
  weigh(rows, samples);

  rows_.clear();
  for (const Pending& p : rows) rows_.push_back(p.row), sums[p.row] = Rgb(0);
  if (!found_.shaded().empty()) reader.set_rows(rows_);
  values_.resize(rows_.size() + count);
  for (const auto& [node] : found_.shaded()) {
    const matrix::ScaledColumn column = tree_.scaled(node);
    reader.column(column.column, std::span(values_).first(rows.size()));
    for (std::size_t k = 0; k < rows.size(); ++k) sums[rows[k].row] += column.scale * values_[k];
  }
  shaded_ += found_.shaded().size() * rows.size();
  if (found_.interpolated().empty()) return;
  for (const CutSample* s : samples) rows_.push_back(s->row);
  reader.set_rows(rows_);
  for (const auto& [node, values] : found_.interpolated()) {
    const matrix::ScaledColumn column = tree_.scaled(node);
    reader.column(column.column, values_, Part::unoccluded);
    const auto there = std::span<const Rgb>(values_).subspan(rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k)
      sums[rows[k].row] +=
          interpolate(std::span(weights_).subspan(kMost * k, count), values, values_[k], there, column.scale);
  }
  interpolated_ += found_.interpolated().size() * rows.size();
}

}  // namespace lumirank::methods
