// Sampling of lights, and the density with which any hit on one would have been sampled. For the path tracer
// and the directly traced receivers; the matrix does not use it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/distribution.h"
#include "emitters/emitter.h"
#include "emitters/light_tree.h"
#include "emitters/round_lamp.h"
#include "scatter/closure.h"
#include "world/world.h"

namespace lumirank::world {

// What light sampling needs to know of a surface that scatters by `closure` towards wo: the side from which
// light matters, or both.
emitters::LitPoint lit_point(Vec3f position, const scatter::Closure& closure, Vec3f wo);

// Triangles of area lights, round lamps, points and spots are leaves of one light tree; what is infinitely
// far is chosen by its irradiance. Neither group gets less than a quarter where both shine.
class LightSampler {
 public:
  explicit LightSampler(const World& world);

  // One sample of the light arriving at a point; `pdf` includes the choice of the light (a probability for
  // delta emitters). pdf 0: nothing found.
  struct Sample {
    emitters::DirectSample direct;
    int emitter = -1;
    float pdf = 0;
  };
  Sample sample(const emitters::LitPoint& at, double u_light, Vec2f u) const;

  // Numbers `u` of a sample to come. What an environment map will be asked for by them may be fetched while
  // something else is done: fetch() some time before sample(), and fetch_column() and fetch_texel() between
  // them.
  struct Ahead {
    Vec2f u;
    emitters::EnvironmentEmitter::Texel texel{};  // only where the map has several
  };
  Ahead fetch(Vec2f u) const {
    Ahead ahead{u};
    if (map_) ahead.texel.row = map_->fetch_row(u);
    return ahead;
  }
  void fetch_column(const Ahead& ahead) const {
    if (map_) map_->fetch_column(ahead.u, ahead.texel.row);
  }
  void fetch_texel(Ahead& ahead) const {
    if (map_) ahead.texel = map_->fetch_texel(ahead.u, ahead.texel.row);
  }
  // As sample() by ahead.u, all steps being done.
  Sample sample_ahead(const emitters::LitPoint& at, double u_light, const Ahead& ahead) const;
  // Likewise for background(): a position on the map, if there is one.
  std::optional<Vec2f> fetch_background(Vec3f direction) const {
    return map_ ? std::optional(map_->fetch_position(direction)) : std::nullopt;
  }

  // Solid-angle density of sample() for a surface hit at `distance` along unit `direction` from `at`.
  float pdf_hit(const emitters::LitPoint& at, const SurfaceHit& hit, Vec3f direction, float distance) const;
  // The same for a ray that leaves the scene.
  float pdf_background(const emitters::LitPoint& at, Vec3f direction) const;
  // And with that what World::background() gives: both for little more than either.
  emitters::EnvironmentEmitter::Seen background(const emitters::LitPoint& at, Vec3f direction) const;
  emitters::EnvironmentEmitter::Seen background_at(const emitters::LitPoint& at, Vec2f position) const;
  Rgb background_at(Vec2f position) const { return map_->eval_at(position); }

  // Probability with which sample() takes a delta emitter.
  float probability_of_delta(const emitters::LitPoint& at, int emitter) const;

  // A place on a near light, drawn for one point and to shine on others: where along a flight its light is
  // worth looking for is known only once the place is.
  struct Place {
    Vec3f position;
    float choice = 0;  // probability of its light; 0: nothing found
    std::uint32_t leaf = 0, triangle = 0;
    Vec2f barycentric;
  };
  // The part of all samples that near lights are worth; 0 without any.
  float place_share() const { return tree_.empty() ? 0.0f : near_share_; }
  const Bounds3f& place_bounds() const { return place_bounds_; }
  Place sample_place(const emitters::LitPoint& at, double u_light, Vec2f u) const;
  // Light from there at another point, with the pdf with which sample() finds it there.
  Sample from_place(const emitters::LitPoint& at, const Place& place) const;
  // Density of sample_place() for `at` of the place that a sample, or a hit as in pdf_hit, found; per solid
  // angle from where it was found, like its own pdf. 0 for far lights.
  float pdf_place(const emitters::LitPoint& at, const Sample& found) const;
  float pdf_place(const emitters::LitPoint& at, const SurfaceHit& hit, Vec3f direction, float distance) const;

 private:
  struct Leaf {
    int emitter;
    std::uint32_t triangle;  // of area emitters; kRound: all of a round lamp's
  };
  static constexpr std::uint32_t kRound = 0xffffffffu;
  struct OnLamp {  // a place on an area emitter
    std::uint32_t triangle;
    Vec2f barycentric;
  };
  const emitters::AreaEmitter* area_of(int emitter) const;  // nullptr: of another kind
  const emitters::AreaEmitter* area_hit(const SurfaceHit& hit) const;
  std::uint32_t leaf_of(int emitter, std::uint32_t triangle) const;
  // Density per solid angle with which a place on an emitter, at `distance` along `direction` from a point,
  // is drawn for that point once its leaf is; and the same of a place that was drawn for another point.
  float pdf_for(int emitter, const emitters::AreaEmitter& area, std::uint32_t triangle, Vec3f at,
                Vec3f direction, float distance) const;
  float pdf_for_another(int emitter, const emitters::AreaEmitter& area, std::uint32_t triangle, Vec3f place,
                        Vec3f drawn_for, Vec3f direction, float distance) const;
  // What a round lamp sends to a point within a cone.
  emitters::DirectSample light_in(int emitter, const emitters::RoundLamp::Cone& cone, Vec3f at,
                                  Vec2f u) const;
  // What a place on an emitter sends to a point, with the pdf of its being drawn for that point.
  emitters::DirectSample light_from(int emitter, const emitters::AreaEmitter& area, const OnLamp& place,
                                    Vec3f at) const;
  Sample sample_leaf(std::uint32_t leaf, Vec3f at, Vec2f u) const;
  float near_share(const emitters::LitPoint& at) const;
  Sample sample(const emitters::LitPoint& at, double u_light, Vec2f u, const Ahead* ahead) const;
  // Probability with which the environment is chosen.
  float choice_of_environment(const emitters::LitPoint& at) const;

  const World& world_;
  std::vector<Leaf> leaves_;
  std::vector<std::uint32_t> first_leaf_;                  // per emitter; its triangles follow each other
  std::vector<std::optional<emitters::RoundLamp>> round_;  // per emitter
  emitters::LightTree tree_;
  std::vector<int> far_;
  const emitters::EnvironmentEmitter* map_ = nullptr;  // of more than one texel
  Distribution1D far_choice_;
  float near_share_ = 1;
  Bounds3f place_bounds_;  // of near lights
};

// Light through whatever lets it pass straight: the fraction that arrives over the open segment from `from`
// (a surface point with geometric normal `ng`) towards `direction` for `distance` (may be infinite).
Rgb visible_fraction(const World& world, Vec3f from, Vec3f ng, Vec3f direction, float distance,
                     std::uint64_t key);

}  // namespace lumirank::world
