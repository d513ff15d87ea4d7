// Sixteen floats at a time, by the compilers' vector extensions: AVX-512 where the build has it, narrower
// registers otherwise, the same results everywhere (every operation here is exactly rounded, and the build
// does not contract products and sums). All kernels are written in these lanes, so an entry has one value
// whether its fifteen neighbors are other receivers, other lights or copies of itself.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#if defined(__AVX512F__) && defined(__AVX512DQ__)
#include <immintrin.h>
#endif

#include "base/rgb.h"
#include "base/vec.h"

namespace lumirank {

inline constexpr int kLanes = 16;

typedef float Lane __attribute__((vector_size(64)));
typedef std::int32_t LaneMask __attribute__((vector_size(64)));  // -1: yes, 0: no

inline Lane splat(float x) { return x - Lane{}; }
inline Lane load(const float* p) {
  Lane v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
inline void store(float* p, Lane v) { std::memcpy(p, &v, sizeof v); }
inline Lane select(LaneMask m, Lane yes, Lane no) { return m ? yes : no; }
inline Lane min(Lane a, Lane b) { return a < b ? a : b; }
inline Lane max(Lane a, Lane b) { return a > b ? a : b; }
inline Lane abs(Lane a) { return reinterpret_cast<Lane>(reinterpret_cast<LaneMask>(a) & 0x7fffffff); }
inline Lane sqrt(Lane a) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return reinterpret_cast<Lane>(_mm512_maskz_sqrt_ps(0xffff, reinterpret_cast<__m512>(a)));
#else
  Lane r;
  for (int i = 0; i < kLanes; ++i) r[i] = std::sqrt(a[i]);
  return r;
#endif
}

// The number of each lane.
inline constexpr LaneMask kLaneNumbers = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

// Bit k of the result: lane k says yes.
inline std::uint32_t bits(LaneMask m) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return _mm512_movepi32_mask(reinterpret_cast<__m512i>(m));
#else
  std::uint32_t b = 0;
  for (int i = 0; i < kLanes; ++i) b |= static_cast<std::uint32_t>(m[i] & 1) << i;
  return b;
#endif
}
inline LaneMask mask_from_bits(std::uint32_t b) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return reinterpret_cast<LaneMask>(_mm512_movm_epi32(static_cast<__mmask16>(b)));
#else
  LaneMask m;
  for (int i = 0; i < kLanes; ++i) m[i] = -static_cast<std::int32_t>(b >> i & 1);
  return m;
#endif
}
// Writes the numbers base + k of the set bits k to `out` (room for 16 is needed); returns the end.
inline std::uint32_t* append_set_bits(std::uint32_t b, std::uint32_t base, std::uint32_t* out) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  const __m512i lane = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  const __m512i number = _mm512_add_epi32(lane, _mm512_set1_epi32(static_cast<int>(base)));
  _mm512_storeu_si512(out, _mm512_maskz_compress_epi32(static_cast<__mmask16>(b), number));
  return out + __builtin_popcount(b);
#else
  for (; b != 0; b &= b - 1) *out++ = base + static_cast<std::uint32_t>(__builtin_ctz(b));
  return out;
#endif
}
// Packs the lanes of the set bits of b to `out` (room for 16 is needed).
inline void append_lanes(std::uint32_t b, Lane v, float* out) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  _mm512_storeu_ps(out, _mm512_maskz_compress_ps(static_cast<__mmask16>(b), reinterpret_cast<__m512>(v)));
#else
  for (; b != 0; b &= b - 1) *out++ = v[__builtin_ctz(b)];
#endif
}
inline void append_lanes(std::uint32_t b, const std::uint32_t* from, std::uint32_t* out) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  _mm512_storeu_si512(out, _mm512_maskz_compress_epi32(static_cast<__mmask16>(b), _mm512_loadu_si512(from)));
#else
  for (; b != 0; b &= b - 1) *out++ = from[__builtin_ctz(b)];
#endif
}
// The inverse of append_set_bits: bit k of `packed` goes to the place of the k-th set bit of `where`.
inline std::uint32_t deposit_bits(std::uint32_t packed, std::uint32_t where) {
#if defined(__BMI2__)
  return __builtin_ia32_pdep_si(packed, where);
#else
  std::uint32_t r = 0;
  for (; where != 0; where &= where - 1, packed >>= 1)
    if (packed & 1) r |= where & -where;
  return r;
#endif
}

struct Lane3 {
  Lane x, y, z;
  friend Lane3 operator+(const Lane3& a, const Lane3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Lane3 operator-(const Lane3& a, const Lane3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Lane3 operator*(const Lane3& a, const Lane3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
  friend Lane3 operator*(const Lane3& a, Lane s) { return {a.x * s, a.y * s, a.z * s}; }
};
inline Lane3 splat(Vec3f v) { return {splat(v.x), splat(v.y), splat(v.z)}; }
inline Lane3 splat(Rgb c) { return {splat(c.r), splat(c.g), splat(c.b)}; }
inline Lane dot(const Lane3& a, const Lane3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Lane max_component(const Lane3& c) { return max(c.x, max(c.y, c.z)); }
inline Lane3 select(LaneMask m, const Lane3& yes, const Lane3& no) {
  return {select(m, yes.x, no.x), select(m, yes.y, no.y), select(m, yes.z, no.z)};
}

}  // namespace lumirank
