#include "methods/multidimensional_lightcuts/pair_cut.h"

#include <algorithm>

namespace lumirank::methods {

using matrix::Index;

namespace {
// Where nothing is known (infinite bounds), more power goes first; far above any finite bound of use.
constexpr float kUnboundedPair = 1e30f;
// Extents are squares: a pixel's receivers count as if they lay twice as far apart. Its representative's
// shadows are those of the whole pixel, and no bound knows of shadows.
constexpr float kPixelsFirst = 4;
}  // namespace

void PairCut::begin(std::span<const Index> rows) {
  gather_.build(rows);
  pairs_.clear(), asked_.clear(), changed_.clear(), heap_.clear();
  total_ = 0, bounds_computed_ = 0, begun_ = false;
  for (const LightTree::Node root : lights_.roots()) pairs_.push_back({GatherTree::root(), root, {}, 0});
}

float PairCut::threshold() const { return static_cast<float>(limits_.error_bound * std::max(total_, 0.0)); }

bool PairCut::split_gather(const Pair& p) const {
  if (gather_.is_leaf(p.gather)) return false;
  return lights_.is_leaf(p.light) ||
         kPixelsFirst * gather_.extent(p.gather) > gather_.extent(lights_.set(p.light));
}

bool PairCut::request(std::uint32_t first_place, std::vector<std::uint32_t>& places,
                      std::vector<Index>& columns) {
  const auto ask_for = [&](std::uint32_t at) {
    asked_.push_back(at);
    places.push_back(first_place + gather_.representative(pairs_[at].gather));
    columns.push_back(lights_.representative(pairs_[at].light));
  };
  asked_.clear(), changed_.clear();
  if (!begun_) {
    begun_ = true;
    for (std::uint32_t at = 0; at < pairs_.size(); ++at) ask_for(at), changed_.push_back(at);
    return !changed_.empty();
  }
  const float limit = threshold();
  for (std::size_t k = 0; k < limits_.per_round && pairs_.size() < limits_.max_pairs; ++k) {
    if (heap_.empty() || !(heap_.front().bound > limit)) break;
    const std::uint32_t at = heap_.front().place;
    std::pop_heap(heap_.begin(), heap_.end(), later);
    heap_.pop_back();
    const Pair parent = pairs_[at];
    total_ -= static_cast<double>(parent.value);
    const bool by_rows = split_gather(parent);
    Pair one = parent, other = parent;
    if (by_rows)
      one.gather = gather_.left(parent.gather), other.gather = gather_.right(parent.gather);
    else
      one.light = lights_.left(parent.light), other.light = lights_.right(parent.light);
    const auto second = static_cast<std::uint32_t>(pairs_.size());
    pairs_[at] = one;
    pairs_.push_back(other);
    for (const std::uint32_t child : {at, second}) {
      const Pair& p = pairs_[child];
      const bool known = gather_.representative(p.gather) == gather_.representative(parent.gather) &&
                         lights_.representative(p.light) == lights_.representative(parent.light);
      if (!known) ask_for(child);
      changed_.push_back(child);
    }
  }
  return !changed_.empty();
}

void PairCut::take(std::span<const Rgb> values) {
  for (std::size_t k = 0; k < asked_.size(); ++k) pairs_[asked_[k]].entry = values[k];
  for (const std::uint32_t at : changed_) add(pairs_[at]);
  for (const std::uint32_t at : changed_) wait(at);
}

void PairCut::add(Pair& p) {
  p.value = is_black(p.entry) ? 0.0f
                              : gather_.weight(p.gather) * luminance(lights_.scaled(p.light).scale * p.entry);
  total_ += static_cast<double>(p.value);
}

void PairCut::wait(std::uint32_t place) {
  const Pair& p = pairs_[place];
  if (exact(p)) return;
  const float weight = gather_.weight(p.gather);
  if (!(weight > 0)) return;
  const float raw_bound = weight * luminance(gather_.bounds(p.gather).bound(lights_.set(p.light)));
  ++bounds_computed_;
  const float bound =
      raw_bound < kUnboundedPair ? raw_bound : kUnboundedPair * (1 + weight * lights_.power(p.light));
  if (!(bound > 0)) return;
  heap_.push_back({bound, place});
  std::push_heap(heap_.begin(), heap_.end(), later);
}

void PairCut::write_sums(std::span<Rgb> sums) const {
  const auto order = gather_.order();
  for (const Index i : order) sums[i] = Rgb(0);
  for (const Pair& p : pairs_) {
    if (is_black(p.entry)) continue;
    const Rgb value = lights_.scaled(p.light).scale * p.entry;
    for (std::uint32_t k = gather_.begin(p.gather); k < gather_.end(p.gather); ++k) sums[order[k]] += value;
  }
}

}  // namespace lumirank::methods
