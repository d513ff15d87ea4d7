#include "methods/row_guided_sampling/bounded_columns.h"

#include <algorithm>
#include <cmath>

namespace lumirank::methods {

namespace {

// Cosines count as at least this: a group has more than one place, and shading normals may lean.
constexpr float kLeastCosine = 0.05f;
// Normals that agree less than this, in the mean, say nothing of the group.
constexpr float kAgreement = 0.8f;
// Beside cosine/π of a surface 1/(4π) of a point, both times π.
constexpr float kOmni = 0.25f;

// In lanes, which vectors can add.
float sum_of_block(const float* weights) {
  constexpr std::size_t kLanes = 16;
  std::array<float, kLanes> lanes{};
  for (std::size_t k = 0; k < BoundedDistribution::kBlock; k += kLanes)
    for (std::size_t l = 0; l < kLanes; ++l) lanes[l] += weights[k + l];
  float sum = 0;
  for (const float lane : lanes) sum += lane;
  return sum;
}

}  // namespace

BoundedColumns::BoundedColumns(const matrix::ColumnFeatures& features, std::size_t columns) {
  if (features.position.size() != columns || features.power.size() != columns ||
      features.normal.size() != columns)
    return;
  for (std::size_t c = 0; c < 3; ++c) {
    position_[c].resize(columns), normal_[c].resize(columns);
    for (std::size_t j = 0; j < columns; ++j) {
      position_[c][j] = features.position[j][static_cast<int>(c)];
      normal_[c][j] = features.normal[j][static_cast<int>(c)];
    }
  }
  power_.assign(features.power.begin(), features.power.end());
  least_.resize(columns);
  for (std::size_t j = 0; j < columns; ++j)
    least_[j] = length_squared(features.normal[j]) > 0 ? kLeastCosine : kOmni;
}

void BoundedDistribution::update(const BoundedColumns& columns, const matrix::RowFeatures& rows,
                                 std::span<const matrix::Index> group) {
  total_ = 0;
  const std::size_t n = columns.size();
  if (n == 0 || rows.position.empty() || group.empty()) return;
  const auto count = static_cast<float>(group.size());
  Vec3f center, normal;
  for (const matrix::Index row : group) {
    center += rows.position[row] / count;
    if (!rows.normal.empty()) normal += rows.normal[row] / count;
  }
  float extent = 1e-12f;  // the mean square
  for (const matrix::Index row : group) extent += length_squared(rows.position[row] - center) / count;
  const bool agree = length_squared(normal) > kAgreement * kAgreement;
  if (!agree) normal = {};
  const float least = agree ? kLeastCosine : 1.0f;
  const float *x = columns.position_[0].data(), *y = columns.position_[1].data(),
              *z = columns.position_[2].data();
  const float *u = columns.normal_[0].data(), *v = columns.normal_[1].data(), *w = columns.normal_[2].data();
  const float *least_there = columns.least_.data(), *power = columns.power_.data();
  const auto weight_of = [&](std::size_t j) {
    const float dx = x[j] - center.x, dy = y[j] - center.y, dz = z[j] - center.z;
    const float inverse = 1 / std::sqrt(dx * dx + dy * dy + dz * dz + extent);
    const float there = std::max(least_there[j], -(dx * u[j] + dy * v[j] + dz * w[j]) * inverse);
    const float here = std::max(least, (dx * normal.x + dy * normal.y + dz * normal.z) * inverse);
    return power[j] * there * here * (inverse * inverse);
  };
  weights_.assign((n + kBlock - 1) / kBlock * kBlock, 0.0f);
  blocks_.resize(weights_.size() / kBlock);
  float* weight = weights_.data();
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const std::size_t begin = b * kBlock, end = std::min(n, begin + kBlock);
    for (std::size_t j = begin; j < end; ++j) weight[j] = weight_of(j);
    blocks_[b] = sum_of_block(weights_.data() + begin);
    total_ += static_cast<double>(blocks_[b]);
  }
  if (!std::isfinite(total_)) total_ = 0;
}

matrix::Index BoundedDistribution::draw(double u) const {
  double left = u * total_;
  std::size_t b = 0, last = 0;
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    if (!(blocks_[k] > 0)) continue;
    b = k;
    if (left < static_cast<double>(blocks_[k])) break;
    left -= static_cast<double>(blocks_[k]);
  }
  for (std::size_t j = b * kBlock; j < (b + 1) * kBlock; ++j) {
    if (!(weights_[j] > 0)) continue;
    last = j;
    if (left < static_cast<double>(weights_[j])) break;
    left -= static_cast<double>(weights_[j]);
  }
  return static_cast<matrix::Index>(last);
}

}  // namespace lumirank::methods
