#include "transport/pairs/tile_plan.h"

#include <algorithm>

namespace lumirank::transport {

TilePlan TilePlan::build(std::span<const std::uint16_t> kinds, std::uint32_t tile_items) {
  TilePlan plan;
  plan.slot.resize(kinds.size());
  plan.item.reserve(kinds.size() + kinds.size() / 16);
  std::vector<std::uint32_t> order;
  for (std::size_t begin = 0; begin < kinds.size(); begin += tile_items) {
    const std::size_t end = std::min(kinds.size(), begin + tile_items);
    plan.first_run.push_back(static_cast<std::uint32_t>(plan.runs.size()));
    order.clear();
    for (std::size_t i = begin; i < end; ++i) order.push_back(static_cast<std::uint32_t>(i));
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return kinds[a] < kinds[b]; });
    for (std::size_t k = 0; k < order.size();) {
      const std::uint16_t kind = kinds[order[k]];
      Run run{static_cast<std::uint32_t>(plan.item.size()), 0, kind};
      for (; k < order.size() && kinds[order[k]] == kind; ++k) {
        plan.slot[order[k]] = static_cast<std::uint32_t>(plan.item.size());
        plan.item.push_back(order[k]);
      }
      plan.item.resize((plan.item.size() + 15) / 16 * 16, kNoItem);
      run.end = static_cast<std::uint32_t>(plan.item.size());
      plan.runs.push_back(run);
      plan.kind.resize(plan.item.size() / 16, kind);
    }
  }
  plan.first_run.push_back(static_cast<std::uint32_t>(plan.runs.size()));
  return plan;
}

}  // namespace lumirank::transport
