// Rows in participating media: pieces of eye rays, which gather what the medium scatters towards the eye (Huo
// et al. 2016, section 3.2).
#pragma once

#include <cstdint>
#include <vector>

#include "base/random.h"
#include "base/rgb.h"
#include "base/vec.h"
#include "media/medium.h"

namespace lumirank::transport {

// One before all are laid out; see EyeSegments for the fields.
struct EyeSegment {
  Vec3f origin, direction;
  float length = 0;
  Rgb weight;
  std::uint64_t id = 0;
  std::uint32_t sample = 0;
  std::uint16_t depth = 0;
  std::int16_t medium = -1;
  Rgb through{0};  // what of light comes through it, where it was cut by depth; not kept in EyeSegments
};

// Like Receivers, in the order of the film. Row i is what is scattered along
// origin + t·direction, 0 ≤ t ≤ length, towards -direction, as it arrives at the origin.
struct EyeSegments {
  std::vector<Vec3f> origin, direction;  // unit
  std::vector<float> length;
  std::vector<Rgb> weight;  // throughput of the chain from the eye to the origin, transmittance included
  std::vector<std::uint64_t> id;      // who it is, as of receivers
  std::vector<std::uint32_t> sample;  // film sample that it belongs to
  std::vector<std::uint16_t> depth;   // path segments from the eye to here (1: seen directly)
  std::vector<std::int16_t> medium;   // index into World::media()
  std::vector<std::uint32_t> slice;   // of which it is one (eye_groups.h); empty: none were made

  std::size_t size() const { return origin.size(); }
  bool empty() const { return origin.empty(); }
  std::size_t memory_bytes() const {
    return size() * (2 * sizeof(Vec3f) + 4 + sizeof(Rgb) + 8 + 4 + 2 + 2) + 4 * slice.size();
  }
  void resize(std::size_t count);
  void set(std::size_t i, const EyeSegment& segment);
};

}  // namespace lumirank::transport
