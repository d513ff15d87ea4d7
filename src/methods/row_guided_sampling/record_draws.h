// Columns drawn for one receiver from what the records near it say.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "matrix/lighting_matrix.h"
#include "methods/row_guided_sampling/bounded_columns.h"
#include "methods/row_guided_sampling/light_records.h"

namespace lumirank::methods {

struct GuidedColumn {
  matrix::Index column;
  float probability;  // of a draw, by all distributions together: the balance heuristic
  float visible;      // what the records near think of its visibility, in (0, 1]
};

// A mixture of the distributions of the nearest records, with and without visibility, of bounds (may be
// empty), and of the columns' power: where one of them knows nothing of a column, another does, and no column
// that has power is out of reach (importance caching: Georgiev, Křivánek, Popov and Slusallek 2012). Records
// and bounds must outlive it.
class RecordMixture {
 public:
  RecordMixture(const LightRecords& records, const BoundedDistribution& bounded, matrix::Index row);

  // As many columns as `drawn` holds, in equal steps of [0, 1) from `offset`, in [0, 1), steps on: they are
  // spread over the distributions, and in each of them over its columns in their order.
  void draw(double offset, std::span<GuidedColumn> drawn) const;

 private:
  GuidedColumn guided(std::uint32_t column) const;

  struct NearRecord {
    RunningSum lit, unoccluded;
    // Of a draw, and of brightness, for each unit of the sums.
    float lit_share, unoccluded_share, lit_light, unoccluded_light;
  };
  struct Piece {  // of [0, 1), and the distribution that is drawn from there
    double end;
    std::uint32_t distribution;
  };

  const LightRecords& records_;
  const BoundedDistribution& bounded_;
  std::array<Piece, 2 * LightRecords::kNear + 2> pieces_;
  std::size_t piece_count_ = 0, near_count_ = 0;
  std::array<std::optional<NearRecord>, LightRecords::kNear> near_;
  RunningSum power_;
  float bounded_share_ = 0, power_share_ = 1;
};

// The fraction of a scrambled van der Corput sequence (Owen 1995): any 2^k ≤ 64 numbers after one another
// from a multiple of 2^k on are in different parts of as many equal ones. Rows that follow one another lie
// close in the picture, so errors of neighbors make up for one another (Ahmed and Wonka 2020); blocks of 64
// are scrambled apart, since a denoiser takes what is alike in all of them for a pattern of the scene.
double spread_fraction(std::uint64_t index, std::uint64_t seed);

}  // namespace lumirank::methods
