#include "transport/lights/emission_guide.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/sequence.h"

namespace lumirank::transport {
namespace {

// This part of all paths stays spread evenly: what the pilot did not find must still be found.
constexpr double kEvenPart = 0.3;
// Of the others, this part goes where importance was found, the rest where it may be: a large box with few
// strong observations has a great mean square, and would draw away what small boxes hold for certain.
constexpr double kByImportance = 0.75;
// A box is halved while it holds more than this part of the importance, enough observations to tell (fewer
// if all of them are of paths that count), and room.
constexpr double kSplitAbove = 1.0 / 512;
constexpr std::size_t kMinObservations = 32, kMinImportantObservations = 8;
// A box counts as if it held this many observations more, as strong as those of the box that it was cut from:
// a few that brought nothing do not prove that nothing is there.
constexpr double kPrior = 6;
constexpr float kMinSize = 1.0f / 256;

}  // namespace

double EmissionGuide::Box::volume() const {
  return std::accumulate(size.begin(), size.end(), 1.0, [](double v, float s) { return v * s; });
}

EmissionGuide::EmissionGuide() : cdf_{0, 1} {
  Box all;
  all.lo.fill(0), all.size.fill(1);
  boxes_.push_back(all);
}

EmissionGuide::Start EmissionGuide::draw(double u, std::uint64_t index, std::uint64_t seed,
                                         Stage stage) const {
  const auto above = std::upper_bound(cdf_.begin() + 1, cdf_.end() - 1, u);
  const auto k = static_cast<std::size_t>(above - cdf_.begin()) - 1;
  const Box& box = boxes_[k];
  const double p = cdf_[k + 1] - cdf_[k];
  const double within = std::clamp((u - cdf_[k]) / p, 0.0, 0x1.fffffffffffffp-1);
  const Sequence4 sequence(seed, stage, ~static_cast<std::uint64_t>(k));
  const Vec2f a = sequence.first(index), b = sequence.second(index);
  const float spread[4] = {a.x, a.y, b.x, b.y};
  Start start;
  start.emitter = box.lo[0] + box.size[0] * within;
  for (std::size_t d = 1; d < kStartDimensions; ++d)
    start.rest[d - 1] = std::min(box.lo[d] + box.size[d] * spread[d - 1], 0x1.fffffep-1f);
  start.density = p / box.volume();
  return start;
}

// A box with the observations that lie in it.
struct EmissionGuide::Node {
  Box box;
  std::vector<Observation> inside;
  double importance = 0;   // Σ values
  double mean_square = 0;  // of what a path brings, smoothed towards the box that this one was cut from

  // `before`: the mean square in the box that this one was cut from; kPrior 0 at the root.
  void sum(double before, double prior) {
    importance = 0;
    double squares = 0, starts = 0;  // of paths that were spread evenly, estimated
    for (const Observation& o : inside) {
      importance += o.value;
      squares += static_cast<double>(o.value) * o.value * o.density;
      starts += 1 / static_cast<double>(o.density);
    }
    const double weight = inside.empty() ? 1 : starts / static_cast<double>(inside.size());
    mean_square = (squares + prior * weight * before) / (starts + prior * weight);
  }
  bool upper(const Observation& o, std::size_t axis) const {
    return o.at[axis] >= box.lo[axis] + 0.5f * box.size[axis];
  }
  // The axis along which the halves differ most; among equals, the longest.
  std::size_t best_axis() const {
    std::size_t best = 0;
    double best_score = -1;
    for (std::size_t axis = 0; axis < kStartDimensions; ++axis) {
      if (box.size[axis] <= kMinSize) continue;
      double up = 0;
      for (const Observation& o : inside) up += upper(o, axis) ? o.value : 0.0f;
      const double score = std::abs(2 * up - importance) / importance + 1e-3 * box.size[axis];
      if (score > best_score) best_score = score, best = axis;
    }
    return best;
  }
  // Keeps the lower half, returns the upper one.
  Node halve(std::size_t axis) {
    Node other;
    other.box = box;
    std::vector<Observation> lower_half;
    for (const Observation& o : inside) (upper(o, axis) ? other.inside : lower_half).push_back(o);
    inside = std::move(lower_half);
    box.size[axis] *= 0.5f;
    other.box.size[axis] = box.size[axis];
    other.box.lo[axis] += box.size[axis];
    const double before = mean_square;
    sum(before, kPrior), other.sum(before, kPrior);
    return other;
  }
  // The best density of paths goes with the root of the mean square.
  double strength() const { return std::sqrt(mean_square) * box.volume(); }
};

EmissionGuide EmissionGuide::fit(std::span<const Observation> observations, Spread spread) {
  EmissionGuide guide;
  Node root;
  root.box = guide.boxes_[0];
  root.inside.assign(observations.begin(), observations.end());
  root.sum(0, 0);
  const double total = root.importance;
  if (!(total > 0)) return guide;

  const std::size_t min_observations =
      spread == Spread::by_density ? kMinObservations : kMinImportantObservations;
  std::vector<Node> open, done;
  open.push_back(std::move(root));
  while (!open.empty()) {
    Node node = std::move(open.back());
    open.pop_back();
    const bool room =
        std::any_of(node.box.size.begin(), node.box.size.end(), [](float s) { return s > kMinSize; });
    if (!room || node.importance <= kSplitAbove * total || node.inside.size() < min_observations) {
      done.push_back(std::move(node));
      continue;
    }
    Node other = node.halve(node.best_axis());
    open.push_back(std::move(other));
    open.push_back(std::move(node));
  }
  double strength = 0, importance = 0;
  for (const Node& node : done) strength += node.strength(), importance += node.importance;
  const double by_importance = spread == Spread::by_density ? kByImportance : 1;
  guide.boxes_.clear();
  guide.cdf_.assign(1, 0.0);
  for (const Node& node : done) {
    guide.boxes_.push_back(node.box);
    const double found =
        (1 - by_importance) * node.strength() / strength + by_importance * node.importance / importance;
    const double p = (1 - kEvenPart) * found + kEvenPart * node.box.volume();
    guide.cdf_.push_back(guide.cdf_.back() + p);
  }
  for (double& c : guide.cdf_) c /= guide.cdf_.back();
  return guide;
}

}  // namespace lumirank::transport
