// Participating media: what they absorb, scatter and add along a ray. Everything is in units of the world;
// coefficients are per length of it, for each channel.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "base/bounds.h"
#include "base/rgb.h"
#include "media/grid.h"
#include "media/phase.h"

namespace lumirank::media {

inline Rgb not_negative(Rgb c) { return {std::max(c.r, 0.0f), std::max(c.g, 0.0f), std::max(c.b, 0.0f)}; }

// Of something per length over a length that may be infinite, where 0 · ∞ is 0.
inline Rgb over_length(Rgb per_length, float length) {
  Rgb out{0};
  for (int c = 0; c < 3; ++c)
    if (per_length[c] > 0) out[c] = per_length[c] * length;
  return out;
}

// What a medium is at one place.
struct Coefficients {
  Rgb extinction, scattering;
  Rgb emission;  // radiance added for each length
};

// Of the extinction in the cells of a coarse grid over a medium's box.
class ExtinctionBounds {
 public:
  struct Range {
    Rgb least, most;
    // What is between: within `half` of the middle in every channel.
    Rgb middle() const { return (least + most) * 0.5f; }
    float half() const { return 0.5f * max_component(most - least); }
  };
  ExtinctionBounds(std::array<int, 3> size, std::vector<Range> cells)
      : size_(size), cells_(std::move(cells)) {}
  const std::array<int, 3>& size() const { return size_; }
  int index(int x, int y, int z) const { return (z * size_[1] + y) * size_[0] + x; }
  const Range& operator[](int index) const { return cells_[static_cast<std::size_t>(index)]; }
  std::size_t memory_bytes() const { return cells_.size() * sizeof(Range); }

 private:
  std::array<int, 3> size_;
  std::vector<Range> cells_;
};

class Medium {
 public:
  // What is given: extinction and albedo, or absorption and scattering.
  enum class Form : std::uint8_t { extinction_and_albedo, absorption_and_scattering };

  // first, second: as the form says. Fields of lengths' coefficients that have grids are 0 outside of them.
  Medium(Form form, Field first, Field second, Field emission, const PhaseFunction& phase);

  const PhaseFunction& phase() const { return phase_; }
  bool homogeneous() const { return !bounds_; }         // in what it takes from light
  const Rgb& even_extinction() const { return even_; }  // where it is homogeneous
  bool scatters_evenly() const { return !first_.grid && !second_.grid; }
  bool emits() const { return !emission_.zero(); }
  // Somewhere, perhaps.
  bool scatters() const {
    return !second_.zero() && (form_ == Form::absorption_and_scattering || !first_.zero());
  }
  Coefficients at(Vec3f place) const;
  Rgb extinction(Vec3f place) const {  // alone, as in at()
    const Rgb first = not_negative(first_.at(place));
    return form_ == Form::extinction_and_albedo ? first : first + not_negative(second_.at(place));
  }

  // The cells that a ray passes, one after the other, with bounds of the extinction in them; what it passes
  // before, between and after is empty. A homogeneous medium is one cell.
  class Walk {
   public:
    struct Piece {
      float begin = 0, end = 0;
      ExtinctionBounds::Range extinction{};
    };
    // `direction`: unit.
    Walk(const Medium& medium, Vec3f origin, Vec3f direction, float t_max);
    bool next(Piece& piece);
    // Numbers of the grid along a unit of the ray, where the extinction has one.
    float places_per_length() const;
    // At origin + t·direction, which lies in one of the pieces.
    Rgb extinction(float t) const {
      const bool one = medium_.form_ == Form::extinction_and_albedo;
      return one ? not_negative(medium_.first_.scale *
                                medium_.first_.grid->at(unit_origin_ + unit_direction_ * t))
                 : medium_.extinction(origin_ + direction_ * t);
    }

   private:
    const Medium& medium_;
    Vec3f origin_, direction_, unit_origin_, unit_direction_;  // in the world and in the box of the bounds
    bool done_ = false;
    float t_ = 0, t_end_ = 0;
    // Along each axis: cells until the box ends, how the index changes with one, and where the next begins.
    int left_[3]{}, stride_[3]{}, index_ = 0;
    float next_t_[3]{}, delta_t_[3]{};
  };

  // What scatters along a ray's way at most: over all of it, and where it is most per length.
  struct Scattering {
    Rgb total, most;
  };
  Scattering max_scattering(Vec3f origin, Vec3f direction, float length) const;

  std::size_t memory_bytes() const;  // without its grids, which media may share

 private:
  friend class Walk;
  Form form_;
  Field first_, second_, emission_;
  PhaseFunction phase_;
  std::optional<ExtinctionBounds> bounds_;
  Transform to_unit_;  // of the box of bounds_
  Rgb even_;
  Rgb max_albedo_{1};
};

inline bool Medium::Walk::next(Piece& piece) {
  if (done_) return false;
  if (medium_.homogeneous()) {
    piece = {0, t_end_, {medium_.even_, medium_.even_}};
    done_ = true;
    return true;
  }
  const int axis =
      next_t_[0] < next_t_[1] ? (next_t_[0] < next_t_[2] ? 0 : 2) : (next_t_[1] < next_t_[2] ? 1 : 2);
  const float end = std::min(t_end_, std::max(t_, next_t_[axis]));
  piece = {t_, end, (*medium_.bounds_)[index_]};
  t_ = end;
  index_ += stride_[axis];
  next_t_[axis] += delta_t_[axis];
  done_ = !(t_ < t_end_) || --left_[axis] == 0;
  return true;
}

}  // namespace lumirank::media
