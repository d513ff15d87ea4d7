// Closures of many points in little memory. Points of one untextured material share one list of lobes (a
// "recipe"); what differs from point to point is only the frame, of which the owner keeps the normals anyway.
// So a closure costs 8 bytes here instead of about 700, and points of one recipe can be evaluated together.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "base/vec.h"
#include "scatter/closure.h"

namespace lumirank::transport {

class ClosurePool {
 public:
  // Keeps the smooth lobes of `closure` (delta lobes are left out) and its tangent. `normal` is the normal
  // that the owner keeps for the point: frame.n or -frame.n. Returns the index of the closure.
  std::uint32_t add(const scatter::Closure& closure, Vec3f normal);

  // Appends all closures of `other`, in order; returns the index that its first one has here.
  std::uint32_t append(const ClosurePool& other);

  std::size_t size() const { return entries_.size(); }
  std::size_t recipes() const { return offsets_.size() - 1; }
  // Which lobe list closure i uses, below recipes().
  std::uint32_t recipe(std::uint32_t i) const { return entries_[i].recipe_and_side >> 1; }
  std::span<const scatter::Lobe> lobes(std::uint32_t recipe_index) const {
    return {lobes_.data() + offsets_[recipe_index], offsets_[recipe_index + 1] - offsets_[recipe_index]};
  }
  // 1, or -1 where the closure's frame.n is the opposite of the normal that the owner keeps (a rough
  // dielectric seen from inside). The same holds for ng.
  float side(std::uint32_t i) const { return entries_[i].recipe_and_side & 1 ? -1.0f : 1.0f; }
  // Direction of frame.s, to 16 bits per octahedral coordinate, so within 1e-4 of the given one; matters to
  // anisotropic lobes only.
  Vec3f tangent(std::uint32_t i) const;

  // Closure i as it was added, without delta lobes; `normal` and `ng` are those that the owner keeps.
  scatter::Closure get(std::uint32_t i, Vec3f normal, Vec3f ng) const;

  std::size_t memory_bytes() const;
  // Gives back spare capacity and the table that finds equal recipes: nothing can be added afterwards.
  void freeze();
  void clear() { *this = ClosurePool(); }

 private:
  struct Entry {
    std::uint32_t recipe_and_side;  // recipe · 2 + (1: side is negative)
    std::uint32_t tangent;
  };
  std::uint32_t recipe_of(std::span<const scatter::Lobe> lobes);

  std::vector<Entry> entries_;
  std::vector<std::uint32_t> offsets_{0};  // of recipes into lobes_, one more than recipes
  std::vector<scatter::Lobe> lobes_;
  std::unordered_multimap<std::uint64_t, std::uint32_t> by_hash_;
};

}  // namespace lumirank::transport
