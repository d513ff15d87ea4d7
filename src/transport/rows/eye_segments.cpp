#include "transport/rows/eye_segments.h"

namespace lumirank::transport {

void EyeSegments::resize(std::size_t count) {
  origin.resize(count), direction.resize(count), length.resize(count), weight.resize(count);
  id.resize(count), sample.resize(count), depth.resize(count), medium.resize(count);
}

void EyeSegments::set(std::size_t i, const EyeSegment& s) {
  origin[i] = s.origin, direction[i] = s.direction, length[i] = s.length, weight[i] = s.weight;
  id[i] = s.id, sample[i] = s.sample, depth[i] = s.depth, medium[i] = s.medium;
}

}  // namespace lumirank::transport
