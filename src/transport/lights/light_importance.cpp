#include "transport/lights/light_importance.h"

#include <algorithm>
#include <cmath>

#include "base/bounds.h"

namespace lumirank::transport {
namespace {

// A cell with more sites is halved.
constexpr std::size_t kSitesInCell = 16;
// A cell counts as if it held this many sites more with the mean of the cell that it was cut from.
constexpr float kPriorSites = 1;

float mean_value(std::span<const LightImportance::Site> sites, float before, float prior) {
  double sum = static_cast<double>(prior) * before;
  for (const LightImportance::Site& s : sites) sum += s.value;
  const double weight = static_cast<double>(sites.size()) + prior;
  return weight > 0 ? static_cast<float>(sum / weight) : 0.0f;
}

bool any_seen(std::span<const LightImportance::Site> sites) {
  return std::any_of(sites.begin(), sites.end(),
                     [](const LightImportance::Site& s) { return s.seen || s.value > 0; });
}

}  // namespace

std::size_t LightImportance::side_of(Vec3f n) {
  const float x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  if (x >= y && x >= z) return n.x < 0 ? 0 : 1;
  if (y >= z) return n.y < 0 ? 2 : 3;
  return n.z < 0 ? 4 : 5;
}

LightImportance::LightImportance(std::span<const Site> sites) {
  if (sites.empty()) return;
  std::vector<Site> ordered(sites.begin(), sites.end());
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const Site& a, const Site& b) { return side_of(a.normal) < side_of(b.normal); });
  const float all = mean_value(ordered, 0, 0);
  std::size_t begin = 0;
  for (std::size_t side = 0; side < kSides; ++side) {
    std::size_t end = begin;
    while (end < ordered.size() && side_of(ordered[end].normal) == side) ++end;
    const std::span<Site> part(ordered.data() + begin, end - begin);
    root_[side] = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    nodes_.back().value = mean_value(part, all, kPriorSites);
    nodes_.back().seen = nodes_.back().seen_here = any_seen(part);
    divide(root_[side], part);
    begin = end;
  }
}

void LightImportance::divide(std::uint32_t node, std::span<Site> sites) {
  if (sites.size() <= kSitesInCell) return;
  Bounds3f box;
  for (const Site& s : sites) box.extend(s.position);
  const Vec3f size = box.diagonal();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  if (!(size[axis] > 0)) return;
  const std::size_t half = sites.size() / 2;
  std::nth_element(sites.begin(), sites.begin() + static_cast<std::ptrdiff_t>(half), sites.end(),
                   [axis](const Site& a, const Site& b) { return a.position[axis] < b.position[axis]; });
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  const float before = nodes_[node].value;
  const bool seen_here = nodes_[node].seen_here;
  nodes_[node].axis = static_cast<std::uint8_t>(axis), nodes_[node].split = sites[half].position[axis],
  nodes_[node].child = child;
  nodes_.resize(nodes_.size() + 2);
  const std::span<Site> parts[2] = {sites.first(half), sites.subspan(half)};
  for (std::uint32_t k = 0; k < 2; ++k) {
    Node& half_node = nodes_[child + k];
    half_node.value = mean_value(parts[k], before, kPriorSites);
    half_node.seen_here = any_seen(parts[k]);
    half_node.seen = half_node.seen_here || seen_here;
  }
  for (std::uint32_t k = 0; k < 2; ++k) divide(child + k, parts[k]);
}

const LightImportance::Node* LightImportance::leaf(Vec3f position, Vec3f normal) const {
  const Node* node = &nodes_[root_[side_of(normal)]];
  while (node->child != kNone) node = &nodes_[node->child + (position[node->axis] < node->split ? 0 : 1)];
  return node;
}

bool LightImportance::seen(Vec3f position, Vec3f normal) const {
  return even() || leaf(position, normal)->seen;
}

float LightImportance::at(Vec3f position, Vec3f normal) const {
  if (even()) return 1;
  const Node* node = leaf(position, normal);
  return node->seen ? std::clamp(node->value, range_.low, range_.high) : range_.unseen;
}

}  // namespace lumirank::transport
