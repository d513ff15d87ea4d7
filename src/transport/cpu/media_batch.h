// Entries of a lighting matrix in participating media, collected until there are sixteen of a kind, and then
// until there are sixteen rays.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/ray_scene.h"
#include "matrix/lighting_matrix.h"
#include "media/tracking.h"
#include "transport/cpu/media_pair.h"

namespace lumirank::transport {

// Work space of one task. What is asked for stands in its places after finish().
class MediaBatch {
 public:
  MediaBatch(const MediaPairs& pairs, matrix::Part part);

  // The entry of a row and a column, counted within their kinds.
  void add(PairKind kind, std::uint32_t row, std::uint32_t column, Rgb& out);
  // Takes from `value`, E·V of a receiver and a point in empty space, what media between them take. Panes are
  // in it already.
  void attenuate(std::uint32_t receiver, std::uint32_t point, Rgb& value);
  matrix::Cost finish();  // all but the energy

 private:
  struct Queue {
    int count = 0;
    std::array<std::uint32_t, 16> rows, columns;
    std::array<Rgb*, 16> out;
  };
  struct Connection {
    PairKind kind;
    bool far;  // `to` is the unit direction to something infinitely far
    int medium;
    std::uint32_t row, column;
    Rgb value;
    Vec3f from, to;
    float row_way, column_way;
    Rgb* out;
  };
  void connect(PairKind kind);
  void wait(const Connection& connection);
  // Starts off the receiver's surface, in the medium there.
  void leave_surface(Connection& connection) const;
  void trace();
  std::uint32_t visible(geometry::ShadowPacket& packet);
  // What is left of the connections in `lanes`.
  void attenuate_waiting(std::uint32_t lanes, geometry::ShadowPacket& packet);
  void fly(const Connection& connection, bool clear, media::OpticalPath& path);

  const MediaPairs& pairs_;
  matrix::Part part_;
  bool has_attenuating_;
  matrix::Cost cost_;
  std::array<Queue, kPairKinds> queues_;
  std::array<Connection, 16> waiting_;
  int waiting_count_ = 0;
  std::vector<geometry::Hit> crossed_;
};

}  // namespace lumirank::transport
