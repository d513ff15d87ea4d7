// Bounds of entries for sets of receivers: what geometry and materials allow at most.
#pragma once

#include <vector>

#include "matrix/entry_bounds.h"
#include "scatter/lobe_bound.h"
#include "transport/pairs/sphere_rules.h"
#include "transport/rows/receivers.h"

namespace lumirank::transport {

// What of a matrix's settings entries depend on.
struct BoundRules {
  SphereRules spheres;
  float traced_direct_below = 0;
};

// All rows are one box of places, one cone of normals, and materials: the largest of the lambertian ones,
// each of a few others, or the largest of many others wherever the light is. A single receiver is the case of
// a point and a single normal. Seen from a row, a set of lights is the box of differences.
class SceneRowBounds final : public matrix::RowBounds {
 public:
  SceneRowBounds(const Receivers& receivers, const BoundRules& rules)
      : SceneRowBounds(std::vector<const Receivers*>{&receivers}, rules) {}
  // Of several matrices, as block_diagonal.h numbers their rows: one part's after the other's.
  SceneRowBounds(std::vector<const Receivers*> parts, const BoundRules& rules);

  void set_rows(std::span<const matrix::Index> rows) override;
  Rgb bound(const matrix::ColumnSet& set) const override;
  matrix::BoundParts parts(const matrix::ColumnSet& set) const override;  // of any set but rays
  const Bounds3f& box() const { return box_; }                            // of the rows

 private:
  // Rows with more closures than that know only their greatest values.
  static constexpr std::size_t kMaxClosures = 8;

  struct Row {
    const Receivers& of;
    matrix::Index i;
  };
  Row row(matrix::Index i) const;
  static scatter::ClosureBound closure_bound(const Row& row);
  Rgb scattered(const scatter::DirectionCone& cone, float cosine, bool direct) const;

  std::vector<const Receivers*> parts_;
  std::vector<std::size_t> first_;  // rows of the parts before each
  BoundRules rules_;
  Bounds3f box_;
  matrix::Cone normals_;  // of rows that do not answer light from behind
  float normals_sine_ = 0;
  Rgb matt_;  // greatest albedo/π
  std::vector<scatter::ClosureBound> closures_;
  bool many_ = false, behind_ = false;  // more closures; some answer light from behind
  Rgb max_f_, max_direct_;              // of many closures, f times the cosine
  bool sharp_ = false;                  // of spherical lights, integrals may follow a lobe
};

}  // namespace lumirank::transport
