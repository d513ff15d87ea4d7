// Collects the lobes of a material and of the materials nested in it into one closure. Inside this room only.
#pragma once

#include "scatter/material.h"

namespace lumirank::scatter {

class ClosureBuilder {
 public:
  ClosureBuilder(const MaterialSet& set, Vec3f wo) : set_(set), wo_(wo) {}

  // Adds a material at a point, scaled by `weight` > 0. The point's frame may differ from part to part (bump
  // maps, two-sidedness); the closure keeps the frame of the part that weighs most.
  void add(int material, const SurfacePoint& at, float weight);
  Closure finish(const SurfacePoint& at);

  // For add_lobes() of the materials (material.h).
  const TextureSet& textures() const { return set_.textures; }
  bool front(const SurfacePoint& at) const { return dot(wo_, at.ng) > 0; }
  void push(Lobe lobe, const SurfacePoint& at, float weight);
  // A builder of the same, for what is nested.
  ClosureBuilder inside() const { return ClosureBuilder(set_, wo_); }

 private:
  void use_frame(const SurfacePoint& at, float weight);

  const MaterialSet& set_;
  Vec3f wo_;
  Closure out_;
  float frame_weight_ = 0;
};

Lobe lobe_of(LobeKind kind, Rgb color);

// Inputs with their textures looked up. Reflectances are held within [0, 1], so that no surface makes energy;
// what is not a number counts as 0.
Rgb reflectance(const TextureSet& textures, const ColorInput& input, const SurfaceUv& uv);
// Not held within [0, 1] but at least 0: optical thicknesses.
Rgb positive_color(const TextureSet& textures, const ColorInput& input, const SurfaceUv& uv);
float number(const TextureSet& textures, const FloatInput& input, const SurfaceUv& uv);
float fraction(const TextureSet& textures, const FloatInput& input, const SurfaceUv& uv);  // within [0, 1]
// Along the tangent, see PlasticDesc.
inline float stretched_alpha(float alpha, float stretch) { return alpha + (1 - alpha) * square(stretch); }
float rough_alpha(const TextureSet& textures, const FloatInput& input,
                  const SurfaceUv& uv);  // [kMinAlpha, 1]

// Weights of a mixture's parts at a point; divided by their sum if that exceeds 1.
std::vector<float> mixture_weights(const TextureSet& textures, const MixtureMaterial& m, const SurfaceUv& uv);

// Perturbed points (perturb.cpp).
SurfacePoint bumped(const TextureSet& textures, const BumpMaterial& m, const SurfacePoint& at);
SurfacePoint normal_mapped(const TextureSet& textures, const NormalMapMaterial& m, const SurfacePoint& at);
SurfacePoint with_turned_tangent(const TextureSet& textures, const TurnedTangentMaterial& m,
                                 const SurfacePoint& at);
// The same point with its other side outside; tangents stay.
SurfacePoint turned(const SurfacePoint& at);

// What a coating lets through of light that goes straight along w (coating.cpp).
Rgb coating_passage(const TextureSet& textures, const CoatingMaterial& m, const SurfacePoint& at, Vec3f w);

// Makes room in a full closure (merge_lobes.cpp).
void merge_lobes(Closure& closure, const Lobe& extra);
// Adds `lobe`'s color to a lobe that is equal but for its color, if there is one.
bool absorb(Closure& closure, const Lobe& lobe);

}  // namespace lumirank::scatter
