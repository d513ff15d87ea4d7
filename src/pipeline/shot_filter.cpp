#include "pipeline/shot_filter.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/parallel.h"
#include "base/rgb_range.h"
#include "world/camera.h"

namespace lumirank::pipeline {
namespace {

constexpr Vec2f kMiddleOfLens{0.5f, 0.5f};

// A denoiser leaves about half of the noise that it is given, in blotches, where that is large. Where its
// amount is not known it is taken to be usual.
constexpr float kLeftOfNoise = 0.5f, kLeastTolerance = 0.06f, kMostTolerance = 0.4f, kUsualTolerance = 0.15f;
// Noise is asked of so many pixels around one.
constexpr int kNoiseRadius = 3;
// A pixel shows a lamp or the sky where these send this part of its light.
constexpr float kShines = 0.02f;
// Albedo by which light is divided; darker than this it is not light that a texture shapes.
constexpr float kLeastAlbedo = 0.02f;
// Of the mean light of a frame: what differs by less is not seen.
constexpr float kUnseenPart = 0.02f;
// Part of what is interpolated from which on a pixel counts for how much they differ.
constexpr float kCountsForDetail = 0.02f;
// Two places are one where they are this near, in distances between pixels, above the surface and along it.
constexpr float kAbove = 0.7f, kAlong = 2.5f, kSameNormal = 0.9f;

float weight_of(float change, float tolerance) {
  const float u = change / (3 * tolerance);
  return u < 1 ? square(1 - u * u) : 0;
}

float greatest_of(Rgb change) {
  return std::max({std::abs(change.r), std::abs(change.g), std::abs(change.b)});
}

// Mean over a square around each pixel.
std::vector<float> blurred(const std::vector<float>& values, int width, int height) {
  std::vector<float> rows(values.size()), out(values.size());
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  };
  const auto mean_around = [](int middle, int end, const auto& value) {
    const int from = std::max(0, middle - kNoiseRadius), to = std::min(end - 1, middle + kNoiseRadius);
    float sum = 0;
    for (int k = from; k <= to; ++k) sum += value(k);
    return sum / static_cast<float>(to - from + 1);
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      rows[at(x, y)] = mean_around(x, width, [&](int k) { return values[at(k, y)]; });
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      out[at(x, y)] = mean_around(y, height, [&](int k) { return rows[at(x, k)]; });
  return out;
}

float unseen(const image::Image& picture) {
  double all = 0;
  for (const Rgb& color : picture.pixels) all += static_cast<double>(luminance(color));
  return kUnseenPart *
         static_cast<float>(all / static_cast<double>(std::max<std::size_t>(1, picture.pixels.size())));
}

bool of_size(const image::Image& image, const image::Image& other) {
  return image.width == other.width && image.height == other.height;
}

std::vector<float> tolerances(const image::Image& picture, const PictureFeatures& features) {
  const std::size_t pixels = picture.pixels.size();
  std::vector<float> out(pixels, kUsualTolerance);
  if (of_size(features.difference, picture)) {
    std::vector<float> noise(pixels), light(pixels);
    for (std::size_t p = 0; p < pixels; ++p) {
      noise[p] = std::abs(luminance(features.difference.pixels[p])) / 2;
      light[p] = luminance(picture.pixels[p]);
    }
    noise = blurred(noise, picture.width, picture.height);
    light = blurred(light, picture.width, picture.height);
    const float least = unseen(picture);
    for (std::size_t p = 0; p < pixels; ++p)
      out[p] = std::clamp(kLeftOfNoise * noise[p] / (light[p] + least), kLeastTolerance, kMostTolerance);
  }
  if (!of_size(features.means.emission, picture)) return out;
  // Few film samples may miss what shines at the edge of a pixel, so those beside one are left out as well.
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      if (luminance(features.means.emission.at(x, y)) > kShines * luminance(picture.at(x, y)))
        for (int v = std::max(0, y - 1); v <= std::min(picture.height - 1, y + 1); ++v)
          for (int u = std::max(0, x - 1); u <= std::min(picture.width - 1, x + 1); ++u)
            out[static_cast<std::size_t>(v) * static_cast<std::size_t>(picture.width) +
                static_cast<std::size_t>(u)] = 0;
  return out;
}

bool is_same(const FilmSurface& a, const FilmSurface& b) {
  if (b.spacing == 0 || dot(a.normal, b.normal) < kSameNormal) return false;
  const Vec3f between = b.position - a.position;
  const float above = std::abs(dot(between, a.normal));
  // Along a surface that is seen from the side pixels are farther apart.
  return above < kAbove * std::max(a.spacing, b.spacing) &&
         length(between) < kAlong * std::max(a.along, b.along);
}

void mark_edges(std::vector<FilmSurface>& surfaces, int width, int height) {
  const auto compare = [](FilmSurface& a, FilmSurface& b) {
    if (a.spacing != 0 && is_same(a, b)) return;
    a.at_edge = b.at_edge = true;
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t p =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      if (x + 1 < width) compare(surfaces[p], surfaces[p + 1]);
      if (y + 1 < height) compare(surfaces[p], surfaces[p + static_cast<std::size_t>(width)]);
    }
}

// One frame as others look into it.
class Shown {
 public:
  // Of places that `own` shows.
  Shown(const ShotFrame& frame, const ShotFrame& own)
      : frame_(frame),
        own_(own),
        camera_(frame.view.sensor, frame.world ? frame.world->units() : world::Units{}),
        moves_(frame.world && own.world && frame.world != own.world &&
               frame.world->placement_ids() == own.world->placement_ids()) {}

