// One entry of a lighting matrix with a ray or a segment in it, or between two points with media between
// them.
#pragma once

#include "base/random.h"
#include "matrix/lighting_matrix.h"
#include "transport/lights/ray_lights.h"
#include "transport/rows/receivers.h"
#include "world/straight_path.h"

namespace lumirank::transport {

class MediaPairs {
 public:
  struct Settings {
    std::uint64_t seed = 1;
    int max_depth = -1;  // as in SceneMatrixSettings
    // Where on a ray and on a segment an entry is estimated is decided by the column alone instead of by the
    // pair: a column is a smooth function of its row, and the matrix of nearly as low a rank as without
    // sampling. Each entry is without bias all the same.
    bool shared_places = false;
  };
  MediaPairs(const world::World& world, const Receivers& receivers, const LightsInMedia& lights,
             const Settings& settings)
      : world_(world), receivers_(receivers), lights_(lights), settings_(settings) {}

  struct Entry {
    Rgb unoccluded;
    bool visible = false;
    bool traced = false;  // a ray was needed
    Rgb of(matrix::Part part) const {
      if (part == matrix::Part::visibility) return Rgb(visible ? 1.0f : 0.0f);
      return part == matrix::Part::unoccluded || visible ? unoccluded : Rgb{0};
    }
  };

  // Equation 3: what of the ray light scatters to the segment and there towards the eye.
  Entry ray_to_segment(std::size_t segment, std::size_t ray, matrix::Part part) const;
  // Equation 4.
  Entry point_to_segment(std::size_t segment, std::size_t point, matrix::Part part) const;
  // Equation 5.
  Entry ray_to_receiver(std::size_t receiver, std::size_t ray, matrix::Part part) const;
  // What media between the two leave of equation 6, whose other factors are a SceneMatrix's. Panes are among
  // those, so they are left out here.
  Rgb media_between(std::size_t receiver, std::size_t point) const;

 private:
  // The random numbers of an entry: those of tracking are the pair's, of places the pair's or the column's.
  struct Numbers {
    Rng tracking, of_column;
    bool shared;
    float place() { return shared ? of_column.next_float() : tracking.next_float(); }
  };
  Numbers numbers_of(std::uint64_t row, std::uint64_t column) const {
    return {{settings_.seed, Stage::ray_pairs, row, column},
            {settings_.seed, Stage::ray_places, column},
            settings_.shared_places};
  }
  bool too_deep(int row, int light) const {
    return settings_.max_depth >= 0 && row + light + 1 > settings_.max_depth;
  }
  const media::Medium& medium(int index) const { return world_.media()[static_cast<std::size_t>(index)]; }
  Entry connect(Rgb value, const world::StraightSegment& segment, matrix::Part part, Rng& rng) const;

  const world::World& world_;
  const Receivers& receivers_;
  const LightsInMedia& lights_;
  Settings settings_;
};

}  // namespace lumirank::transport
