// Closures of many points in little memory. Points of one material share one list of lobes without their
// colors (a "recipe"), and points of one color the list of colors; what else differs from point to point
// is only the frame, of which the owner keeps the normals anyway. So a closure costs 12 bytes here (24 to 36
// with a color of its own) instead of about 500, and points of one recipe can be evaluated together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/list_store.h"
#include "base/rgb.h"
#include "base/vec.h"
#include "scatter/closure.h"

namespace lumirank::scatter {

// The closure of a point that is not worth a place in a pool: one diffuse lobe.
Closure lambertian(Rgb albedo, Vec3f normal, Vec3f ng);

class ClosurePool {
 public:
  // Keeps the non-delta lobes of `closure` (delta lobes are left out) and its tangent. `normal` is the normal
  // that the owner keeps for the point: frame.n or -frame.n. Returns the index of the closure.
  std::uint32_t add(const scatter::Closure& closure, Vec3f normal);

  // Appends all closures of `other`, in order; returns the index that its first one has here.
  std::uint32_t append(const ClosurePool& other);
  // Keeps closure order[k] as the k-th, for all k: a permutation or a selection.
  void reorder(std::span<const std::uint32_t> order);

  std::size_t size() const { return entries_.size(); }
  std::size_t recipes() const { return recipes_.size(); }
  // Which lobe list closure i uses, below recipes().
  std::uint32_t recipe(std::uint32_t i) const { return entries_[i].recipe_and_side >> 1; }
  // The lobes of a recipe, all with color 1.
  std::span<const scatter::Lobe> lobes(std::uint32_t recipe_index) const { return recipes_[recipe_index]; }
  // Colors of the lobes of closure i, one per lobe of its recipe.
  std::span<const Rgb> colors(std::uint32_t i) const { return palettes_[entries_[i].palette]; }
  // 1, or -1 where the closure's frame.n is the opposite of the normal that the owner keeps (a rough
  // dielectric seen from inside). The same holds for ng.
  float side(std::uint32_t i) const { return entries_[i].recipe_and_side & 1 ? -1.0f : 1.0f; }
  // Direction of frame.s, to 16 bits per octahedral coordinate, so within 1e-4 of the given one; matters to
  // anisotropic lobes and to fibers only.
  Vec3f tangent(std::uint32_t i) const;

  // Closure i as it was added, without delta lobes; `normal` and `ng` are those that the owner keeps.
  scatter::Closure get(std::uint32_t i, Vec3f normal, Vec3f ng) const;

  std::size_t memory_bytes() const;
  // Gives back spare capacity and the tables that find equal lists; call it when nothing more will be added.
  void shrink();

 private:
  struct Entry {
    std::uint32_t recipe_and_side;  // recipe · 2 + (1: side is negative)
    std::uint32_t palette;
    std::uint32_t tangent;
  };

  std::vector<Entry> entries_;
  ListStore<scatter::Lobe> recipes_;
  ListStore<Rgb> palettes_;
};

}  // namespace lumirank::scatter