  // Light without albedo of a place of another frame, between the pixels around it that show the same
  // surface; empty where none does. `detail`: how much these differ among each other, as a part.
  struct Light {
    Rgb value{0};
    float detail = 0;
  };
  std::optional<Light> light_at(const FilmSurface& shown, float least) const {
    const FilmSurface place = moves_ ? moved(shown) : shown;
    const auto seen = camera_.project(place.position, kMiddleOfLens);
    if (!seen) return std::nullopt;
    const float x = seen->film.x - static_cast<float>(frame_.view.crop_x) - 0.5f,
                y = seen->film.y - static_cast<float>(frame_.view.crop_y) - 0.5f;
    if (!(x > -1 && y > -1 && x < static_cast<float>(frame_.view.width) &&
          y < static_cast<float>(frame_.view.height)))
      return std::nullopt;
    const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
    Light light;
    Rgb lowest(kInfinity), highest(0);
    float weights = 0;
    for (int v = top; v <= top + 1; ++v)
      for (int u = left; u <= left + 1; ++u) {
        if (u < 0 || v < 0 || u >= frame_.view.width || v >= frame_.view.height) continue;
        const std::size_t q = pixel(u, v);
        // What is whole is not mixed with what shows two surfaces: their edge would lose its steps' middle.
        const FilmSurface& there = frame_.surfaces[q];
        if (place.at_edge != there.at_edge || frame_.tolerance[q] == 0 || !is_same(place, there)) continue;
        const float weight =
            (1 - std::abs(x - static_cast<float>(u))) * (1 - std::abs(y - static_cast<float>(v)));
        const Rgb here = light_of(q);
        light.value += weight * here, weights += weight;
        // Where nothing moves a place is in the middle of a pixel, and what lies beside that is no matter.
        if (weight < kCountsForDetail) continue;
        lowest = min_of(lowest, here), highest = max_of(highest, here);
      }
    // A little of one pixel at the edge of what is hidden says nothing.
    if (weights < 0.25f) return std::nullopt;
    light.value = light.value * (1 / weights);
    light.detail = max_component(highest - lowest) / (max_component(light.value) + least);
    return light;
  }

  Rgb light_of(std::size_t p) const { return frame_.picture.pixels[p] / albedo(p); }
  Rgb albedo(std::size_t p) const {
    return frame_.albedo.pixels.empty() ? Rgb(1) : max_of(frame_.albedo.pixels[p], Rgb(kLeastAlbedo));
  }

 private:
  std::size_t pixel(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(frame_.view.width) +
           static_cast<std::size_t>(x);
  }
  // The same point of its triangle at this frame's moment; where it is, if there is no such triangle now.
  FilmSurface moved(FilmSurface place) const {
    const auto at = [&](const world::World& world) {
      const geometry::Hit hit{0, place.placement, world.rays().placements()[place.placement].mesh,
                              place.triangle, place.barycentric};
      return world.surface(hit, -place.normal).point;
    };
    const auto mesh = [&](const world::World& world) -> const geometry::TriangleMesh& {
      return world.rays().mesh(world.rays().placements()[place.placement].mesh);
    };
    if (mesh(*frame_.world).primitive_count() != mesh(*own_.world).primitive_count()) return place;
    const scatter::SurfacePoint now = at(*frame_.world), then = at(*own_.world);
    if (now.position == then.position && now.shading.n == then.shading.n) return place;
    place.position = place.position + (now.position - then.position);
    place.normal = dot(then.shading.n, place.normal) < 0 ? -now.shading.n : now.shading.n;
    return place;
  }

