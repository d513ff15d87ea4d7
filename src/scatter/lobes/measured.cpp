// Measured isotropic BRDFs: tables over Rusinkiewicz' half and difference angles, in the format of the MERL
// database (Matusik et al. 2003, "A Data-Driven Reflectance Model"; coordinates of Rusinkiewicz 1998).
//
// A table has n_h · n_d · n_p cells (90, 90 and 180 in the database): θh along √(θh/90°), so that cells are
// narrow about the mirror direction, θd evenly up to 90°, φd evenly up to 180° (what is beyond is the same by
// reciprocity). Between the middles of cells f is linear, where the database's own reader takes the nearest
// cell. What was measured or extrapolated at grazing angles may send back more light than arrives; such
// values are divided by the greater albedo E of the two directions, which keeps f reciprocal. Draws are of a
// mixture of GGX and a cosine that is fitted to the table.
#include <array>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "base/parallel.h"
#include "base/warp.h"
#include "scatter/closure_builder.h"
#include "scatter/lobes/bound_terms.h"
#include "scatter/lobes/family.h"
#include "scatter/microfacet.h"
#include "scatter/tensor_brdf.h"

namespace lumirank::scatter {
namespace {

constexpr int kAlbedos = 16;             // cosines with a known albedo; their square roots are spaced evenly
constexpr int kTilts = 64, kTurns = 32;  // half vectors over which is integrated
constexpr std::size_t kMaxCells = 1u << 24;

}  // namespace

struct MeasuredTable : LobeTable {
  int n_h = 0, n_d = 0, n_p = 0;
  std::vector<Rgb> cells;  // φd runs fastest, θh slowest
  std::vector<Rgb> max;    // of all cells at this θh or more and this θd or less, whatever φd
  std::array<Rgb, kAlbedos> raw{}, kept{};  // albedo of the table, and of f; see albedo_cosine()
  float alpha = 1, share = 0;               // what draws follow: GGX of that width, in that share

