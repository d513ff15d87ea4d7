#include "linalg/local_splitter.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lumirank::linalg {

namespace {

// Costs below this share of (Σ‖x‖)² are rounding of the coordinates (16 bits where they come from ShortRows).
constexpr double kZeroCost = 1e-6;
// Clusters without cost are split only when none with cost is left.
constexpr double kParallel = 1e-12;

template <std::size_t Lanes>
float short_dot(const float* a, const float* b, std::size_t n) {
  float parts[Lanes] = {};
  for (std::size_t d = 0; d < n; d += Lanes)
    for (std::size_t k = 0; k < Lanes; ++k) parts[k] += a[d + k] * b[d + k];
  for (std::size_t width = Lanes / 2; width > 0; width /= 2)
    for (std::size_t k = 0; k < width; ++k) parts[k] += parts[k + width];
  return parts[0];
}

// sum[0 … n): coordinates; sum[n]: weight.
template <std::size_t Lanes>
void add_to(double* sum, const float* x, float norm, std::size_t n) {
  for (std::size_t d = 0; d < n; d += Lanes)
    for (std::size_t k = 0; k < Lanes; ++k) sum[d + k] += static_cast<double>(x[d + k]);
  sum[n] += static_cast<double>(norm);
}

double short_cost(const double* sum, std::size_t n) {
  double squares = 0;
  for (std::size_t d = 0; d < n; ++d) squares += sum[d] * sum[d];
  return std::max(0.0, sum[n] * sum[n] - squares);
}

}  // namespace

void LocalSplitter::clear(std::size_t dimension) {
  dimension_ = dimension;
  padded_ = (dimension + kLanes - 1) / kLanes * kLanes;
  norms_.clear(), ids_.clear(), nodes_.clear(), queue_.clear();
  line_.assign(padded_, 0.0f);
  bins_.assign((kBins + 2) * (padded_ + 1), 0.0);
  open_ = 0;
}

void LocalSplitter::begin_cluster() { finish_cluster(); }

void LocalSplitter::finish_cluster() {
  const auto end = static_cast<std::uint32_t>(ids_.size());
  if (end == open_) return;
  double* sum = bins_.data();
  std::fill(sum, sum + padded_ + 1, 0.0);
  for (std::size_t k = open_; k < end; ++k) add_to<kLanes>(sum, point(k), norms_[k], padded_);
  nodes_.push_back(node_of(open_, end, sum));
  enqueue(static_cast<std::uint32_t>(nodes_.size() - 1));
  open_ = end;
}

void LocalSplitter::add(std::uint32_t id, const float* x) {
  const std::size_t at = ids_.size() * padded_;
  if (x_.size() < at + padded_) x_.resize(std::max(2 * x_.size(), at + padded_));
  float* to = x_.data() + at;
  std::copy(x, x + dimension_, to);
  std::fill(to + dimension_, to + padded_, 0.0f);
  ids_.push_back(id);
  norms_.push_back(std::sqrt(short_dot<kLanes>(to, to, padded_)));
}

LocalSplitter::Node LocalSplitter::node_of(std::uint32_t begin, std::uint32_t end, const double* sum) const {
  Node node{begin, end, 0, sum[padded_]};
  if (end - begin > 1) node.cost = short_cost(sum, padded_);
  if (node.cost <= kZeroCost * node.weight * node.weight) node.cost = 0;
  return node;
}

void LocalSplitter::enqueue(std::uint32_t n) {
  const Node& node = nodes_[n];
  if (node.end - node.begin < 2) return;
  queue_.push_back({node.cost > 0 ? node.cost : kParallel * node.weight * node.weight, n});
  std::push_heap(queue_.begin(), queue_.end());
}

// From the heaviest member towards the one that costs most together with it: ‖a‖‖x‖ − a·x.
void LocalSplitter::choose_line(const Node& node) {
  std::size_t heaviest = node.begin;
  for (std::size_t k = node.begin; k < node.end; ++k)
    if (norms_[k] > norms_[heaviest]) heaviest = k;
  const float* a = point(heaviest);
  std::size_t farthest = node.begin;
  float max_cost = -1;
  for (std::size_t k = node.begin; k < node.end; ++k) {
    const float cost = norms_[heaviest] * norms_[k] - short_dot<kLanes>(a, point(k), padded_);
    if (cost > max_cost && k != heaviest) max_cost = cost, farthest = k;
  }
  const float *b = point(farthest), na = 1 / norms_[heaviest], nb = 1 / norms_[farthest];
  for (std::size_t d = 0; d < padded_; ++d) line_[d] = a[d] * na - b[d] * nb;
}

