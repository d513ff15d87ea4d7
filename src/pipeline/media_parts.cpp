#include "pipeline/media_parts.h"

#include "base/timer.h"
#include "pipeline/develop.h"
#include "transport/lights/cut_rays.h"
#include "transport/lights/ray_tree.h"
#include "transport/rows/eye_groups.h"

namespace lumirank::pipeline {

using Segments = matrix::MethodContract::Segments;

namespace {

// Parts of a ray's way through a medium (Huo et al. 2016, section 4.1: 16 points); of a pass's fewer, since
// noise is averaged over passes.
constexpr int kSegmentsPerRay = 17, kSegmentsOfAPass = 4;

// Pieces of a light ray, about, for methods that go by bounds (docs/decisions.md has what whole ones gave).
constexpr double kPiecesOfLightRays = 4;

// At so many places of a segment at least the light of all emitters together is estimated: one place for the
// sun made noise of its shafts.
constexpr std::size_t kLeastDirect = 32;

int pieces_of_eye_rays(const MediaPlan& plan) {
  switch (plan.segments) {
    case Segments::whole:
    case Segments::light_pieces:
      return 1;
    case Segments::pieces:
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

void make_rows(PreparedMedia& made, const Sinks& sinks) {
  const Timer timer;
  transport::ReceiverSettings settings = receiver_settings(made.recipe, made.view);
  settings.eye_medium = made.view.sensor.medium;
  settings.segments = pieces_of_eye_rays(made.plan);
  made.rows = transport::trace_receivers(*made.world, world::Camera(made.view.sensor, made.world->units()),
                                         settings, sinks);
  made.seconds["receivers"] = timer.seconds();
  if (!in_groups(made.plan)) return;
  const Timer grouping;
  transport::EyeGroupSettings groups;
  groups.seed = made.recipe.seed;
  transport::group_eye_segments(*made.world, made.rows.film, groups, made.rows.segments, sinks);
  made.seconds["segments"] += grouping.seconds();
}

void make_columns(PreparedMedia& made, const Sinks& sinks) {
  const Timer timer;
  const std::uint64_t seed = made.recipe.light_seed;
  transport::MediaLightSettings settings;
  settings.seed = seed;
  settings.count = made.plan.lights;
  settings.max_depth = made.recipe.max_depth;
  settings.eye_medium = made.view.sensor.medium;
  settings.direct = made.recipe.only != LightPart::indirect;
  settings.indirect = made.recipe.only != LightPart::direct;
  settings.least_direct = kLeastDirect;
  made.lights = transport::trace_lights_in_media(*made.world, settings, sinks);
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

}  // namespace

Segments segments_for(const methods::MethodInfo& method,
                      const std::map<std::string, std::string>& parameters) {
  return method.segments_wanted ? method.segments_wanted(parameters) : method.contract.segments;
}

std::shared_ptr<const PreparedMedia> prepare_in_media(const SharedWorld& world, const View& view,
                                                      const Recipe& recipe, const MediaPlan& plan,
                                                      const Sinks& sinks) {
  auto made = std::make_shared<PreparedMedia>();
  made->world = world, made->view = view, made->recipe = recipe, made->plan = plan;
  made->recipe.film_samples = 0;
  make_rows(*made, sinks);
  make_columns(*made, sinks);
  const Timer timer;
  made->matrix = std::make_unique<transport::MediaMatrix>(
      *world, made->rows, made->lights,
      transport::MediaMatrixSettings{matrix_settings(made->recipe), in_groups(plan)});
  made->seconds["matrix"] = timer.seconds();
  return made;
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
