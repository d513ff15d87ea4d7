// From row sums to pictures.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "film/filter.h"
#include "image/image.h"
#include "lumirank/lumirank.h"
#include "pipeline/prepared.h"
#include "transport/rows/receiver_finder.h"

namespace lumirank::pipeline {

// The picture for given row sums: chain weights, traced light, emission, reconstruction filter.
struct FilmParts {
  bool emission = true, matrix = true, traced_direct = true, traced_indirect = true;
};
// What `only` leaves of the picture.
FilmParts wanted_parts(LightPart only);

// What a picture is made of beside row sums, rows and traced light only where some of it is wanted. Must
// outlive the call.
struct FilmInput {
  const world::World& world;
  const View& view;
  const Recipe& recipe;
  const transport::Receivers& rows;  // of the matrix
  const TracedLight& traced;
};
FilmInput film_input(const Prepared& prepared);

// How many surfaces of film samples took their light from where (transport::FilmFit).
struct FilmFits {
  std::array<std::uint64_t, transport::kFilmFits> count{};
  double share(transport::FilmFit fit) const;
  FilmFits operator+(const FilmFits& other) const;
};

// With film samples of their own (Recipe::film_samples) these are traced again by every call, tile by tile.
image::Image develop(const FilmInput& film, std::span<const Rgb> sums, FilmParts parts,
                     FilmFits* fits = nullptr);
// The mean of what `value` makes of the eye's first hits.
image::Image develop_first_hits(const FilmInput& film,
                                const std::function<Rgb(const transport::FirstHit&)>& value);

// One value per film sample of the receivers.
std::vector<Rgb> sample_values(const transport::Receivers& rows, const TracedLight& traced,
                               std::span<const Rgb> sums, FilmParts parts);
// The picture of these samples alone, whatever the recipe.
image::Image develop(const View& view, const transport::Receivers& rows, std::span<const Rgb> values);
// InputError if a value is infinite or not a number (sound_pixels.h).
Picture to_picture(const image::Image& image);
// The colors of a picture.
image::Image image_of(const Picture& picture);
// Where the picture that is shown has the box in the place of a filter (film/refilter.h).
void refilter(Picture& picture, const std::optional<film::Filter>& filter);

}  // namespace lumirank::pipeline
