#include "scatter/albedo_table.h"

#include <cmath>

#include "scatter/fresnel.h"
#include "scatter/microfacet.h"

namespace lumirank::scatter {
namespace {

constexpr int kAlphas = 17, kCosines = 25, kSide = 16;

ReflectionMoments integrate(NormalDistribution distribution, float alpha, float cos_o) {
  const Vec3f wo{std::sqrt(std::max(0.0f, 1 - cos_o * cos_o)), 0, cos_o};
  double white = 0, schlick = 0;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const Vec2f u{(static_cast<float>(i) + 0.5f) / kSide, (static_cast<float>(j) + 0.5f) / kSide};
      const Vec3f m = sample_visible_normal(distribution, wo, u, alpha, alpha);
      const Vec3f wi = reflect(wo, m);
      const float c = dot(wo, m);
      if (c <= 0 || wi.z <= 0) continue;
      const float g = microfacet_g1(distribution, wi, alpha, alpha);
      white += g, schlick += g * schlick_weight(c);
    }
  }
  constexpr double n = kSide * kSide;
  return {static_cast<float>(white / n), static_cast<float>(schlick / n)};
}

// The cosine's grid is finer towards grazing: its square root is spaced evenly, from 0.02 on.
constexpr float kFirstRoot = 0.14f;

template <NormalDistribution Distribution>
const std::vector<ReflectionMoments>& table() {
  static const std::vector<ReflectionMoments> cells = [] {
    std::vector<ReflectionMoments> out;
    for (int a = 0; a < kAlphas; ++a)
      for (int c = 0; c < kCosines; ++c) {
        const float root_alpha = static_cast<float>(a) / (kAlphas - 1);
        const float root = kFirstRoot + (1 - kFirstRoot) * static_cast<float>(c) / (kCosines - 1);
        out.push_back(integrate(Distribution, std::max(root_alpha * root_alpha, kMinAlpha), root * root));
      }
    return out;
  }();
  return cells;
}

}  // namespace

ReflectionMoments reflection_moments(NormalDistribution distribution, float alpha, float cos_o) {
  const auto& cells = distribution == NormalDistribution::ggx ? table<NormalDistribution::ggx>()
                                                              : table<NormalDistribution::beckmann>();
  const float a = std::sqrt(std::clamp(alpha, 0.0f, 1.0f)) * (kAlphas - 1);
  const float root = std::sqrt(std::clamp(cos_o, 0.0f, 1.0f));
  const float c = std::max(0.0f, (root - kFirstRoot) / (1 - kFirstRoot)) * (kCosines - 1);
  const int a0 = std::min(static_cast<int>(a), kAlphas - 2), c0 = std::min(static_cast<int>(c), kCosines - 2);
  const float fa = a - static_cast<float>(a0), fc = c - static_cast<float>(c0);
  ReflectionMoments out;
  for (int da = 0; da < 2; ++da) {
    for (int dc = 0; dc < 2; ++dc) {
      const float w = (da ? fa : 1 - fa) * (dc ? fc : 1 - fc);
      const ReflectionMoments& cell = cells[static_cast<std::size_t>((a0 + da) * kCosines + c0 + dc)];
      out.white += w * cell.white, out.schlick += w * cell.schlick;
    }
  }
  return out;
}

namespace {
float alpha_of(const Lobe& lobe) {
  return lobe.alpha_u == lobe.alpha_v ? lobe.alpha_u : std::sqrt(lobe.alpha_u * lobe.alpha_v);
}
// Whose Schlick weight is the mean one.
float mean_cosine(const ReflectionMoments& moments) {
  return 1 - std::pow(std::clamp(moments.schlick / moments.white, 0.0f, 1.0f), 0.2f);
}
}  // namespace

Rgb microfacet_reflect_albedo(LobeView view, float cos_o) {
  const ReflectionMoments k = reflection_moments(view.lobe.distribution, alpha_of(view.lobe), cos_o);
  if (!(k.white > 0)) return Rgb(0);
  return view.lobe.color * lobe_fresnel(view, mean_cosine(k)) * k.white;
}

bool table_tells_roughly(const Lobe& lobe) {
  constexpr float kRoughest = 0.35f, kMostBrushed = 8;
  return std::max(lobe.alpha_u, lobe.alpha_v) <= kRoughest &&
         std::max(lobe.alpha_u, lobe.alpha_v) <= kMostBrushed * std::min(lobe.alpha_u, lobe.alpha_v);
}

Rgb rough_transmit_albedo(LobeView view, float eta, float cos_o) {
  const ReflectionMoments k = reflection_moments(view.lobe.distribution, alpha_of(view.lobe), cos_o);
  if (!(k.white > 0)) return Rgb(0);
  // What leaves a denser side is turned away from the normal and masked as what is reflected; else less.
  const float unmasked = eta < 1 ? k.white : std::sqrt(k.white);
  return view.lobe.color * ((1 - fresnel_dielectric(mean_cosine(k), eta)) * unmasked);
}

}  // namespace lumirank::scatter
