// What the eye rays of each pixel say without any receiver: emission that is seen, and the features by which
// a denoiser tells edges from noise. All pixels get a few film samples, those at edges more.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/sinks.h"
#include "film/filter.h"
#include "image/image.h"
#include "pipeline/recipe.h"
#include "world/world.h"

namespace lumirank::pipeline {

// Means over pixels (a box filter). All of the size of the view.
struct PixelFeatures {
  image::Image emission;  // what is seen straight and in focus
  // Emission by mirrors and glass, and out of focus: a few samples may find a small lamp, so this is noisy.
  image::Image noisy_emission;
  // Σ weight · albedo, Σ weight · normal / Σ weight of the surfaces at the ends of the eye's specular chains:
  // what a mirror shows counts, not the mirror. Black where there is none.
  image::Image albedo, normal;
  // Part of the pixel that is not `emission` alone: gray, [0, 1]. 1 where there is noisy emission.
  image::Image cover;
};

// What is told of a picture by who rendered it, beside its colors. Empty where it is not known.
struct PictureFeatures {
  PixelFeatures means;
  image::Image difference;  // twice the noise before a denoiser, of the picture's size or smaller
  std::optional<film::Filter> lacking_filter;  // the picture has the box in its place
};

class PixelFeatureTracing {
 public:
  // Must outlive it: the world. Random numbers are by the recipe's seed.
  PixelFeatureTracing(const world::World& world, const View& view, const Recipe& recipe);

  // So many film samples of each pixel; the first say where edges are. False if it was cancelled.
  bool trace_all(int samples, const Sinks& sinks);
  // The part of the pixels that differ from a neighbor, or within themselves; and of those that differ in
  // emission by more than a screen shows: a hundredth of a sunny window is seen on a bar across it.
  double differing() const { return part_from(Edge::some); }
  double glaring() const { return part_from(Edge::glaring); }
  // So many more for these. False if it was cancelled.
  bool trace_differing(int samples, const Sinks& sinks);
  bool trace_glaring(int samples, const Sinks& sinks);
  PixelFeatures means() const;

 private:
  struct Sums {
    Rgb emission{0}, straight{0}, sharp{0};             // all, and parts of it
    Rgb albedo{0}, min_color{kInfinity}, max_color{0};  // the latter two: albedo + straight emission
    Vec3f normal{0, 0, 0};
    float normals = 0;  // Σ |normal| of the samples: longer than their sum where they differ
    float trusted = 0;  // what samples count for in albedo and normals, together
    int count = 0, covered = 0;
  };
  enum class Edge : std::uint8_t { none, some, glaring };
  // In pixels with such an edge, or more.
  bool trace(int samples, Edge least, const Sinks& sinks);
  void mark_edges();
  double part_from(Edge least) const;

  const world::World& world_;
  View view_;
  Recipe recipe_;
  std::vector<Sums> sums_;
  std::vector<Edge> edges_;  // by pixel
  bool edges_marked_ = false;
};

// Without single pixels that are far brighter than all around them and than `usual`, a luminance: what one
// film sample in many finds by way of a mirror is a firefly, which no denoiser takes out of one pixel.
image::Image without_fireflies(image::Image emission, float usual);

}  // namespace lumirank::pipeline
