// Film positions drawn from the reconstruction filter itself (filter importance sampling, Ernst et al. 2006):
// every pixel is then an independent mean, with weights ±1 for filters that go negative.
#pragma once

#include <vector>

#include "base/distribution.h"
#include "film/filter.h"

namespace lumirank::film {

class FilterSampler {
 public:
  explicit FilterSampler(const Filter& filter);

  struct Sample {
    Vec2f offset;  // from the pixel's center, in pixels
    float weight;  // expectation 1
  };
  Sample sample(Vec2f u) const;

  // The other way round: one of the pixels for which a place on the film counts, drawn by the filter.
  struct Pixel {
    Vec2i at;
    float weight;  // its expectation over all pixels is 1
  };
  Pixel pixel(Vec2f film, Vec2f u) const;

 private:
  struct Axis {
    float offset, weight;
  };
  Axis axis(float u) const;
  struct AxisPixel {
    int at;
    float weight;
  };
  AxisPixel axis_pixel(float film, float u) const;

  Filter filter_;
  Distribution1D table_;
  std::vector<bool> negative_;  // by its bins
  double scale_ = 1;            // ∫|f| / ∫f
  double integral_ = 1;         // ∫f
};

}  // namespace lumirank::film