  Rgb at(Vec3f wo, Vec3f wi) const;
  float density(Vec3f wo, Vec3f wi, float width, float glossy) const;
};

namespace {

struct BetweenCells {
  std::size_t a, b;
  float t;
};
// `x` in cells, whose middles have the values.
BetweenCells between(float x, int n) {
  const float shifted = std::clamp(x - 0.5f, 0.0f, static_cast<float>(n - 1));
  const auto a = static_cast<std::size_t>(shifted);
  return {a, std::min(a + 1, static_cast<std::size_t>(n - 1)), shifted - static_cast<float>(a)};
}
BetweenCells around(float x, int n) {
  const float shifted = x - 0.5f, floor = std::floor(shifted);
  const int a = (static_cast<int>(floor) + n) % n;
  return {static_cast<std::size_t>(a), static_cast<std::size_t>((a + 1) % n), shifted - floor};
}

float cells_of_half(float theta_h, int n) {
  return std::sqrt(std::max(0.0f, theta_h) * (2 * kInvPi)) * static_cast<float>(n);
}
float cells_of_difference(float theta_d, int n) { return theta_d * (2 * kInvPi) * static_cast<float>(n); }

float albedo_cosine(int k) {
  const float root = (static_cast<float>(k) + 0.5f) / kAlbedos;
  return root * root;
}
Rgb look_up_albedo(const std::array<Rgb, kAlbedos>& albedo, float cosine) {
  const BetweenCells x = between(std::sqrt(std::clamp(cosine, 0.0f, 1.0f)) * kAlbedos, kAlbedos);
  return lerp(albedo[x.a], albedo[x.b], x.t);
}

Rgb not_above_albedo(const MeasuredTable& table, Rgb f, float cos_o, float cos_i) {
  const Rgb o = look_up_albedo(table.raw, cos_o), i = look_up_albedo(table.raw, cos_i);
  for (int c = 0; c < 3; ++c) f[c] /= std::max({1.0f, o[c], i[c]});
  return f;
}

}  // namespace

Rgb MeasuredTable::at(Vec3f wo, Vec3f wi) const {
  const Vec3f sum = wo + wi, apart = wi - wo;
  const float across = std::sqrt(sum.x * sum.x + sum.y * sum.y), len = length(sum);
  const float theta_h = std::atan2(across, sum.z), theta_d = std::atan2(length(apart), len);
  // wi in the half vector's frame: to (wo, wi) exchanged it has the opposite sign across, and φd is the same.
  const float c = across > 0 ? sum.x / across : 1, s = across > 0 ? sum.y / across : 0;
  const float cos_h = sum.z / len, sin_h = across / len;
  const float x = dot(Vec3f{cos_h * c, cos_h * s, -sin_h}, apart), y = dot(Vec3f{-s, c, 0}, apart);
  float phi_d = std::atan2(y, x);
  if (phi_d < 0) phi_d += kPi;

  const BetweenCells h = between(cells_of_half(theta_h, n_h), n_h),
                     d = between(cells_of_difference(theta_d, n_d), n_d),
                     p = around(phi_d * kInvPi * static_cast<float>(n_p), n_p);
  const auto width = static_cast<std::size_t>(n_p), rows = static_cast<std::size_t>(n_d);
  const auto line = [&](std::size_t i, std::size_t j) {
    const Rgb* row = &cells[(i * rows + j) * width];
    return lerp(row[p.a], row[p.b], p.t);
  };
  return lerp(lerp(line(h.a, d.a), line(h.a, d.b), d.t), lerp(line(h.b, d.a), line(h.b, d.b), d.t), h.t);
}

float MeasuredTable::density(Vec3f wo, Vec3f wi, float width, float glossy) const {
  const float even = (1 - glossy) * pdf_cosine_hemisphere(wi.z);
  if (!(glossy > 0)) return even;
  return even + glossy * ggx_g1(wo, width, width) * ggx_d(normalize(wo + wi), width, width) / (4 * wo.z);
}

namespace {

// Calls visit(wi, solid angle) for directions whose half vectors with wo are finer spaced towards the normal.
template <typename Visit>
void over_half_vectors(Vec3f wo, Visit&& visit) {
  for (int i = 0; i < kTilts; ++i) {
    const float x = (static_cast<float>(i) + 0.5f) / kTilts, theta = 0.5f * kPi * x * x;
    const float ring = std::sin(theta) * kPi * x / kTilts * (2 * kPi / kTurns);
    for (int j = 0; j < kTurns; ++j) {
      const float phi = 2 * kPi * (static_cast<float>(j) + 0.5f) / kTurns;
      const Vec3f h{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
      const Vec3f wi = reflect(wo, h);
      if (dot(wo, h) > 0 && wi.z > 1e-4f) visit(wi, ring * 4 * dot(wo, h));
    }
  }
}

Vec3f at_cosine(float cosine) { return {std::sqrt(std::max(0.0f, 1 - cosine * cosine)), 0, cosine}; }

void integrate_albedos(MeasuredTable& table) {
  for (int k = 0; k < kAlbedos; ++k) {
    const Vec3f wo = at_cosine(albedo_cosine(k));
    Rgb& sum = table.raw[static_cast<std::size_t>(k)];
    over_half_vectors(wo, [&](Vec3f wi, float angle) { sum += table.at(wo, wi) * (wi.z * angle); });
  }
  for (int k = 0; k < kAlbedos; ++k) {
    const Vec3f wo = at_cosine(albedo_cosine(k));
    Rgb sum(0);
    over_half_vectors(wo, [&](Vec3f wi, float angle) {
      sum += not_above_albedo(table, table.at(wo, wi), wo.z, wi.z) * (wi.z * angle);
    });
    table.kept[static_cast<std::size_t>(k)] = clamp_below(sum, 1);
  }
}

// The mixture whose weights f·cos/pdf vary least, of some, at three angles of incidence.
void fit_draws(MeasuredTable& table) {
  struct Seen {
    Vec3f wo, wi;
    float flux, angle;
  };
  std::vector<Seen> seen[3];
  double all[3] = {0, 0, 0};
  for (int k = 0; k < 3; ++k) {
    const Vec3f wo = at_cosine(std::array{0.95f, 0.7f, 0.35f}[static_cast<std::size_t>(k)]);
    over_half_vectors(wo, [&](Vec3f wi, float angle) {
      const float flux = mean(table.at(wo, wi)) * wi.z;
      seen[k].push_back({wo, wi, flux, angle});
      all[k] += static_cast<double>(flux * angle);
    });
  }
  double min_moment = -1;
  for (const float glossy : {0.0f, 0.25f, 0.5f, 0.75f, 0.9f, 0.95f}) {
    for (float alpha = 0.006f; alpha < 1; alpha *= 1.5f) {
      double moment = 0;
      for (int k = 0; k < 3; ++k) {
        if (!(all[k] > 0)) continue;
        for (const Seen& s : seen[k])
          moment += static_cast<double>(s.flux) * static_cast<double>(s.flux) * static_cast<double>(s.angle) /
                    (static_cast<double>(table.density(s.wo, s.wi, alpha, glossy)) * all[k] * all[k]);
      }
      if (min_moment < 0 || moment < min_moment)
        min_moment = moment, table.share = glossy, table.alpha = alpha;
      if (glossy == 0) break;
    }
  }
  if (table.share == 0) table.alpha = 1;
}

void find_maxima(MeasuredTable& table) {
  const auto n_h = static_cast<std::size_t>(table.n_h), n_d = static_cast<std::size_t>(table.n_d),
             n_p = static_cast<std::size_t>(table.n_p);
  table.max.resize(n_h * n_d);
  for (std::size_t h = n_h; h-- > 0;) {
    for (std::size_t d = 0; d < n_d; ++d) {
      Rgb max_value(0);
      const auto raise = [&](Rgb value) {
        for (int c = 0; c < 3; ++c) max_value[c] = std::max(max_value[c], value[c]);
      };
      for (std::size_t p = 0; p < n_p; ++p) raise(table.cells[(h * n_d + d) * n_p + p]);
      if (h + 1 < n_h) raise(table.max[(h + 1) * n_d + d]);
      if (d > 0) raise(table.max[h * n_d + d - 1]);
      table.max[h * n_d + d] = max_value;
    }
  }
}

const MeasuredTable& measured_table(const Lobe& lobe) {
  return *static_cast<const MeasuredTable*>(lobe.table);
}

Rgb measured_value(LobeView view, Vec3f wo, Vec3f wi) {
  const MeasuredTable& table = measured_table(view.lobe);
  return view.lobe.color * not_above_albedo(table, table.at(wo, wi), wo.z, wi.z);
}

float measured_pdf(LobeView view, Vec3f wo, Vec3f wi) {
  const MeasuredTable& table = measured_table(view.lobe);
  return table.density(wo, wi, table.alpha, table.share);
}

bool measured_sample(LobeView view, Vec3f wo, Vec2f u, Vec3f& wi) {
  const MeasuredTable& table = measured_table(view.lobe);
  if (u.x < table.share) {
    u.x /= table.share;
    wi = reflect(wo, sample_visible_normal(NormalDistribution::ggx, wo, u, table.alpha, table.alpha));
  } else {
    u.x = (u.x - table.share) / (1 - table.share);
    wi = warp_cosine_hemisphere(u);
  }
  return wi.z > 0;
}

Rgb measured_albedo(LobeView view, Vec3f wo) {
  return view.lobe.color * look_up_albedo(measured_table(view.lobe).kept, wo.z);
}

float measured_importance(LobeView view, float cos_o) {
  const Rgb color = view.lobe.color;
  return std::max(kMinImportance * mean(color),
                  mean(color * look_up_albedo(measured_table(view.lobe).kept, cos_o)));
}

float measured_factor(const Lobe&, float, float) { return 1; }

Rgb measured_bound(const LobeTerm& t, const AngleRange& r, CosineFactor factor) {
  const MeasuredTable& table = measured_table(*t.lobe);
  // A thousandth of a cell is for the roundings of angles.
  const float h = cells_of_half(std::atan2(r.tilt_sin, r.tilt_cos), table.n_h) - 1e-3f;
  const float d = cells_of_difference(std::acos(std::clamp(r.half_lo, 0.0f, 1.0f)), table.n_d) + 1e-3f;
  const std::size_t row = between(h, table.n_h).a, column = between(d, table.n_d).b;
  return t.scale * table.max[row * static_cast<std::size_t>(table.n_d) + column] *
         (factor == CosineFactor::cosine ? r.cos_hi : 1.0f);
}

float measured_roughness(const Lobe& lobe) { return measured_table(lobe).alpha; }

UnderCoat measured_under_coat(LobeView view) {
  return {UnderCoat::Sort::diffuse, measured_albedo(view, {0, 0, 1})};
}

}  // namespace

constinit const LobeFamily measured_family{.value = measured_value,
                                           .pdf = measured_pdf,
                                           .sample = measured_sample,
                                           .albedo = measured_albedo,
                                           .importance = measured_importance,
                                           .factor_of_wo = measured_factor,
                                           .bound = measured_bound,
                                           .roughness = measured_roughness,
                                           .under_coat = measured_under_coat};

void add_lobes(const MeasuredMaterial& m, ClosureBuilder& out, const SurfacePoint& at, float weight) {
  if (!out.front(at)) return;
  Lobe lobe = lobe_of(LobeKind::measured, Rgb(1));
  lobe.table = m.table.get();
  lobe.alpha_u = lobe.alpha_v = m.table->alpha;
  out.push(lobe, at, weight);
}

namespace {

std::shared_ptr<const MeasuredTable> finished(std::shared_ptr<MeasuredTable> table) {
  find_maxima(*table);
  integrate_albedos(*table);
  fit_draws(*table);
  return table;
}

// f in the middles of cells. Pairs below the horizon have the value of a pair just above it.
std::shared_ptr<const MeasuredTable> table_of(const TensorBrdf& f) {
  auto table = std::make_shared<MeasuredTable>();
  table->n_h = 90, table->n_d = 45, table->n_p = 45;
  const auto lifted = [](Vec3f w) {
    w.z = std::max(w.z, 0.02f);
    return normalize(w);
  };
  const auto n_d = static_cast<std::size_t>(table->n_d), n_p = static_cast<std::size_t>(table->n_p);
  table->cells.resize(static_cast<std::size_t>(table->n_h) * n_d * n_p);
  parallel_for(static_cast<std::size_t>(table->n_h), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t h = begin; h < end; ++h) {
      const float root = (static_cast<float>(h) + 0.5f) / static_cast<float>(table->n_h);
      const float theta_h = 0.5f * kPi * root * root, s = std::sin(theta_h), c = std::cos(theta_h);
      for (std::size_t d = 0; d < n_d; ++d) {
        const float theta_d = 0.5f * kPi * (static_cast<float>(d) + 0.5f) / static_cast<float>(n_d);
        for (std::size_t p = 0; p < n_p; ++p) {
          const float phi = kPi * (static_cast<float>(p) + 0.5f) / static_cast<float>(n_p);
          const Vec3f off = Vec3f{c * std::cos(phi), std::sin(phi), -s * std::cos(phi)} * std::sin(theta_d);
          const Vec3f along = Vec3f{s, 0, c} * std::cos(theta_d);
          table->cells[(h * n_d + d) * n_p + p] = f(lifted(along - off), lifted(along + off));
        }
      }
    }
  });
  return finished(std::move(table));
}

}  // namespace

