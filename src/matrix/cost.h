// Cost of a call on a lighting matrix.
#pragma once

#include <cstdint>

namespace lumirank::matrix {

struct Cost {
  std::uint64_t entries = 0;  // whose value was needed, zero or not
  std::uint64_t culled = 0;   // of these, decided without a ray because E = 0
  std::uint64_t rays = 0;     // shadow rays
  // r + g + b over the entries whose value was asked for, as they were added up: what is visible of them
  // after clamping, what clamping took away from that, and what of it nothing else gives back to the picture.
  double energy = 0, clamped = 0, lost = 0;

  Cost& operator+=(const Cost& o) {
    entries += o.entries, culled += o.culled, rays += o.rays;
    energy += o.energy, clamped += o.clamped, lost += o.lost;
    return *this;
  }
  friend Cost operator+(Cost a, const Cost& b) { return a += b; }
  bool operator==(const Cost&) const = default;
};

// Energy that clamping took away, as a share of what there would be without it; 0 where there is none.
inline double clamped_fraction(const Cost& cost) {
  const double whole = cost.energy + cost.clamped;
  return whole > 0 ? cost.clamped / whole : 0;
}

}  // namespace lumirank::matrix
