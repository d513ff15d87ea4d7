#include "transport/lights/light_peaks.h"

#include "base/parallel.h"
#include "scatter/lobe_bound.h"

namespace lumirank::transport {

std::vector<LightPeak> light_peaks(const VirtualLights& lights) {
  std::vector<LightPeak> peaks(lights.closures.size());
  parallel_for(lights.size(), 1 << 12, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      if (lights.kind[j] != LightKind::surface || lights.closure[j] == VirtualLights::kLambertian) continue;
      const std::uint32_t c = lights.closure[j];
      const auto lobes = lights.closures.lobes(lights.closures.recipe(c));
      const Vec3f n = lights.normal[j], wo = lights.incoming[j];
      const bool outside = dot(n, wo) * lights.closures.side(c) > 0;
      const scatter::ClosureBound bound(lobes, lights.closures.colors(c), n, lights.closures.tangent(c), wo,
                                        outside, true);
      LightPeak& peak = peaks[c];
      peak.one_sided = true;
      bool fiber = false;
      for (const scatter::Lobe& lobe : lobes) {
        fiber = fiber || scatter::is_hair(lobe.kind);
        peak.one_sided = peak.one_sided && !fiber && !scatter::shines_through(lobe.kind);
      }
      peak.max_f = bound.anywhere(scatter::CosineFactor::none);
      peak.max_f_cos = bound.anywhere(scatter::CosineFactor::cosine);
      // The two normals' cosines differ by no more than the normals do.
      if (!fiber) peak.max_f_cos += peak.max_f * length(n - lights.ng[j]);
    }
  });
  return peaks;
}

}  // namespace lumirank::transport
