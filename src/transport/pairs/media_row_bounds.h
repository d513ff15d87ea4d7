// Bounds of entries in participating media: for rows that are receivers or pieces of eye rays, and columns
// that are points or rays.
//
// An entry along a ray is an integral of 1/d². Where the ray is no nearer than D, its part along a length L
// is at most min(L/D², π/D): a line as a whole subtends an angle of π, over its distance (Vibert et al.,
// "Scalable virtual ray lights rendering for participating media", 2019, bound the same estimates). Boxes of
// lights in fog mostly have rows in them, and then D is 0 and nothing is bounded; so D is a quarter of L at
// least, and the few pairs that come nearer may bring more than their bound. What is between takes nothing,
// but for homogeneous media that both ends are in, of which the shortest way is subtracted; that supposes
// that this way stays within them.
#pragma once

#include <vector>

#include "transport/pairs/row_bounds.h"
#include "world/world.h"

namespace lumirank::transport {

class MediaRowBounds final : public matrix::RowBounds {
 public:
  // Rows: first the receivers, then their segments. Holds references.
  MediaRowBounds(const world::World& world, const Receivers& receivers, const BoundRules& rules);

  void set_rows(std::span<const matrix::Index> rows) override;
  Rgb bound(const matrix::ColumnSet& set) const override;
  matrix::BoundParts parts(const matrix::ColumnSet& set) const override;

 private:
  // Few rows are taken one by one, and each in parts, whose bounds add up; of many it is known only in what
  // box they are, and what is greatest in any.
  static constexpr std::size_t kRowsApart = 4;
  static constexpr int kPartsOfRow = 4;

  // What towards the eye may be scattered along a part of a row.
  struct Piece {
    Bounds3f box;
    matrix::Cone directions;  // of the eye rays
    media::Medium::Scattering scattering;
    float spread = 0;  // along such a length, if it were the greatest all along
    std::int16_t medium = -1;
    std::uint32_t sum = 0;  // pieces of one number add up, those of others are other rows
  };
  void take_apart(std::size_t segment, std::uint32_t sum);
  void merge(std::size_t segment);
  const media::Medium& medium(std::int16_t number) const {
    return world_.media()[static_cast<std::size_t>(number)];
  }
  matrix::BoundParts of_surfaces(const matrix::ColumnSet& set) const;
  matrix::BoundParts of_piece(const Piece& piece, const matrix::ColumnSet& set) const;
  // Of each row the sum over its pieces, and of these the greatest: apart from distances, and at the least
  // and the greatest of these.
  struct Sums {
    Rgb reflected{0}, near{0}, far{0};
  };
  Sums greatest(const matrix::ColumnSet& set) const;

  const world::World& world_;
  const Receivers& receivers_;
  SceneRowBounds surfaces_;
  std::vector<matrix::Index> on_surfaces_;
  std::vector<Piece> pieces_;
};

// What a ray is to bounds: its flux is `power` at the origin.
matrix::ColumnSet ray_set(const media::Medium& medium, std::int16_t number, Vec3f origin, Vec3f direction,
                          float length, Rgb power);

}  // namespace lumirank::transport
