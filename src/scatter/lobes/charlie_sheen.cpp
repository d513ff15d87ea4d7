#include "scatter/lobes/charlie_sheen.h"

#include <cmath>
#include <vector>

#include "scatter/lobes/bound_terms.h"
#include "scatter/lobes/family.h"

namespace lumirank::scatter {
namespace {

constexpr int kRoughnesses = 25, kSheenCosines = 33;
constexpr int kSteps = 48;  // of the integrals, in either dimension
// The cosine's grid is finer towards grazing: its square root is spaced evenly, from 0.0001 on.
constexpr float kFirstSheenRoot = 0.01f;

float grid_roughness(int r) {
  return kMinSheenRoughness + (1 - kMinSheenRoughness) * static_cast<float>(r) / (kRoughnesses - 1);
}
float grid_cosine(int c) {
  const float root = kFirstSheenRoot + (1 - kFirstSheenRoot) * static_cast<float>(c) / (kSheenCosines - 1);
  return root * root;
}

// D·V.
float raw_value(float alpha, Vec3f wo, Vec3f wi) {
  const Vec3f h = normalize(wo + wi);
  const float sin2 = std::min(1.0f, h.x * h.x + h.y * h.y), inverse = 1 / alpha;
  const float d = (2 + inverse) * (0.5f * kInvPi) * std::pow(sin2, 0.5f * inverse);
  return d / (4 * (wo.z + wi.z - wo.z * wi.z));
}

struct Cell {
  int index;
  float fraction;
};
Cell cell_of(float x, int count) {
  const float at = std::clamp(x, 0.0f, 1.0f) * static_cast<float>(count - 1);
  const int index = std::min(static_cast<int>(at), count - 2);
  return {index, at - static_cast<float>(index)};
}

using Table = std::vector<float>;

float look_up(const Table& table, float roughness, float cosine) {
  const Cell r = cell_of((roughness - kMinSheenRoughness) / (1 - kMinSheenRoughness), kRoughnesses);
  const Cell c =
      cell_of((std::sqrt(std::max(cosine, 0.0f)) - kFirstSheenRoot) / (1 - kFirstSheenRoot), kSheenCosines);
  const float* row = &table[static_cast<std::size_t>(r.index * kSheenCosines + c.index)];
  return lerp(lerp(row[0], row[1], c.fraction), lerp(row[kSheenCosines], row[kSheenCosines + 1], c.fraction),
              r.fraction);
}

// ∫ D·V / norm(cos_i) · cos_i dwi for every cell, by midpoints in the azimuth and the square root of cos_i.
template <typename Norm>
Table integrate(const Norm& norm) {
  Table out;
  for (int r = 0; r < kRoughnesses; ++r) {
    const float roughness = grid_roughness(r), alpha = roughness * roughness;
    for (int c = 0; c < kSheenCosines; ++c) {
      const float cos_o = grid_cosine(c);
      const Vec3f wo{std::sqrt(std::max(0.0f, 1 - cos_o * cos_o)), 0, cos_o};
      double sum = 0;
      for (int i = 0; i < kSteps; ++i) {
        const float root = (static_cast<float>(i) + 0.5f) / kSteps, cos_i = root * root;
        const float sin_i = std::sqrt(1 - cos_i * cos_i);
        double ring = 0;
        for (int k = 0; k < kSteps; ++k) {
          const float phi = kPi * (static_cast<float>(k) + 0.5f) / kSteps;
          ring += raw_value(alpha, wo, {sin_i * std::cos(phi), sin_i * std::sin(phi), cos_i});
        }
        sum += ring * cos_i * 2 * root / norm(roughness, std::min(cos_o, cos_i));
      }
      out.push_back(static_cast<float>(sum * 2 * kPi / (kSteps * kSteps)));
    }
  }
  return out;
}

struct Tables {
  Table raw, held;
};
const Tables& tables() {
  static const Tables both = [] {
    Tables t;
    t.raw = integrate([](float, float) { return 1.0f; });
    t.held = integrate(
        [&](float roughness, float cosine) { return std::max(1.0f, look_up(t.raw, roughness, cosine)); });
    return t;
  }();
  return both;
}

float raw_albedo(float roughness, float cosine) { return look_up(tables().raw, roughness, cosine); }

}  // namespace

SheenAlbedo sheen_albedo(float roughness, float cosine) {
  return {raw_albedo(roughness, cosine), std::min(1.0f, look_up(tables().held, roughness, cosine))};
}

float sheen_layer_factor(const SheenLayer& sheen_layer, float min_cosine) {
  return 1 -
         sheen_layer.share_value() * std::min(1.0f, raw_albedo(sheen_layer.roughness_value(), min_cosine));
}

namespace {

// color · D·V / max(1, E(least cosine)); alpha_u is α.
Rgb charlie_sheen_value(LobeView view, Vec3f wo, Vec3f wi) {
  const Lobe& lobe = view.lobe;
  const float e = raw_albedo(std::sqrt(lobe.alpha_u), std::min(wo.z, wi.z));
  return lobe.color * (raw_value(lobe.alpha_u, wo, wi) / std::max(1.0f, e));
}
Rgb charlie_sheen_albedo(LobeView view, Vec3f wo) {
  return view.lobe.color * sheen_albedo(std::sqrt(view.lobe.alpha_u), wo.z).held;
}
float charlie_sheen_importance(LobeView view, float cos_o) {
  const Lobe& lobe = view.lobe;
  return mean(lobe.color) * std::max(kMinImportance, sheen_albedo(std::sqrt(lobe.alpha_u), cos_o).held);
}
float charlie_sheen_factor(const Lobe& lobe, float cos_o, float) {
  // The albedo falls with the cosine, and the smaller one counts.
  return (2 + 1 / lobe.alpha_u) * (0.5f * kInvPi) /
         std::max(1.0f, sheen_albedo(std::sqrt(lobe.alpha_u), cos_o).raw);
}
Rgb charlie_sheen_bound(const LobeTerm& t, const AngleRange& r, CosineFactor factor) {
  const float cosine = factor == CosineFactor::cosine ? r.cos_hi : 1.0f;
  const float d = std::pow(r.max_tilt_sin, 1 / t.lobe->alpha_u);
  // c/(co + c - co·c) grows with c, and what is below it too.
  const float c = factor == CosineFactor::cosine ? r.cos_hi : r.cos_lo;
  return t.scale * (d * cosine / (4 * (t.cos_o + c - t.cos_o * c)));
}
float charlie_sheen_reach(const LobeTerm&) { return 1; }
UnderCoat charlie_sheen_under_coat(LobeView view) {
  return {UnderCoat::Sort::diffuse, charlie_sheen_albedo(view, {0, 0, 2.0f / 3})};
}

}  // namespace

constinit const LobeFamily charlie_sheen_family{.value = charlie_sheen_value,
                                                .albedo = charlie_sheen_albedo,
                                                .importance = charlie_sheen_importance,
                                                .factor_of_wo = charlie_sheen_factor,
                                                .bound = charlie_sheen_bound,
                                                .reach = charlie_sheen_reach,
                                                .under_coat = charlie_sheen_under_coat};

}  // namespace lumirank::scatter
