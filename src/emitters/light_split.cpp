#include "emitters/light_split.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lumirank::emitters {

namespace {

constexpr int kBins = 12;

// The lights of a bin. The cone is found in two walks (mean axis, then the farthest normal from it): joining
// pair by pair is slower and wider.
struct Bin {
  LightBound bound;
  Vec3f axes{0, 0, 0};
  std::size_t count = 0;
  float min_cosine = 1;  // of the axis with those of flat lights

  void add(const LightItem& item) {
    bound.bounds.extend(item.bound.bounds);
    bound.reach = count == 0 ? item.bound.reach : std::max(bound.reach, item.bound.reach);
    bound.intensity += item.bound.intensity;
    axes += item.bound.axis;
    ++count;
  }
  void set_axis() {
    const float len = length(axes);
    bound.axis = len > 1e-3f * static_cast<float>(count) ? axes / len : Vec3f{0, 0, 1};
  }
  void widen(const LightItem& item) {
    const float cosine = dot(bound.axis, item.bound.axis);
    if (item.bound.spread == 0) {
      min_cosine = std::min(min_cosine, cosine);  // one arc cosine for all flat lights
    } else {
      bound.spread = std::max(bound.spread, angle_of(cosine) + item.bound.spread);
    }
  }
  void set_spread() {
    if (min_cosine < 1) bound.spread = std::max(bound.spread, angle_of(min_cosine));
    bound.spread = std::min(bound.spread, kPi);
  }
  // The arc cosine of a rounded cosine is within 5·10⁻⁴ of the angle.
  static float angle_of(float cosine) { return std::acos(std::clamp(cosine, -1.0f, 1.0f)) + 5e-4f; }
};

// What a group costs: the more it emits, the wider and the larger it is.
float cost(const LightBound& b) {
  return b.intensity * emission_measure(b) * length_squared(b.bounds.diagonal());
}

std::size_t halve(std::span<LightItem> items, int axis) {
  const std::size_t middle = items.size() / 2;
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(middle), items.end(),
                   [axis](const LightItem& a, const LightItem& b) {
                     // Equal places by index: the tree must not depend on the order of the items.
                     return a.center[axis] != b.center[axis] ? a.center[axis] < b.center[axis]
                                                             : a.light < b.light;
                   });
  return middle;
}

}  // namespace

LightBound join_all(std::span<const LightItem> items) {
  if (items.size() == 1) return items[0].bound;
  Bin all;
  for (const LightItem& item : items) all.add(item);
  all.set_axis();
  for (const LightItem& item : items) all.widen(item);
  all.set_spread();
  return all.bound;
}

std::size_t split_lights(std::span<LightItem> items) {
  Bounds3f centers;
  for (const LightItem& item : items) centers.extend(item.center);
  const Vec3f size = centers.diagonal();
  const int longest = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
  if (items.size() == 2 || !(size[longest] > 0)) return halve(items, longest);

  float best = kInfinity;
  int best_axis = -1, best_bin = 0;
  const auto bin_of = [&](const LightItem& item, int axis) {
    return std::min(kBins - 1, static_cast<int>((item.center[axis] - centers.lo[axis]) / size[axis] * kBins));
  };
  for (int axis = 0; axis < 3; ++axis) {
    // Slices across a short side are long and thin.
    if (!(size[axis] > 0.1f * size[longest])) continue;
    std::array<Bin, kBins> bins;
    for (const LightItem& item : items) bins[bin_of(item, axis)].add(item);
    for (Bin& bin : bins) bin.set_axis();
    for (const LightItem& item : items) bins[bin_of(item, axis)].widen(item);
    for (Bin& bin : bins) bin.set_spread();
    std::array<float, kBins> below{};
    LightBound sum;
    for (int k = 0; k + 1 < kBins; ++k) {
      sum = join(sum, bins[k].bound);
      below[k] = sum.intensity > 0 ? cost(sum) : 0;
    }
    sum = {};
    std::size_t above = 0;
    for (int k = kBins - 1; k > 0; --k) {
      sum = join(sum, bins[k].bound);
      above += bins[k].count;
      const float total = (below[k - 1] + (sum.intensity > 0 ? cost(sum) : 0)) * size[longest] / size[axis];
      if (above > 0 && above < items.size() && total < best) best = total, best_axis = axis, best_bin = k;
    }
  }
  if (best_axis < 0) return halve(items, longest);
  const auto middle = std::stable_partition(
      items.begin(), items.end(), [&](const LightItem& item) { return bin_of(item, best_axis) < best_bin; });
  return static_cast<std::size_t>(middle - items.begin());
}

}  // namespace lumirank::emitters
