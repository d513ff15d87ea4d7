// Frames of a shot that were finished one by one, averaged with their neighbors in time: of what noise there
// was a denoiser makes other blotches in every frame, which boil.
//
// A pixel takes the mean of what it shows and of what is shown of its place in frames before and after:
// places of what moves or deforms go with its triangles. Frames are taken in pairs, equally far before and
// after: the mean of a pair leaves alone what changes evenly, so that light which slides over a surface stays
// where it is. A pair counts the less the more its mean differs from what the pixel shows itself (Tukey's
// biweight), measured by what its noise explains, still less where light jumps from one to the other, and not
// at all where its place is hidden in both. Light is averaged without the albedo, so that textures stay
// sharp. (Reprojection: Scherzer et al., "A Survey on Temporal Coherence Methods in Real-Time Rendering",
// 2011. Here the future is known, and nothing is fed back.)
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "image/image.h"
#include "pipeline/pixel_features.h"
#include "pipeline/recipe.h"
#include "world/world.h"

namespace lumirank::pipeline {

// What a pixel's middle sees.
struct FilmSurface {
  Vec3f position, normal;
  // Between what the middles of neighboring pixels see: across the ray, and along the surface. 0: none is
  // seen.
  float spacing = 0, along = 0;
  std::uint32_t placement = 0, triangle = 0;  // by which it is found at another moment
  Vec2f barycentric;
  bool at_edge = false;  // a pixel beside it sees another surface, so that it may show some of that
};
// Of all pixels of a view.
std::vector<FilmSurface> film_surfaces(const world::World& world, const View& view);

struct ShotFrame {
  View view;
  std::shared_ptr<const world::World> world;  // nullptr: what it shows moves nowhere
  image::Image picture;                       // finished
  image::Image albedo;                        // empty: not known
  std::vector<FilmSurface> surfaces;
  // By pixel: which part of its light it may differ from a pair and still be averaged with it. 0: it is left
  // as it is, as what shines by itself.
  std::vector<float> tolerance;
  std::optional<film::Filter> lacking_filter;  // as of its PictureFeatures
};
ShotFrame shot_frame(std::shared_ptr<const world::World> world, const View& view, image::Image picture,
                     const PictureFeatures& features);

// Frame `own` of these, which follow one another.
image::Image filtered_in_time(const std::deque<ShotFrame>& frames, std::size_t own);

}  // namespace lumirank::pipeline
