#include "film/filter.h"

#include <algorithm>
#include <cmath>

namespace lumirank::film {
namespace {

// Mitchell and Netravali 1988, eq. 8.
float cubic(float x, float b, float c) {
  const float x2 = x * x, x3 = x2 * x;
  if (x < 1) return ((12 - 9 * b - 6 * c) * x3 + (-18 + 12 * b + 6 * c) * x2 + (6 - 2 * b)) / 6;
  if (x < 2)
    return ((-b - 6 * c) * x3 + (6 * b + 30 * c) * x2 + (-12 * b - 48 * c) * x + (8 * b + 24 * c)) / 6;
  return 0;
}

float sinc(float x) { return x < 1e-4f ? 1 : std::sin(kPi * x) / (kPi * x); }

}  // namespace

float Filter::eval(float x) const {
  if (kind == FilterKind::box) return x >= -radius && x < radius ? 1.0f : 0.0f;
  x = std::abs(x);
  if (!(x < radius)) return 0;
  switch (kind) {
    case FilterKind::box:
      return 1;
    case FilterKind::tent:
      return 1 - x / radius;
    case FilterKind::gaussian: {
      // Lowered so that it is 0 at the radius.
      const float alpha = -1 / (2 * stddev * stddev);
      return std::max(0.0f, std::exp(alpha * x * x) - std::exp(alpha * radius * radius));
    }
    case FilterKind::mitchell:
      return cubic(x, b, c);
    case FilterKind::catmullrom:
      return cubic(x, 0, 0.5f);
    case FilterKind::lanczos:
      return sinc(x) * sinc(x / static_cast<float>(lobes));
  }
  return 0;
}

// It lies between 0.5 and k + 0.5 from the centers of the pixels k beside its own, both open: within the
// radius for k ≤ ceil(radius − 0.5) only.
int Filter::reach() const { return std::max(0, static_cast<int>(std::ceil(radius - 0.5f))); }

Filter Filter::standard(FilterKind kind) {
  Filter filter;
  filter.kind = kind;
  switch (kind) {
    case FilterKind::box:
      filter.radius = 0.5f;
      break;
    case FilterKind::tent:
      filter.radius = 1;
      break;
    case FilterKind::gaussian:
      filter.radius = 4 * filter.stddev;
      break;
    case FilterKind::mitchell:
    case FilterKind::catmullrom:
      filter.radius = 2;
      break;
    case FilterKind::lanczos:
      filter.radius = static_cast<float>(filter.lobes);
      break;
  }
  return filter;
}

}  // namespace lumirank::film
