// What pictures of a world with participating media are estimated on: receivers and eye segments × points and
// rays, and the picture that sums of these rows give.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "matrix/lighting_tensor.h"
#include "methods/method.h"
#include "pipeline/prepared.h"
#include "transport/cpu/media_matrix.h"

namespace lumirank::pipeline {

// Pieces of an eye ray's way through a medium in a frame of a shot, at most; 4 and 17 had more error
// (docs/decisions.md).
inline constexpr int kSegmentsOfShot = 8;

struct MediaPlan {
  matrix::MethodContract::Segments segments = matrix::MethodContract::Segments::pieces;
  std::size_t lights = 0;  // points and rays
  bool pass = false;       // one of several, of which the mean is shown
  bool of_shot = false;    // eye rays are cut so that their pieces go along with media that move
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
// What is prepared for every frame of a shot: the same lights, whose power follows the media, and rows that
// do. Throws InputError where anything but media and the camera moves.
std::vector<std::shared_ptr<const PreparedMedia>> prepare_shot_in_media(
    const std::vector<SharedWorld>& worlds, const std::vector<View>& views, const Recipe& recipe,
    std::size_t count, const Sinks& sinks);
// Frames as a tensor: columns have the same numbers in all of them.
class MediaShotTensor : public matrix::LightingTensor {
 public:
  explicit MediaShotTensor(std::vector<std::shared_ptr<const PreparedMedia>> frames)
      : frames_(std::move(frames)) {}
  std::size_t frames() const override { return frames_.size(); }
  std::size_t columns() const override { return frames_.empty() ? 0 : frames_.front()->matrix->columns(); }
  std::shared_ptr<const matrix::LightingMatrix> frame(std::size_t k) const override {
    return {frames_[k], frames_[k]->matrix.get()};
  }

 private:
  std::vector<std::shared_ptr<const PreparedMedia>> frames_;
};

image::Image picture_of(const PreparedMedia& prepared, std::span<const Rgb> sums);

}  // namespace lumirank::pipeline
