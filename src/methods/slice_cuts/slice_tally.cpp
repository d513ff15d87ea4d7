#include "methods/slice_cuts/slice_tally.h"

#include <algorithm>

namespace lumirank::methods {

SliceTally& SliceTally::operator+=(const SliceTally& o) {
  seconds_cut += o.seconds_cut, seconds_splitting += o.seconds_splitting;
  seconds_visibility += o.seconds_visibility, seconds_gather += o.seconds_gather;
  slices += o.slices, rows += o.rows, columns += o.columns;
  max_columns = std::max(max_columns, o.max_columns);
  shades += o.shades, entries += o.entries, sampled += o.sampled;
  return *this;
}

void SliceTally::add_choice(double seconds, const SliceCut& cut) {
  seconds_cut += cut.seconds_of_bounds();
  seconds_splitting += seconds - cut.seconds_of_bounds();
}

void SliceTally::add(const SliceColumns& slice) {
  const std::uint64_t own = slice.columns().size(), own_rows = slice.entries().rows().size();
  ++slices;
  rows += own_rows;
  columns += own;
  max_columns = std::max(max_columns, own);
  shades += own * slice.entries().rows().receivers().size();
  entries += own_rows * own;
  sampled += slice.sampled();
}

void write_tally(const SliceTally& tally, const std::string& visibility, Trace& trace) {
  auto& numbers = trace.numbers;
  numbers["cpu_seconds.cut"] = tally.seconds_cut;
  numbers["cpu_seconds.splitting"] = tally.seconds_splitting;
  numbers["cpu_seconds." + visibility] = tally.seconds_visibility;
  numbers["cpu_seconds.gather"] = tally.seconds_gather;
  const auto ratio = [](std::uint64_t a, std::uint64_t b, double of_none) {
    return b > 0 ? static_cast<double>(a) / static_cast<double>(b) : of_none;
  };
  numbers["columns"] = ratio(tally.columns, tally.slices, 0);
  numbers["columns_max"] = static_cast<double>(tally.max_columns);
  numbers["sampling_rate"] = ratio(tally.sampled, tally.entries, 1);
  numbers["samples_per_row"] = ratio(tally.sampled, tally.rows, 0);
}

}  // namespace lumirank::methods
