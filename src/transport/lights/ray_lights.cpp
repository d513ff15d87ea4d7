#include "transport/lights/ray_lights.h"

#include "media/tracking.h"
#include "transport/lights/media_particles.h"

namespace lumirank::transport {
namespace {

// Light in one world, by delta tracking.
class CarriedInOneWorld {
 public:
  struct Shared {
    const world::World& only;
    const world::World& world() const { return only; }
  };
  CarriedInOneWorld(const Shared& shared, Rng& rng)
      : world_(&shared.only), hero_(static_cast<int>(rng.next_below(3))) {}

  void multiply(Rgb value) { path_.multiply(value); }
  Rgb weight() const { return path_.weight(); }
  void note(std::uint64_t, float, MediaBatch&) const {}
  bool scatters(int medium) const { return of(medium).scatters(); }

  Flight fly(int number, geometry::Ray& ray, float way, Rng& rng) {
    const media::Medium& medium = of(number);
    const auto random = [&rng] { return rng.next_float(); };
    const Vec3f origin = ray.origin, forward = ray.direction;
    bool scattered = false;
    const bool arrived = media::fly(medium, origin, forward, way, hero_, random, path_,
                                    [&](float t, const media::Coefficients& at, Rgb bound) {
                                      const Rgb null = bound - at.extinction;
                                      if (random() * bound[hero_] >= at.extinction[hero_]) {
                                        if (null[hero_] > 0) path_.event(null, null, hero_);
                                        return true;
                                      }
                                      path_.event(at.scattering, at.extinction, hero_);
                                      if (is_black(at.scattering)) return false;
                                      const float u_lobe = random();
                                      const Vec3f next =
                                          medium.phase().sample(forward, hero_, u_lobe, rng.next_2d());
                                      const Rgb f = medium.phase().eval(dot(forward, next));
                                      if (!(f[hero_] > 0)) return false;
                                      path_.event(f, f, hero_);
                                      ray = {origin + forward * t, next};
                                      scattered = true;
                                      return false;
                                    });
    if (arrived) return Flight::arrived;
    return scattered ? Flight::scattered : Flight::ended;
  }

 private:
  const media::Medium& of(int medium) const { return world_->media()[static_cast<std::size_t>(medium)]; }

  const world::World* world_;
  media::ChannelThroughput path_ = {};
  int hero_;
};

}  // namespace

LightsInMedia trace_lights_in_media(const world::World& world, const MediaLightSettings& settings,
                                    const Sinks& sinks) {
  std::vector<MediaBatch> batches;
  return trace_lights_carrying<CarriedInOneWorld>({world}, settings, batches, sinks);
}

}  // namespace lumirank::transport
