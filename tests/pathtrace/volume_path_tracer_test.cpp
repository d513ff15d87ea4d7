// What no scene file can say, but a medium may be: channels that turn differently.
#include "pathtrace/volume_path_tracer.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/random.h"
#include "scenedesc/readers.h"
#include "support/statistics.h"

namespace lumirank::pathtrace {
namespace {

TEST(VolumePathTracer, ChannelsThatTurnDifferentlyLoseNothingInAFurnace) {
  // With an albedo of 1 under an even sky every path finds the sky at last, by light sampling or by its
  // direction, which is drawn for one channel: the two are weighted by all three.
  auto desc = scenedesc::parse_mitsuba(R"(<scene version="3.0.0"><sensor type="perspective"/>
    <emitter type="constant"><rgb name="radiance" value="1"/></emitter>
    <shape type="cube"><bsdf type="null"/><medium type="homogeneous" name="interior">
      <rgb name="sigma_t" value="1, 1, 1"/><rgb name="albedo" value="1, 1, 1"/>
      <phase type="hg"><float name="g" value="0.5"/></phase></medium></shape></scene>)",
                                       "furnace.xml");
  ASSERT_EQ(desc.media.size(), 1u);
  desc.media[0].phase[0].g = {0.9f, 0.0f, -0.6f};
  std::vector<scenedesc::Warning> warnings;
  const world::World world = world::World::build(desc, {}, warnings);
  const VolumePathTracer tracer(world, 5, -1, -1);
  std::vector<double> values[3];
  for (std::uint64_t pixel = 0; pixel < 20000; ++pixel) {
    Rng rng(2, Stage::test, pixel);
    const Vec2f u = rng.next_2d();
    const Rgb all = tracer.trace({{-3, 1.8f * u.x - 0.9f, 1.8f * u.y - 0.9f}, {1, 0, 0}}, pixel, 0).total();
    for (int c = 0; c < 3; ++c) values[c].push_back(static_cast<double>(all[c]));
  }
  for (int c = 0; c < 3; ++c) {
    const auto m = test::mean_of(values[c]);
    EXPECT_NEAR(m.mean, 1, test::normal_quantile(1e-4, 3) * m.standard_error + 1e-4) << "channel " << c;
  }
}

}  // namespace
}  // namespace lumirank::pathtrace
