// Frames of a shot as one tensor: their columns are the same lights by their ids.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "matrix/lighting_tensor.h"
#include "pipeline/prepared.h"
#include "transport/lights/gather_samples.h"

namespace lumirank::pipeline {

// The frames' matrices under common numbers of columns: one for every id that any frame has. A light that a
// frame lacks, because its particle took another way there, is a black column of it.
class ShotTensor : public matrix::LightingTensor {
 public:
  explicit ShotTensor(std::vector<SharedPrepared> frames);

  std::size_t frames() const override { return frames_.size(); }
  std::size_t columns() const override { return number_.size(); }
  std::shared_ptr<const matrix::LightingMatrix> frame(std::size_t k) const override { return matrices_[k]; }
  // Share of the columns that all frames have.
  double common_share() const;

 private:
  std::vector<SharedPrepared> frames_;
  std::unordered_map<std::uint64_t, matrix::Index> number_;  // of each id
  std::vector<std::shared_ptr<const matrix::LightingMatrix>> matrices_;
  std::size_t common_ = 0;
};

// What makes the lights of a shot's frames the same lights: they are aimed at what some moments see.
struct ShotLights {
  SharedSurvey guide;          // the middle one's, so that particles start alike in all frames
  transport::GatherPlan plan;  // of all moments, where lights stand on gather samples
  std::size_t count = 0;       // of lights, for which it is made
};

// A moment of a shot.
struct ShotMoment {
  SharedWorld world;
  View view;
};
// At least one moment.
std::shared_ptr<const ShotLights> plan_shot_lights(const std::vector<ShotMoment>& moments,
                                                   const Recipe& recipe, std::size_t count,
                                                   const Sinks& sinks);

// What is prepared for every frame of a shot. Lights are planned for the first, middle and last one.
std::vector<SharedPrepared> prepare_shot(const std::vector<SharedWorld>& worlds,
                                         const std::vector<View>& views, const Recipe& recipe,
                                         std::size_t count, const Sinks& sinks);

}  // namespace lumirank::pipeline
