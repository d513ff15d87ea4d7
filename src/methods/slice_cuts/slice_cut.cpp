#include "methods/slice_cuts/slice_cut.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/timer.h"
#include "methods/common/slices/slice_fields.h"

namespace lumirank::methods {

using matrix::Index;
using Node = LightTree::Node;

namespace {

// A cluster's neighbors are the clusters below an ancestor of it that has up to four times its power (the
// supplement with the paper's own range search was not at hand), of these the nearest eight on either side.
constexpr float kNeighborPower = 4;
constexpr std::size_t kReach = 8;

}  // namespace

std::uint32_t SliceCut::place(Node node) const {
  return static_cast<std::uint32_t>(tree_.columns(node).data() - tree_.order().data());
}

void SliceCut::initial_cut(std::size_t count, std::span<const Index> receivers) {
  bounds_->set_rows(receivers);
  const auto less = [](const Bounded& a, const Bounded& b) {
    if (a.bound != b.bound) return a.bound < b.bound;
    return a.power != b.power ? a.power < b.power : a.node < b.node;
  };
  const auto push = [&](Node node) {
    heap_.push_back({mean(bounds_->bound(tree_.set(node))), tree_.power(node), node});
    std::push_heap(heap_.begin(), heap_.end(), less);
  };
  heap_.clear();
  clusters_.clear();
  for (const Node root : tree_.roots()) push(root);
  // Single lights are done; what cannot light the slice at all is left whole.
  while (!heap_.empty() && heap_.size() + clusters_.size() < count) {
    std::pop_heap(heap_.begin(), heap_.end(), less);
    const Bounded top = heap_.back();
    heap_.pop_back();
    if (tree_.is_leaf(top.node) || top.bound <= 0) {
      clusters_.push_back({top.node, kNoSlot, {}, -1});
      continue;
    }
    push(tree_.left(top.node));
    push(tree_.right(top.node));
  }
  for (const Bounded& b : heap_) clusters_.push_back({b.node, kNoSlot, {}, -1});
  for (Cluster& c : clusters_) c.column = tree_.scaled(c.node);
  std::sort(clusters_.begin(), clusters_.end(),
            [&](const Cluster& a, const Cluster& b) { return place(a.node) < place(b.node); });
}

void SliceCut::add_slots(const SliceCutSettings& settings, SliceEntries& entries) {
  const bool sample = settings.sparse_visibility;
  const std::size_t samples = settings.samples(entries.rows().size());
  for (Cluster& c : clusters_) {
    if (c.slot != kNoSlot) continue;
    c.slot = static_cast<std::uint32_t>(entries.add(c.column));
    if (sample) entries.request_next(c.slot, samples);
  }
  if (sample) {
    entries.resolve();
    sample_members(settings, entries);
  }
}

// A representative tells of one light; whether the others are hidden as well is asked of some of them, at
// rows spread over the slice.
void SliceCut::sample_members(const SliceCutSettings& settings, SliceEntries& entries) {
  const std::size_t rows = entries.rows().size();
  // Two fifths of the representative's own samples.
  const auto samples = static_cast<std::size_t>(
      std::clamp(std::ceil(0.4 * settings.rho * static_cast<double>(rows)), 4.0, 32.0));
  member_rows_.clear(), member_cluster_.clear(), members_.clear();
  for (std::size_t c = 0; c < clusters_.size(); ++c) {
    Cluster& cluster = clusters_[c];
    if (cluster.lit >= 0 || tree_.is_leaf(cluster.node)) continue;
    cluster.lit = 0;
    const auto columns = tree_.columns(cluster.node);
    Rng rng(entries.key(), Stage::method, cluster.node);
    const auto order = entries.patterns().order(rng.next_below(SamplePatterns::kPatterns));
    for (std::size_t k = 0; k < std::min({samples, columns.size(), rows}); ++k) {
      member_rows_.push_back(order[k]);
      members_.push_back(columns[rng.next_below(columns.size())]);
      member_cluster_.push_back(static_cast<std::uint32_t>(c));
    }
  }
  entries.values_at(member_rows_, members_, member_light_);
  for (std::size_t k = 0; k < members_.size(); ++k) {
    const float power = mean(tree_.emitted_of(members_[k]));
    float& lit = clusters_[member_cluster_[k]].lit;
    if (power > 0) lit = std::max(lit, member_light_[k] / power);
  }
}

// Equation 7: Γ = (greatest M·G among the neighbors) · (whether any sample of theirs is visible) · power.
// Where none is, the paper's factor is 0; but hidden are only so many representatives, each one light of
// many. By the rule of succession the next would be visible with probability 1/(number + 2).
void SliceCut::contributions(const SliceCutSettings& settings, SliceEntries& entries) {
  const std::size_t n = clusters_.size();
  max_entry_.resize(n);
  contribution_.resize(n);
  for (std::size_t c = 0; c < n; ++c) {
    const float power = mean(tree_.emitted(clusters_[c].node));
    const float scaled = mean(clusters_[c].column.scale) * entries.slot(clusters_[c].slot).max_scalar;
    max_entry_[c] = std::max(power > 0 ? scaled / power : 0, clusters_[c].lit);
  }
  for (std::size_t c = 0; c < n; ++c) {
    const Node node = clusters_[c].node;
    const float power = mean(tree_.emitted(node));
    Node above = node;
    for (Node p = tree_.parent(node);
         p != LightTree::kNone && tree_.power(p) <= kNeighborPower * tree_.power(node); p = tree_.parent(p))
      above = p;
    const std::uint32_t begin = place(above),
                        end = begin + static_cast<std::uint32_t>(tree_.columns(above).size());
    float max_entry = 0;
    bool visible = !settings.sparse_visibility;
    float sampled = 0;
    const auto take = [&](std::size_t k) {
      const std::uint32_t at = place(clusters_[k].node);
      if (at < begin || at >= end) return false;
      max_entry = std::max(max_entry, max_entry_[k]);
      visible |= entries.slot(clusters_[k].slot).any_visible || clusters_[k].lit > 0;
      ++sampled;
      return true;
    };
    for (std::size_t k = c; k < std::min(n, c + kReach + 1) && take(k); ++k) {
    }
    for (std::size_t k = c; k > 0 && c - k < kReach && take(k - 1); --k) {
    }
    contribution_[c] = max_entry * power * (visible ? 1 : 1 / (sampled + 2));
  }
}

// Splits what is above the threshold of equation 8, the greatest first while there is room. False if nothing
// was.
bool SliceCut::split(const SliceCutSettings& settings, SliceEntries& entries) {
  double sum = 0;
  for (const float g : contribution_) sum += static_cast<double>(g);
  const double threshold = settings.alpha * sum;
  candidates_.clear();
  for (std::size_t c = 0; c < clusters_.size(); ++c)
    if (!tree_.is_leaf(clusters_[c].node) &&
        (settings.alpha == 0 || static_cast<double>(contribution_[c]) > threshold))
      candidates_.push_back(static_cast<std::uint32_t>(c));
  if (candidates_.empty() || clusters_.size() >= settings.max_columns) return false;
  const std::size_t room = settings.max_columns - clusters_.size();
  if (candidates_.size() > room) {
    std::sort(candidates_.begin(), candidates_.end(), [&](std::uint32_t a, std::uint32_t b) {
      return contribution_[a] != contribution_[b] ? contribution_[a] > contribution_[b] : a < b;
    });
    candidates_.resize(room);
    std::sort(candidates_.begin(), candidates_.end());
  }
  next_.clear();
  std::size_t candidate = 0;
  for (std::size_t c = 0; c < clusters_.size(); ++c) {
    const Cluster& whole = clusters_[c];
    if (candidate == candidates_.size() || candidates_[candidate] != c) {
      next_.push_back(whole);
      continue;
    }
    ++candidate;
    for (const Node child : {tree_.left(whole.node), tree_.right(whole.node)}) {
      Cluster part{child, kNoSlot, tree_.scaled(child), -1};
      if (part.column.column == entries.slot(whole.slot).column) part.slot = whole.slot;
      next_.push_back(part);
    }
  }
  std::swap(clusters_, next_);
  std::sort(clusters_.begin(), clusters_.end(),
            [&](const Cluster& a, const Cluster& b) { return place(a.node) < place(b.node); });
  return true;
}

// A cluster stays whole because what was seen of its representative is dark, so that one is darker than the
// cluster in the mean: the sums would be too small. Who is drawn after all decisions has no such bias.
void SliceCut::redraw(const SliceCutSettings& settings, std::uint64_t drawing) {
  const std::uint64_t key = tree_.seed() + 1 + settings.redraws * kMaxDrawings + drawing;
  for (Cluster& c : clusters_) {
    if (tree_.is_leaf(c.node)) continue;
    c.column = tree_.redrawn(c.node, key);
    c.slot = kNoSlot;
  }
}

void SliceCut::choose(const SliceCutSettings& settings, SliceEntries& entries) {
  const ThreadTimer timer;
  initial_cut(std::min(settings.initial_columns, settings.max_columns), entries.rows().receivers());
  seconds_of_bounds_ = timer.seconds();
  if (settings.splitting) {
    add_slots(settings, entries);
    contributions(settings, entries);
    while (split(settings, entries)) {
      add_slots(settings, entries);
      contributions(settings, entries);
    }
  }
  if (settings.splitting && settings.redraw) redraw(settings, 0);
}

}  // namespace lumirank::methods
