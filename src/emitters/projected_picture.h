// The intensity of a point light that throws a picture, as a slide projector does.
#pragma once

#include <vector>

#include "base/distribution.h"
#include "emitters/intensity_profile.h"

namespace lumirank::emitters {

// The picture's frame is a rectangle about +z, perpendicular to it: bilinear between centers of pixels,
// even from the outer ones to the frame, and black beyond.
class ProjectedPicture final : public IntensityProfile {
 public:
  // values: width × height intensities, x fastest; the first pixel is that of the least local x and y. half:
  // half the frame's width and height at a distance of 1. InternalError if a size does not fit, or a value is
  // negative or not finite.
  ProjectedPicture(int width, int height, std::vector<Rgb> values, Vec2f half);

  Rgb intensity(Vec3f local) const override;
  Rgb total() const override { return total_; }  // of values that are even within pixels
  // Follows the largest channel of the pixels' light, evenly over the frame within a pixel.
  Sample sample(Vec2f u) const override;
  float pdf(Vec3f local) const override;
  float max_value() const override { return max_value_; }
  float min_theta() const override { return 0; }
  float max_theta() const override;

 private:
  // Where on the picture a direction is, in pixels; outside of it or behind: false.
  bool place_of(Vec3f local, Vec2f& place) const;
  const Rgb& value(int x, int y) const;

  int width_, height_;
  Vec2f half_;
  std::vector<Rgb> values_;
  Rgb total_{0};
  float max_value_ = 0;
  Distribution1D rows_;
  std::vector<Distribution1D> columns_;  // of each row
};

}  // namespace lumirank::emitters
