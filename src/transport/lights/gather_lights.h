// Virtual lights on gather samples: lit by the emitters directly, and by photons that bounced before (Hašan
// et al. 2008, section 5).
#pragma once

#include <vector>

#include "transport/lights/gather_samples.h"
#include "transport/lights/light_plan.h"
#include "transport/lights/light_record.h"
#include "world/world.h"

namespace lumirank::transport {

// Four lights at most for each sample: on each side of the surface one for direct light, and one for all
// other light. Each has the flux of all that arrives there and the direction of one part of it, drawn by
// power: exact for lambertian surfaces, right in the mean for all others. Random numbers belong to samples
// and photons, so that what does not move and is lit alike is the same light to the bit at every moment.
//
// Ours: what shines (most of whose light leaves in narrow lobes) has up to eight of each, one for every
// octant of space from which light comes, and where lobes are widened each has the mean direction of its
// octant. One direction of all is drawn anew whenever photons move, and its caustic flickers; the paper has
// lights on lambertian surfaces only.
//
// Ours, where the paper estimates the photons' density at the samples: every photon is shared out among the
// nearest samples on its shape and its side of the surface, so that no flux is lost in corners or along
// edges. It is moved by about the distance between samples: a bias that vanishes as they grow in number.
std::vector<LightBatch> gather_lights(const world::World& world, const GatherPlan& plan,
                                      const LightSurvey& survey, const LightSettings& settings);

// What moments share, for `settings.count` lights in all: samples are placed by what all surveys tell, and
// their number is found by lighting some of them at the middle one. `worlds` as many as `surveys`.
GatherPlan plan_gather(std::span<const world::World* const> worlds,
                       std::span<const LightSurvey* const> surveys, const LightSettings& settings);

}  // namespace lumirank::transport
