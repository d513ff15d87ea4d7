// Forms of closures: those whose lobes have the same kinds in the same order are evaluated together.
#pragma once

#include <cstdint>
#include <vector>

#include "scatter/closure.h"
#include "scatter/closure_pool.h"
#include "scatter/lobes/family.h"

namespace lumirank::transport {

struct LobeForm {
  scatter::LobeKind kind;
  scatter::LaneForm lanes;  // of the kind
  scatter::FresnelKind fresnel;
  scatter::NormalDistribution distribution;
  std::uint8_t variant;  // of ward
  bool coated;
  friend bool operator==(const LobeForm&, const LobeForm&) = default;
};

// From where light matters.
enum class Sides : std::uint8_t {
  front,
  both,   // some lobe shines through the surface
  fiber,  // all around, and the sine of the angle to the tangent takes the place of the cosine
};

struct ScatterForm {
  std::vector<LobeForm> lobes;
  bool in_lanes = false;  // there is vectorized code for all lobes; otherwise scatter::eval_f, lane by lane
  bool microfacets = false;  // some lobe needs the half vector
  bool anisotropic = false;  // some lobe needs the tangent
  bool coated = false;       // some lobe has a coat
  Sides sides = Sides::front;
  friend bool operator==(const ScatterForm&, const ScatterForm&) = default;
};

// The forms of the closures of one pool.
class ScatterForms {
 public:
  explicit ScatterForms(const scatter::ClosurePool& pool);
  std::uint16_t of_recipe(std::uint32_t recipe) const { return form_of_recipe_[recipe]; }
  const ScatterForm& operator[](std::uint16_t form) const { return forms_[form]; }
  std::size_t size() const { return forms_.size(); }
  // Not all are Sides::front: rays start on the side to which they go.
  bool some_two_sided() const;

 private:
  std::vector<ScatterForm> forms_;
  std::vector<std::uint16_t> form_of_recipe_;
};

}  // namespace lumirank::transport
