#include "transport/lights/lights_of_moments.h"

#include <cmath>
#include <unordered_map>

#include "media/depth_profile.h"
#include "media/tracking.h"
#include "transport/lights/media_particles.h"

namespace lumirank::transport {
namespace {

class CarriedInManyWorlds {
 public:
  struct Shared {
    std::span<const world::World* const> worlds;
    const world::World& world() const { return *worlds.front(); }
  };
  CarriedInManyWorlds(const Shared& shared, Rng& rng)
      : worlds_(shared.worlds),
        guide_(rng.next_below(worlds_.size())),
        hero_(static_cast<int>(rng.next_below(3))),
        moments_(worlds_.size()) {}

  void multiply(Rgb value) { common_ *= value; }
  Rgb weight() const {
    Rgb greatest{0};
    for (const Moment& m : moments_)
      for (int c = 0; c < 3; ++c) greatest[c] = std::max(greatest[c], m.value[c]);
    return common_ * greatest;
  }
  void note(std::uint64_t id, float factor, MediaBatch& batch) const {
    batch.known.push_back({id, batch.powers.size()});
    for (const Moment& m : moments_) batch.powers.push_back(common_ * m.value * factor);
  }
  bool scatters(int medium) const {
    return std::any_of(worlds_.begin(), worlds_.end(),
                       [medium](const world::World* world) { return of(*world, medium).scatters(); });
  }

  Flight fly(int number, geometry::Ray& ray, float way, Rng& rng) {
    const Vec3f origin = ray.origin, forward = ray.direction;
    profile_.follow(of(*worlds_[guide_], number), origin, forward, way);
    const float t = profile_.place_of(-std::log1p(-rng.next_float()), hero_);
    const bool collides = t < way;
    if (!collides && !std::isfinite(way)) return Flight::ended;
    const Vec3f place = origin + forward * t;
    const auto carry = [&](std::size_t k) {  // along the profile of that world
      const Rgb through = media::exp_minus(profile_.depth(collides ? t : way));
      moments_[k].value *= collides ? through * of(*worlds_[k], number).at(place).scattering : through;
      moments_[k].density *= collides ? through * profile_.extinction(t) : through;
    };
    carry(guide_);
    for (std::size_t k = 0; k < worlds_.size(); ++k) {
      if (k == guide_) continue;
      profile_.follow(of(*worlds_[k], number), origin, forward, way);
      carry(k);
    }
    if (!even_out()) return Flight::ended;
    if (!collides) return Flight::arrived;
    const float u_lobe = rng.next_float();
    const Vec3f next = of(*worlds_[guide_], number).phase().sample(forward, hero_, u_lobe, rng.next_2d());
    for (std::size_t k = 0; k < worlds_.size(); ++k) {
      const Rgb f = of(*worlds_[k], number).phase().eval(dot(forward, next));
      moments_[k].value *= f, moments_[k].density *= f;
    }
    ray = {place, next};
    return even_out() ? Flight::scattered : Flight::ended;
  }

 private:
  // Of the way so far in one world: what it transports, and how densely the channels' choices would have made
  // it there, both over the mean of the latter.
  struct Moment {
    Rgb value{1}, density{1};
  };

  static const media::Medium& of(const world::World& world, int medium) {
    return world.media()[static_cast<std::size_t>(medium)];
  }

  // False if no world's light goes on.
  bool even_out() {
    double all = 0;
    for (const Moment& m : moments_) all += static_cast<double>(mean(m.density));
    const double one = static_cast<double>(moments_.size()) / all;
    if (!std::isfinite(one)) return false;
    bool lit = false;
    for (Moment& m : moments_) {
      m.value *= static_cast<float>(one), m.density *= static_cast<float>(one);
      lit |= !is_black(m.value);
    }
    return lit;
  }

  std::span<const world::World* const> worlds_;
  std::size_t guide_;  // whose media decide where it collides
  int hero_;
  Rgb common_{1};  // what is the same in all worlds
  std::vector<Moment> moments_;
  media::DepthProfile profile_;
};

// Some random numbers tell an emitter well enough.
bool same_emission(const world::World& a, const world::World& b, int emitter) {
  constexpr float kProbes[][5] = {{0.1f, 0.7f, 0.3f, 0.6f, 0.2f}, {0.8f, 0.2f, 0.9f, 0.3f, 0.7f}};
  for (const auto& u : kProbes) {
    const auto one = a.sample_emission(emitter, u[0], {u[1], u[2]}, {u[3], u[4]}),
               other = b.sample_emission(emitter, u[0], {u[1], u[2]}, {u[3], u[4]});
    if (one.origin != other.origin || one.direction != other.direction || one.weight != other.weight)
      return false;
  }
  return true;
}

bool same_surfaces(const world::World& a, const world::World& b) {
  const auto &one = a.rays().placements(), &other = b.rays().placements();
  if (one.size() != other.size()) return false;
  for (std::size_t i = 0; i < one.size(); ++i)
    if (one[i].to_world != other[i].to_world ||
        a.rays().meshes()[one[i].mesh] != b.rays().meshes()[other[i].mesh])
      return false;
  return true;
}

}  // namespace

bool only_media_differ(std::span<const world::World* const> worlds) {
  const world::World& first = *worlds.front();
  return std::all_of(worlds.begin() + 1, worlds.end(), [&](const world::World* world) {
    if (world->media().size() != first.media().size() ||
        world->emitters().size() != first.emitters().size() || !same_surfaces(first, *world))
      return false;
    for (int e = 0; e < static_cast<int>(first.emitters().size()); ++e)
      if (!same_emission(first, *world, e)) return false;
    return true;
  });
}

std::vector<LightsInMedia> trace_lights_of_moments(std::span<const world::World* const> worlds,
                                                   const MediaLightSettings& settings, const Sinks& sinks) {
  std::vector<MediaBatch> batches;
  const LightsInMedia lights = trace_lights_carrying<CarriedInManyWorlds>({worlds}, settings, batches, sinks);
  std::unordered_map<std::uint64_t, const Rgb*> powers;
  for (const MediaBatch& batch : batches)
    for (const PowersOfLight& light : batch.known) powers.emplace(light.id, &batch.powers[light.first]);
  std::vector<LightsInMedia> out(worlds.size(), lights);
  const auto tell = [&](const std::vector<std::uint64_t>& id, std::vector<Rgb>& power, std::size_t k) {
    for (std::size_t j = 0; j < id.size(); ++j)
      if (const auto found = powers.find(id[j]); found != powers.end()) power[j] = found->second[k];
  };
  for (std::size_t k = 0; k < worlds.size(); ++k) {
    tell(out[k].points.id, out[k].points.power, k);
    tell(out[k].rays.id, out[k].rays.power, k);
  }
  return out;
}

}  // namespace lumirank::transport
