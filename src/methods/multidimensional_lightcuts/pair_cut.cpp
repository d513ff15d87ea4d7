#include "methods/multidimensional_lightcuts/pair_cut.h"

#include <algorithm>

#include "methods/multidimensional_lightcuts/race.h"

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
  for (const LightTree::Node root : lights_.roots()) {
    Pair p;
    p.gather = GatherTree::root(), p.light = root;
    if (choose(p)) pairs_.push_back(p);
  }
}

float PairCut::find_common(const Pair& p) {
  common_.clear();
  float total = 0;
  const auto columns = instants_->parts(p.light);
  auto next = columns.begin();
  for (const GatherTree::Part& rows : gather_.parts(p.gather)) {
    while (next != columns.end() && next->instant < rows.instant) ++next;
    if (next == columns.end()) break;
    if (next->instant != rows.instant) continue;
    const float power = std::max(next->power, 1e-30f);
    common_.push_back({&rows, &*next, power});
    total += rows.weight * power;
  }
  return total;
}

bool PairCut::choose(Pair& p) {
  if (!instants_) {
    p.place = gather_.representative(p.gather), p.column = lights_.representative(p.light);
    p.exact = gather_.is_leaf(p.gather) && lights_.is_leaf(p.light);
    return true;
  }
  find_common(p);
  if (common_.empty()) return false;
  // By the column that would be taken of the instant: pairs of one pixel then look at different instants, and
  // what is refined keeps its entry where it can.
  const Common* drawn = &common_.front();
  float first = kInfinity;
  for (const Common& c : common_) {
    if (common_.size() == 1) break;
    const float turn =
        race_turn(hash_ids(gather_.key(), Stage::representatives, lights_.seed(), c.columns->representative),
                  c.rows->weight * c.power);
    if (turn < first) first = turn, drawn = &c;
  }
  p.place = drawn->rows->representative, p.column = drawn->columns->representative;
  weigh(p);
  return true;
}

void PairCut::weigh(Pair& p) const {
  std::uint64_t entries = 0;
  Rgb emitted{0};
  p.intensity = p.ceiling = Rgb(0);
  for (const Common& c : common_) {
    entries += static_cast<std::uint64_t>(c.rows->rows) * c.columns->columns;
    const float weight = c.rows->weight;
    if (!(weight > 0)) continue;
    emitted += weight * c.columns->emitted;
    p.intensity += weight * c.columns->intensity, p.ceiling += weight * c.columns->ceiling;
  }
  p.exact = entries == 1;
  p.scale = p.exact ? Rgb(common_.front().rows->weight) : lights_.scale_to(emitted, p.column);
}

std::pair<PairCut::Pair, PairCut::Pair> PairCut::halves(const Pair& parent) const {
  Pair one = parent, other = parent;
  if (split_gather(parent))
    one.gather = gather_.left(parent.gather), other.gather = gather_.right(parent.gather);
  else
    one.light = lights_.left(parent.light), other.light = lights_.right(parent.light);
  return {one, other};
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
    places.push_back(first_place + pairs_[at].place);
    columns.push_back(pairs_[at].column);
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
    auto [one, other] = halves(parent);
    const bool first = choose(one), second = choose(other);
    std::uint32_t children[2] = {at, at};
    pairs_[at] = first ? one : other;
    if (first && second) {
      children[1] = static_cast<std::uint32_t>(pairs_.size());
      pairs_.push_back(other);
    }
    for (int side = 0; side < (first && second ? 2 : 1); ++side) {
      const std::uint32_t child = children[side];
      const Pair& p = pairs_[child];
      if (p.place != parent.place || p.column != parent.column) ask_for(child);
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
  if (is_black(p.entry))
    p.value = 0;
  else if (instants_)
    p.value = luminance(p.scale * p.entry);
  else
    p.value = gather_.weight(p.gather) * luminance(lights_.scaled(p.light).scale * p.entry);
  total_ += static_cast<double>(p.value);
}

// As if every row had all instants, and of each as much as the rows have of it.
matrix::ColumnSet PairCut::set_of(const Pair& p) const {
  matrix::ColumnSet set = lights_.set(p.light);
  if (!instants_) return set;
  const float share = 1 / gather_.weight(p.gather);
  set.intensity = share * p.intensity, set.ceiling = share * p.ceiling;
  return set;
}

void PairCut::wait(std::uint32_t place) {
  const Pair& p = pairs_[place];
  if (p.exact) return;
  const float weight = gather_.weight(p.gather);
  if (!(weight > 0)) return;
  const float raw_bound = weight * luminance(gather_.bounds(p.gather).bound(set_of(p)));
  ++bounds_computed_;
  const float bound =
      raw_bound < kUnboundedPair ? raw_bound : kUnboundedPair * (1 + weight * lights_.power(p.light));
  if (!(bound > 0)) return;
  heap_.push_back({bound, place});
  std::push_heap(heap_.begin(), heap_.end(), later);
}

void PairCut::write_by_instants(const Pair& p, std::span<Rgb> sums) {
  const float total = find_common(p);
  if (!(total > 0)) return;  // of no weight in the picture
  const Rgb value = p.scale * p.entry;
  for (std::uint32_t k = gather_.begin(p.gather); k < gather_.end(p.gather); ++k) {
    const std::uint16_t instant = gather_.instant(k);
    const auto at = std::find_if(common_.begin(), common_.end(),
                                 [&](const Common& c) { return c.rows->instant == instant; });
    if (at != common_.end()) sums[gather_.order()[k]] += value * (at->power / total);
  }
}

void PairCut::write_sums(std::span<Rgb> sums) {
  const auto order = gather_.order();
  for (const Index i : order) sums[i] = Rgb(0);
  for (const Pair& p : pairs_) {
    if (is_black(p.entry)) continue;
    if (instants_) {
      write_by_instants(p, sums);
      continue;
    }
    const Rgb value = lights_.scaled(p.light).scale * p.entry;
    for (std::uint32_t k = gather_.begin(p.gather); k < gather_.end(p.gather); ++k) sums[order[k]] += value;
  }
}

}  // namespace lumirank::methods
