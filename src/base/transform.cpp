#include "base/transform.h"

#include <cmath>

namespace lumirank {

Transform Transform::translate(double x, double y, double z) {
  Transform t;
  t.m[3] = x, t.m[7] = y, t.m[11] = z;
  return t;
}

Transform Transform::scale(double x, double y, double z) {
  Transform t;
  t.m[0] = x, t.m[5] = y, t.m[10] = z;
  return t;
}

Transform Transform::rotate(double x, double y, double z, double degrees) {
  const double len = std::sqrt(x * x + y * y + z * z);
  x /= len, y /= len, z /= len;
  const double a = degrees * 3.14159265358979323846 / 180.0;
  const double c = std::cos(a), s = std::sin(a), k = 1 - c;
  Transform t;
  t.m = {c + x * x * k,
         x * y * k - z * s,
         x * z * k + y * s,
         0,  //
         y * x * k + z * s,
         c + y * y * k,
         y * z * k - x * s,
         0,  //
         z * x * k - y * s,
         z * y * k + x * s,
         c + z * z * k,
         0,  //
         0,
         0,
         0,
         1};
  return t;
}

Transform Transform::look_at(Vec3d origin, Vec3d target, Vec3f up) {
  const Vec3d way = target - origin;
  // Scaled first: the squares of tiny and huge numbers leave the range of float.
  const double max_abs = std::max({std::abs(way.x), std::abs(way.y), std::abs(way.z)});
  const bool extreme = !(max_abs > 0x1p-40 && max_abs < 0x1p40) && max_abs > 0 && std::isfinite(max_abs);
  return aimed(origin, static_cast<Vec3f>(extreme ? way * (1 / max_abs) : way), up);
}

Transform Transform::aimed(Vec3d origin, Vec3f direction, Vec3f up) {
  const Vec3f dir = normalize(direction);
  const Vec3f left = normalize(cross(up, dir));
  const Vec3f new_up = cross(dir, left);
  Transform t;
  for (int i = 0; i < 3; ++i) {
    t.m[4 * i + 0] = left[i];
    t.m[4 * i + 1] = new_up[i];
    t.m[4 * i + 2] = dir[i];
    t.m[4 * i + 3] = origin[i];
  }
  return t;
}

Transform operator*(const Transform& a, const Transform& b) {
  Transform t;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      double sum = 0;
      for (int k = 0; k < 4; ++k) sum += a.m[4 * i + k] * b.m[4 * k + j];
      t.m[4 * i + j] = sum;
    }
  return t;
}

std::optional<Transform> Transform::inverse() const {
  // Gauss-Jordan with partial pivoting.
  std::array<double, 16> a = m;
  Transform inv;
  for (int col = 0; col < 4; ++col) {
    int pivot = col;
    for (int row = col + 1; row < 4; ++row)
      if (std::abs(a[4 * row + col]) > std::abs(a[4 * pivot + col])) pivot = row;
    const double p = a[4 * pivot + col];
    if (!(std::abs(p) > 1e-300) || !std::isfinite(p)) return std::nullopt;
    for (int k = 0; k < 4; ++k) {
      std::swap(a[4 * pivot + k], a[4 * col + k]);
      std::swap(inv.m[4 * pivot + k], inv.m[4 * col + k]);
    }
    for (int k = 0; k < 4; ++k) a[4 * col + k] /= p, inv.m[4 * col + k] /= p;
    for (int row = 0; row < 4; ++row) {
      if (row == col) continue;
      const double f = a[4 * row + col];
      for (int k = 0; k < 4; ++k) {
        a[4 * row + k] -= f * a[4 * col + k];
        inv.m[4 * row + k] -= f * inv.m[4 * col + k];
      }
    }
  }
  return inv;
}

double Transform::determinant3() const {
  return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
         m[2] * (m[4] * m[9] - m[5] * m[8]);
}

bool Transform::is_finite() const {
  for (double v : m)
    if (!std::isfinite(v)) return false;
  return true;
}

Vec3d Transform::place(Vec3d p) const {
  double v[4];
  for (int i = 0; i < 4; ++i) v[i] = m[4 * i] * p.x + m[4 * i + 1] * p.y + m[4 * i + 2] * p.z + m[4 * i + 3];
  const double w = v[3] == 1 ? 1 : 1 / v[3];
  return {v[0] * w, v[1] * w, v[2] * w};
}

Vec3f Transform::point(Vec3f p) const { return static_cast<Vec3f>(place(p)); }

Vec3f Transform::vector(Vec3f p) const {
  double v[3];
  for (int i = 0; i < 3; ++i) v[i] = m[4 * i] * p.x + m[4 * i + 1] * p.y + m[4 * i + 2] * p.z;
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

Vec3f Transform::normal(const Transform& inverse, Vec3f n) {
  double v[3];
  for (int i = 0; i < 3; ++i) v[i] = inverse.m[i] * n.x + inverse.m[4 + i] * n.y + inverse.m[8 + i] * n.z;
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

}  // namespace lumirank
