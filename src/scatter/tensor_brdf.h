// Measured BRDFs in the parameterization of Dupuy and Jakob 2018 ("An Adaptive Parameterization for Efficient
// Material Acquisition and Rendering"): the .bsdf files of the RGL material database, which Mitsuba 3's and
// pbrt's "measured" read.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/rgb.h"
#include "base/vec.h"

namespace lumirank::scatter {

class TensorBrdf {
 public:
  static bool is_one(const std::string& bytes);
  // InputError, at `where`, if the bytes are no such file; `filename` only names it.
  TensorBrdf(const std::string& bytes, const std::string& filename, const SourceLocation& where);

  // f(wo, wi) in the local frame, both with z > 0; of anisotropic materials the mean over turns about z.
  Rgb operator()(Vec3f wo, Vec3f wi) const;
  bool isotropic() const { return isotropic_; }

 private:
  // Values at the corners of a grid over the unit square, bilinear in between.
  struct Grid {
    int columns = 0, rows = 0;
    std::vector<float> values;
    float at(Vec2f u) const;
  };
  // The density of microfacets' normals as one direction sees them, over (√θ, φ) of the normal, and its
  // integrals: along rows, of whole rows, and over the rows before.
  struct Visible {
    std::vector<float> density, along, row, before;
  };
  // Directions between which is interpolated, with their shares.
  struct Corner {
    std::size_t slice;
    float share;
  };
  std::array<Corner, 4> corners(float phi, float theta) const;
  // Where a normal lies in the unit square that its density, uniformly spread, would fill.
  Vec2f uniform(Vec2f u, const std::array<Corner, 4>& corners) const;
  Rgb times_cosine(Vec3f in, Vec3f out) const;

  std::vector<float> phi_, theta_;  // of the directions that were measured
  Grid ndf_, sigma_;
  int columns_ = 0, rows_ = 0;  // of `visible_`
  std::vector<Visible> visible_;
  int color_columns_ = 0, color_rows_ = 0;
  std::vector<std::vector<Rgb>> colors_;
  bool isotropic_ = true, jacobian_ = true;
  int parts_ = 1;  // of a turn; one of them was measured, and the others are its mirror images
};

}  // namespace lumirank::scatter
