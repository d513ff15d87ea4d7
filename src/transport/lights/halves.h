// The two independent halves of the lights, from whose difference the error of too few lights is known.
//
// Samples belong to halves in turn. Each half is an evenly spread set by itself, randomized apart from the
// other: twice the sum over one half estimates the same as twice the sum over the other, independently.
#pragma once

#include <cstddef>
#include <cstdint>

namespace lumirank::transport {

// What matrix::ColumnFeatures::half says.
inline constexpr std::uint8_t kNoHalf = 0;  // stands for all of its emitter, without error

// Number k of `count` samples: its half (0 or 1), its number there and how many there are.
struct PlaceInHalf {
  PlaceInHalf(std::size_t k, std::size_t count) : half(k & 1), index(k >> 1), size((count + 1 - half) >> 1) {}
  std::size_t half, index, size;

  std::uint8_t feature() const { return static_cast<std::uint8_t>(1 + half); }
  // Keys of random numbers that one half does not share with the other.
  std::uint64_t key(std::uint64_t id) const { return id ^ (static_cast<std::uint64_t>(half) << 32); }
};

inline std::size_t even(std::size_t n) { return n + (n & 1); }

}  // namespace lumirank::transport
