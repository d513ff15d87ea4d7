#include "pipeline/media_parts.h"

#include "base/error.h"
#include "base/timer.h"
#include "pipeline/develop.h"
#include "transport/lights/cut_rays.h"
#include "transport/lights/lights_of_moments.h"
#include "transport/lights/ray_tree.h"
#include "transport/rows/eye_groups.h"

namespace lumirank::pipeline {

using Segments = matrix::MethodContract::Segments;

namespace {

// Parts of a ray's way through a medium (Huo et al. 2016, section 4.1: 16 points); of a pass's fewer, since
// noise is averaged over passes.
constexpr int kSegmentsPerRay = 17, kSegmentsOfAPass = 4;

// Of 4 (SegmentSimilarity, Huo et al. 2016, equations 8 to 13): pieces of a ray that are more alike are one.
// The paper puts together above 2.5, within groups of a graph. In a hall of fog 2.8 left half as many pieces
// and 1.8 times the error; all that were cut took 1.5 times as long for nearly the same.
constexpr float kMergeAbove = 3;

// Pieces of a light ray, about, for methods that go by bounds (docs/decisions.md has what whole ones gave).
constexpr double kPiecesOfLightRays = 4;

// At so many places of a segment at least the light of all emitters together is estimated: one place for the
// sun made noise of its shafts.
constexpr std::size_t kLeastDirect = 32;

int pieces_of_eye_rays(const MediaPlan& plan) {
  if (plan.of_shot) return kSegmentsOfShot;
  switch (plan.segments) {
    case Segments::whole:
    case Segments::light_pieces:
      return 1;
    case Segments::pieces:
    case Segments::smooth_pieces:
      return plan.pass ? kSegmentsOfAPass : kSegmentsPerRay;
    case Segments::groups:
    case Segments::groups_and_tree:
      break;
  }
  return kSegmentsPerRay;
}

bool in_groups(const MediaPlan& plan) {
  return plan.segments == Segments::groups || plan.segments == Segments::groups_and_tree;
}

bool smooth(const MediaPlan& plan) {
  return in_groups(plan) || plan.segments == Segments::smooth_pieces || plan.of_shot;
}

bool merged_along_rays(const MediaPlan& plan) {
  return !plan.of_shot && !plan.pass &&
         (plan.segments == Segments::pieces || plan.segments == Segments::smooth_pieces);
}

void make_rows(PreparedMedia& made, const Sinks& sinks) {
  const Timer timer;
  transport::ReceiverSettings settings = receiver_settings(made.recipe, made.view);
  settings.eye_medium = made.view.sensor.medium;
  settings.segments = pieces_of_eye_rays(made.plan);
  settings.segments_by_depth = made.plan.of_shot;
  made.rows = transport::trace_receivers(*made.world, world::Camera(made.view.sensor, made.world->units()),
                                         settings, sinks);
  made.seconds["receivers"] = timer.seconds();
  const Timer grouping;
  if (in_groups(made.plan)) {
    transport::EyeGroupSettings groups;
    groups.seed = made.recipe.seed;
    transport::group_eye_segments(*made.world, made.rows.film, groups, made.rows.segments, sinks);
  } else if (merged_along_rays(made.plan)) {
    transport::merge_eye_segments(*made.world, made.rows.film, kMergeAbove, made.recipe.seed,
                                  made.rows.segments, sinks);
  } else {
    return;
  }
  made.seconds["segments"] += grouping.seconds();
}

transport::MediaLightSettings light_settings_in_media(const Recipe& recipe, const View& view,
                                                      const world::Units& units, std::size_t count) {
  transport::MediaLightSettings settings;
  settings.seed = recipe.light_seed;
  settings.count = count;
  settings.max_depth = recipe.max_depth;
  settings.eye = world::Camera(view.sensor, units).eye(), settings.eye_medium = view.sensor.medium;
  settings.direct = recipe.only != LightPart::indirect;
  settings.indirect = recipe.only != LightPart::direct;
  settings.least_direct = kLeastDirect;
  return settings;
}

void make_columns(PreparedMedia& made, const Sinks& sinks) {
  const Timer timer;
  const std::uint64_t seed = made.recipe.light_seed;
  made.lights = transport::trace_lights_in_media(
      *made.world, light_settings_in_media(made.recipe, made.view, made.world->units(), made.plan.lights),
      sinks);
  made.whole_rays = made.lights.rays.size();
  made.seconds["lights"] = timer.seconds();
  const Timer cutting;
  if (made.plan.segments == Segments::light_pieces) {
    made.lights.rays = transport::cut_evenly(*made.world, made.lights.rays, kPiecesOfLightRays, seed);
  } else if (made.plan.segments == Segments::groups_and_tree) {
    transport::RayTreeSettings tree;
    tree.seed = seed;
    transport::build_ray_tree(*made.world, tree, made.lights.rays, sinks);
  } else {
    return;
  }
  made.seconds["segments"] += cutting.seconds();
}

std::shared_ptr<PreparedMedia> begin(const SharedWorld& world, const View& view, const Recipe& recipe,
                                     const MediaPlan& plan) {
  auto made = std::make_shared<PreparedMedia>();
  made->world = world, made->view = view, made->recipe = recipe, made->plan = plan;
  made->recipe.film_samples = 0;
  return made;
}

void make_matrix(PreparedMedia& made) {
  // Of few columns for many rows smooth ones leave less noise, and methods that complete them need it.
  const Timer timer;
  made.matrix = std::make_unique<transport::MediaMatrix>(
      *made.world, made.rows, made.lights,
      transport::MediaMatrixSettings{matrix_settings(made.recipe), smooth(made.plan)});
  made.seconds["matrix"] = timer.seconds();
}

}  // namespace

Segments segments_for(const methods::MethodInfo& method,
                      const std::map<std::string, std::string>& parameters) {
  return method.segments_wanted ? method.segments_wanted(parameters) : method.contract.segments;
}

std::shared_ptr<const PreparedMedia> prepare_in_media(const SharedWorld& world, const View& view,
                                                      const Recipe& recipe, const MediaPlan& plan,
                                                      const Sinks& sinks) {
  auto made = begin(world, view, recipe, plan);
  make_rows(*made, sinks);
  make_columns(*made, sinks);
  make_matrix(*made);
  return made;
}

std::vector<std::shared_ptr<const PreparedMedia>> prepare_shot_in_media(
    const std::vector<SharedWorld>& worlds, const std::vector<View>& views, const Recipe& recipe,
    std::size_t count, const Sinks& sinks) {
  std::vector<const world::World*> seen;
  seen.reserve(worlds.size());
  for (const SharedWorld& world : worlds) seen.push_back(world.get());
  if (!transport::only_media_differ(seen))
    throw InputError(
        "tensor clustering in participating media needs surfaces and lights that stand still, and "
        "some of this scene's move",
        "name another --method");
  const Timer timer;
  std::vector<transport::LightsInMedia> lights = transport::trace_lights_of_moments(
      seen, light_settings_in_media(recipe, views.front(), seen.front()->units(), count), sinks);
  const double light_seconds = timer.seconds() / static_cast<double>(worlds.size());
  std::vector<std::shared_ptr<const PreparedMedia>> frames;
  for (std::size_t k = 0; k < worlds.size(); ++k) {
    auto made = begin(worlds[k], views[k], recipe, {Segments::pieces, count, false, true});
    make_rows(*made, sinks);
    made->lights = std::move(lights[k]);
    made->whole_rays = made->lights.rays.size();
    made->seconds["lights"] = light_seconds;
    make_matrix(*made);
    frames.push_back(std::move(made));
    sinks.report("frames", static_cast<double>(k + 1) / static_cast<double>(worlds.size()));
  }
  return frames;
}

image::Image picture_of(const PreparedMedia& prepared, std::span<const Rgb> sums) {
  const FilmParts parts{
      .emission = prepared.recipe.only == LightPart::all, .traced_direct = false, .traced_indirect = false};
  const transport::Receivers& rows = prepared.rows;
  std::vector<Rgb> values = sample_values(rows, {}, sums.first(rows.size()), parts);
  const transport::EyeSegments& segments = rows.segments;
  for (std::size_t k = 0; k < segments.size(); ++k)
    values[segments.sample[k]] += segments.weight[k] * sums[rows.size() + k];
  return develop(prepared.view, rows, values);
}

}  // namespace lumirank::pipeline