  const ShotFrame &frame_, &own_;
  world::Camera camera_;
  bool moves_;
};

}  // namespace

std::vector<FilmSurface> film_surfaces(const world::World& world, const View& view) {
  const world::Camera camera(view.sensor, world.units());
  const auto width = static_cast<std::size_t>(view.width);
  std::vector<FilmSurface> out(width * static_cast<std::size_t>(view.height));
  parallel_for(static_cast<std::size_t>(view.height), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin * width; p < end * width; ++p) {
      const Vec2f film{static_cast<float>(view.crop_x) + static_cast<float>(p % width) + 0.5f,
                       static_cast<float>(view.crop_y) + static_cast<float>(p / width) + 0.5f};
      const geometry::Ray ray = camera.ray(film, kMiddleOfLens);
      const auto hit = world.intersect_from_eye(ray);
      if (!hit) continue;
      const float density = camera.density(ray, hit->hit.t * length(ray.direction));
      if (!(density > 0)) continue;
      FilmSurface& surface = out[p];
      surface.position = hit->point.position, surface.normal = hit->point.shading.n;
      surface.placement = hit->hit.instance, surface.triangle = hit->hit.triangle;
      surface.barycentric = hit->hit.barycentric;
      surface.spacing = 1 / std::sqrt(density);
      const float cosine = std::abs(dot(hit->point.ng, normalize(ray.direction)));
      surface.along = surface.spacing / std::max(cosine, 0.05f);
    }
  });
  mark_edges(out, view.width, view.height);
  return out;
}

ShotFrame shot_frame(std::shared_ptr<const world::World> world, const View& view, image::Image picture,
                     const PictureFeatures& features) {
  ShotFrame frame{view, std::move(world), std::move(picture), {}, {}, {}, features.lacking_filter};
  frame.surfaces = film_surfaces(*frame.world, view);
  if (of_size(features.means.albedo, frame.picture)) frame.albedo = features.means.albedo;
  frame.tolerance = tolerances(frame.picture, features);
  return frame;
}

image::Image filtered_in_time(const std::deque<ShotFrame>& frames, std::size_t own) {
  const ShotFrame& frame = frames[own];
  const Shown here(frame, frame);
  std::vector<Shown> shown;
  shown.reserve(frames.size());
  for (const ShotFrame& other : frames) shown.emplace_back(other, frame);
  image::Image out = frame.picture;
  const float least = unseen(frame.picture);
  parallel_for(out.pixels.size(), std::size_t{1} << 12, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const FilmSurface& place = frame.surfaces[p];
      const float tolerance = frame.tolerance[p];
      if (place.spacing == 0 || tolerance == 0) continue;
      const Rgb albedo = here.albedo(p), light = here.light_of(p);
      // What is not seen of the picture, of light.
      const float hidden = least / mean(albedo);
      Rgb sum = light;
      float weights = 1;
      for (std::size_t d = 1; d <= own || own + d < frames.size(); ++d) {
        std::optional<Shown::Light> a, b;
        if (d <= own) a = shown[own - d].light_at(place, hidden);
        if (own + d < frames.size()) b = shown[own + d].light_at(place, hidden);
        if (!a && !b) continue;
        // At an end of the shot, and beside what hides it on one side, there is half a pair.
        const float count = a && b ? 2 : 1;
        if (!a) a = b;
        if (!b) b = a;
        const Rgb pair = 0.5f * (a->value + b->value);
        const float light_there = max_component(max_of(light, pair)) + hidden;
        const float differs = greatest_of(pair - light) / light_there;
        // Where light has jumped in between, as at the edge of a shadow, the pixel is like one of the two.
        const float jump = 0.5f * greatest_of(b->value - a->value) / light_there;
        const float allowed = tolerance * std::min(1.0f, square(tolerance / std::max(jump, 1e-6f)));
        const float weight = count * weight_of(differs, allowed) *
                             weight_of(std::max(a->detail, b->detail), std::max(tolerance, kUsualTolerance));
        sum += weight * pair, weights += weight;
      }
      out.pixels[p] = albedo * sum * (1 / weights);
    }
  });
  return out;
}

}  // namespace lumirank::pipeline
