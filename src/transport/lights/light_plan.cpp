#include "transport/lights/light_plan.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/parallel.h"
#include "transport/lights/halves.h"
#include "transport/lights/particle.h"

namespace lumirank::transport {
namespace {

constexpr std::size_t kPilotPaths = 4096, kRoulettePaths = 1 << 14;
// Neither direct nor indirect light gets a smaller share of the lights than this, if there is any of it to
// carry; direct light never more than half, because a column more costs it nothing in rank and indirect light
// needs them.
constexpr double kMinShare = 0.1, kMaxDirectShare = 0.5;
// Of emitter samples where nearly all direct light is traced.
constexpr double kMinDirectShare = 0.01;
// Where hardly any particle meets a surface, this many paths per light are the end of the search.
constexpr double kMaxPathsPerLight = 32;
// More paths are traced until lights are worth this part of as many equal ones, or there are so many per
// light.
constexpr double kWorth = 0.7, kMaxRoulettePaths = 16;
// Where receivers see it, light is held to be of use between these many times a typical one's: what is of
// little use to all together may be close to a few, and must not be heavy. The lower bound may add this part
// to the use of all; and of all that is kept, about the unseen share is lights of places that the pilots
// never saw, more where such lights would be so many times as strong as others and up to the most.
constexpr double kMinUse = 0.7, kMaxUse = 3, kLowShare = 0.25, kUnseenShare = 0.1, kMaxUnseenShare = 0.25,
                 kStrongUnseen = 16;

ParticleSettings pilot_settings(const LightSettings& settings, const LightSurvey& survey) {
  const std::size_t paths = survey.aimed ? kRoulettePaths : kPilotPaths;
  return {settings.seed,
          Stage::pilot,
          settings.brief_survey ? paths / 2 : paths,
          survey.parts.deepest,
          0,
          &survey.aim.guide,
          settings.lobes.unwidened()};
}

struct Pilot {
  double lights_per_path = 0;
  // Of the power, if asked for: what arrives from emitters over that plus what surfaces send on.
  double direct_share = 1;
  // Per light, if asked for: its power times the number of paths and its reflectance; of how much use light
  // is there, negative where no receiver sees it.
  std::vector<double> powers;
  std::vector<float> importances;
};

struct PilotAsks {
  bool direct_share = false;
  const LightImportance* importance = nullptr;
};

Pilot run_pilot(const world::World& world, const world::EmitterChoice& choice,
                const ParticleSettings& settings, const PilotAsks& asks) {
  struct Piece {
    double lights = 0, first = 0, scattered = 0;
    std::vector<double> powers;
    std::vector<float> importances;
  };
  constexpr std::size_t kPathsAtOnce = 256;
  const ParticleTracer tracer(world, choice, settings);
  std::vector<Piece> pieces((settings.paths + kPathsAtOnce - 1) / kPathsAtOnce);
  parallel_for(settings.paths, kPathsAtOnce, [&](std::size_t begin, std::size_t end) {
    Piece& piece = pieces[begin / kPathsAtOnce];
    LightBatch batch;
    PathTally tally;
    for (std::size_t path = begin; path < end; ++path)
      tracer.trace(path, batch, asks.direct_share ? &tally : nullptr);
    piece.lights = static_cast<double>(batch.lights.size());
    piece.first = tally.first_flux, piece.scattered = tally.scattered_flux;
    const LightImportance* importance = asks.importance;
    if (!importance) return;
    for (const LightRecord& light : batch.lights) {
      const double power = static_cast<double>(max_component(light.power)) * rough_reflectance(light) *
                           static_cast<double>(settings.paths);
      piece.powers.push_back(power);
      piece.importances.push_back(
          importance->seen(light.position, light.normal) ? importance->at(light.position, light.normal) : -1);
    }
  });
  Pilot pilot;
  double first = 0, scattered = 0;
  for (const Piece& piece : pieces) {
    pilot.lights_per_path += piece.lights / static_cast<double>(settings.paths);
    first += piece.first, scattered += piece.scattered;
    pilot.powers.insert(pilot.powers.end(), piece.powers.begin(), piece.powers.end());
    pilot.importances.insert(pilot.importances.end(), piece.importances.begin(), piece.importances.end());
  }
  if (first + scattered > 0) pilot.direct_share = first / (first + scattered);
  return pilot;
}

std::size_t emitter_samples_of(std::size_t count, const DirectNeed& need, double share, LightParts parts) {
  if (!parts.direct) return 0;
  if (!parts.indirect) return need.sampled ? count : std::min(count, need.min_count);
  const auto target = static_cast<double>(count), min_count = static_cast<double>(need.min_count);
  double samples = share * target;
  if (!need.sampled) samples = std::min(samples, min_count);
  // Many lamps: each its own column as long as that leaves half to indirect light.
  samples = std::max(samples, std::min(min_count, 0.5 * target));
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(samples)));
}

