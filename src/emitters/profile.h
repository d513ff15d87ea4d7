// Angular profile of a point light: a table over two angles (a luminaire's photometric file, a
// goniometric picture).
#pragma once

#include <vector>

#include "base/distribution.h"
#include "base/vec.h"
#include "emitters/intensity_profile.h"

namespace lumirank::emitters {

// Bilinear in the angles between the entries, 0 beyond the first and last polar angle. Local directions:
// theta is measured from +z, phi from +x towards +y.
class AngularProfile final : public IntensityProfile {
 public:
  // Radians, both ascending: theta within [0, π] with two or more entries, phi from exactly 0 to 2π (float)
  // with two or more, the last column equal to the first. values: theta.size() × phi.size(), phi fastest,
  // finite and not negative. InternalError otherwise.
  AngularProfile(std::vector<float> theta, std::vector<float> phi, std::vector<float> values);

  float eval(Vec3f local) const;  // of a unit vector
  Rgb intensity(Vec3f local) const override { return Rgb(eval(local)); }

  // Follows the table: the cell by its integral, evenly over the solid angle of the cell.
  Sample sample(Vec2f u) const override;
  float pdf(Vec3f local) const override;

  double integral() const { return rows_.total(); }  // ∫ eval dω, exact
  Rgb total() const override { return Rgb(static_cast<float>(integral())); }
  float max_value() const override { return max_value_; }
  float min_theta() const override { return min_theta_; }
  float max_theta() const override { return max_theta_; }
  std::size_t memory_bytes() const;

 private:
  // The interval of `angles` that x lies in and how far, from 0 to 1.
  struct Place {
    std::size_t index;
    float fraction;
  };
  static Place locate(const std::vector<float>& angles, float x);
  float value(std::size_t row, std::size_t column) const { return values_[row * phi_.size() + column]; }
  double cell_integral(std::size_t row, std::size_t column) const;
  float cell_solid_angle(std::size_t row, std::size_t column) const;

  std::vector<float> theta_, phi_, values_, cos_theta_;
  Distribution1D rows_;
  std::vector<Distribution1D> columns_;  // of each row of cells
  float max_value_ = 0, min_theta_ = 0, max_theta_ = 0;
};

}  // namespace lumirank::emitters
