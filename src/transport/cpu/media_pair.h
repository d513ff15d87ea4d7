// Sixteen entries at a time of a lighting matrix with a ray or a segment in them: where on these the integral
// is estimated, and what light would arrive if nothing were between and along them.
#pragma once

#include <cstdint>
#include <vector>

#include "base/lane_math.h"
#include "base/random.h"
#include "transport/lights/ray_lights.h"
#include "transport/pairs/ray_sampling.h"
#include "transport/rows/receivers.h"
#include "world/world.h"

namespace lumirank::transport {

enum class PairKind : std::uint8_t {
  point_to_receiver,  // equation 6, which is a SceneMatrix's
  ray_to_receiver,    // equation 5
  point_to_segment,   // equation 4
  ray_to_segment,     // equation 3: what of the ray scatters to the segment and there towards the eye
};
inline constexpr int kPairKinds = 4;
constexpr bool has_ray(PairKind kind) {
  return kind == PairKind::ray_to_receiver || kind == PairKind::ray_to_segment;
}
constexpr bool has_segment(PairKind kind) {
  return kind == PairKind::point_to_segment || kind == PairKind::ray_to_segment;
}

// Sixteen connections between a place of a row and one of a column.
struct Connections {
  std::uint32_t alive = 0;   // lanes with a value
  Lane3 value;               // E, but for what media and panes take
  Lane3 from, to;            // the places; to directional light: the direction towards it
  Lane row_way, column_way;  // from where the segment and the ray begin to the places on them
};

// Indices of rows and columns count within their kind.
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
             const Settings& settings);

  const world::World& world() const { return world_; }
  const Receivers& receivers() const { return receivers_; }
  const LightsInMedia& lights() const { return lights_; }
  std::uint64_t seed() const { return settings_.seed; }
  bool too_deep(PairKind kind, std::uint32_t row, std::uint32_t column) const;
  // Of tracking through media.
  Rng random_of(PairKind kind, std::uint32_t row, std::uint32_t column) const;
  std::uint32_t row_key(PairKind kind, std::uint32_t row) const;
  std::uint32_t column_key(PairKind kind, std::uint32_t column) const;
  std::size_t memory_bytes() const;

  // Of one kind, but not point_to_receiver.
  void connect(PairKind kind, const std::uint32_t rows[16], const std::uint32_t columns[16],
               Connections& out) const;

 private:
  // How a point sends light.
  enum class Sends : std::uint8_t { evenly, facing, otherwise };

  void ray_to_receiver(const std::uint32_t* rows, const std::uint32_t* columns, Connections& out) const;
  void point_to_segment(const std::uint32_t* rows, const std::uint32_t* columns, Connections& out) const;
  void ray_to_segment(const std::uint32_t* rows, const std::uint32_t* columns, Connections& out) const;
  struct Numbers {
    Lane first, second;
  };
  Numbers numbers(PairKind kind, const std::uint32_t* rows, const std::uint32_t* columns) const;
  // What the media that `number` gives for `items` scatter at the places, by the cosine between directions.
  Lane3 scattered(const std::vector<std::int16_t>& number, const std::uint32_t* items, LaneMask wanted,
                  const Lane3& places, Lane cosine) const;
  Lane3 shining(const std::uint32_t* points, LaneMask wanted, const Lane3& w) const;
  Lane3 reflected(const std::uint32_t* receivers, LaneMask wanted, const Lane3& w) const;

  const world::World& world_;
  const Receivers& receivers_;
  const LightsInMedia& lights_;
  Settings settings_;
  std::vector<std::uint32_t> receiver_key_, segment_key_, point_key_, ray_key_;  // of random numbers
  std::vector<Sends> sends_;
  std::vector<Rgb> sent_;  // by points that send evenly, or times the cosine
};

}  // namespace lumirank::transport
