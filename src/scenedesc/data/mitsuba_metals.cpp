// What the RGB modes of Mitsuba 3.9.1 take for the names of its conductors: n and k of other measurements
// than ours in part, and all of them projected to RGB there.
#include "scenedesc/data/mitsuba_metals.h"

#include <map>

namespace lumirank::scenedesc {

namespace {

// clang-format off
const std::map<std::string, MetalIndex>& mitsuba_metals() {
  static const std::map<std::string, MetalIndex> all = {
      {"Ag", {{0.15528f, 0.11673f, 0.13839f}, {4.8284f, 3.1222f, 2.1469f}}},
      {"Al", {{1.6575f, 0.8804f, 0.52124f}, {9.2238f, 6.2695f, 4.837f}}},
      {"AlAs", {{3.6053f, 3.2329f, 2.2163f}, {0.00067944f, 0, 0.0075127f}}},
      {"AlSb", {{0, 4.1394f, 4.6693f}, {0, 0.094009f, 1.3006f}}},
      {"Au", {{0.14304f, 0.37531f, 1.442f}, {3.983f, 2.3856f, 1.6034f}}},
      {"Be", {{4.185f, 3.185f, 2.7841f}, {3.8355f, 3.0101f, 2.869f}}},
      {"Cr", {{4.3697f, 2.9165f, 1.6549f}, {5.2065f, 4.2313f, 3.7547f}}},
      {"CsI", {{2.1449f, 1.7023f, 1.6624f}, {0, 0, 0}}},
      {"Cu", {{0.20101f, 0.92375f, 1.1022f}, {3.9133f, 2.453f, 2.1421f}}},
      {"Cu2O", {{3.5518f, 2.9499f, 2.7519f}, {0.11421f, 0.1939f, 0.60613f}}},
      {"CuO", {{3.2475f, 2.4478f, 2.2102f}, {0.52109f, 0.57003f, 0.72218f}}},
      {"Cu_palik", {{0.21323f, 0.91972f, 1.1024f}, {3.9219f, 2.4573f, 2.1366f}}},
      {"Hg", {{2.3989f, 1.44f, 0.90957f}, {6.3276f, 4.3719f, 3.4218f}}},
      {"HgTe", {{4.779f, 3.2312f, 2.6599f}, {1.6316f, 1.5808f, 1.7293f}}},
      {"Ir", {{3.0863f, 2.0822f, 1.6179f}, {5.5922f, 4.0671f, 3.2673f}}},
      {"K", {{0.064043f, 0.04641f, 0.038185f}, {2.1042f, 1.3489f, 0.91313f}}},
      {"Li", {{0.26579f, 0.19562f, 0.22095f}, {3.5402f, 2.3111f, 1.6686f}}},
      {"MgO", {{2.0896f, 1.6507f, 1.5949f}, {0, 0, 0}}},
      {"Mo", {{4.484f, 3.5251f, 2.7763f}, {4.1114f, 3.4208f, 3.1506f}}},
      {"Na", {{0.060269f, 0.056141f, 0.061988f}, {3.1793f, 2.1125f, 1.579f}}},
      {"Nb", {{3.4201f, 2.7901f, 2.3956f}, {3.4414f, 2.7377f, 2.5797f}}},
      {"Ni", {{2.3673f, 1.6634f, 1.4671f}, {4.4988f, 3.0502f, 2.3454f}}},
      {"Rh", {{2.5858f, 1.8602f, 1.5543f}, {6.7823f, 4.703f, 3.9761f}}},
      {"Se", {{4.0583f, 2.8429f, 2.8209f}, {0.75405f, 0.63844f, 0.52181f}}},
      {"Se-e", {{5.7228f, 4.1657f, 4.0813f}, {0.87114f, 1.1052f, 1.5653f}}},
      {"SiC", {{3.1723f, 2.526f, 2.4794f}, {0, 0, 1.0193e-05f}}},
      {"SnTe", {{4.5242f, 1.9816f, 1.2816f}, {0, 0, 0}}},
      {"Ta", {{2.0627f, 2.3929f, 2.6279f}, {2.4084f, 1.7415f, 1.947f}}},
      {"Te", {{7.3902f, 4.4821f, 2.6371f}, {3.256f, 3.5271f, 3.2921f}}},
      {"Te-e", {{7.5089f, 4.2964f, 2.37f}, {5.5839f, 4.9472f, 3.9976f}}},
      {"ThF4", {{1.8307f, 1.4422f, 1.3876f}, {0, 0, 0}}},
      {"TiC", {{3.7005f, 2.8374f, 2.5823f}, {3.2656f, 2.3516f, 2.1728f}}},
      {"TiN", {{1.6484f, 1.1505f, 1.3798f}, {3.3683f, 1.9435f, 1.1021f}}},
      {"TiO2", {{3.4566f, 2.8017f, 2.9052f}, {0.00010526f, 0, 0.00065289f}}},
      {"TiO2-e", {{3.1066f, 2.5132f, 2.5824f}, {2.9752e-05f, 0, 0.0001827f}}},
      {"V", {{4.2776f, 3.5129f, 2.7611f}, {3.4913f, 2.8895f, 3.1115f}}},
      {"VC", {{3.6576f, 2.7527f, 2.5327f}, {3.0683f, 2.1987f, 1.9632f}}},
      {"VN", {{2.8656f, 2.1192f, 1.9401f}, {3.0322f, 2.0561f, 1.6163f}}},
      {"W", {{4.3708f, 3.3002f, 2.9984f}, {3.5006f, 2.6049f, 2.2732f}}},
      {"a-C", {{2.944f, 2.2271f, 1.9682f}, {0.88746f, 0.7993f, 0.81529f}}},
      {"d-C", {{2.7087f, 2.3188f, 2.2289f}, {0, 0, 0}}},
  };
  return all;
}
// clang-format on

}  // namespace

std::optional<MetalIndex> mitsuba_metal(const std::string& name) {
  if (name == "none") return MetalIndex{Rgb(0), Rgb(1)};  // reflects everything
  const auto& all = mitsuba_metals();
  auto found = all.find(name);
  // "Cu_palik" and "Cu" are two measurements there; of most metals there is one.
  if (found == all.end()) found = all.find(name.substr(0, name.find('_')));
  if (found != all.end()) return found->second;
  return metal_index(name);
}

std::string mitsuba_metal_names() {
  std::string names = metal_names();
  for (const auto& [name, index] : mitsuba_metals())
    if (!metal_spectra(name)) names += ", " + name;
  return names;
}

}  // namespace lumirank::scenedesc