// The part of all lights that emitters get. Of an unknown view it follows their power; else what columns have
// to carry to the receivers.
double emitter_share(const Pilot& pilot, const LightSettings& settings, const Aim& aim) {
  if (!settings.receivers || !(aim.direct + aim.indirect > 0)) {
    return std::clamp(pilot.direct_share, kMinShare, kMaxDirectShare);
  }
  const double share = aim.direct / (aim.direct + aim.indirect);
  return std::clamp(share, settings.traced_direct_below > 0 ? kMinDirectShare : kMinShare, kMaxDirectShare);
}

std::size_t natural_paths(double wanted, double lights_per_path) {
  const double per_light = lights_per_path > 0 ? 1 / lights_per_path : kMaxPathsPerLight;
  return even(static_cast<std::size_t>(std::ceil(wanted * std::min(per_light, kMaxPathsPerLight))));
}

// How far importance may differ between places, and the uses of the pilot's lights then. Nothing if no light
// is of any.
std::optional<LightImportance::Range> bounded_uses(const Pilot& pilot, std::vector<double>& uses) {
  const std::size_t n = pilot.powers.size();
  double use = 0, use_of_importance = 0, unseen = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const double power = pilot.powers[k], importance = pilot.importances[k];
    if (importance < 0) unseen += power;
    if (importance > 0) use += power * importance, use_of_importance += power * importance * importance;
  }
  if (!(use > 0)) return std::nullopt;
  // That of the place where an average use comes from, not of an average light: under a sky nearly all power
  // is where hardly anything is seen of it.
  const double typical = use_of_importance / use, high = typical * kMaxUse;
  const auto use_with = [&](double low) {
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k)
      if (pilot.importances[k] >= 0)
        sum += pilot.powers[k] * std::clamp<double>(pilot.importances[k], low, high);
    return sum;
  };
  const double bounded = use_with(0);
  double low = 0, above = typical * kMinUse;
  if (use_with(above) <= (1 + kLowShare) * bounded) low = above;
  for (int step = 0; step < 40 && low < above; ++step) {
    const double middle = 0.5 * (low + above);
    (use_with(middle) <= (1 + kLowShare) * bounded ? low : above) = middle;
  }
  LightImportance::Range range{static_cast<float>(low), static_cast<float>(high), static_cast<float>(low)};
  if (unseen > 0) {
    const double share = use_with(low) / unseen;
    range.unseen =
        std::min(range.low, static_cast<float>(std::clamp(typical / kStrongUnseen, kUnseenShare * share,
                                                          kMaxUnseenShare * share)));
  }
  for (std::size_t k = 0; k < n; ++k) {
    const float importance = pilot.importances[k];
    uses.push_back(pilot.powers[k] *
                   (importance >= 0 ? std::clamp(importance, range.low, range.high) : range.unseen));
  }
  return range;
}

}  // namespace

std::size_t emitter_sample_count(std::size_t count, const LightSurvey& survey) {
  return emitter_samples_of(count, survey.need, survey.emitter_share, survey.parts);
}