void LocalSplitter::swap_points(std::size_t a, std::size_t b) {
  std::swap_ranges(x_.begin() + static_cast<std::ptrdiff_t>(a * padded_),
                   x_.begin() + static_cast<std::ptrdiff_t>((a + 1) * padded_),
                   x_.begin() + static_cast<std::ptrdiff_t>(b * padded_));
  std::swap(ids_[a], ids_[b]);
  std::swap(norms_[a], norms_[b]);
  std::swap(keys_[a], keys_[b]);
}

std::uint32_t LocalSplitter::cut(const Node& node) {
  choose_line(node);
  keys_.resize(ids_.size());
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (std::size_t k = node.begin; k < node.end; ++k) {
    keys_[k] = short_dot<kLanes>(line_.data(), point(k), padded_) / norms_[k];
    low = std::min(low, keys_[k]), high = std::max(high, keys_[k]);
  }
  const std::size_t stride = padded_ + 1;
  std::fill(bins_.begin(), bins_.end(), 0.0);
  double *left = bins_.data() + kBins * stride, *right = left + stride;
  if (!(high > low)) {  // no line tells them apart: half of them each
    const std::uint32_t middle = node.begin + (node.end - node.begin) / 2;
    for (std::size_t k = node.begin; k < node.end; ++k)
      add_to<kLanes>(k < middle ? left : right, point(k), norms_[k], padded_);
    return middle;
  }

  const float scale = static_cast<float>(kBins) / (high - low) * 0.99999f;
  const auto bin_of = [&](float key) {
    return std::min(static_cast<std::size_t>((key - low) * scale), kBins - 1);
  };
  const auto add_bins = [&](std::size_t begin, std::size_t end, double* sum) {
    for (std::size_t b = begin; b < end; ++b)
      for (std::size_t d = 0; d < stride; ++d) sum[d] += bins_[b * stride + d];
  };
  for (std::size_t k = node.begin; k < node.end; ++k)
    add_to<kLanes>(bins_.data() + bin_of(keys_[k]) * stride, point(k), norms_[k], padded_);
  add_bins(0, kBins, right);
  double min_cost = std::numeric_limits<double>::infinity();
  std::size_t bins_left = 1;
  for (std::size_t b = 0; b + 1 < kBins; ++b) {
    add_bins(b, b + 1, left);
    for (std::size_t d = 0; d < stride; ++d) right[d] -= bins_[b * stride + d];
    const double cost = short_cost(left, padded_) + short_cost(right, padded_);
    if (cost < min_cost) min_cost = cost, bins_left = b + 1;
  }
  // Afresh, so that no difference of large numbers is carried on.
  std::fill(left, right + stride, 0.0);
  add_bins(0, bins_left, left);
  add_bins(bins_left, kBins, right);
  // The ends of the range lie in the first and the last bin, so neither side is empty.
  std::size_t a = node.begin, z = node.end;
  while (a < z) {
    if (bin_of(keys_[a]) < bins_left)
      ++a;
    else
      swap_points(a, --z);
  }
  return static_cast<std::uint32_t>(a);
}

void LocalSplitter::split_to(std::size_t clusters, double enough) {
  finish_cluster();
  double weight = 0, remaining = cost();
  for (const Node& node : nodes_) weight += node.weight;
  const double least = enough * enough * weight * weight;
  while (nodes_.size() < clusters && !queue_.empty() && !(enough > 0 && remaining <= least)) {
    std::pop_heap(queue_.begin(), queue_.end());
    const std::uint32_t n = queue_.back().node;
    queue_.pop_back();
    const Node whole = nodes_[n];
    const std::uint32_t at = cut(whole);
    const double* left = bins_.data() + kBins * (padded_ + 1);
    nodes_[n] = node_of(whole.begin, at, left);
    nodes_.push_back(node_of(at, whole.end, left + padded_ + 1));
    enqueue(n);
    enqueue(static_cast<std::uint32_t>(nodes_.size() - 1));
    remaining += nodes_[n].cost + nodes_.back().cost - whole.cost;
  }
}

double LocalSplitter::cost() const {
  double sum = 0;
  for (const Node& node : nodes_) sum += node.cost;
  return sum;
}

std::size_t LocalSplitter::memory_bytes() const {
  return (x_.capacity() + norms_.capacity() + keys_.capacity()) * sizeof(float) +
         ids_.capacity() * sizeof(std::uint32_t);
}

}  // namespace lumirank::linalg
