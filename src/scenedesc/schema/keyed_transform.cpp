#include "scenedesc/schema/keyed_transform.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lumirank::scenedesc {
namespace {

using Quaternion = std::array<double, 4>;  // x, y, z, w

// Linear part without translation, as a transform.
Transform linear_part(const Transform& t) {
  Transform linear = t;
  linear.m[3] = linear.m[7] = linear.m[11] = 0;
  return linear;
}

Transform transposed(const Transform& t) {
  Transform out;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) out.m[i * 4 + j] = t.m[j * 4 + i];
  return out;
}

// The rotation nearest to the linear part, by averaging it with its inverse transpose until that changes
// nothing more; with a mirror in it if the transform has one. Singular transforms have none: the identity.
Transform rotation_of(const Transform& t) {
  Transform r = linear_part(t);
  for (int step = 0; step < 100; ++step) {
    const auto inverse = r.inverse();
    if (!inverse) return {};
    const Transform other = transposed(*inverse);
    double change = 0;
    for (const std::size_t i : {0u, 1u, 2u, 4u, 5u, 6u, 8u, 9u, 10u}) {
      const double mean = 0.5 * (r.m[i] + other.m[i]);
      change = std::max(change, std::abs(mean - r.m[i]));
      r.m[i] = mean;
    }
    if (change < 1e-14) break;
  }
  return r;
}

Quaternion quaternion_of(const Transform& r) {
  const auto& m = r.m;
  const double trace = m[0] + m[5] + m[10];
  Quaternion q{};
  if (trace > 0) {
    const double s = std::sqrt(trace + 1);
    q[3] = 0.5 * s;
    q[0] = (m[9] - m[6]) * 0.5 / s, q[1] = (m[2] - m[8]) * 0.5 / s, q[2] = (m[4] - m[1]) * 0.5 / s;
    return q;
  }
  const std::size_t i = m[5] > m[0] ? (m[10] > m[5] ? 2 : 1) : (m[10] > m[0] ? 2 : 0), j = (i + 1) % 3,
                    k = (i + 2) % 3;
  const auto at = [&](std::size_t row, std::size_t column) { return m[row * 4 + column]; };
  const double s = std::sqrt(at(i, i) - at(j, j) - at(k, k) + 1);
  q[i] = 0.5 * s;
  q[3] = (at(k, j) - at(j, k)) * 0.5 / s;
  q[j] = (at(j, i) + at(i, j)) * 0.5 / s, q[k] = (at(k, i) + at(i, k)) * 0.5 / s;
  return q;
}

Transform matrix_of(const Quaternion& q) {
  const auto [x, y, z, w] = q;
  Transform t;
  t.m = {1 - 2 * (y * y + z * z),
         2 * (x * y - w * z),
         2 * (x * z + w * y),
         0,
         2 * (x * y + w * z),
         1 - 2 * (x * x + z * z),
         2 * (y * z - w * x),
         0,
         2 * (x * z - w * y),
         2 * (y * z + w * x),
         1 - 2 * (x * x + y * y),
         0,
         0,
         0,
         0,
         1};
  return t;
}

Quaternion turned(const Quaternion& a, Quaternion b, double t) {
  double cosine = 0;
  for (std::size_t c = 0; c < 4; ++c) cosine += a[c] * b[c];
  if (cosine < 0)
    for (double& c : b) c = -c;
  const double angle = std::acos(std::min(std::abs(cosine), 1.0));
  double first = 1 - t, second = t;
  if (angle > 1e-4)
    first = std::sin(angle * first) / std::sin(angle), second = std::sin(angle * t) / std::sin(angle);
  Quaternion out{};
  double size = 0;
  for (std::size_t c = 0; c < 4; ++c) out[c] = first * a[c] + second * b[c], size += out[c] * out[c];
  for (double& c : out) c /= std::sqrt(size);
  return out;
}

Transform mixed(const Transform& a, const Transform& b, double t) {
  Transform out;
  for (std::size_t i = 0; i < 16; ++i) out.m[i] = (1 - t) * a.m[i] + t * b.m[i];
  return out;
}

Transform between(const Transform& a, const Transform& b, double t) {
  if (a == b || t <= 0) return a;
  const bool mirrors = a.determinant3() < 0;
  if (mirrors != (b.determinant3() < 0)) return a;
  // A mirror commutes with stretching and is kept apart, so that what remains is a rotation.
  const Transform mirror = mirrors ? Transform::scale(-1, -1, -1) : Transform{};
  const Transform turn_a = rotation_of(a), turn_b = rotation_of(b);
  const Transform stretch =
      mixed(transposed(turn_a) * linear_part(a), transposed(turn_b) * linear_part(b), t);
  const Transform turn =
      matrix_of(turned(quaternion_of(turn_a * mirror), quaternion_of(turn_b * mirror), t)) * mirror;
  const Vec3d from = a.origin(), to = b.origin();
  return Transform::translate(from + (to - from) * t) * turn * stretch;
}

}  // namespace

Transform transform_at(const std::vector<TransformKey>& keys, double seconds) {
  const auto next = std::upper_bound(keys.begin(), keys.end(), seconds,
                                     [](double s, const TransformKey& key) { return s < key.seconds; });
  if (next == keys.begin()) return keys.front().transform;
  if (next == keys.end()) return keys.back().transform;
  const TransformKey &a = *(next - 1), &b = *next;
  return between(a.transform, b.transform, (seconds - a.seconds) / (b.seconds - a.seconds));
}

}  // namespace lumirank::scenedesc
