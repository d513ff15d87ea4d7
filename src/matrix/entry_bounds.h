// Upper bounds of what a set of columns adds to a row, without evaluating its entries: light cuts refine by
// them (Walter et al. 2005, section 4.1: material × geometry × intensity, visibility taken as 1).
#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "base/bounds.h"
#include "base/rgb.h"
#include "base/vec.h"

namespace lumirank::matrix {

using Index = std::uint32_t;

// All directions within an angle of an axis.
struct Cone {
  Vec3f axis{0, 0, 1};  // unit
  float cosine = -1;    // of that angle; -1: all directions
};
// A cone that holds both; the least one, but for rounding to the safe side (4e-7 of the cosine).
Cone join(const Cone& a, const Cone& b);

// How a column sends light. Columns that differ in it, of which only one is spherical, or that scatter in
// different media, do not share a node.
enum class Emission : std::uint8_t {
  omni,         // from its position, in all directions alike or bounded by the same number
  oriented,     // the same times the cosine with its normal, nothing behind
  directional,  // from infinitely far
  ray,          // scattered in a medium out of what flies along a line within its box
};

// A set of columns of one kind, as bounds see it.
struct ColumnSet {
  Emission emission = Emission::omni;
  bool spherical = false;
  // All of them stand for emitters: rows may take part of such light from elsewhere, where it is not in the
  // entries.
  bool direct = false;
  Bounds3f box;  // positions; not used if directional
  // oriented: normals; directional: directions towards the light; ray: of the flights
  Cone cone;
  float radius = 0, min_radius = 0;  // of the largest and the smallest sphere
  // Sum over the columns of the greatest radiant intensity that each has in any direction, before the cosine
  // (directional: irradiance; ray: flux that is scattered along it at most, whatever the direction).
  Rgb intensity{0};
  // ray: the medium, which columns of a node have in common, and the least of the lengths along which each
  // scatters its flux where it scatters at its greatest rate all along.
  std::int16_t medium = -1;
  float min_length = 0;
  // Sum over the columns of the greatest entry that clamping leaves; infinite where it leaves any.
  Rgb ceiling{kInfinity};
};
// Both must be of one kind (emission, spherical and medium).
ColumnSet join(const ColumnSet& a, const ColumnSet& b);

// A bound apart from what distance makes of it.
struct BoundParts {
  Rgb reflected;            // bound = min(reflected · near, ceiling)
  float near = 1, far = 1;  // factors at the least and at the greatest distance
};

// Bounds for one set of rows at a time: a receiver, the receivers of a pixel, a slice. One thread at a time.
class RowBounds {
 public:
  virtual ~RowBounds() = default;
  // The rows of which the following questions ask. Costs O(rows); keeps its buffers.
  virtual void set_rows(std::span<const Index> rows) = 0;
  // Per channel, at least Σ_j∈set E(i, j) for every one of the rows i; of entries that estimate an integral,
  // at least these integrals, but of rays that nearly touch (media_row_bounds.h). Finite unless a row may
  // lie in the set's box and nothing is clamped (nor spherical).
  virtual Rgb bound(const ColumnSet& set) const = 0;
  // The same in parts, for guesses at what a set sends rather than at what it sends at most.
  virtual BoundParts parts(const ColumnSet& set) const { return {bound(set)}; }
};

}  // namespace lumirank::matrix
