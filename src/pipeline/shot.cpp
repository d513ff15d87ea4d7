#include "pipeline/shot.h"

#include "base/error.h"
#include "matrix/renumbered_columns.h"

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

std::vector<SharedPrepared> prepare_shot(const std::vector<SharedWorld>& worlds,
                                         const std::vector<View>& views, const Recipe& recipe,
                                         std::size_t count, const Sinks& sinks) {
  if (worlds.empty()) return {};
  const std::size_t middle = worlds.size() / 2;
  const SharedSurvey common =
      survey(*worlds[middle], recipe, aim_at(*worlds[middle], views[middle], recipe.light_seed, sinks));
  std::vector<SharedPrepared> frames;
  for (std::size_t k = 0; k < worlds.size(); ++k) {
    std::map<std::string, double> seconds;
    TracedRows made = trace_rows_and_light(*worlds[k], views[k], recipe, sinks, seconds);
    Columns columns = trace_columns(*worlds[k], recipe, *common, count, sinks);
    made.traced.near = trace_near(*worlds[k], *made.rows, columns, recipe, sinks);
    frames.push_back(join(worlds[k], views[k], recipe, std::move(made.rows), std::move(columns),
                          std::move(made.traced), std::move(seconds)));
    sinks.report("frames", static_cast<double>(k + 1) / static_cast<double>(worlds.size()));
  }
  return frames;
}

}  // namespace lumirank::pipeline
