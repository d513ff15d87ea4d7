// Many points of few dimensions, as the clustering sees them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lumirank::linalg {

// A view of count × dimension floats, point-major.
struct Points {
  const float* data = nullptr;
  std::size_t count = 0;
  std::size_t dimension = 0;

  std::span<const float> operator[](std::size_t j) const { return {data + j * dimension, dimension}; }
};

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
