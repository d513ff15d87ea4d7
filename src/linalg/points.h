// Many points of few dimensions, as the clustering sees them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lumirank::linalg {

// A view of count × dimension coordinates, point-major: floats, or (data is null) 16-bit integers in units of
// a power of two that each point has for itself.
struct Points {
  const float* data = nullptr;
  std::size_t count = 0;
  std::size_t dimension = 0;
  const std::int16_t* units = nullptr;
  const float* unit = nullptr;

  // Costs below this share of (Σ‖x‖)² are rounding of the coordinates: the members are parallel.
  double zero_cost() const { return data ? 1e-12 : 1e-6; }
};

// Coordinates as floats, one point at a time: where they lie, or converted to a place of its own.
class PointReader {
 public:
  explicit PointReader(const Points& points)
      : points_(points), converted_(points.data ? 0 : points.dimension) {}
  // Valid until the next call.
  std::span<const float> operator[](std::size_t j) {
    if (points_.data) return {points_.data + j * points_.dimension, points_.dimension};
    read(j, converted_.data());
    return converted_;
  }
  // `out`: dimension floats.
  void read(std::size_t j, float* out, float factor = 1) const {
    const std::size_t dim = points_.dimension;
    if (points_.data) {
      const float* from = points_.data + j * dim;
      for (std::size_t d = 0; d < dim; ++d) out[d] = factor * from[d];
    } else {
      const std::int16_t* from = points_.units + j * dim;
      const float scale = factor * points_.unit[j];
      for (std::size_t d = 0; d < dim; ++d) out[d] = scale * static_cast<float>(from[d]);
    }
  }

 private:
  Points points_;
  std::vector<float> converted_;
};

// Writes `point` as 16-bit integers; returns their unit: the power of two that makes the largest need all 16
// bits, so that coordinates are off by at most 2⁻¹⁵ of it.
float pack_point(std::span<const float> point, std::int16_t* out);

// Σ x_d·y_d in double precision, in an order that depends on the dimension alone.
double dot(std::span<const float> x, const double* y);

// Norms of the points themselves, summed in double precision.
std::vector<double> own_norms(const Points& points);

// A sum of points and of their norms.
struct PointSum {
  explicit PointSum(std::size_t dimension) : vector(dimension, 0.0) {}
  void add(std::span<const float> x, double norm) {
    for (std::size_t d = 0; d < vector.size(); ++d) vector[d] += static_cast<double>(x[d]);
    weight += norm;
  }
  friend PointSum operator+(PointSum a, const PointSum& b) {
    for (std::size_t d = 0; d < a.vector.size(); ++d) a.vector[d] += b.vector[d];
    a.weight += b.weight;
    return a;
  }
  double squared_length() const {
    double s = 0;
    for (double v : vector) s += v * v;
    return s;
  }

  std::vector<double> vector;
  double weight = 0;
};

}  // namespace lumirank::linalg
