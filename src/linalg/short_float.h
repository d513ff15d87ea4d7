// Numbers ≥ 0 of one scale in 16 bits each: five bits of exponent, eleven of mantissa. Relative to the power
// of two below the largest, numbers down to 2⁻³¹ of it keep a relative error of at most 2⁻¹²; what is smaller
// becomes 0.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>

namespace lumirank::linalg {

// The greatest magnitude. Bit patterns of numbers ≥ 0 are in the order of the numbers, and the greatest
// integer is found in vectors.
inline float max_abs_of(std::span<const float> values) {
  std::uint32_t bits = 0;
  for (float v : values) bits = std::max(bits, std::bit_cast<std::uint32_t>(v) & 0x7fffffffu);
  return std::bit_cast<float>(bits);
}

// The power of two below `max_abs` (1 for 0): numbers are divided by it before they are shortened. Kept so
// large that its inverse is a number as well.
inline float scale_for(float max_abs) {
  const std::uint32_t exponent = std::clamp(std::bit_cast<std::uint32_t>(max_abs) >> 23, 1u, 253u);
  return max_abs > 0 ? std::bit_cast<float>(exponent << 23) : 1.0f;
}

namespace short_float {
inline constexpr std::uint32_t kMinExponent = 96u << 23;  // of 2⁻³¹
inline constexpr int kDropped = 12;                       // bits of a float's mantissa
}  // namespace short_float

// x: in [0, 2).
inline std::uint16_t shorten(float x) {
  const std::uint32_t rounded = std::bit_cast<std::uint32_t>(x) + (1u << (short_float::kDropped - 1));
  const std::uint32_t above = std::max(rounded, short_float::kMinExponent) - short_float::kMinExponent;
  return static_cast<std::uint16_t>(std::min(above >> short_float::kDropped, 0xffffu));
}
inline float lengthen(std::uint16_t bits) {
  const std::uint32_t all =
      (static_cast<std::uint32_t>(bits) << short_float::kDropped) + short_float::kMinExponent;
  return bits == 0 ? 0.0f : std::bit_cast<float>(all);
}

}  // namespace lumirank::linalg
