#include "scatter/lobes/bound_terms.h"

#include "scatter/microfacet.h"

namespace lumirank::scatter {

// It grows until 1/cos² = 2α².
float gaussian_slopes(const AngleRange& r, float alpha) {
  const float a2 = alpha * alpha;
  const float tan2 = std::max(square(r.tilt_sin / std::max(r.tilt_cos, 1e-6f)), 2 * a2 - 1);
  return std::exp(-tan2 / a2) * square(1 + tan2);
}

float masking(NormalDistribution distribution, float cosine, float alpha) {
  const Vec3f v{std::sqrt(std::max(0.0f, 1 - cosine * cosine)), 0, cosine};
  return cosine > 0 ? microfacet_g1(distribution, v, alpha, alpha) : 0.0f;
}

}  // namespace lumirank::scatter
