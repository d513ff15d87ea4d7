// pbrt's materials reflect on both sides, so opaque ones become "twosided".
#include <algorithm>
#include <cmath>

#include "scenedesc/data/media.h"
#include "scenedesc/pbrt/material_maker.h"
#include "scenedesc/pbrt/media_parts.h"
#include "scenedesc/schema/hair.h"

namespace lumirank::scenedesc::pbrt {

namespace {

// Trowbridge-Reitz widths: α = √roughness unless "remaproughness" is false (TrowbridgeReitzDistribution of
// pbrt-v4); below 10⁻³ pbrt takes the surface for smooth.
struct Roughness {
  FloatInput u, v;
};

FloatInput alpha_of(Reader& reader, Params& p, const char* name, FloatInput roughness, bool remap) {
  if (roughness.texture == kNone) {
    if (!(roughness.value >= 0)) p.fail(name, "is negative");
    const float alpha = remap ? std::sqrt(roughness.value) : roughness.value;
    return {alpha < 1e-3f ? 0 : alpha};
  }
  if (!remap) return roughness;
  return {0,
          reader.add_texture("", p.where_of(name), RootTextureDesc{ColorInput{Rgb(0), roughness.texture}})};
}

Roughness roughness(Reader& reader, Params& p, const std::string& prefix, bool remap) {
  // Parameter names live as long as the list that remembers having been asked for them.
  static const std::map<std::string, std::array<const char*, 3>> names = {
      {"", {"roughness", "uroughness", "vroughness"}},
      {"interface.", {"interface.roughness", "interface.uroughness", "interface.vroughness"}},
      {"conductor.", {"conductor.roughness", "conductor.uroughness", "conductor.vroughness"}}};
  const auto& [both, along_u, along_v] = names.at(prefix);
  const FloatInput same = reader.scalar(p, both, {0});
  const FloatInput u = reader.scalar(p, along_u, same), v = reader.scalar(p, along_v, same);
  const bool equal = u.value == v.value && u.texture == v.texture;
  Roughness out;
  out.u = alpha_of(reader, p, p.has(along_u) ? along_u : both, u, remap);
  out.v = equal ? out.u : alpha_of(reader, p, p.has(along_v) ? along_v : both, v, remap);
  return out;
}

// The dielectric layer of coateddiffuse and coatedconductor has a thickness and may scatter.
void ignore_layer(Reader& reader, Params& p) {
  p.ignore({"thickness", "maxdepth", "nsamples", "g"});
  const ColorInput albedo = reader.color(p, "albedo", {Rgb(0), kNone}, Intent::albedo);
  if (albedo.texture != kNone || !is_black(albedo.value))
    reader.warn(p.where_of("albedo"), "a scattering medium in the coating of " + p.title(),
                "a clear coating");
}

}  // namespace

int MaterialMaker::make(const std::string& type) {
  if (type == "diffuse") return two_sided(DiffuseDesc{color("reflectance", 0.5f)});
  if (type == "coateddiffuse") return coated_diffuse();
  if (type == "conductor") return two_sided(conductor("", {}));
  if (type == "coatedconductor") return coated_conductor();
  if (type == "dielectric") return dielectric();
  if (type == "thindielectric") return detailed(add(ThinDielectricDesc{dielectric_eta(p_, "eta", 1.5f)}));
  if (type == "diffusetransmission") return diffuse_transmission();
  if (type == "mix") return mix();
  if (type == "interface" || type == "none" || type.empty()) return add(NullBsdfDesc{});
  if (type == "hair") return hair();
  if (type == "subsurface") return subsurface();
  if (type == "measured") {
    const auto found =
        reader_.file(p_.required_text("filename"), p_.where_of("filename"), "BRDF file", "diffuse of 0.5");
    MeasuredDesc measured;
    measured.file.name = found.name, measured.file.missing = found.missing;
    return two_sided(std::move(measured));
  }
  throw InputError(p_.where(), "the material " + in_quotes(type) + " is not known",
                   "diffuse, coateddiffuse, conductor, coatedconductor, dielectric, thindielectric, "
                   "diffusetransmission, mix, interface, hair, subsurface and measured are");
}

int MaterialMaker::detailed(int bsdf) {
  if (p_.has("normalmap")) {
    BitmapTextureDesc map;
    const auto file = reader_.file(p_.text("normalmap", ""), p_.where_of("normalmap"), "normal map",
                                   "the surface without it");
    map.filename = file.name, map.missing = file.missing;
    map.raw = true;
    bsdf = add(NormalMapDesc{reader_.add_texture("", p_.where_of("normalmap"), map), bsdf});
  }
  p_.ignore({"normalmap"});
  if (p_.has("displacement")) {
    const FloatInput height = reader_.scalar(p_, "displacement", {0});
    // pbrt's bump mapping: the surface's normal as if it were moved along itself.
    if (height.texture != kNone) bsdf = add(BumpMapDesc{height.texture, 1, bsdf});
  }
  p_.ignore({"displacement"});
  return bsdf;
}

int MaterialMaker::two_sided(MaterialKind kind) {
  const int front = detailed(add(std::move(kind)));
  return add(TwoSidedDesc{front, front});
}

ConductorDesc MaterialMaker::conductor(const std::string& prefix, std::optional<float> outside) {
  const bool coated = !prefix.empty();
  const char* eta = coated ? "conductor.eta" : "eta";
  const char* k = coated ? "conductor.k" : "k";
  ConductorDesc out;
  const Roughness r = roughness(reader_, p_, prefix, remap_);
  out.distribution = Distribution::ggx, out.alpha_u = r.u, out.alpha_v = r.v;
  if (p_.has("reflectance")) {
    if (p_.has(eta) || p_.has(k))
      p_.fail("reflectance", "is given beside \"" + std::string(eta) + "\" or \"" + k + "\"",
              "keep one of them");
    reflecting(out);
  } else {
    const ConductorIndex index = conductor_index(p_, eta, k);
    out.eta = index.eta, out.k = index.k;
  }
  if (outside) out.eta = out.eta / *outside, out.k = out.k / *outside;
  return out;
}

// The index of a metal of a given reflectance at normal incidence, with η = 1 (pbrt: k = 2√r / √(1 - r)).
void MaterialMaker::reflecting(ConductorDesc& out) {
  const ColorInput r = color("reflectance", 0.5f);
  if (r.texture != kNone) {
    reader_.warn(p_.where_of("reflectance"), "Fresnel reflection of a textured metal",
                 "the same reflectance at all angles");
    out.eta = Rgb(0), out.k = Rgb(1), out.specular_reflectance = r;
    return;
  }
  out.eta = Rgb(1);
  for (int i = 0; i < 3; ++i) {
    const float value = std::clamp(r.value[i], 0.0f, 0.9999f);
    out.k[i] = 2 * std::sqrt(value) / std::sqrt(1 - value);
  }
}

// The layer over what is nested; pbrt walks at random between the two (LayeredBxDF).
int MaterialMaker::coated(int nested, const char* eta, const std::string& prefix) {
  CoatingDesc out;
  out.nested = nested;
  out.eta = dielectric_eta(p_, eta, 1.5f);
  const Roughness r = roughness(reader_, p_, prefix, remap_);
  out.distribution = Distribution::ggx, out.alpha_u = r.u, out.alpha_v = r.v;
  ignore_layer(reader_, p_);
  return two_sided(out);
}

int MaterialMaker::coated_diffuse() {
  return coated(add(DiffuseDesc{color("reflectance", 0.5f)}), "eta", "");
}

int MaterialMaker::coated_conductor() {
  const float layer = dielectric_eta(p_, "interface.eta", 1.5f);
  p_.ignore({"interface.thickness"});
  return coated(add(conductor("conductor.", layer)), "interface.eta", "interface.");
}

int MaterialMaker::dielectric() {
  DielectricDesc out;
  out.eta = dielectric_eta(p_, "eta", 1.5f);
  const Roughness r = roughness(reader_, p_, "", remap_);
  out.distribution = Distribution::ggx, out.alpha_u = r.u, out.alpha_v = r.v;
  return detailed(add(out));
}

int MaterialMaker::diffuse_transmission() {
  const ColorInput reflectance = color("reflectance", 0.25f);
  const ColorInput transmittance = color("transmittance", 0.25f);
  const float scale = p_.number("scale", 1);
  if (!(scale >= 0)) p_.fail("scale", "is negative", "give 0 or more");
  const auto scaled = [&](const ColorInput& input) -> ColorInput {
    if (input.texture == kNone) return {clamp_below(input.value * scale, 1), kNone};
    if (scale == 1) return input;
    return {Rgb(0), reader_.add_texture("", p_.where(), ScaleTextureDesc{input, Rgb(scale)})};
  };
  return detailed(add(DiffuseTransmitterDesc{scaled(reflectance), scaled(transmittance)}));
}

int MaterialMaker::mix() {
  const auto names = p_.texts("materials");
  if (names.size() != 2)
    p_.fail("materials", "names " + std::to_string(names.size()) + " materials; 2 are needed");
  const FloatInput amount = reader_.scalar(p_, "amount", {0.5f});
  if (amount.texture == kNone && !(amount.value >= 0 && amount.value <= 1))
    p_.fail("amount", "is not between 0 and 1");
  return mix(names, amount);
}

int MaterialMaker::mix(const std::vector<std::string>& names, const FloatInput& amount) {
  MixtureDesc out;
  for (int k = 0; k < 2; ++k)
    out.parts.push_back(
        {amount, k == 0,
         reader_.named_material(names[static_cast<std::size_t>(k)], p_.where_of("materials"))});
  return add(out);
}

// The color that a thick body of the medium has. As in pbrt: a name comes before coefficients, these before
// a color, and of nothing stated is whole milk.
ColorInput MaterialMaker::color_of_depth() {
  const std::string name = p_.text("name", "");
  const auto known = named_medium(name.empty() ? "Wholemilk" : name);
  if (!name.empty() && !known)
    reader_.warn(p_.where_of("name"), "the medium " + in_quotes(name), "whole milk");
  const bool textured = p_.is_texture("sigma_a") || p_.is_texture("sigma_s");
  if (textured) reader_.warn(p_.where(), "subsurface scattering by textures", "whole milk");
  NamedMedium medium = known.value_or(*named_medium("Wholemilk"));
  if (name.empty() && !textured && p_.has("sigma_a") && p_.has("sigma_s")) {
    medium.absorption = constant(p_, "sigma_a", Rgb(0), Intent::unbounded);
    medium.scattering = constant(p_, "sigma_s", Rgb(0), Intent::unbounded);
  } else if (name.empty() && p_.has("reflectance")) {
    return color("reflectance", 0.5f);
  }
  return {albedo_of_depth(medium.scattering, medium.absorption, std::min(0.999f, p_.number("g", 0))), kNone};
}

int MaterialMaker::subsurface() {
  reader_.warn(p_.where(), "subsurface scattering", "a rough plastic of the color of a thick body");
  PlasticDesc out;
  out.eta = p_.number("eta", 1.33f);
  out.diffuse_reflectance = color_of_depth();
  out.nonlinear = true, out.distribution = Distribution::ggx;
  out.alpha = roughness(reader_, p_, "", remap_).u;
  p_.ignore({"name", "sigma_a", "sigma_s", "reflectance", "mfp", "g", "scale"});
  return two_sided(out);
}

// Chiang et al. 2016. What is painted is Kajiya-Kay of the same energy.
int MaterialMaker::hair() {
  const float beta_m = p_.number("beta_m", 0.3f), beta_n = p_.number("beta_n", 0.3f);
  const float eta = p_.number("eta", 1.55f);
  if (!(eta > 0)) p_.fail("eta", "is not positive");
  if (!(beta_m >= 0 && beta_m <= 1)) p_.fail("beta_m", "is not between 0 and 1");
  if (!(beta_n >= 0 && beta_n <= 1)) p_.fail("beta_n", "is not between 0 and 1");
  const float alpha = p_.number("alpha", 2);
  if (!(std::abs(alpha) <= kMaxHairTilt)) p_.fail("alpha", "is beyond 20 degrees");
  Rgb sigma;
  ColorInput painted;
  if (const auto given = constant_color(p_, "sigma_a", Intent::unbounded)) {
    sigma = *given;
    p_.ignore({"reflectance", "color", "eumelanin", "pheomelanin"});
  } else if (const char* name = p_.has("reflectance") ? "reflectance" : "color"; p_.has(name)) {
    // The color of dense hair, inverted (section 4.2 of that paper). A textured one cannot be.
    painted = color(name, 0.5f);
    const float b = beta_n, width = 5.969f - 0.215f * b + 2.532f * b * b - 10.73f * b * b * b +
                                    5.574f * b * b * b * b + 0.245f * b * b * b * b * b;
    for (int i = 0; i < 3; ++i)
      sigma[i] = square(std::log(std::clamp(painted.value[i], 1e-6f, 1.0f)) / width);
    p_.ignore({"eumelanin", "pheomelanin"});
  } else {
    const bool stated = p_.has("eumelanin") || p_.has("pheomelanin");
    const float eu = p_.number("eumelanin", stated ? 0 : 1.3f), pheo = p_.number("pheomelanin", 0);
    if (!(eu >= 0 && pheo >= 0)) p_.fail("eumelanin", "or \"pheomelanin\" is negative");
    sigma = hair_absorption(eu, pheo);
  }
  for (int i = 0; i < 3; ++i)
    if (!(sigma[i] >= 0)) p_.fail("sigma_a", "is negative");
  if (painted.texture == kNone) {
    HairFiberDesc out;
    out.sigma_a = sigma, out.eta = eta, out.beta_m = beta_m, out.beta_n = beta_n, out.tilt = alpha;
    return add(out);
  }
  HairDesc out = hair_from_absorption(sigma, eta, beta_m);
  out.diffuse_reflectance = painted;
  reader_.warn_once(
      p_.where(), "hair whose color is a texture",
      "Kajiya-Kay hair of the same brightness, which sends light that went through a fiber back "
      "as well as on, and has no second highlight and no glints");
  return add(out);
}

int Reader::make_material(Params& p, const std::string& type, const std::string& id) {
  MaterialMaker maker(*this, p, id);
  return version3_ ? maker.make_of_version3(type) : maker.make(type);
}

int Reader::named_material(const std::string& name, const Place& where) {
  const auto [it, fresh] = materials_.try_emplace(name);
  if (fresh) it->second = {add_bsdf(name, where, DiffuseDesc{}), false, where};
  return it->second.bsdf;
}

void Reader::name_material(Params& p, const std::string& name) {
  const std::string type = p.required_text("type");
  const auto found = materials_.find(name);
  if (found != materials_.end() && found->second.defined) {
    if (!version3_)
      throw InputError(p.where(), "the material " + in_quotes(name) + " is defined twice", "rename one");
    // In pbrt-v3 the name means the new one from there on.
    found->second = {make_material(p, type, name), true, p.where()};
    return;
  }
  const int made = make_material(p, type, name);
  NamedMaterial& entry = materials_[name];
  if (entry.bsdf == kNone) {
    entry.bsdf = made;
  } else {  // it was used before: what was made moves to the place that was kept for it
    auto& slot = scene_.bsdfs[static_cast<std::size_t>(entry.bsdf)];
    slot = scene_.bsdfs[static_cast<std::size_t>(made)];
  }
  entry.defined = true;
}

namespace {

// How many plain materials a mixture of mixtures has; they may be defined in any order. Stops at kMixed or at
// kMixed levels, so loops end too.
constexpr int kMixed = 64;
int mixed_parts(const SceneDesc& scene, int bsdf, int level) {
  if (level >= kMixed) return kMixed;
  const auto* mixture = std::get_if<MixtureDesc>(&scene.bsdfs[static_cast<std::size_t>(bsdf)].kind);
  if (!mixture) return 1;
  int sum = 0;
  for (const auto& part : mixture->parts)
    if (sum < kMixed) sum += mixed_parts(scene, part.bsdf, level + 1);
  return sum;
}

}  // namespace

void Reader::check_mixtures() const {
  for (std::size_t i = 0; i < scene_.bsdfs.size(); ++i)
    if (mixed_parts(scene_, static_cast<int>(i), 0) >= kMixed)
      throw InputError(
          scene_.bsdfs[i].where,
          "the mixture " + in_quotes(scene_.bsdfs[i].id) + " holds itself or more than 64 materials",
          "mixtures of mixtures multiply; simplify them");
}

bool Reader::material_is_hair() const {
  if (state_.bsdf == kNone) return false;
  const BsdfKind& kind = scene_.bsdfs[static_cast<std::size_t>(state_.bsdf)].kind;
  return std::holds_alternative<HairFiberDesc>(kind) || std::holds_alternative<HairDesc>(kind);
}

int Reader::current_bsdf(const Place& where) {
  if (state_.bsdf != kNone) return state_.bsdf;
  if (default_bsdf_ == kNone) {
    const int front = add_bsdf("", where, DiffuseDesc{});
    default_bsdf_ = add_bsdf("", where, TwoSidedDesc{front, front});
  }
  return default_bsdf_;
}

}  // namespace lumirank::scenedesc::pbrt
