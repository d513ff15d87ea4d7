// Exposure, tone map and sRGB encoding.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/parallel.h"
#include "image/image_io.h"
#include "image/srgb.h"

namespace lumirank::image {
namespace {

// Negative parts (reconstruction filters have negative lobes) and NaN show as black.
Rgb without_negatives(Rgb c) {
  for (int i = 0; i < 3; ++i)
    if (!(c[i] > 0)) c[i] = 0;
  return c;
}

// Reinhard, Stark, Shirley, Ferwerda 2002, eq. 3: luminance L becomes L / (1 + L), hue and saturation stay.
Rgb reinhard(Rgb c) { return std::isfinite(luminance(c)) ? c / (1 + luminance(c)) : Rgb(1); }

// AgX, Troy Sobotka's display transform, in the published fit of Benjamin Wrensch ("Minimal AgX
// Implementation", 2023): into a wider-primaries space, log2 over 16.5 stops around middle gray, a
// sixth-order polynomial for the contrast curve, and back. The result is meant for a display of exponent 2.2,
// so it is linearized by that exponent here.
Rgb agx(Rgb c) {
  constexpr float min_ev = -12.47393f, max_ev = 4.026069f;
  const Rgb inset{0.842479062253094f * c.r + 0.0784335999999992f * c.g + 0.0792237451477643f * c.b,
                  0.0423282422610123f * c.r + 0.878468636469772f * c.g + 0.0791661274605434f * c.b,
                  0.0423756549057051f * c.r + 0.0784336f * c.g + 0.879142973793104f * c.b};
  Rgb curve;
  for (int i = 0; i < 3; ++i) {
    const float ev = std::clamp(std::log2(std::max(inset[i], 1e-10f)), min_ev, max_ev);
    const float x = (ev - min_ev) / (max_ev - min_ev);
    curve[i] =
        -0.00232f + x * (0.1191f + x * (0.4298f + x * (-6.868f + x * (31.96f + x * (-40.14f + x * 15.5f)))));
  }
  const Rgb outset{
      1.19687900512017f * curve.r - 0.0980208811401368f * curve.g - 0.0990297440797205f * curve.b,
      -0.0528968517574562f * curve.r + 1.15190312990417f * curve.g - 0.0989611768448433f * curve.b,
      -0.0529716355144438f * curve.r - 0.0980434501171241f * curve.g + 1.15107367264116f * curve.b};
  Rgb linear;
  for (int i = 0; i < 3; ++i) linear[i] = std::pow(std::clamp(outset[i], 0.0f, 1.0f), 2.2f);
  return linear;
}

Rgb apply(Rgb c, ToneMap map) {
  if (map == ToneMap::reinhard) return reinhard(c);
  if (map == ToneMap::agx) return agx(c);
  return c;
}

}  // namespace

double exposure_to_see(std::span<const float> rgb) {
  std::vector<float> lit;
  for (std::size_t p = 0; p + 2 < rgb.size(); p += 3) {
    const float y = luminance({rgb[p], rgb[p + 1], rgb[p + 2]});
    if (std::isfinite(y) && y > 0) lit.push_back(y);
  }
  if (lit.empty()) return 0;
  const auto at = [&](double share) {
    const auto k = static_cast<std::ptrdiff_t>(share * static_cast<double>(lit.size() - 1));
    std::nth_element(lit.begin(), lit.begin() + k, lit.end());
    return static_cast<double>(lit[static_cast<std::size_t>(k)]);
  };
  if (at(0.1) <= 1 && at(0.99) >= 0.02) return 0;
  return std::round(2 * std::log2(0.5 / at(0.9))) / 2;
}

std::vector<unsigned char> to_display(const Image& image, const DisplayOptions& display) {
  std::vector<unsigned char> bytes(image.pixels.size() * 3);
  const float scale = std::exp2(display.exposure);
  parallel_for(image.pixels.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Rgb c = apply(without_negatives(image.pixels[i] * scale), display.tonemap);
      for (int k = 0; k < 3; ++k)
        bytes[3 * i + k] = static_cast<unsigned char>(srgb_encode(c[k]) * 255.0f + 0.5f);
    }
  });
  return bytes;
}

}  // namespace lumirank::image
