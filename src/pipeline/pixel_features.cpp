#include "pipeline/pixel_features.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/random.h"
#include "base/rgb_range.h"
#include "scatter/closure.h"
#include "transport/rows/film_samples.h"

namespace lumirank::pipeline {
namespace {

// From which difference on a pixel is at an edge: of albedo and emission, of the mean normal's length below
// that of its samples, and between the mean normals of neighbors.
constexpr float kColorEdge = 0.04f, kNormalSpread = 0.02f, kNormalEdge = 0.15f;
// The same of emission that glares: albedos cannot differ by as much.
constexpr float kGlare = 1;
// Of a lamp out of focus few samples see anything: so many pixels around one that did are taken for its disc.
constexpr std::size_t kOfDisc = 4;
// Emission that a screen shows as white.
constexpr float kWhite = 4;
// How many times what stands beside it, or what is usual, a pixel may be.
constexpr float kOverNeighbors = 4, kOverUsual = 16;

// Into so many parts an eye ray's way through a medium is cut at most, and what a medium is like of which
// nothing is known at a place.
constexpr int kMediumParts = 4;
constexpr float kUsualAlbedo = 0.8f;
// Which of the ways through many panes of glass a sample took, where it could not take them all, is noise,
// and a denoiser keeps what features have. So samples of unlikely ways hardly count, unless there are no
// others; and from which trust on one tells edges.
constexpr float kLeastTrusted = 1e-3f, kTrusted = 0.5f;
// What of a sample is left by media: less is dark, and its inverse may be infinite.
constexpr float kLeastWeight = 1e-30f;
constexpr std::size_t kPixelsOfMeans = 16384;

float distance(Rgb a, Rgb b) {
  return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

// What a part of an eye ray hides of what is behind it, and what it sends of light that shines on it from all
// around, as albedos of surfaces tell it.
struct PartOfMedium {
  Rgb hidden, albedo;
};
PartOfMedium look_at(const world::World& world, const transport::EyeSegment& part) {
  const media::Medium& medium = world.media()[static_cast<std::size_t>(part.medium)];
  const media::Coefficients there = medium.at(part.origin + part.direction * part.length);
  Rgb albedo(kUsualAlbedo);
  for (int c = 0; c < 3; ++c)
    if (there.extinction[c] > 0) albedo[c] = there.scattering[c] / there.extinction[c];
  const auto within = [](Rgb c) { return min_of(max_of(c, Rgb(0)), Rgb(1)); };
  return {within(part.weight * (Rgb(1) - part.through)), within(albedo)};
}

// Albedos and normals by weight, and the weights of all.
struct SeenSurfaces {
  Rgb albedo{0};
  Vec3f normal{0, 0, 0};
  float weight = 0;
};
SeenSurfaces look_at(const std::vector<transport::EyeVertex>& vertices) {
  SeenSurfaces seen;
  for (const transport::EyeVertex& v : vertices) {
    const float weight = luminance(v.weight);
    seen.albedo += v.weight * v.albedo;
    seen.normal = seen.normal + v.normal * weight, seen.weight += weight;
  }
  return seen;
}

}  // namespace

PixelFeatureTracing::PixelFeatureTracing(const world::World& world, const View& view, const Recipe& recipe)
    : world_(world),
      view_(view),
      recipe_(recipe),
      sums_(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height)),
      edges_(sums_.size(), Edge::none) {}

bool PixelFeatureTracing::trace(int samples, Edge least, const Sinks& sinks) {
  if (samples <= 0) return !sinks.cancelled();
  const world::Camera camera(view_.sensor, world_.units());
  transport::ReceiverSettings settings = receiver_settings(recipe_, view_);
  settings.film_samples = 0;
  settings.seed = hash_ids(recipe_.seed, Stage::film_samples, 1);
  // Without chance: noise of features is taken for edges.
  if (!world_.media().empty())
    settings.segments = kMediumParts, settings.segments_by_depth = true,
    settings.eye_medium = view_.sensor.medium;
  const auto width = static_cast<std::size_t>(view_.width);
  parallel_for(static_cast<std::size_t>(view_.height), 4, [&](std::size_t begin, std::size_t end) {
    if (sinks.cancelled()) return;
    transport::FilmEye eye(world_, camera, settings);
    for (std::size_t p = begin * width; p < end * width; ++p) {
      if (edges_[p] < least) continue;
      eye.begin({view_.crop_x + static_cast<int>(p % width), view_.crop_y + static_cast<int>(p / width)});
      Sums& sums = sums_[p];
      for (int k = 0; k < samples; ++k) {
        const transport::FilmSample sample = eye.trace_in_sequence(static_cast<std::uint64_t>(sums.count));
        auto [albedo, normal, weights] = look_at(eye.vertices());
        for (const transport::EyeSegment& part : eye.segments()) {
          const PartOfMedium seen = look_at(world_, part);
          albedo += seen.hidden * seen.albedo;
          weights += luminance(seen.hidden);
        }
        if (weights > kLeastWeight) normal = normal * (1 / weights);
        const float trusted =
            std::max(kLeastTrusted, square(square(square(1 - std::min(1.0f, eye.unlikely())))));
        const Rgb color = albedo + min_of(sample.straight, Rgb(kWhite));
        sums.emission += sample.emission, sums.straight += sample.straight, sums.sharp += sample.sharp;
        sums.albedo += albedo * trusted;
        if (trusted >= kTrusted)
          sums.min_color = min_of(sums.min_color, color), sums.max_color = max_of(sums.max_color, color);
        sums.normal = sums.normal + normal * trusted, sums.normals += length(normal) * trusted;
        sums.trusted += trusted;
        if (weights > 0 || is_black(sample.sharp)) ++sums.covered;
        ++sums.count;
      }
    }
  });
  return !sinks.cancelled();
}

bool PixelFeatureTracing::trace_all(int samples, const Sinks& sinks) {
  if (!trace(samples, Edge::none, sinks)) return false;
  if (!edges_marked_) mark_edges();
  edges_marked_ = true;
  return true;
}

bool PixelFeatureTracing::trace_differing(int samples, const Sinks& sinks) {
  return trace(samples, Edge::some, sinks);
}

bool PixelFeatureTracing::trace_glaring(int samples, const Sinks& sinks) {
  return trace(samples, Edge::glaring, sinks);
}

void PixelFeatureTracing::mark_edges() {
  const auto color = [](const Sums& s) {
    return s.albedo * (1 / s.trusted) + min_of(s.straight * (1 / static_cast<float>(s.count)), Rgb(kWhite));
  };
  const auto mark = [&](std::size_t p, float colors, bool of_normals) {
    const Edge edge = colors > kGlare                     ? Edge::glaring
                      : colors > kColorEdge || of_normals ? Edge::some
                                                          : Edge::none;
    edges_[p] = std::max(edges_[p], edge);
  };
  const auto compare = [&](std::size_t p, std::size_t q) {
    const Sums &a = sums_[p], &b = sums_[q];
    const float colors = distance(color(a), color(b));
    const bool of_normals = length(a.normal / a.trusted - b.normal / b.trusted) > kNormalEdge;
    mark(p, colors, of_normals), mark(q, colors, of_normals);
  };
  const auto width = static_cast<std::size_t>(view_.width), height = static_cast<std::size_t>(view_.height);
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t p = y * width + x;
      const Sums& s = sums_[p];
      const bool known = s.min_color.r <= s.max_color.r;  // by a sample that is trusted
      mark(p, known ? distance(s.max_color, s.min_color) : 0.0f,
           !known || length(s.normal) < (1 - kNormalSpread) * s.normals);
      if (x + 1 < width) compare(p, p + 1);
      if (y + 1 < height) compare(p, p + width);
      if (luminance(s.straight - s.sharp) <= kGlare * static_cast<float>(s.count)) continue;
      for (std::size_t v = y - std::min(y, kOfDisc); v < std::min(height, y + kOfDisc + 1); ++v)
        for (std::size_t u = x - std::min(x, kOfDisc); u < std::min(width, x + kOfDisc + 1); ++u)
          edges_[v * width + u] = Edge::glaring;
    }
}

