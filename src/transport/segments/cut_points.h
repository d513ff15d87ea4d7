// Where rays in media are cut.
#pragma once

#include <vector>

#include "base/random.h"
#include "media/depth_profile.h"
#include "media/medium.h"

namespace lumirank::transport {

// Where a ray's way through a medium is cut into `pieces` parts at most: at distances at which it would
// collide, so that parts are short where much of what is seen is scattered (Huo et al. 2016, section 4.1:
// Woodcock tracking, 17 parts). Ascending, all within (0, length). `rng` is advanced.
void cut_points(const media::Medium& medium, Vec3f origin, Vec3f direction, float length, int pieces,
                Rng& rng, std::vector<float>& out);

// The same without chance (ours): where 1/pieces, 2/pieces, … of what collides on the way has collided, by
// the mean of the channels. So cuts go along with smoke that moves.
void cut_points_by_depth(const media::DepthProfile& profile, float length, int pieces,
                         std::vector<float>& out);

}  // namespace lumirank::transport
