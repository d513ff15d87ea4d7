#include "scenedesc/pbrt/perlin_noise.h"

#include <array>
#include <cmath>

#include "base/rgb.h"

namespace lumirank::scenedesc::pbrt {
namespace {

// The order of 0 to 255 of Perlin's reference implementation.
// clang-format off
constexpr std::array<unsigned char, 256> kOrder = {
    151, 160, 137, 91, 90, 15, 131, 13, 201, 95, 96, 53, 194, 233, 7, 225, 140, 36, 103, 30, 69, 142,
    8, 99, 37, 240, 21, 10, 23, 190, 6, 148, 247, 120, 234, 75, 0, 26, 197, 62, 94, 252, 219, 203,
    117, 35, 11, 32, 57, 177, 33, 88, 237, 149, 56, 87, 174, 20, 125, 136, 171, 168, 68, 175, 74, 165,
    71, 134, 139, 48, 27, 166, 77, 146, 158, 231, 83, 111, 229, 122, 60, 211, 133, 230, 220, 105, 92, 41,
    55, 46, 245, 40, 244, 102, 143, 54, 65, 25, 63, 161, 1, 216, 80, 73, 209, 76, 132, 187, 208, 89,
    18, 169, 200, 196, 135, 130, 116, 188, 159, 86, 164, 100, 109, 198, 173, 186, 3, 64, 52, 217, 226, 250,
    124, 123, 5, 202, 38, 147, 118, 126, 255, 82, 85, 212, 207, 206, 59, 227, 47, 16, 58, 17, 182, 189,
    28, 42, 223, 183, 170, 213, 119, 248, 152, 2, 44, 154, 163, 70, 221, 153, 101, 155, 167, 43, 172, 9,
    129, 22, 39, 253, 19, 98, 108, 110, 79, 113, 224, 232, 178, 185, 112, 104, 218, 246, 97, 228, 251, 34,
    242, 193, 238, 210, 144, 12, 191, 179, 162, 241, 81, 51, 145, 235, 249, 14, 239, 107, 49, 192, 214, 31,
    181, 199, 106, 157, 184, 84, 204, 176, 115, 121, 50, 45, 127, 4, 150, 254, 138, 236, 205, 93, 222, 114,
    67, 29, 24, 72, 243, 141, 128, 195, 78, 66, 215, 61, 156, 180};
// clang-format on

unsigned shuffled(unsigned k) { return kOrder[k & 255]; }

// The slope of a corner of the lattice times the way from there: one of twelve directions towards the middles
// of a cube's edges, four of them twice.
float away(unsigned corner, Vec3f d) {
  const unsigned h = corner & 15;
  const bool twice = h == 12 || h == 13;
  const float u = h < 8 || twice ? d.x : d.y, v = h < 4 || twice ? d.y : d.z;
  return (h & 1 ? -u : u) + (h & 2 ? -v : v);
}

float smooth(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }

float mix(float t, float a, float b) { return (1 - t) * a + t * b; }

}  // namespace

float perlin_noise(Vec3f p) {
  unsigned at[3];
  Vec3f d;
  for (int axis = 0; axis < 3; ++axis) {
    // Larger floats are whole, if they are numbers at all.
    if (!(std::abs(p[axis]) < 8388608)) return 0;
    const float floor = std::floor(p[axis]);
    d[axis] = p[axis] - floor;
    at[axis] = static_cast<unsigned>(static_cast<int>(floor)) & 255;
  }
  float corners[8];
  for (unsigned k = 0; k < 8; ++k) {
    const unsigned x = k & 1, y = k >> 1 & 1, z = k >> 2;
    corners[k] =
        away(shuffled(shuffled(shuffled(at[0] + x) + at[1] + y) + at[2] + z),
             {d.x - static_cast<float>(x), d.y - static_cast<float>(y), d.z - static_cast<float>(z)});
  }
  const float wx = smooth(d.x), wy = smooth(d.y), wz = smooth(d.z);
  const float near = mix(wy, mix(wx, corners[0], corners[1]), mix(wx, corners[2], corners[3]));
  const float far = mix(wy, mix(wx, corners[4], corners[5]), mix(wx, corners[6], corners[7]));
  return mix(wz, near, far);
}

Vec3f perlin_slope(Vec3f p) {
  constexpr float kStep = 0.01f;
  const float here = perlin_noise(p);
  Vec3f out;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3f there = p;
    there[axis] += kStep;
    out[axis] = (perlin_noise(there) - here) / kStep;
  }
  return out;
}

}  // namespace lumirank::scenedesc::pbrt
