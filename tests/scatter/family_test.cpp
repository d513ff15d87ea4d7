// The table of lobe families is whole: what is asked of a kind is there.
#include <gtest/gtest.h>

#include "scatter/lobes/family.h"

namespace lumirank::scatter {
namespace {

TEST(LobeFamilies, AreWhole) {
  for (int k = 0; k < kLobeKinds; ++k) {
    const auto kind = static_cast<LobeKind>(k);
    const LobeFamily& family = family_of(kind);
    EXPECT_TRUE(family.value && family.pdf && family.sample && family.albedo && family.importance) << k;
    EXPECT_TRUE(family.factor_of_wo && family.bound && family.reach) << k;
    EXPECT_EQ(family.direction != nullptr, is_delta(kind)) << k;
    EXPECT_EQ(family.fiber_bound != nullptr, is_hair(kind)) << k;
    // Lanes mirror what shines through to wo's side, and know nothing else of the other side.
    EXPECT_FALSE(family.lanes != LaneForm::none && (is_delta(kind) || is_hair(kind) || family.refracts)) << k;
    EXPECT_FALSE(family.matt && (family.roughness || transmits(kind))) << k;
  }
}

}  // namespace
}  // namespace lumirank::scatter
