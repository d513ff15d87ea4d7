// Files of the RGL database, made from closed forms.
#include "scatter/tensor_brdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>

#include "base/random.h"
#include "base/warp.h"
#include "scatter/bsdf_list.h"

namespace lumirank::scatter {
namespace {

struct Field {
  std::vector<std::uint64_t> shape;
  std::vector<float> values;  // of one: a byte
};

std::string file_of(const std::map<std::string, Field>& fields) {
  std::string head("tensor_file\0\1\0", 14), body;
  const auto put = [](std::string& to, auto value) {
    to.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  put(head, static_cast<std::uint32_t>(fields.size()));
  std::size_t size = head.size();
  for (const auto& [name, field] : fields) size += 2 + name.size() + 2 + 1 + 8 + 8 * field.shape.size();
  for (const auto& [name, field] : fields) {
    put(head, static_cast<std::uint16_t>(name.size()));
    head += name;
    put(head, static_cast<std::uint16_t>(field.shape.size()));
    const bool byte = name == "jacobian";
    put(head, static_cast<std::uint8_t>(byte ? 1 : 10));
    put(head, static_cast<std::uint64_t>(size + body.size()));
    for (const std::uint64_t n : field.shape) put(head, n);
    for (const float v : field.values) byte ? put(body, static_cast<std::uint8_t>(v)) : put(body, v);
  }
  return head + body;
}

// Everything even; `rgb` and `jacobian` as given.
std::map<std::string, Field> plain(float jacobian) {
  return {{"phi_i", {{1}, {0}}},
          {"theta_i", {{2}, {0, kPi / 2}}},
          {"jacobian", {{1}, {jacobian}}},
          {"ndf", {{2, 2}, {1, 1, 1, 1}}},
          {"sigma", {{2, 2}, {1, 1, 1, 1}}},
          {"vndf", {{1, 2, 2, 2}, std::vector<float>(8, 1)}},
          {"rgb", {{1, 2, 3, 2, 2}, std::vector<float>(24, 0.25f)}}};
}
TensorBrdf brdf(const std::map<std::string, Field>& fields) { return {file_of(fields), "test.bsdf", {}}; }

// Density (½ + x)(½ + y) of the normal, √(2θ/π) and φ, and colors that are linear where that is spread
// evenly: at x/2 + x²/2 and y/2 + y²/2.
TEST(TensorBrdf, ColorsAreReadWhereTheDensityIsSpreadEvenly) {
  auto fields = plain(0);
  for (std::size_t slice = 0; slice < 2; ++slice)
    for (std::size_t y = 0; y < 2; ++y)
      for (std::size_t x = 0; x < 2; ++x) {
        const float density = (0.5f + static_cast<float>(x)) * (0.5f + static_cast<float>(y));
        fields["vndf"].values[slice * 4 + y * 2 + x] = 7 * density;  // of any scale
        for (std::size_t c = 0; c < 3; ++c)
          fields["rgb"].values[(slice * 3 + c) * 4 + y * 2 + x] =
              c == 0 ? static_cast<float>(x) : static_cast<float>(y);
      }
  const TensorBrdf f = brdf(fields);
  const Vec3f wo = normalize(Vec3f{0.3f, 0.4f, 0.9f});
  const float phi_o = std::atan2(wo.y, wo.x);
  Rng rng(1, Stage::test);
  for (int k = 0; k < 200; ++k) {
    Vec3f wi = warp_sphere(rng.next_2d());
    wi.z = std::abs(wi.z) + 0.05f, wi = normalize(wi);
    const Vec3f m = normalize(wo + wi);
    const float x = std::sqrt(std::acos(std::min(1.0f, m.z)) * 2 / kPi);
    const auto turn = [](float phi) {
      const float u = (phi + kPi) / (2 * kPi);
      return u - std::floor(u);
    };
    // Both ways; the turn is about the one that comes first.
    const float phi_m = std::atan2(m.y, m.x), y = turn(phi_m - phi_o),
                back = turn(phi_m - std::atan2(wi.y, wi.x));
    const auto spread = [](float u) { return 0.5f * (u + u * u); };
    const Rgb got = f(wo, wi);
    EXPECT_NEAR(got.r, 0.5f * spread(x) * (1 / wi.z + 1 / wo.z), 2e-3f * got.r + 1e-4f);
    EXPECT_NEAR(got.g, 0.5f * (spread(y) / wi.z + spread(back) / wo.z), 2e-3f * got.g + 1e-4f);
  }
}

// Microfacets: colors · D/(4σ) over the cosine, by the angles of normal and direction.
TEST(TensorBrdf, MicrofacetsAreScaledByTheirAreas) {
  auto fields = plain(1);
  constexpr std::size_t kKnots = 400;
  const auto d = [](float theta) { return std::exp(-3 * theta * theta); };
  const auto sigma = [](float theta) { return 0.4f + 0.6f * std::cos(theta); };
  for (const char* name : {"ndf", "sigma"}) {
    fields[name] = {{2, kKnots}, {}};
    for (std::size_t k = 0; k < 2 * kKnots; ++k) {
      const float u = static_cast<float>(k % kKnots) / (kKnots - 1), theta = u * u * kPi / 2;
      fields[name].values.push_back(name[0] == 'n' ? d(theta) : sigma(theta));
    }
  }
  const TensorBrdf f = brdf(fields);
  for (const float a : {0.1f, 0.7f, 1.2f})
    for (const float b : {0.0f, 0.5f, 1.3f}) {
      const Vec3f wo{std::sin(a), 0, std::cos(a)}, wi{std::sin(b) * 0.6f, std::sin(b) * 0.8f, std::cos(b)};
      const float theta_m = std::acos(std::min(1.0f, normalize(wo + wi).z));
      const float want = 0.25f * d(theta_m) / 4 * 0.5f * (1 / (sigma(a) * wi.z) + 1 / (sigma(b) * wo.z));
      EXPECT_NEAR(f(wo, wi).g, want, 2e-3f * want);
      EXPECT_EQ(f(wo, wi), f(wi, wo));
    }
}

// Spectra of a constant are gray, and the whole material is as the file has it between the table's cells.
TEST(TensorBrdf, BecomesAMaterial) {
  auto fields = plain(0);
  fields.erase("rgb");
  fields["wavelengths"] = {{3}, {360, 500, 1000}};
  fields["spectra"] = {{1, 2, 3, 2, 2}, std::vector<float>(24, 0.1f)};
  const TensorBrdf f = brdf(fields);
  MaterialSet set;
  set.materials.push_back(MeasuredMaterial{parse_measured(file_of(fields), "test.bsdf", {})});
  for (const float a : {0.3f, 0.8f})
    for (const float b : {0.1f, 0.9f}) {
      const Vec3f wo{std::sin(a), 0, std::cos(a)}, wi{0, std::sin(b), std::cos(b)};
      const Rgb value = f(wo, wi);
      EXPECT_NEAR(value.r, value.b, 1e-3f * value.r);
      EXPECT_NEAR(value.g, 0.05f * (1 / wo.z + 1 / wi.z), 1e-3f * value.g);
      const Closure closure = set.closure(0, point_with_normal({0, 0, 1}), wo);
      EXPECT_NEAR(eval_f(closure, wo, wi).g, value.g, 0.02f * value.g);
    }
}

// Of an anisotropic one that was measured over half a turn, the mean over turns.
TEST(TensorBrdf, AnisotropicOnesAreAveraged) {
  auto fields = plain(0);
  fields["phi_i"] = {{3}, {-kPi, -kPi / 2, 0}};
  fields["vndf"] = {{3, 2, 2, 2}, std::vector<float>(24, 1)};
  fields["rgb"] = {{3, 2, 3, 2, 2}, {}};
  for (int phi = 0; phi < 3; ++phi)
    for (int k = 0; k < 24; ++k) fields["rgb"].values.push_back(phi == 1 ? 1.0f : 0.0f);
  const TensorBrdf f = brdf(fields);
  EXPECT_FALSE(f.isotropic());
  const Vec3f wo = normalize(Vec3f{0.2f, 0.1f, 0.8f}), wi = normalize(Vec3f{-0.3f, 0.5f, 0.7f});
  // A tent over half a turn: ½ in the mean, whichever way they are turned together (twelve turns see it so).
  const float a = 0.5f * 0.5f * (1 / wo.z + 1 / wi.z);
  EXPECT_NEAR(f(wo, wi).g, a, 0.03f * a);
}

TEST(TensorBrdf, BadFilesAreRefused) {
  const std::string whole = file_of(plain(1));
  EXPECT_NO_THROW(TensorBrdf(whole, "x", {}));
  for (std::size_t size = 11; size < whole.size(); size += 7)
    EXPECT_THROW(TensorBrdf(whole.substr(0, size), "x", {}), InputError) << size;
  for (const char* name : {"phi_i", "theta_i", "jacobian", "ndf", "sigma", "vndf", "rgb"}) {
    auto fields = plain(1);
    fields.erase(name);
    EXPECT_THROW(brdf(fields), InputError) << name;
  }
  auto fields = plain(1);
  fields["theta_i"].values = {1, 0};
  EXPECT_THROW(brdf(fields), InputError);
  fields = plain(1);
  fields["ndf"].values[2] = NAN;
  EXPECT_THROW(brdf(fields), InputError);
  fields = plain(1);
  fields["vndf"].shape = {1, 1, 4, 2};
  EXPECT_THROW(brdf(fields), InputError);
}

}  // namespace
}  // namespace lumirank::scatter
