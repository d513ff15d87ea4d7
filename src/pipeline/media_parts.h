// What pictures of a world with participating media are estimated on: receivers and eye segments × points and
// rays, and the picture that sums of these rows give.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "methods/method.h"
#include "pipeline/prepared.h"
#include "transport/cpu/media_matrix.h"

namespace lumirank::pipeline {

struct MediaPlan {
  matrix::MethodContract::Segments segments = matrix::MethodContract::Segments::pieces;
  std::size_t lights = 0;  // points and rays
  bool pass = false;       // one of several, of which the mean is shown
  bool operator==(const MediaPlan&) const = default;
};
// What a method with these parameters has rays be.
matrix::MethodContract::Segments segments_for(const methods::MethodInfo& method,
                                              const std::map<std::string, std::string>& parameters);

// Owns what it is made of and never changes.
struct PreparedMedia {
  SharedWorld world;
  View view;
  Recipe recipe;
  MediaPlan plan;
  transport::Receivers rows;  // with their segments
  transport::LightsInMedia lights;
  std::size_t whole_rays = 0;  // before they were cut
  std::unique_ptr<const transport::MediaMatrix> matrix;
  std::map<std::string, double> seconds;  // by stage
};

// Film samples apart from receivers are not made: what is seen of a medium belongs to no surface that others
// could share.
std::shared_ptr<const PreparedMedia> prepare_in_media(const SharedWorld& world, const View& view,
                                                      const Recipe& recipe, const MediaPlan& plan,
                                                      const Sinks& sinks);
image::Image picture_of(const PreparedMedia& prepared, std::span<const Rgb> sums);

}  // namespace lumirank::pipeline
