#include "methods/lightcuts/block_painter.h"

#include <algorithm>
#include <cmath>

#include "base/timer.h"

namespace lumirank::methods {

using matrix::Index;
using matrix::Part;

namespace {
constexpr std::size_t kMax = ReconstructionCut::kMaxSamples;
// Of a sample as far away as a block is wide, so that no receiver is left without weights.
constexpr float kMinWeight = 0.01f;
}  // namespace

void BlockPainter::paint(const ImageBlocks& blocks, std::size_t group, ReceiverCuts& cuts,
                         matrix::EntryReader& reader, std::span<Rgb> sums) {
  choose_samples(blocks, group, reader);
  cut_samples(cuts, reader);
  for (const Own& own : own_) sums[own.row] = samples_[own.sample].sum;
  const Timer timer;
  std::size_t begin = 0, end = 0;
  for (const std::uint32_t block_end : block_end_)
    for (; begin < block_end; begin = end) {
      while (end < block_end && pending_[end].samples == pending_[begin].samples) ++end;
      reconstruct(std::span(pending_).subspan(begin, end - begin), reader, sums);
    }
  seconds_ += timer.seconds();
}

void BlockPainter::choose_samples(const ImageBlocks& blocks, std::size_t group, matrix::EntryReader& reader) {
  const auto group_rows = blocks.row_groups()[group];
  std::vector<Index>& corners = rows_;
  corners.clear();
  for (std::size_t which = 0; which < blocks.blocks(group); ++which) {
    const ImageBlocks::Block block = blocks.block(group, which);
    corners.insert(corners.end(), block.corners.begin(), block.corners.begin() + block.corner_count);
  }
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  corner_count_ = corners.size();
  receivers_.clear();
  for (std::size_t c = 0; c < corner_count_; ++c) receivers_.push_back({corners[c], group_rows.size() + c});
  corners.insert(corners.begin(), group_rows.begin(), group_rows.end());
  responses_.measure(rows_, reader);

  pending_.clear(), own_.clear(), block_end_.clear();
  for (std::size_t which = 0; which < blocks.blocks(group); ++which) {
    const ImageBlocks::Block block = blocks.block(group, which);
    const auto first_place = static_cast<std::size_t>(block.rows.data() - group_rows.data());
    find_candidates(block);
    if (order_.size() != block.rows.size()) order_ = coarse_to_fine(block.rows.size());
    for (const std::uint32_t k : order_) {
      const Receiver receiver{block.rows[k], first_place + k};
      std::size_t count = 0;
      samples_for(receiver, count);
      if (count >= kMinSamples) continue;
      const bool corner = std::any_of(candidates_.begin(), candidates_.end(),
                                      [&](Number s) { return receivers_[s].row == receiver.row; });
      if (corner) continue;
      candidates_.push_back(static_cast<Number>(receivers_.size()));
      receivers_.push_back(receiver);
    }
    assign(block, first_place);
  }
}

void BlockPainter::assign(const ImageBlocks::Block& block, std::size_t first_place) {
  const std::size_t begin = pending_.size();
  for (std::size_t k = 0; k < block.rows.size(); ++k) {
    const Index i = block.rows[k];
    const auto own = std::find_if(candidates_.begin(), candidates_.end(),
                                  [&](Number s) { return receivers_[s].row == i; });
    std::size_t count = 0;
    if (own != candidates_.end())
      own_.push_back({i, *own});
    else
      pending_.push_back({samples_for({i, first_place + k}, count), i});
  }
  std::sort(pending_.begin() + static_cast<std::ptrdiff_t>(begin), pending_.end(),
            [](const Pending& a, const Pending& b) {
              return a.samples != b.samples ? a.samples < b.samples : a.row < b.row;
            });
  block_end_.push_back(static_cast<std::uint32_t>(pending_.size()));
}

void BlockPainter::cut_samples(ReceiverCuts& cuts, matrix::EntryReader& reader) {
  used_.assign(receivers_.size(), false);
  for (const Pending& p : pending_)
    for (const Number s : p.samples)
      if (s != kNoSample) used_[s] = true;
  rows_.clear();
  for (const Receiver& r : receivers_) rows_.push_back(r.row);
  if (samples_.size() < rows_.size()) samples_.resize(rows_.size());
  cuts.cut(rows_, reader, [&](std::size_t k, const Cut& cut) {
    if (used_[k])
      samples_[k].set(cut, tree_);
    else
      samples_[k].sum = cut.total();
  });
}

void BlockPainter::find_candidates(const ImageBlocks::Block& block) {
  candidates_.clear();
  const auto corners = std::span<const Receiver>(receivers_).first(corner_count_);
  for (const Index i : std::span(block.corners).first(static_cast<std::size_t>(block.corner_count))) {
    const auto corner = std::lower_bound(corners.begin(), corners.end(), i,
                                         [](const Receiver& r, Index row) { return r.row < row; });
    candidates_.push_back(static_cast<Number>(corner - corners.begin()));
  }
}

BlockPainter::SampleList BlockPainter::samples_for(const Receiver& receiver, std::size_t& count) const {
  SampleList list;
  list.fill(kNoSample);
  count = 0;
  for (std::size_t s = 0; s < candidates_.size() && count < kMax; ++s) {
    const Receiver& sample = receivers_[candidates_[s]];
    if (alike(features_, receiver.row, sample.row) &&
        responses_.similarity(receiver.place, sample.place) >= min_similarity_)
      list[count++] = candidates_[s];
  }
  return list;
}

// Bilinear where the samples are the block's corners.
void BlockPainter::weigh(std::span<const Pending> rows, std::span<const CutSample* const> samples) {
  weights_.assign(kMax * rows.size(), 0);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    float sum = 0;
    float* w = &weights_[kMax * k];
    for (std::size_t s = 0; s < samples.size(); ++s) {
      const Vec2f a = features_.pixel[rows[k].row], b = features_.pixel[samples[s]->row];
      const auto tent = [](float x) { return std::max(0.0f, 1 - std::abs(x) / ImageBlocks::kSide); };
      w[s] = kMinWeight + tent(a.x - b.x) * tent(a.y - b.y);
      sum += w[s];
    }
    for (std::size_t s = 0; s < samples.size(); ++s) w[s] /= sum;
  }
}

void BlockPainter::reconstruct(std::span<const Pending> rows, matrix::EntryReader& reader,
                               std::span<Rgb> sums) {
  std::array<const CutSample*, kMax> list;
  std::size_t count = 0;
  for (const Number s : rows.front().samples)
    if (s != kNoSample) list[count++] = &samples_[s];
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
          interpolate(std::span(weights_).subspan(kMax * k, count), values, values_[k], there, column.scale);
  }
  interpolated_ += found_.interpolated().size() * rows.size();
}

}  // namespace lumirank::methods
