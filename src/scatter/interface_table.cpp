#include "scatter/interface_table.h"

#include <array>
#include <cmath>
#include <utility>

#include "scatter/microfacet.h"

namespace lumirank::scatter {
namespace {

constexpr int kTerms = 6;
constexpr int kRuleCosines = 24;

// Gauss-Legendre nodes and weights on [0, 1].
struct Rule {
  std::array<double, kRuleCosines> x, w;
};
Rule gauss_legendre() {
  Rule rule;
  for (int i = 0; i < kRuleCosines; ++i) {
    double z = std::cos(3.14159265358979324 * (i + 0.75) / (kRuleCosines + 0.5)), slope = 1;
    for (int step = 0; step < 50; ++step) {
      double p = 1, before = 0;
      for (int k = 1; k <= kRuleCosines; ++k) {
        const double next = ((2 * k - 1) * z * p - (k - 1) * before) / k;
        before = std::exchange(p, next);
      }
      slope = kRuleCosines * (z * p - before) / (z * z - 1);
      z -= p / slope;
    }
    rule.x[i] = 0.5 * (1 - z);
    rule.w[i] = 1 / ((1 - z * z) * slope * slope);
  }
  return rule;
}

std::vector<Vec3f> visible_normals(NormalDistribution distribution, float alpha, Vec3f w, int side) {
  std::vector<Vec3f> normals;
  normals.reserve(static_cast<std::size_t>(side) * side);
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      normals.push_back(
          sample_visible_normal(distribution, w, {(i + 0.5f) / side, (j + 0.5f) / side}, alpha, alpha));
  return normals;
}

Vec3f direction(float cos_theta) {
  return {std::sqrt(std::max(0.0f, 1 - cos_theta * cos_theta)), 0, cos_theta};
}

InterfaceMeans means_over(NormalDistribution distribution, float alpha, float eta, Vec3f w,
                          const std::vector<Vec3f>& normals) {
  InterfaceMeans sum;
  for (const Vec3f m : normals) {
    const float c = dot(w, m);
    if (c <= 0) continue;
    float cos_t;
    const float f = fresnel_dielectric(c, eta, &cos_t);
    const Vec3f reflected = reflect(w, m);
    if (reflected.z > 0) sum.reflectance += f * microfacet_g1(distribution, reflected, alpha, alpha);
    const Vec3f refracted = m * (c / eta - cos_t) - w / eta;
    if (f < 1 && refracted.z < 0)
      sum.transmittance += (1 - f) * microfacet_g1(distribution, refracted, alpha, alpha);
  }
  const double n = static_cast<double>(normals.size());
  return {sum.transmittance / n, sum.reflectance / n};
}

// Of what a perfect mirror's facets reflect.
double masked_share(NormalDistribution distribution, float alpha, Vec3f w,
                    const std::vector<Vec3f>& normals) {
  double left = 0;
  for (const Vec3f m : normals) {
    const Vec3f reflected = reflect(w, m);
    const bool leaves = dot(w, m) > 0 && reflected.z > 0;
    left += 1 - (leaves ? microfacet_g1(distribution, reflected, alpha, alpha) : 0.0f);
  }
  return left / static_cast<double>(normals.size());
}

// Least squares by normal equations and Gaussian elimination with pivoting.
using Matrix = std::array<std::array<double, kTerms + 1>, kTerms>;
std::array<double, kTerms> solve(Matrix m) {
  for (int col = 0; col < kTerms; ++col) {
    int pivot = col;
    for (int r = col + 1; r < kTerms; ++r)
      if (std::abs(m[r][col]) > std::abs(m[pivot][col])) pivot = r;
    std::swap(m[col], m[pivot]);
    for (int r = 0; r < kTerms; ++r) {
      if (r == col) continue;
      const double factor = m[r][col] / m[col][col];
      for (int k = col; k <= kTerms; ++k) m[r][k] -= factor * m[col][k];
    }
  }
  std::array<double, kTerms> x;
  for (int i = 0; i < kTerms; ++i) x[i] = m[i][kTerms] / m[i][i];
  return x;
}

// Fits T at the rule's cosines by the terms of interface_transmittance(), starting from the smooth interface.
void fit(const Rule& rule, float eta, const std::array<double, kRuleCosines>& t, float out[kTerms]) {
  Matrix m{};
  for (int k = 0; k < kRuleCosines; ++k) {
    const double s = 1 - fresnel_dielectric(static_cast<float>(rule.x[k]), eta);
    const std::array<double, kTerms> power{1, s, s * s, s * s * s, rule.x[k], rule.x[k] * rule.x[k]};
    for (int i = 0; i < kTerms; ++i) {
      for (int j = 0; j < kTerms; ++j) m[i][j] += rule.w[k] * power[i] * power[j];
      m[i][kTerms] += rule.w[k] * power[i] * (t[k] - s);
    }
  }
  // A whiff of regularization: near eta = 1 all s are 1 and the powers cannot be told apart.
  for (int i = 0; i < kTerms; ++i) m[i][i] += 1e-9;
  const std::array<double, kTerms> x = solve(m);
  for (int i = 0; i < kTerms; ++i) out[i] = static_cast<float>(x[i] + (i == 1 ? 1.0 : 0.0));
}

// Transmittance from inside at the angle refracted from `mu` outside. Interpolated between the rule's cosines
// is the difference from the smooth interface, which is small where that one changes fast.
double out_again(const Rule& rule, float eta, double mu,
                 const std::array<InterfaceMeans, kRuleCosines>& inside) {
  const double sin2 = (1 - mu * mu) / (eta * eta);
  if (sin2 >= 1) return 0;
  const auto smooth = [&](double c) { return 1.0 - fresnel_dielectric(static_cast<float>(c), 1 / eta); };
  const auto difference = [&](std::size_t k) { return inside[k].transmittance - smooth(rule.x[k]); };
  const double c = std::sqrt(1 - sin2);
  // The rule's cosines fall or rise; either way a neighbor pair encloses c, or c lies beyond the last.
  double found = difference(rule.x[0] > rule.x[kRuleCosines - 1] ? 0 : kRuleCosines - 1);
  for (std::size_t k = 0; k + 1 < kRuleCosines; ++k) {
    const double f = (c - rule.x[k]) / (rule.x[k + 1] - rule.x[k]);
    if (f >= 0 && f <= 1) found = difference(k) + f * (difference(k + 1) - difference(k));
  }
  return std::max(0.0, smooth(c) + found);
}

MaskedCoefficients masked_cell(const Rule& rule, const std::array<double, kRuleCosines>& left) {
  MaskedCoefficients cell;
  fit(rule, kMaskedEta, left, cell.left);
  for (int k = 0; k < kRuleCosines; ++k)
    cell.diffuse_left += static_cast<float>(2 * rule.w[k] * rule.x[k] * left[k]);
  return cell;
}

}  // namespace

InterfaceMeans interface_means(NormalDistribution distribution, float alpha, float eta, float cos_theta,
                               int side) {
  const Vec3f w = direction(cos_theta);
  return means_over(distribution, alpha, eta, w, visible_normals(distribution, alpha, w, side));
}

InterfaceTable::InterfaceTable(NormalDistribution distribution) : cells_(kAlphas * kEtas) {
  constexpr int side = 16;
  const Rule rule = gauss_legendre();
  for (int a = 0; a < kAlphas; ++a) {
    const float root = static_cast<float>(a) / (kAlphas - 1);
    const float alpha = std::max(root * root, kMinAlpha);
    std::array<std::array<InterfaceMeans, kRuleCosines>, kEtas> means;
    std::array<double, kRuleCosines> masked;
    for (int k = 0; k < kRuleCosines; ++k) {
      const Vec3f w = direction(static_cast<float>(rule.x[k]));
      const std::vector<Vec3f> normals = visible_normals(distribution, alpha, w, side);
      masked[k] = masked_share(distribution, alpha, w, normals);
      for (int e = 0; e < kEtas; ++e) {
        const auto eta = static_cast<float>(std::exp(kLogRange * (2.0 * e / (kEtas - 1) - 1)));
        means[e][k] = means_over(distribution, alpha, eta, w, normals);
      }
    }
    masked_.push_back(masked_cell(rule, masked));
    for (int e = 0; e < kEtas; ++e) {
      const auto eta = static_cast<float>(std::exp(kLogRange * (2.0 * e / (kEtas - 1) - 1)));
      std::array<double, kRuleCosines> t;
      for (int k = 0; k < kRuleCosines; ++k) t[k] = means[e][k].transmittance;
      InterfaceCoefficients cell;
      fit(rule, eta, t, cell.c);
      std::array<double, kRuleCosines> twice;
      for (int k = 0; k < kRuleCosines; ++k)
        twice[k] = std::sqrt(t[k] * out_again(rule, eta, rule.x[k], means[kEtas - 1 - e]));
      fit(rule, eta, twice, cell.twice);
      // From inside, the relative index is the inverse one, whose means stand in the mirrored column.
      // Reflectance jumps at the critical angle, which the rule cannot integrate; what is lost does not.
      std::array<double, kRuleCosines> left;
      for (int k = 0; k < kRuleCosines; ++k) left[k] = 1 - means[e][k].reflectance;
      fit(rule, eta, left, cell.left);
      double outside = 0, all_left = 0, lost_inside = 0;
      for (int k = 0; k < kRuleCosines; ++k) {
        const InterfaceMeans& inside = means[kEtas - 1 - e][k];
        outside += 2 * rule.w[k] * rule.x[k] * t[k];
        all_left += 2 * rule.w[k] * rule.x[k] * left[k];
        lost_inside += 2 * rule.w[k] * rule.x[k] * (1 - inside.transmittance - inside.reflectance);
      }
      // Kept as differences from the smooth interface, which are nearly linear in what is interpolated.
      const double smooth = 1 - fresnel_diffuse_reflectance(eta);
      cell.diffuse_transmittance = static_cast<float>(outside - smooth);
      cell.diffuse_left = static_cast<float>(all_left - smooth);
      cell.internal_reflectance = static_cast<float>((smooth - outside) / (eta * eta) - lost_inside);
      cells_[static_cast<std::size_t>(a) * kEtas + e] = cell;
    }
  }
}

MaskedCoefficients InterfaceTable::masked(float alpha) const {
  const float a = std::sqrt(std::clamp(alpha, 0.0f, 1.0f)) * (kAlphas - 1);
  const int a0 = std::min(static_cast<int>(a), kAlphas - 2);
  const float f = a - static_cast<float>(a0);
  const auto &low = masked_[static_cast<std::size_t>(a0)], &high = masked_[static_cast<std::size_t>(a0) + 1];
  MaskedCoefficients out;
  for (int i = 0; i < kTerms; ++i) out.left[i] = low.left[i] + f * (high.left[i] - low.left[i]);
  out.diffuse_left = low.diffuse_left + f * (high.diffuse_left - low.diffuse_left);
  return out;
}

InterfaceCoefficients InterfaceTable::lookup(float alpha, float eta) const {
  const float a = std::sqrt(std::clamp(alpha, 0.0f, 1.0f)) * (kAlphas - 1);
  const float e =
      std::clamp(static_cast<float>(0.5 + 0.5 * std::log(eta) / kLogRange), 0.0f, 1.0f) * (kEtas - 1);
  const int a0 = std::min(static_cast<int>(a), kAlphas - 2), e0 = std::min(static_cast<int>(e), kEtas - 2);
  const float fa = a - static_cast<float>(a0), fe = e - static_cast<float>(e0);
  InterfaceCoefficients out;
  const float held = std::exp(static_cast<float>(kLogRange) * (2 * e / (kEtas - 1) - 1));
  out.c[1] = out.twice[1] = out.left[1] = 0;
  out.diffuse_transmittance = out.diffuse_left = 1 - fresnel_diffuse_reflectance(held);
  out.internal_reflectance = fresnel_diffuse_reflectance(1 / held);
  for (int da = 0; da < 2; ++da) {
    for (int de = 0; de < 2; ++de) {
      const float w = (da ? fa : 1 - fa) * (de ? fe : 1 - fe);
      const InterfaceCoefficients& cell = cells_[static_cast<std::size_t>(a0 + da) * kEtas + (e0 + de)];
      for (int i = 0; i < kTerms; ++i) {
        out.c[i] += w * cell.c[i];
        out.twice[i] += w * cell.twice[i];
        out.left[i] += w * cell.left[i];
      }
      out.diffuse_transmittance += w * cell.diffuse_transmittance;
      out.diffuse_left += w * cell.diffuse_left;
      out.internal_reflectance += w * cell.internal_reflectance;
    }
  }
  return out;
}

namespace {

// A table each, so that a scene pays (a sixth of a second) only for the distribution that it has.
template <NormalDistribution Distribution>
const InterfaceTable& table_of() {
  static const InterfaceTable table(Distribution);
  return table;
}

}  // namespace

const InterfaceTable& interface_table(NormalDistribution distribution) {
  return distribution == NormalDistribution::ggx ? table_of<NormalDistribution::ggx>()
                                                 : table_of<NormalDistribution::beckmann>();
}

}  // namespace lumirank::scatter
