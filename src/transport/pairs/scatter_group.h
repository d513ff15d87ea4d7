// Receivers or surface lights that are not lambertian, 16 of one form at a time. What depends on the
// direction known first is worked out once, when a group is fetched; then the group is evaluated for many
// partners.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "base/lanes.h"
#include "scatter/closure.h"
#include "scatter/closure_pool.h"
#include "transport/pairs/lobe_cones.h"
#include "transport/pairs/scatter_forms.h"

namespace lumirank::transport {

// The closures of one side of the matrix and the directions known first.
struct ScatterSide {
  const scatter::ClosurePool* pool;
  const ScatterForms* forms;
  const std::vector<std::uint32_t>* closure;
  const std::vector<Vec3f>*normal, *ng, *wo;
  bool adjoint;  // light flows from wo, as at a virtual light
  // Lobes with less roughness do not answer direct light (SceneMatrixSettings::traced_direct_below).
  float traced_below = 0;
  const std::vector<LobeCone>* cones = nullptr;  // by recipe, where lights are spherical

  scatter::Closure get(std::uint32_t item) const {
    return pool->get((*closure)[item], (*normal)[item], (*ng)[item]);
  }
};

// One lobe of 16 closures. What the fields mean depends on the lobe's kind.
struct LobeLanes {
  // diffuse: color/π; interfaced_diffuse: color·T(wo)/π; microfacet: color·G1(wo)/(4·wo.z); the others: see
  // prepare(). Under a coat, what the coat does on wo's side is multiplied in.
  Lane3 color;
  Lane alpha_u, alpha_v;
  Lane eta;         // seen from wo's side
  LaneMask traced;  // of direct light, this lobe's part is traced elsewhere
  Lane3 a, b;       // conductor: eta and k; schlick: a is F0; interfaced_diffuse: the coefficients of T;
                    // oren_nayar: a is ρ², b and eta its constants; disney_diffuse: b.x is the flatness
};

// The coat over one lobe of 16 closures: scatter::Coat.
struct CoatLanes {
  Lane eta, bend, t[6];
  Lane3 depth;
  Lane trapped, width, critical;
  Lane3 wo;    // refracted into the coat
  Lane cos_o;  // its cosine
};

// All directions on the side of wo: n, ng and t are turned so that n·wo > 0.
struct ScatterGroup {
  const ScatterForm* form = nullptr;
  bool adjoint = false;
  bool some_traced = false;  // some lobe leaves direct light to tracing
  Lane3 n, ng, wo;
  Lane3 s, t;                        // anisotropic forms only
  LaneMask answers;                  // n and ng agree about the side of wo
  Lane cos_o;                        // n·wo; 1 in lanes that do not answer
  const LobeLanes* lobes = nullptr;  // form->lobes.size()
  const CoatLanes* coats = nullptr;  // as many, if form->coated; meaningless for lobes without a coat
  LobeCones cones;                   // if ScatterSide::cones
  // Forms without lane code: nullptr where padded.
  const scatter::Closure* closure[16];
  const scatter::Closure* broad[16];  // if some_traced: without the lobes that leave direct light to tracing
};

// Keeps what ScatterGroups point to; clear() before the next tile.
class ScatterArena {
 public:
  // items: 16 receivers or lights of one form, kNoItem where there is none.
  ScatterGroup fetch(const ScatterSide& side, const std::uint32_t items[16]);
  // 16 times the same.
  ScatterGroup fetch(const ScatterSide& side, std::uint32_t item);
  void clear();

 private:
  void keep(ScatterGroup& group, int lane, const ScatterSide& side, std::uint32_t item);
  LobeLanes* new_lobes(std::size_t count);
  CoatLanes* new_coats(const ScatterForm& form);

  std::deque<scatter::Closure> closures_;  // does not move its elements
  std::vector<std::vector<LobeLanes>> chunks_;
  std::deque<std::vector<CoatLanes>> coats_;
  std::size_t chunk_ = 0, used_ = 0;
};

// f(wo, wi) of scatter::eval_f, wi unit and away from the surface. `direct`: lanes whose light is direct.
Lane3 eval_f(const ScatterGroup& group, const Lane3& wi, LaneMask direct);

}  // namespace lumirank::transport
