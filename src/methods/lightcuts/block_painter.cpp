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
  const auto unit_rows = blocks.units()[unit];
  rows_.assign(unit_rows.begin(), unit_rows.end());
  rows_.insert(rows_.end(), corner_rows_.begin(), corner_rows_.end());
  answers_.ask(rows_, reader);
  for (std::size_t which = 0; which < blocks.blocks(unit); ++which) {
    const ImageBlocks::Block block = blocks.block(unit, which);
    const auto first_place = static_cast<std::size_t>(block.rows.data() - unit_rows.data());
    choose_samples(block, first_place, unit_rows.size());
    const auto corners = static_cast<std::size_t>(block.corner_count);
    extra_rows_.clear();
    for (const Receiver& r : std::span(sample_rows_).subspan(corners)) extra_rows_.push_back(r.row);
    if (extras_.size() < extra_rows_.size()) extras_.resize(extra_rows_.size());
    cuts.cut(extra_rows_, reader, [&](std::size_t k, const Cut& cut) { extras_[k].set(cut, tree_); });
    samples_.clear();
    for (std::size_t s = 0; s < sample_rows_.size(); ++s)
      samples_.push_back(s < corners ? &corners_[sample_rows_[s].place - unit_rows.size()]
                                     : &extras_[s - corners]);
    const Timer timer;
    pending_.clear();
    for (std::size_t k = 0; k < block.rows.size(); ++k) {
      const Index i = block.rows[k];
      const auto own = std::find_if(sample_rows_.begin(), sample_rows_.end(),
                                    [&](const Receiver& r) { return r.row == i; });
      std::size_t count = 0;
      if (own != sample_rows_.end())
        sums[i] = samples_[static_cast<std::size_t>(own - sample_rows_.begin())]->sum;
      else
        pending_.push_back({samples_for({i, first_place + k}, count), i});
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
void BlockPainter::choose_samples(const ImageBlocks::Block& block, std::size_t first_place,
                                  std::size_t corner_place) {
  sample_rows_.clear();
  for (const Index i : std::span(block.corners).first(static_cast<std::size_t>(block.corner_count))) {
    const auto corner = std::lower_bound(corner_rows_.begin(), corner_rows_.end(), i);
    sample_rows_.push_back({i, corner_place + static_cast<std::size_t>(corner - corner_rows_.begin())});
  }
  for (const std::uint32_t k : coarse_to_fine(block.rows.size())) {
    const Receiver receiver{block.rows[k], first_place + k};
    std::size_t count = 0;
    samples_for(receiver, count);
    if (count >= kFewestSamples) continue;
    const bool corner = std::any_of(sample_rows_.begin(), sample_rows_.end(),
                                    [&](const Receiver& r) { return r.row == receiver.row; });
    if (!corner) sample_rows_.push_back(receiver);
  }
}

bool BlockPainter::alike_in_all(const Receiver& a, const Receiver& b) const {
  return alike(features_, a.row, b.row) && answers_.likeness(a.place, b.place) >= least_likeness_;
}

BlockPainter::SampleList BlockPainter::samples_for(const Receiver& receiver, std::size_t& count) const {
  SampleList list;
  list.fill(kNoSample);
  count = 0;
  for (std::size_t s = 0; s < sample_rows_.size() && count < kMost; ++s)
    if (alike_in_all(receiver, sample_rows_[s])) list[count++] = static_cast<std::uint16_t>(s);
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
