// The bytes of MERL tables, made from closed forms.
#pragma once

#include <cmath>
#include <cstring>
#include <string>

#include "base/rgb.h"
#include "base/vec.h"

namespace lumirank::scatter {

// f(wo, wi) in the middles of n_h × n_d × n_p cells. Pairs that lie below the horizon, where nothing can be
// measured, have the value of a pair just above it.
template <typename F>
std::string merl_bytes(int n_h, int n_d, int n_p, const F& f) {
  const std::size_t cells =
      static_cast<std::size_t>(n_h) * static_cast<std::size_t>(n_d) * static_cast<std::size_t>(n_p);
  std::string bytes(12 + 3 * cells * sizeof(double), '\0');
  const int n[3] = {n_h, n_d, n_p};
  std::memcpy(bytes.data(), n, sizeof n);
  const auto lifted = [](Vec3f w) {
    w.z = std::max(w.z, 0.05f);
    return normalize(w);
  };
  std::size_t at = 0;
  for (int h = 0; h < n_h; ++h) {
    const float root = (static_cast<float>(h) + 0.5f) / static_cast<float>(n_h),
                theta_h = 0.5f * kPi * root * root;
    const Vec3f normal{std::sin(theta_h), 0, std::cos(theta_h)},
        across{std::cos(theta_h), 0, -std::sin(theta_h)};
    for (int d = 0; d < n_d; ++d) {
      const float theta_d = 0.5f * kPi * (static_cast<float>(d) + 0.5f) / static_cast<float>(n_d);
      for (int p = 0; p < n_p; ++p, ++at) {
        const float phi = kPi * (static_cast<float>(p) + 0.5f) / static_cast<float>(n_p);
        const Vec3f off = (across * std::cos(phi) + Vec3f{0, std::sin(phi), 0}) * std::sin(theta_d);
        const Vec3f along = normal * std::cos(theta_d);
        const Rgb value = f(lifted(along - off), lifted(along + off));
        const double stored[3] = {value.r * 1500.0, value.g * 1500.0 / 1.15, value.b * 1500.0 / 1.66};
        for (std::size_t c = 0; c < 3; ++c)
          std::memcpy(bytes.data() + 12 + (c * cells + at) * sizeof(double), &stored[c], sizeof(double));
      }
    }
  }
  return bytes;
}

}  // namespace lumirank::scatter
