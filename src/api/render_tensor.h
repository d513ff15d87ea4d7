// The frames of a part of a shot by tensor clustering.
#pragma once

#include <vector>

#include "linalg/rectangle_clustering.h"
#include "lumirank/animate.h"

namespace lumirank::api {

// Throws InputError for numbers out of range, and for what a render can be asked for and tensor clustering
// does not do.
void check(const TensorSettings& tensor, const RenderSettings& settings);

// As many frames as a chunk may have, so that it takes no more memory than `tensor` allows, by estimates that
// are the same on every machine; all that `tensor` wants where it names no memory. `first`: the first frames
// of the motion, three or fewer, since later ones share with those before them. Throws InputError if one
// frame is too many.
int frames_within_memory(const std::vector<Scene>& first, const RenderSettings& settings,
                         const TensorSettings& tensor);

struct TensorFrames {
  std::vector<RenderResult> frames;
  // If they are to be written: frames counted from 0.
  std::vector<linalg::RectangleClustering::Rectangle> rectangles;
  std::size_t lights = 0;
};

// One picture and report for each scene, which are one scene at moments one after the other; none if it was
// cancelled. Throws InputError if they take more memory than there is.
TensorFrames render_tensor(const std::vector<Scene>& scenes, const RenderSettings& settings,
                           const TensorSettings& tensor, const Sinks& sinks);

}  // namespace lumirank::api