std::shared_ptr<const MeasuredTable> parse_measured(const std::string& bytes, const std::string& filename,
                                                    const SourceLocation& where) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(where, "the BRDF table " + filename + " " + what,
                     "give a whole file in the format of the MERL database (.binary)");
  };
  std::array<std::int32_t, 3> n{};
  if (TensorBrdf::is_one(bytes)) return table_of(TensorBrdf(bytes, filename, where));
  if (bytes.size() < sizeof n) refuse("ends within its header");
  std::memcpy(n.data(), bytes.data(), sizeof n);
  std::size_t cells = 1;
  for (const std::int32_t k : n)
    cells = k > 0 && cells <= kMaxCells ? cells * static_cast<std::size_t>(k) : 0;
  if (cells == 0 || cells > kMaxCells)
    refuse("states a size of " + std::to_string(n[0]) + " × " + std::to_string(n[1]) + " × " +
           std::to_string(n[2]) + " cells, which is no table");
  const std::size_t size = sizeof n + 3 * cells * sizeof(double);
  if (bytes.size() != size)
    refuse("has " + std::to_string(bytes.size()) + " bytes where its header asks for " +
           std::to_string(size));

  auto table = std::make_shared<MeasuredTable>();
  table->n_h = n[0], table->n_d = n[1], table->n_p = n[2];
  table->cells.resize(cells);
  // All red values, then all green, then all blue, in these units.
  constexpr double kUnits[3] = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};
  for (int c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < cells; ++i) {
      double value;
      std::memcpy(&value, bytes.data() + sizeof n + (static_cast<std::size_t>(c) * cells + i) * sizeof value,
                  sizeof value);
      const auto f = static_cast<float>(value * kUnits[c]);
      if (!std::isfinite(f)) refuse("has a value that is not a finite number");
      table->cells[i][c] = std::max(0.0f, f);  // below 0: not measured
    }
  }
  return finished(std::move(table));
}

}  // namespace lumirank::scatter