double PixelFeatureTracing::part_from(Edge least) const {
  return static_cast<double>(
             std::count_if(edges_.begin(), edges_.end(), [&](Edge edge) { return edge >= least; })) /
         static_cast<double>(std::max<std::size_t>(1, edges_.size()));
}

PixelFeatures PixelFeatureTracing::means() const {
  PixelFeatures features;
  for (image::Image* image :
       {&features.emission, &features.noisy_emission, &features.albedo, &features.normal, &features.cover})
    *image = image::Image(view_.width, view_.height);
  parallel_for(sums_.size(), kPixelsOfMeans, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const Sums& s = sums_[p];
      const float part = 1 / static_cast<float>(std::max(1, s.count));
      features.emission.pixels[p] = s.sharp * part,
      features.noisy_emission.pixels[p] = (s.emission - s.sharp) * part;
      features.cover.pixels[p] =
          Rgb(is_black(s.emission - s.sharp) ? static_cast<float>(s.covered) * part : 1.0f);
      const float of_trusted = s.count > 0 ? 1 / s.trusted : 0;
      features.albedo.pixels[p] = s.albedo * of_trusted;
      features.normal.pixels[p] = Rgb{s.normal.x, s.normal.y, s.normal.z} * of_trusted;
    }
  });
  return features;
}

image::Image without_fireflies(image::Image emission, float usual) {
  const image::Image all = emission;
  for (int y = 0; y < all.height; ++y)
    for (int x = 0; x < all.width; ++x) {
      const float here = luminance(all.at(x, y));
      if (here <= kOverUsual * usual) continue;
      float beside = 0;
      for (int v = std::max(0, y - 1); v < std::min(all.height, y + 2); ++v)
        for (int u = std::max(0, x - 1); u < std::min(all.width, x + 2); ++u)
          if (u != x || v != y) beside = std::max(beside, luminance(all.at(u, v)));
      const float limit = std::max(kOverNeighbors * beside, kOverUsual * usual);
      if (here > limit) emission.at(x, y) = all.at(x, y) * (limit / here);
    }
  return emission;
}

}  // namespace lumirank::pipeline
