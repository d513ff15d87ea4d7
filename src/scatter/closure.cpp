#include "scatter/closure.h"

#include <span>

#include "base/error.h"
#include "scatter/lobe.h"
#include "scatter/lobes/family.h"

namespace lumirank::scatter {
namespace {

// Cosines below this are grazing: nothing is evaluated there.
constexpr float kGrazing = 1e-6f;

// wo in the local frame, mirrored so that z > 0 (not on a fiber).
struct Incident {
  Vec3f wo;
  float side;  // of wo: +1 outside, -1 inside
  bool valid;  // shading and geometric normal agree about the side
  bool fiber;
};

Incident incident(const Closure& c, Vec3f wo) {
  Vec3f local = c.frame.to_local(wo);
  if (c.is_fiber()) return {local, 1, fiber_sine(local) > kGrazing, true};
  const float side = local.z > 0 ? 1.0f : -1.0f;
  local.z *= side;
  return {local, side, local.z > kGrazing && dot(wo, c.ng) * side > 0, false};
}

// Does wi (world) lie on the side which its shading cosine says? `local_z` unmirrored.
bool sides_agree(const Closure& c, Vec3f wi, float local_z) { return dot(wi, c.ng) * local_z > 0; }

// wi in the local frame, mirrored as wo is; false where nothing arrives.
bool arriving(const Closure& c, const Incident& in, Vec3f wi, Vec3f& local) {
  local = c.frame.to_local(wi);
  if (in.fiber) return fiber_sine(local) > kGrazing;
  if (!(std::abs(local.z) > kGrazing) || !sides_agree(c, wi, local.z)) return false;
  local.z *= in.side;
  return true;
}

// The lobes of a surface face one side each.
bool meets(LobeKind kind, const Incident& in, Vec3f wi) { return in.fiber || transmits(kind) == (wi.z < 0); }

bool wanted(LobeKind kind, Lobes which) {
  return which == Lobes::all || (which == Lobes::delta) == is_delta(kind);
}

struct DeltaLobe {
  Vec3f wi;         // world
  Rgb coefficient;  // without radiance scaling
  float eta = 1;    // relative index crossed
};
bool follow_delta(const Closure& c, const Incident& in, const Lobe& lobe, Vec3f wo, DeltaLobe& out) {
  const LobeView view = view_from(lobe, in.side > 0);
  if (lobe.kind == LobeKind::delta_pass) {
    // Straight on whatever the shading normal says; only thin slabs need its cosine.
    Vec3f local;
    const Vec3f from{in.wo.x, in.wo.y, std::max(in.wo.z, 0.0f)};
    if (!delta_direction(view, from, local, out.coefficient)) return false;
    out.wi = -wo, out.eta = 1;
    return true;
  }
  Vec3f local;
  if (!in.valid || !delta_direction(view, in.wo, local, out.coefficient)) return false;
  local.z *= in.side;
  out.wi = c.frame.to_world(local);
  out.eta = family_of(lobe.kind).refracts ? view.eta : 1.0f;
  return sides_agree(c, out.wi, local.z);
}

// Probabilities (not normalized) of the lobes for one wo, and the delta directions on the way.
struct Selection {
  float weight[kMaxLobes];
  float total = 0;
  DeltaLobe delta[kMaxLobes];
};
Selection select(const Closure& c, const Incident& in, Vec3f wo, Lobes which) {
  Selection s;
  for (int k = 0; k < c.count; ++k) {
    const Lobe& lobe = c.lobes[k];
    s.weight[k] = 0;
    if (!wanted(lobe.kind, which)) continue;
    if (is_delta(lobe.kind)) {
      if (follow_delta(c, in, lobe, wo, s.delta[k])) s.weight[k] = mean(s.delta[k].coefficient);
    } else if (in.valid) {
      s.weight[k] = lobe_importance(view_from(lobe, in.side > 0), in.wo.z);
    }
    s.total += s.weight[k];
  }
  return s;
}

// Value and density of all non-delta lobes at one pair; wi local and mirrored as wo is.
Rgb value_of_all(const Closure& c, const Incident& in, Vec3f wi) {
  Rgb sum(0);
  for (int k = 0; k < c.count; ++k) {
    const Lobe& lobe = c.lobes[k];
    if (is_delta(lobe.kind) || !meets(lobe.kind, in, wi)) continue;
    sum += lobe_value(view_from(lobe, in.side > 0), in.wo, wi);
  }
  return sum;
}
float density_of_all(const Closure& c, const Incident& in, Vec3f wi, const Selection& s) {
  float sum = 0;
  for (int k = 0; k < c.count; ++k) {
    const Lobe& lobe = c.lobes[k];
    if (is_delta(lobe.kind) || !(s.weight[k] > 0) || !meets(lobe.kind, in, wi)) continue;
    sum += s.weight[k] * lobe_pdf(view_from(lobe, in.side > 0), in.wo, wi);
  }
  return sum / s.total;
}

float crossed_eta(const Closure& c, const Incident& in, Vec3f wi) {
  if (wi.z > 0 || in.fiber) return 1;
  for (int k = 0; k < c.count; ++k)
    if (!is_delta(c.lobes[k].kind) && family_of(c.lobes[k].kind).refracts)
      return view_from(c.lobes[k], in.side > 0).eta;
  return 1;
}

}  // namespace

void Closure::add(const Lobe& lobe) {
  if (is_black(lobe.color) && !(family_of(lobe.kind).two_colors && !is_black(lobe.conductor_eta))) return;
  if (count == kMaxLobes) throw InternalError("a closure has more lobes than kMaxLobes");
  lobes[count++] = lobe;
}

bool Closure::has_non_delta() const {
  for (int k = 0; k < count; ++k)
    if (!is_delta(lobes[k].kind)) return true;
  return false;
}

bool Closure::has_delta() const {
  for (int k = 0; k < count; ++k)
    if (is_delta(lobes[k].kind)) return true;
  return false;
}

bool Closure::is_fiber() const {
  for (int k = 0; k < count; ++k)
    if (is_hair(lobes[k].kind)) return true;
  return false;
}

float Closure::cosine(Vec3f w) const {
  return is_fiber() ? fiber_sine(frame.to_local(w)) : std::abs(dot(w, frame.n));
}

bool Closure::sides_agree(Vec3f w) const { return is_fiber() || dot(w, frame.n) * dot(w, ng) > 0; }

void face_viewer(Closure& closure, Vec3f wo) {
  constexpr float least_cosine = 0.01f;
  if (closure.is_fiber() || closure.sides_agree(wo)) return;
  const float toward = dot(closure.ng, wo), side = toward < 0 ? -1.0f : 1.0f;
  if (toward == 0) return;
  const Vec3f n = closure.frame.n * side, turned = n + wo * (least_cosine - dot(n, wo));
  closure.frame = Frame::from_normal_tangent(normalize(turned) * side, closure.frame.s);
}

bool Closure::is_lambertian() const {
  int non_delta = 0;
  for (int k = 0; k < count; ++k) {
    if (is_delta(lobes[k].kind)) continue;
    if (lobes[k].kind != LobeKind::diffuse || lobes[k].coat || lobes[k].sheen_layer) return false;
    ++non_delta;
  }
  return non_delta == 1;
}

Rgb Closure::diffuse_color() const {
  for (int k = 0; k < count; ++k)
    if (lobes[k].kind == LobeKind::diffuse) return lobes[k].color;
  return {};
}

float Closure::roughness() const {
  float min_roughness = has_non_delta() ? 1.0f : 0.0f;
  for (int k = 0; k < count; ++k)
    if (!is_delta(lobes[k].kind)) min_roughness = std::min(min_roughness, lobe_roughness(lobes[k]));
  return min_roughness;
}

namespace {
Closure part(const Closure& closure, float limit, bool sharp) {
  Closure kept = closure;
  kept.count = 0;
  for (int k = 0; k < closure.count; ++k)
    if (!is_delta(closure.lobes[k].kind) && (lobe_roughness(closure.lobes[k]) < limit) == sharp)
      kept.lobes[kept.count++] = closure.lobes[k];
  return kept;
}
}  // namespace

Closure sharp_part(const Closure& closure, float limit) { return part(closure, limit, true); }
Closure broad_part(const Closure& closure, float limit) { return part(closure, limit, false); }

Closure widened(const Closure& closure, Vec3f wo, float least) {
  // At a slant albedos are small and their ratios of no use.
  constexpr float kMostScaling = 2;
  const Incident in = incident(closure, wo);
  Closure wide = closure;
  for (Lobe& lobe : std::span(wide.lobes, static_cast<std::size_t>(wide.count))) {
    const float roughness = lobe_roughness(lobe);
    if (is_delta(lobe.kind) || !(roughness < least)) continue;
    const LobeFamily& family = family_of(lobe.kind);
    const Lobe sharp = lobe;
    // Widths add up as variances do. A coat widens what comes from under it by itself.
    const float own = family.roughness(lobe), wanted = own * least / std::max(roughness, 1e-6f);
    const Widening by{lobe.distribution, std::sqrt(2 * std::max(0.0f, square(wanted) - square(own)))};
    if (family.two_widths || lobe.kind == LobeKind::microfacet_transmit)
      lobe.alpha_u = by(lobe.alpha_u), lobe.alpha_v = by(lobe.alpha_v);
    else if (family.widen)
      family.widen(lobe, by);
    else
      continue;
    if (!in.valid) continue;
    const Rgb before = lobe_albedo(view_from(sharp, in.side > 0), in.wo),
              after = lobe_albedo(view_from(lobe, in.side > 0), in.wo);
    for (int c = 0; c < 3; ++c)
      if (after[c] > 0) lobe.color[c] *= std::clamp(before[c] / after[c], 1 / kMostScaling, kMostScaling);
  }
  return wide;
}

Rgb eval_f(const Closure& closure, Vec3f wo, Vec3f wi, bool adjoint) {
  if (adjoint) std::swap(wo, wi);
  const Incident in = incident(closure, wo);
  Vec3f local;
  if (!in.valid || !arriving(closure, in, wi, local)) return Rgb(0);
  return value_of_all(closure, in, local);
}

Rgb eval(const Closure& closure, Vec3f wo, Vec3f wi, bool adjoint) {
  return eval_f(closure, wo, wi, adjoint) * closure.cosine(wi);
}

float pdf(const Closure& closure, Vec3f wo, Vec3f wi, Lobes which) {
  if (which == Lobes::delta) return 0;
  const Incident in = incident(closure, wo);
  Vec3f local;
  if (!in.valid || !arriving(closure, in, wi, local)) return 0;
  const Selection s = select(closure, in, wo, which);
  return s.total > 0 ? density_of_all(closure, in, local, s) : 0.0f;
}

std::optional<BsdfSample> sample(const Closure& closure, Vec3f wo, float u1, Vec2f u2, Lobes which,
                                 bool adjoint) {
  const Incident in = incident(closure, wo);
  const Selection s = select(closure, in, wo, which);
  if (!(s.total > 0)) return std::nullopt;
  int chosen = -1;
  float left = u1 * s.total;
  for (int k = 0; k < closure.count; ++k) {
    if (!(s.weight[k] > 0)) continue;
    chosen = k;
    if (left < s.weight[k]) break;
    left -= s.weight[k];
  }
  const Lobe& lobe = closure.lobes[chosen];
  BsdfSample out;
  out.kind = lobe.kind;
  if (is_delta(lobe.kind)) {
    const DeltaLobe& delta = s.delta[chosen];
    out.wi = delta.wi;
    out.delta = true;
    out.transmitted = transmits(lobe.kind);
    out.eta = delta.eta;
    out.pdf = s.weight[chosen] / s.total;
    out.weight = delta.coefficient / out.pdf;
    if (!adjoint) out.weight *= 1 / (delta.eta * delta.eta);
    return out;
  }
  Vec3f local;
  if (!lobe_sample(view_from(lobe, in.side > 0), in.wo, u2, local)) return std::nullopt;
  const float cosine = in.fiber ? fiber_sine(local) : std::abs(local.z);
  if (!(cosine > kGrazing)) return std::nullopt;
  out.wi = closure.frame.to_world({local.x, local.y, local.z * in.side});
  if (!in.fiber && !sides_agree(closure, out.wi, local.z * in.side)) return std::nullopt;
  out.pdf = density_of_all(closure, in, local, s);
  if (!(out.pdf > 0) || !std::isfinite(out.pdf)) return std::nullopt;
  out.transmitted = local.z < 0 && !in.fiber;
  out.eta = crossed_eta(closure, in, local);
  out.weight = value_of_all(closure, in, local) * (cosine / out.pdf);
  // Radiance scales by the squared index when it crosses; the value above is that of radiance.
  if (adjoint) out.weight *= out.eta * out.eta;
  return out;
}

int delta_continuations(const Closure& closure, Vec3f wo, DeltaContinuation out[kMaxLobes + 1],
                        bool adjoint) {
  const Incident in = incident(closure, wo);
  int n = 0;
  for (int k = 0; k < closure.count; ++k) {
    if (!is_delta(closure.lobes[k].kind)) continue;
    DeltaLobe delta;
    if (!follow_delta(closure, in, closure.lobes[k], wo, delta)) continue;
    const float scale = adjoint ? 1.0f : 1 / (delta.eta * delta.eta);
    out[n++] = {delta.wi, delta.coefficient * scale, closure.lobes[k].kind, delta.eta};
  }
  return n;
}

namespace {

Rgb albedo(const Closure& closure, Vec3f wo, bool roughly) {
  const Incident in = incident(closure, wo);
  Rgb sum(0);
  for (int k = 0; k < closure.count; ++k) {
    const Lobe& lobe = closure.lobes[k];
    DeltaLobe delta;
    if (is_delta(lobe.kind)) {
      if (follow_delta(closure, in, lobe, wo, delta)) sum += delta.coefficient;
    } else if (in.valid) {
      LobeView view = view_from(lobe, in.side > 0);
      view.roughly = roughly;
      sum += lobe_albedo(view, in.wo);
    }
  }
  return clamp_below(sum, 1);
}

}  // namespace

Rgb albedo(const Closure& closure, Vec3f wo) { return albedo(closure, wo, false); }
Rgb rough_albedo(const Closure& closure, Vec3f wo) { return albedo(closure, wo, true); }

float shading_correction(const Closure& closure, Vec3f wo, Vec3f wi) {
  if (closure.is_fiber()) return 1;
  const float numerator = std::abs(dot(wo, closure.frame.n) * dot(wi, closure.ng));
  const float denominator = std::abs(dot(wo, closure.ng) * dot(wi, closure.frame.n));
  return denominator > 0 ? numerator / denominator : 0.0f;
}

}  // namespace lumirank::scatter
