#include "linalg/multiset_sampling.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/parallel.h"
#include "base/random.h"
#include "linalg/blas.h"

namespace lumirank::linalg {

namespace {

constexpr std::size_t kGrain = 4096;

PointSum sum_of(const Points& points, std::span<const double> norms, std::span<const std::uint32_t> members) {
  return parallel_sum(members.size(), kGrain, PointSum(points.dimension), [&](std::size_t b, std::size_t e) {
    PointReader reader(points);
    PointSum s(points.dimension);
    for (std::size_t k = b; k < e; ++k) s.add(reader[members[k]], norms[members[k]]);
    return s;
  });
}

}  // namespace

std::vector<double> edge_costs(const Points& points, std::span<const double> norms, const Partition& groups) {
  std::vector<double> alpha(groups.order.size());
  for (std::size_t g = 0; g < groups.clusters(); ++g) {
    const auto members = groups.members(g);
    const PointSum sum = sum_of(points, norms, members);
    double* out = alpha.data() + groups.starts[g];
    parallel_for(members.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      PointReader reader(points);
      for (std::size_t k = begin; k < end; ++k) {
        const double product = norms[members[k]] * sum.weight;
        const double cost = product - dot(reader[members[k]], sum.vector.data());
        out[k] = cost > points.zero_cost() * product ? cost : 0.0;
      }
    });
  }
  return alpha;
}

Centers draw_centers(std::span<const double> alpha, std::size_t count, std::uint64_t seed) {
  std::vector<double> cdf(alpha.size() + 1, 0.0);
  std::size_t candidates = 0;
  for (std::size_t k = 0; k < alpha.size(); ++k) {
    cdf[k + 1] = cdf[k] + alpha[k];
    candidates += alpha[k] > 0;
  }
  count = std::min(count, candidates);
  Centers centers;
  if (count == 0) return centers;
  Rng rng(seed, Stage::clustering, 0);
  std::map<std::uint32_t, double> multiset;
  for (std::size_t draw = 0; multiset.size() < count && draw < 64 * count; ++draw) {
    const double target = rng.next_double() * cdf.back();
    // The bin whose right edge is the first above the target: never one of zero width.
    const auto it = std::upper_bound(cdf.begin() + 1, cdf.end(), target);
    if (it == cdf.end()) continue;  // rounding at the very end
    const auto k = static_cast<std::uint32_t>(it - cdf.begin() - 1);
    multiset[k] += cdf.back() / alpha[k];
  }
  for (const auto& [position, weight] : multiset) {
    centers.position.push_back(position);
    centers.weight.push_back(weight);
  }
  return centers;
}

namespace {

constexpr std::size_t kPointBlock = 256, kCenterBlock = 256;
// Cosines nearer to 1 than this differ only by rounding, of single precision or of 16-bit points.
constexpr float kSameDirection = 1e-6f;
// Centers of one direction have equal scales (1/p falls with the length), so distances to them differ by
// rounding; so little nearer is not nearer, or parallel points would be torn apart.
constexpr float kNearer = 1 - 1e-4f;

// label[k] = nearest of the centers (unit vectors in rows, scales w‖k‖) for the members [begin, end).
void nearest_centers(const Points& points, std::span<const double> norms,
                     std::span<const std::uint32_t> members, std::span<const float> units,
                     std::span<const float> scales, std::uint32_t* label) {
  const std::size_t dim = points.dimension;
  const PointReader reader(points);
  std::vector<float> block(kPointBlock * dim), cosine(kPointBlock * kCenterBlock), best(kPointBlock);
  for (std::size_t p = 0; p < members.size(); p += kPointBlock) {
    const std::size_t count = std::min(kPointBlock, members.size() - p);
    for (std::size_t a = 0; a < count; ++a) {
      const std::uint32_t j = members[p + a];
      reader.read(j, block.data() + a * dim, norms[j] > 0 ? static_cast<float>(1.0 / norms[j]) : 0.0f);
      best[a] = std::numeric_limits<float>::infinity();
      label[p + a] = 0;
    }
    std::uint32_t* at = label + p;
    float* min_distances = best.data();
    for (std::size_t q = 0; q < scales.size(); q += kCenterBlock) {
      const std::size_t centers = std::min(kCenterBlock, scales.size() - q);
      gemm({centers, count, dim, false, true}, units.data() + q * dim, dim, block.data(), dim, cosine.data(),
           kPointBlock);
      // Points side by side, centers one after the other.
      for (std::size_t k = 0; k < centers; ++k) {
        const float* row = cosine.data() + k * kPointBlock;
        const float scale = scales[q + k];
        const auto number = static_cast<std::uint32_t>(q + k);
        for (std::size_t a = 0; a < count; ++a) {
          const float angle = 1.0f - row[a];
          const float distance = angle > kSameDirection ? scale * angle : 0.0f;
          const bool nearer = distance < kNearer * min_distances[a];
          min_distances[a] = nearer ? distance : min_distances[a];
          at[a] = nearer ? number : at[a];
        }
      }
    }
  }
}

}  // namespace

Partition assign_to_centers(const Points& points, std::span<const double> norms, const Partition& groups,
                            const Centers& centers) {
  const std::size_t dim = points.dimension;
  // Scales only matter by their ratios; the largest is made 1 to stay within single precision.
  double max_scale = 0;
  for (std::size_t k = 0; k < centers.position.size(); ++k)
    max_scale = std::max(max_scale, centers.weight[k] * norms[groups.order[centers.position[k]]]);

  Partition result;
  result.order.reserve(groups.order.size());
  result.starts.push_back(0);
  std::size_t next = 0;
  for (std::size_t g = 0; g < groups.clusters(); ++g) {
    const auto members = groups.members(g);
    const std::size_t first = next;
    while (next < centers.position.size() && centers.position[next] < groups.starts[g + 1]) ++next;
    const std::size_t count = next - first;
    std::vector<std::uint32_t> label(members.size(), 0);
    if (count > 1) {
      std::vector<float> units(count * dim), scales(count);
      const PointReader reader(points);
      for (std::size_t k = 0; k < count; ++k) {
        const std::uint32_t j = groups.order[centers.position[first + k]];
        scales[k] = static_cast<float>(centers.weight[first + k] * norms[j] / max_scale);
        reader.read(j, units.data() + k * dim, static_cast<float>(1 / norms[j]));
      }
      parallel_for(members.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        nearest_centers(points, norms, members.subspan(begin, end - begin), units, scales,
                        label.data() + begin);
      });
    }
    std::vector<std::uint32_t> offset(std::max<std::size_t>(count, 1) + 1, 0);
    for (std::uint32_t l : label) ++offset[l + 1];
    const auto base = static_cast<std::uint32_t>(result.order.size());
    for (std::size_t k = 1; k < offset.size(); ++k) {
      if (offset[k] > 0) result.starts.push_back(base + offset[k - 1] + offset[k]);
      offset[k] += offset[k - 1];
    }
    result.order.resize(base + members.size());
    for (std::size_t k = 0; k < members.size(); ++k) result.order[base + offset[label[k]]++] = members[k];
  }
  return result;
}

}  // namespace lumirank::linalg
