#include "methods/lightcuts/cut.h"

#include <algorithm>

#include "base/timer.h"

namespace lumirank::methods {

using matrix::Index;

namespace {
// Bounds below this part of the threshold are not kept in order.
constexpr float kAsleep = 0.5f;
// Where nothing is known (infinite bounds), more power goes first; far above any finite bound of use.
constexpr float kUnboundedNode = 1e30f;
}  // namespace

void Cut::begin(Index row, const matrix::RowBounds& bounds) {
  row_ = row, bounds_ = &bounds;
  nodes_.clear(), asked_.clear(), refined_.clear(), heap_.clear(), asleep_.clear();
  max_asleep_ = 0, total_ = 0, bounds_computed_ = 0, begun_ = false;
  for (const LightTree::Node root : tree_.roots()) nodes_.push_back({root, 0, {}, 0});
  size_ = nodes_.size();
}

float Cut::threshold() const { return static_cast<float>(limits_.error_bound * std::max(total_, 0.0)); }

bool Cut::request(std::vector<Index>& columns) {
  if (!begun_) {
    begun_ = true;
    for (std::uint32_t place = 0; place < nodes_.size(); ++place) {
      asked_.push_back(place);
      columns.push_back(tree_.representative(nodes_[place].node));
    }
    return !asked_.empty();
  }
  refined_.clear(), asked_.clear();
  const float limit = threshold();
  while (refined_.size() < limits_.per_round && size_ < limits_.max_nodes) {
    if (heap_.empty() || !(heap_.front().bound > limit)) {
      if (!(max_asleep_ > limit) || !wake()) break;
      continue;
    }
    const std::uint32_t place = heap_.front().place;
    std::pop_heap(heap_.begin(), heap_.end(), later);
    heap_.pop_back();
    const auto children = static_cast<std::uint32_t>(nodes_.size());
    const CutNode parent = nodes_[place];
    nodes_[place].children = children;
    const Index known = tree_.representative(parent.node);
    for (const LightTree::Node child : {tree_.left(parent.node), tree_.right(parent.node)}) {
      const Index representative = tree_.representative(child);
      if (representative != known) {
        asked_.push_back(static_cast<std::uint32_t>(nodes_.size()));
        columns.push_back(representative);
      }
      nodes_.push_back({child, 0, representative == known ? parent.entry : Rgb(0), 0});
    }
    refined_.push_back(place);
    ++size_;
  }
  return !refined_.empty();
}

void Cut::take(std::span<const Rgb> values) {
  for (std::size_t k = 0; k < asked_.size(); ++k) nodes_[asked_[k]].entry = values[k];
  if (refined_.empty()) {  // the roots
    for (const std::uint32_t place : asked_) add(place), wait(place);
    return;
  }
  for (const std::uint32_t place : refined_) {
    total_ -= static_cast<double>(nodes_[place].value);
    for (std::uint32_t child = nodes_[place].children; child < nodes_[place].children + 2; ++child)
      add(child);
  }
  for (const std::uint32_t place : refined_)
    for (std::uint32_t child = nodes_[place].children; child < nodes_[place].children + 2; ++child)
      wait(child);
}

void Cut::add(std::uint32_t place) {
  CutNode& n = nodes_[place];
  if (is_black(n.entry)) return;
  n.value = luminance(tree_.scaled(n.node).scale * n.entry);
  total_ += static_cast<double>(n.value);
}

void Cut::wait(std::uint32_t place) {
  const LightTree::Node node = nodes_[place].node;
  if (tree_.is_leaf(node)) return;
  const float raw_bound = luminance(bounds_->bound(tree_.set(node)));
  ++bounds_computed_;
  const float bound = raw_bound < kUnboundedNode ? raw_bound : kUnboundedNode * (1 + tree_.power(node));
  if (!(bound > 0)) return;
  if (bound > kAsleep * threshold()) {
    heap_.push_back({bound, place});
    std::push_heap(heap_.begin(), heap_.end(), later);
  } else {
    asleep_.push_back({bound, place});
    max_asleep_ = std::max(max_asleep_, bound);
  }
}

// The total has fallen: what slept may have to be refined. False if nothing has.
bool Cut::wake() {
  const float min_bound = kAsleep * threshold();
  max_asleep_ = 0;
  std::size_t kept = 0, woken = 0;
  for (const Waiting& w : asleep_) {
    if (w.bound > min_bound) {
      heap_.push_back(w);
      std::push_heap(heap_.begin(), heap_.end(), later);
      ++woken;
    } else {
      asleep_[kept++] = w;
      max_asleep_ = std::max(max_asleep_, w.bound);
    }
  }
  asleep_.resize(kept);
  return woken > 0;
}

Rgb Cut::total() const {
  double sum[3] = {0, 0, 0};
  for (const CutNode& n : nodes_) {
    if (n.children != 0 || is_black(n.entry)) continue;
    const Rgb v = tree_.scaled(n.node).scale * n.entry;
    for (int c = 0; c < 3; ++c) sum[c] += static_cast<double>(v[c]);
  }
  return {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
}

void CutRounds::finish(std::span<Cut> cuts, matrix::EntryReader& reader) {
  const Timer timer;
  double last = 0;
  const auto lap = [&](double& seconds) {
    const double now = timer.seconds();
    seconds += now - last;
    last = now;
  };
  rows_.clear();
  for (const Cut& cut : cuts) rows_.push_back(cut.row());
  reader.set_rows(rows_);
  for (;;) {
    places_.clear(), columns_.clear(), ends_.clear();
    bool any = false;
    for (std::uint32_t k = 0; k < cuts.size(); ++k) {
      any = cuts[k].request(columns_) || any;
      places_.resize(columns_.size(), k);
      ends_.push_back(static_cast<std::uint32_t>(columns_.size()));
    }
    lap(seconds_cuts_);
    if (!any) return;
    values_.resize(columns_.size());
    reader.entries_at(places_, columns_, values_);
    entries_ += columns_.size();
    lap(seconds_entries_);
    std::uint32_t from = 0;
    for (std::size_t k = 0; k < cuts.size(); ++k) {
      cuts[k].take(std::span(values_).subspan(from, ends_[k] - from));
      from = ends_[k];
    }
  }
}

}  // namespace lumirank::methods
