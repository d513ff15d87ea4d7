// What columns can add to rows at most, from places, normals and materials.
#include <algorithm>
#include <limits>

#include "transport/scene_matrix_impl.h"

namespace lumirank::transport {

using matrix::ColumnSet;
using matrix::Emission;
using matrix::Index;

namespace {

// Places and reflectances of lambertian receivers; others are only known to be bounded by clamping.
class SceneRowBounds final : public matrix::RowBounds {
 public:
  explicit SceneRowBounds(const Receivers& receivers) : receivers_(receivers) {}

  void set_rows(std::span<const Index> rows) override {
    box_ = {};
    reflectance_ = Rgb(0);
    for (const Index i : rows) {
      box_.extend(receivers_.position[i]);
      const bool matt = receivers_.closure[i] == Receivers::kLambertian;
      for (int c = 0; c < 3; ++c)
        reflectance_[c] = std::max(
            reflectance_[c], matt ? receivers_.albedo[i][c] * kInvPi : std::numeric_limits<float>::max());
    }
  }

  Rgb bound(const ColumnSet& set) const override {
    float geometry = 1;
    if (set.emission != Emission::directional) {
      const Vec3f gap = max(max(set.box.lo - box_.hi, box_.lo - set.box.hi), Vec3f{});
      const float d = length(gap) - set.radius;
      geometry = d > 0 ? 1 / square(d) : kInfinity;
    }
    Rgb bound;
    for (int c = 0; c < 3; ++c) {
      const float most =
          reflectance_[c] > 0 && set.intensity[c] > 0 ? reflectance_[c] * set.intensity[c] * geometry : 0;
      bound[c] = std::min(most, set.ceiling[c]);
    }
    return bound;
  }

 private:
  const Receivers& receivers_;
  Bounds3f box_;
  Rgb reflectance_;
};

}  // namespace

ColumnSet SceneMatrix::column_set(Index j) const {
  const VirtualLights& lights = impl_->lights;
  ColumnSet set;
  set.box.extend(lights.position[j]);
  set.cone = {lights.ng[j], 1};
  set.intensity = lights.power[j];
  switch (lights.kind[j]) {
    case LightKind::omni:
    case LightKind::spot:
      break;
    case LightKind::directional:
      set.emission = Emission::directional;
      set.cone.axis = -lights.normal[j];
      break;
    case LightKind::oriented:
      set.emission = Emission::oriented;
      break;
    case LightKind::surface:
      if (lights.closure[j] == VirtualLights::kLambertian) {
        set.emission = Emission::oriented;
        set.intensity = lights.power[j] * lights.albedo[j] * kInvPi;
      } else {
        set.intensity = Rgb(std::numeric_limits<float>::max());
      }
      if (lights.spherical() && lights.radius[j] > 0) set.spherical = true, set.radius = lights.radius[j];
      break;
  }
  if (lights.area[j] > 0 && impl_->context.clamp < kInfinity && set.emission == Emission::oriented) {
    const Rgb radiance = lights.kind[j] == LightKind::surface ? lights.albedo[j] * kInvPi : Rgb(kInvPi);
    set.ceiling =
        set.intensity * (impl_->context.clamp / (lights.area[j] * square(kPi) * max_component(radiance)));
  }
  return set;
}

std::unique_ptr<matrix::RowBounds> SceneMatrix::row_bounds() const {
  return std::make_unique<SceneRowBounds>(impl_->receivers);
}

}  // namespace lumirank::transport
