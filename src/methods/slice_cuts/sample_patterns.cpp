#include "methods/slice_cuts/sample_patterns.h"

#include <algorithm>

#include "base/random.h"

namespace lumirank::methods {

namespace {
// So many samples are compared to each row faster than they are found along curves.
constexpr std::size_t kFew = 128;

std::uint32_t reversed(std::uint32_t x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  return __builtin_bswap32(x);
}
}  // namespace

void SamplePatterns::build(const HilbertCurves& curves, std::uint64_t key) {
  curves_ = &curves;
  const std::size_t rows = curves.points().size();
  patterns_.resize(kPatterns);
  keys_.resize(rows);
  for (std::size_t p = 0; p < kPatterns; ++p) {
    Pattern& pattern = patterns_[p];
    pattern.counts.clear();
    pattern.next_counts.clear();
    const auto flip = static_cast<std::uint32_t>(mix64(key + p));
    for (std::size_t r = 0; r < rows; ++r) {
      const auto place = static_cast<std::uint32_t>((std::uint64_t{r} << 32) / rows);
      keys_[r] = (std::uint64_t{reversed(place) ^ flip} << 32) | r;
    }
    std::sort(keys_.begin(), keys_.end());
    pattern.order.resize(rows);
    for (std::size_t k = 0; k < rows; ++k) pattern.order[k] = static_cast<std::uint32_t>(keys_[k]);
  }
}

std::span<const SamplePatterns::Few> SamplePatterns::nearest(std::size_t pattern, std::size_t count) {
  Pattern& p = patterns_[pattern];
  for (std::size_t k = 0; k < p.counts.size(); ++k)
    if (p.counts[k] == count) return p.tables[k]->of();
  const std::size_t k = p.counts.size();
  p.counts.push_back(static_cast<std::uint32_t>(count));
  if (k == p.tables.size()) p.tables.push_back(std::make_unique<SampledNeighbors>());
  // From the table of the most samples that are among these, if there is one.
  std::size_t before = k;
  for (std::size_t t = 0; t < k; ++t)
    if (p.counts[t] < count && (before == k || p.counts[t] > p.counts[before])) before = t;
  if (before < k) {
    p.tables[k]->extend(*p.tables[before], *curves_,
                        std::span(p.order).subspan(p.counts[before], count - p.counts[before]));
  } else if (count <= kFew) {
    p.tables[k]->clear(p.order.size());
    p.tables[k]->extend(*p.tables[k], *curves_, std::span(p.order).first(count));
  } else {
    sampled_.assign(p.order.size(), 0);
    for (std::size_t s = 0; s < count; ++s) sampled_[p.order[s]] = 1;
    p.tables[k]->find(*curves_, sampled_);
  }
  return p.tables[k]->of();
}

std::span<const SamplePatterns::Few> SamplePatterns::nearest_of_next(std::size_t pattern, std::size_t count,
                                                                     std::size_t more) {
  Pattern& p = patterns_[pattern];
  for (std::size_t k = 0; k < p.next_counts.size(); ++k)
    if (p.next_counts[k] == count) return p.next_tables[k];
  const std::size_t k = p.next_counts.size();
  p.next_counts.push_back(static_cast<std::uint32_t>(count));
  if (k == p.next_tables.size()) p.next_tables.emplace_back();
  auto& table = p.next_tables[k];
  table.clear();
  const auto points = curves_->points();
  for (std::size_t r = count; r < std::min(count + more, p.order.size()); ++r) {
    const Vec2f at = points[p.order[r]];
    Few few;
    few.fill(SampledNeighbors::kNone);
    std::array<float, 3> distance{kInfinity, kInfinity, kInfinity};
    for (std::size_t s = 0; s < count; ++s) {
      const Vec2f q = points[p.order[s]];
      float d = (q.x - at.x) * (q.x - at.x) + (q.y - at.y) * (q.y - at.y);
      std::uint32_t who = p.order[s];
      for (std::size_t n = 0; n < few.size(); ++n)
        if (d < distance[n]) std::swap(d, distance[n]), std::swap(who, few[n]);
    }
    table.push_back(few);
  }
  return table;
}

}  // namespace lumirank::methods
