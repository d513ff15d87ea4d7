#include "pipeline/shot.h"

#include <set>

#include "base/error.h"
#include "base/timer.h"
#include "matrix/renumbered_columns.h"
#include "transport/lights/gather_lights.h"

namespace lumirank::pipeline {

using matrix::Index;

ShotTensor::ShotTensor(std::vector<SharedPrepared> frames) : frames_(std::move(frames)) {
  std::vector<std::uint32_t> uses;
  for (const SharedPrepared& frame : frames_)
    for (const std::uint64_t id : frame->lights().id) {
      const auto [found, fresh] = number_.try_emplace(id, static_cast<Index>(number_.size()));
      if (fresh) uses.push_back(0);
      ++uses[found->second];
    }
  for (const std::uint32_t n : uses) common_ += n == frames_.size();
  for (const SharedPrepared& frame : frames_) {
    std::vector<Index> whole(number_.size(), matrix::RenumberedColumns::kBlack);
    const auto& ids = frame->lights().id;
    for (std::size_t j = 0; j < ids.size(); ++j) whole[number_.at(ids[j])] = static_cast<Index>(j);
    matrices_.push_back(std::make_shared<matrix::RenumberedColumns>(frame->matrix, std::move(whole)));
  }
}

double ShotTensor::common_share() const {
  return number_.empty() ? 1.0 : static_cast<double>(common_) / static_cast<double>(number_.size());
}

std::shared_ptr<const ShotLights> plan_shot_lights(const std::vector<ShotMoment>& moments,
                                                   const Recipe& recipe, std::size_t count,
                                                   const Sinks& sinks) {
  const bool gather = recipe.lights.placement == LightPlacement::gather;
  auto lights = std::make_shared<ShotLights>();
  lights->count = count;
  std::vector<SharedSurvey> surveys;
  std::vector<const world::World*> seen;
  std::vector<const transport::LightSurvey*> told;
  for (std::size_t k = 0; k < moments.size(); ++k) {
    const bool middle = k == moments.size() / 2;
    if (!gather && !middle) continue;
    const auto& [world, view] = moments[k];
    surveys.push_back(survey(*world, recipe, aim_at(*world, view, recipe.light_seed, sinks)));
    seen.push_back(world.get()), told.push_back(surveys.back().get());
    if (middle) lights->guide = surveys.back();
  }
  if (gather) {
    transport::LightSettings ls = light_settings(recipe);
    ls.count = count;
    lights->plan = transport::plan_gather(seen, told, ls);
  }
  return lights;
}

std::vector<SharedPrepared> prepare_shot(const std::vector<SharedWorld>& worlds,
                                         const std::vector<View>& views, const Recipe& recipe,
                                         std::size_t count, const Sinks& sinks) {
  if (worlds.empty()) return {};
  Timer timer;
  Recipe common = recipe;
  {
    std::vector<ShotMoment> moments;
    for (const std::size_t k : std::set<std::size_t>{0, worlds.size() / 2, worlds.size() - 1})
      moments.push_back({worlds[k], views[k]});
    common.shot_lights = plan_shot_lights(moments, recipe, count, sinks);
  }
  const double survey_seconds = timer.seconds();
  std::vector<SharedPrepared> frames;
  for (std::size_t k = 0; k < worlds.size(); ++k) {
    std::map<std::string, double> seconds;
    TracedRows made = trace_rows_and_light(*worlds[k], views[k], common, sinks, seconds);
    const Timer lights_timer;
    Columns columns = trace_columns(*worlds[k], common, *common.shot_lights->guide, count, sinks);
    seconds["lights"] = lights_timer.seconds() + survey_seconds / static_cast<double>(worlds.size());
    made.traced.near = trace_near(*worlds[k], *made.rows, columns, common, sinks);
    frames.push_back(join(worlds[k], views[k], common, std::move(made.rows), std::move(columns),
                          std::move(made.traced), std::move(seconds)));
    sinks.report("frames", static_cast<double>(k + 1) / static_cast<double>(worlds.size()));
  }
  return frames;
}

}  // namespace lumirank::pipeline
