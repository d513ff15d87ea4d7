// From row sums to pictures.
#pragma once

#include <span>
#include <vector>

#include "image/image.h"
#include "lumirank/lumirank.h"
#include "pipeline/prepared.h"

namespace lumirank::pipeline {

// The picture for given row sums: chain weights, traced light, emission, reconstruction filter.
struct FilmParts {
  bool emission = true, matrix = true, traced_direct = true, traced_indirect = true;
};
// What `only` leaves of the picture.
FilmParts wanted_parts(LightPart only);
// One value per film sample.
std::vector<Rgb> sample_values(const transport::Receivers& rows, const TracedLight& traced,
                               std::span<const Rgb> sums, FilmParts parts);
image::Image develop(const View& view, const transport::Receivers& rows, std::span<const Rgb> values);
// InputError if a value is infinite or not a number (sound_pixels.h).
Picture to_picture(const image::Image& image);

}  // namespace lumirank::pipeline
