// Scalable virtual ray lights (Vibert et al. 2019): a tree over pieces of ray lights, through which every eye
// ray has a cut of its own, refined where the bound of what a node adds to the whole ray is greatest. The
// bounds are the matrix's (transport/pairs/media_row_bounds.h).
//
// Of the paper its abstract was at hand, so this is what it says, with Walter et al.'s cuts (2005) for what
// it leaves open: a bound on the contribution of groups of ray lights along a whole eye ray, which knows by
// what densities places are drawn. On surfaces it is light cuts.
#include "methods/lightcuts/scalable_virtual_ray_lights.h"

#include "methods/lightcuts/lightcuts_method.h"
#include "methods/parameters.h"

namespace lumirank::methods {

namespace {

struct RayCutSettings : LightcutsSettings {
  // Neighboring eye rays pass at other depths of a medium, so nothing is interpolated between them.
  RayCutSettings() { reconstruction = Reconstruction::off; }
};

const Fields<RayCutSettings> kRayCutFields{
    number_field<RayCutSettings>({"error-bound", "",
                                  "A node is refined while its bound exceeds this share of the eye ray's "
                                  "total. 0 with no limit of nodes is brute force."},
                                 &LightcutsSettings::error_bound, 0, 1),
    count_field<RayCutSettings>({"max-nodes", "nodes", "Of an eye ray's cut; time is in proportion."},
                                &LightcutsSettings::max_nodes, 1, kMaxColumns)};

}  // namespace

MethodInfo scalable_virtual_ray_lights_info() {
  return method_info<Lightcuts>(
      {"scalable-virtual-ray-lights",
       "In media a cut through a tree of ray lights for each whole eye ray, refined by error bounds.",
       "Vibert, Gruson, Stokholm, Mortensen, Jarosz, Hachisuka, Nowrouzezahrai 2019, Scalable virtual ray "
       "lights rendering for participating media",
       "error-bound or max-nodes",
       {.needs = {matrix::Ability::bounds}, .segments = matrix::MethodContract::Segments::light_pieces}},
      kRayCutFields);
}

}  // namespace lumirank::methods
