#include "scatter/closure_pool.h"

#include <cmath>

namespace lumirank::scatter {
namespace {

float sign_of(float x) { return std::copysign(1.0f, x); }

// The octahedral map of a unit vector, 16 bits per coordinate.
std::uint32_t encode(Vec3f v) {
  const float norm = std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
  float x = v.x / norm, y = v.y / norm;
  if (v.z < 0) {
    const float folded = (1 - std::abs(y)) * sign_of(x);
    y = (1 - std::abs(x)) * sign_of(y);
    x = folded;
  }
  const auto quantize = [](float t) {
    return static_cast<std::uint32_t>(std::lround((std::min(1.0f, std::max(-1.0f, t)) + 1) * 32767.0f));
  };
  return quantize(x) | quantize(y) << 16;
}

Vec3f decode(std::uint32_t bits) {
  float x = static_cast<float>(bits & 0xffff) / 32767.0f - 1;
  float y = static_cast<float>(bits >> 16) / 32767.0f - 1;
  const float z = 1 - std::abs(x) - std::abs(y);
  if (z < 0) {
    const float unfolded = (1 - std::abs(y)) * sign_of(x);
    y = (1 - std::abs(x)) * sign_of(y);
    x = unfolded;
  }
  return normalize(Vec3f{x, y, z});
}

}  // namespace

std::uint32_t ClosurePool::add(const scatter::Closure& closure, Vec3f normal) {
  scatter::Lobe lobes[scatter::kMaxLobes];
  Rgb colors[scatter::kMaxLobes];
  std::size_t count = 0;
  for (int k = 0; k < closure.count; ++k) {
    if (scatter::is_delta(closure.lobes[k].kind)) continue;
    lobes[count] = closure.lobes[k];
    colors[count] = lobes[count].color;
    lobes[count++].color = Rgb(1);
  }
  const std::uint32_t recipe_index = recipes_.intern({lobes, count});
  const std::uint32_t palette = palettes_.intern({colors, count});
  const std::uint32_t opposite = dot(closure.frame.n, normal) < 0 ? 1 : 0;
  entries_.push_back({recipe_index << 1 | opposite, palette, encode(closure.frame.s)});
  return static_cast<std::uint32_t>(entries_.size() - 1);
}

std::uint32_t ClosurePool::append(const ClosurePool& other) {
  std::vector<std::uint32_t> recipe_of(other.recipes_.size()), palette_of(other.palettes_.size());
  for (std::uint32_t k = 0; k < recipe_of.size(); ++k) recipe_of[k] = recipes_.intern(other.recipes_[k]);
  for (std::uint32_t k = 0; k < palette_of.size(); ++k) palette_of[k] = palettes_.intern(other.palettes_[k]);
  const auto first = static_cast<std::uint32_t>(entries_.size());
  // Twice the room at once: pools are put together from thousands.
  if (const std::size_t needed = entries_.size() + other.entries_.size(); needed > entries_.capacity())
    entries_.reserve(std::max(needed, 2 * entries_.capacity()));
  for (const Entry& e : other.entries_) {
    const std::uint32_t opposite = e.recipe_and_side & 1;
    entries_.push_back({recipe_of[e.recipe_and_side >> 1] << 1 | opposite, palette_of[e.palette], e.tangent});
  }
  return first;
}

void ClosurePool::reorder(std::span<const std::uint32_t> order) {
  std::vector<Entry> sorted;
  sorted.reserve(order.size());
  for (const std::uint32_t i : order) sorted.push_back(entries_[i]);
  entries_ = std::move(sorted);
}

Vec3f ClosurePool::tangent(std::uint32_t i) const { return decode(entries_[i].tangent); }

scatter::Closure ClosurePool::get(std::uint32_t i, Vec3f normal, Vec3f ng) const {
  scatter::Closure closure;
  const float s = side(i);
  closure.frame = Frame::from_normal_tangent(normal * s, tangent(i));
  closure.ng = ng * s;
  const auto shared = lobes(recipe(i));
  const auto own = colors(i);
  for (std::size_t k = 0; k < shared.size(); ++k) {
    closure.lobes[k] = shared[k];
    closure.lobes[k].color = own[k];
  }
  closure.count = static_cast<int>(shared.size());
  return closure;
}

std::size_t ClosurePool::memory_bytes() const {
  return entries_.capacity() * sizeof(Entry) + recipes_.memory_bytes() + palettes_.memory_bytes();
}

void ClosurePool::shrink() {
  entries_.shrink_to_fit();
  recipes_.shrink();
  palettes_.shrink();
}

Closure lambertian(Rgb albedo, Vec3f normal, Vec3f ng) {
  Closure c;
  c.frame = Frame::from_normal(normal);
  c.ng = ng;
  Lobe lobe;
  lobe.kind = LobeKind::diffuse;
  lobe.color = albedo;
  c.add(lobe);
  return c;
}

}  // namespace lumirank::scatter