RoulettePlan plan_roulette(std::vector<double> uses, std::size_t pilot_paths, double wanted) {
  std::sort(uses.begin(), uses.end());
  const auto n = uses.size();
  std::vector<double> sum(n + 1, 0.0), squares(n + 1, 0.0);
  for (std::size_t k = 0; k < n; ++k) {
    sum[k + 1] = sum[k] + uses[k];
    squares[k + 1] = squares[k] + uses[k] * uses[k];
  }
  const auto below = [&](double level) {
    return static_cast<std::size_t>(std::lower_bound(uses.begin(), uses.end(), level) - uses.begin());
  };
  const auto all = static_cast<double>(pilot_paths);
  const auto kept = [&](double level) {  // per path
    const std::size_t k = below(level);
    return ((level > 0 ? sum[k] / level : 0.0) + static_cast<double>(n - k)) / all;
  };
  const double natural = wanted * all / static_cast<double>(std::max<std::size_t>(1, n));
  RoulettePlan plan{natural, 0};
  if (n == 0 || !(sum[n] > 0)) return plan;
  for (double more = 1;; more *= 1.5) {
    plan.paths = std::max(natural, std::min(natural * more, kMaxRoulettePaths * wanted));
    double low = 0, high = uses[n - 1];
    if (plan.paths * kept(high) > wanted) high = plan.paths * sum[n] / all / wanted;
    for (int step = 0; step < 60; ++step) {
      const double middle = 0.5 * (low + high);
      (plan.paths * kept(middle) > wanted ? low : high) = middle;
    }
    plan.level = more > 1 ? high : 0;
    // Σ p·(use/p)², p being the chance to be kept.
    const std::size_t k = below(plan.level);
    const double second = plan.level * sum[k] + squares[n] - squares[k];
    const double worth = plan.paths / all * sum[n] * sum[n] / second;
    if (worth >= kWorth * wanted || plan.paths < natural * more || plan.paths >= kMaxRoulettePaths * wanted)
      return plan;
  }
}

LightSurvey survey_lights(const world::World& world, const world::EmitterChoice& choice,
                          const LightSettings& settings) {
  LightSurvey survey;
  const bool unlimited = settings.max_depth < 0;
  // A light of depth k, seen by a receiver at the first hit, makes a path of depth k + 2.
  survey.parts = {settings.direct && (unlimited || settings.max_depth >= 2),
                  settings.indirect && (unlimited || settings.max_depth >= 3),
                  unlimited ? -1 : settings.max_depth - 2};
  survey.need = direct_need(world, choice);
  survey.aimed = survey.parts.indirect && settings.receivers != nullptr;
  Pilot pilot;
  ParticleSettings pilot_paths;
  if (survey.parts.indirect) {
    if (survey.aimed) survey.aim = learn_aim(world, choice, settings, survey.parts.deepest);
    pilot_paths = pilot_settings(settings, survey);
    pilot_paths.paths = paths_worth_tracing(world, choice, pilot_paths);
    pilot = run_pilot(world, choice, pilot_paths,
                      {!survey.aimed, survey.aimed ? &survey.aim.importance : nullptr});
    // Nothing that the emitters reach scatters: all lights may go to them.
    if (pilot.lights_per_path == 0 && survey.parts.direct) survey.parts.indirect = false;
  }
  survey.lights_per_path = pilot.lights_per_path;
  survey.emitter_share = emitter_share(pilot, settings, survey.aim);
  if (!survey.parts.indirect || !survey.aimed) return survey;
  std::vector<double> uses;
  const auto range = bounded_uses(pilot, uses);
  if (!range) return survey;
  survey.aim.importance.set_range(*range);
  if (settings.on_gather_samples) return survey;
  survey.level = plan_roulette(std::move(uses), pilot_paths.paths, 1).level;
  if (!(survey.level > 0)) return survey;
  // Paths in parts leave more lights than the uses tell: counted.
  const LightRoulette roulette(survey.aim.importance, survey.level);
  ParticleSettings ps = pilot_paths;
  ps.roulette = &roulette, ps.first_id = 1ull << 50;
  survey.lights_per_path = run_pilot(world, choice, ps, {}).lights_per_path;
  return survey;
}

LightPlan plan_lights(std::size_t count, const LightSurvey& survey) {
  LightPlan plan;
  plan.emitter_samples = emitter_sample_count(count, survey);
  if (!survey.parts.indirect) return plan;
  const double wanted = std::max(1.0, static_cast<double>(count) - static_cast<double>(plan.emitter_samples));
  plan.paths = natural_paths(wanted, survey.lights_per_path);
  return plan;
}

}  // namespace lumirank::transport
