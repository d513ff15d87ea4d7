#include "matrix/capabilities.h"

#include <vector>

namespace lumirank::matrix {

namespace {

// In words that need not know what a matrix is, by number.
constexpr const char* kAbilityTexts[kAbilities] = {
    "lights that are either visible or hidden and never partly so",
    "bounds on what groups of lights can add",
    "the receivers' pixels",
    "the receivers' places",
    "the receivers' normals",
    "the receivers' weights in the picture",
    "the receivers' ids",
    "the lights' places",
    "the lights' normals",
    "the lights' powers",
    "the lights' groups",
    "which lights are indirect",
    "which half of the random lights each belongs to",
    "the lights' colors",
    "the lights' ids",
};

}  // namespace

std::string describe(Capabilities capabilities) {
  std::vector<std::string> texts;
  for (int a = 0; a < kAbilities; ++a)
    if (capabilities.has(static_cast<Ability>(a))) texts.emplace_back(kAbilityTexts[a]);
  std::string all;
  for (std::size_t k = 0; k < texts.size(); ++k)
    all += (k == 0 ? "" : k + 1 < texts.size() ? ", " : texts.size() > 2 ? ", and " : " and ") + texts[k];
  return all;
}

}  // namespace lumirank::matrix
