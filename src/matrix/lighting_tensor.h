// The lighting matrices of the frames of a shot, whose columns are the same lights: column j is light j in
// every frame, wherever it is then and however bright (Hašan et al. 2008, section 4.2). Rows are each frame's
// own.
#pragma once

#include <cstddef>
#include <memory>

#include "matrix/lighting_matrix.h"

namespace lumirank::matrix {

class LightingTensor {
 public:
  virtual ~LightingTensor() = default;
  virtual std::size_t frames() const = 0;
  virtual std::size_t columns() const = 0;
  // The matrix of a frame, for as long as it is held. May be made for this call: whoever needs a frame
  // several times keeps it. From any thread.
  virtual std::shared_ptr<const LightingMatrix> frame(std::size_t k) const = 0;
};

}  // namespace lumirank::matrix
