// Layout of receivers (or lights) for the kernels: tiles of neighbors, within a tile one run per class, each
// run padded to whole groups of 16. A place in this layout is a "slot".
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace lumirank::transport {

inline constexpr std::uint32_t kNoItem = 0xffffffffu;

struct TilePlan {
  struct Run {
    std::uint32_t begin, end;  // slots; multiples of 16
    std::uint16_t kind;        // class of all its items
  };
  std::vector<Run> runs;
  std::vector<std::uint32_t> first_run;  // of each tile, and one past the end
  std::vector<std::uint32_t> item;       // slot → item, kNoItem where padded
  std::vector<std::uint32_t> slot;       // item → slot
  std::vector<std::uint16_t> kind;       // group → class of all its items

  // Items keep their order within a run. kinds: class of each item.
  static TilePlan build(std::span<const std::uint16_t> kinds, std::uint32_t tile_items);

  std::size_t tiles() const { return first_run.empty() ? 0 : first_run.size() - 1; }
  std::size_t groups() const { return item.size() / 16; }
  std::uint16_t kind_of(std::uint32_t slot_number) const { return kind[slot_number / 16]; }
  std::span<const Run> tile(std::size_t t) const {
    return {runs.data() + first_run[t], first_run[t + 1] - first_run[t]};
  }
};

}  // namespace lumirank::transport
