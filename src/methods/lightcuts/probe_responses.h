// Responses of receivers to a few lights, nothing in between: a fingerprint of place, normal and material.
// Where two of them are not in proportion, one receiver tells little of the other
// (Walter et al. 2005, section 5, ask for the same material, which a matrix does not know).
#pragma once

#include <span>
#include <vector>

#include "matrix/entry_reader.h"
#include "methods/common/light_tree/light_tree.h"

namespace lumirank::methods {

class ProbeResponses {
 public:
  explicit ProbeResponses(const LightTree& tree);

  // Of all of these rows; forgets others.
  void measure(std::span<const matrix::Index> rows, matrix::EntryReader& reader);
  // The cosine of two rows' responses, by their places among those measured; 1 where both or no lights at all
  // are dark, 0 where one is.
  float similarity(std::size_t a, std::size_t b) const;

 private:
  std::vector<matrix::Index> lights_;
  std::vector<float> responses_;  // by row, of unit length or 0
  std::vector<Rgb> values_;
};

}  // namespace lumirank::methods
