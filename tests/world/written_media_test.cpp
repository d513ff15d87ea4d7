// Media of every kind of grid, written as Mitsuba 3 XML and read again, have the same coefficients.
#include <gtest/gtest.h>

#include <fstream>

#include "base/random.h"
#include "scenedesc/readers.h"
#include "scenedesc/writer/mitsuba_writer.h"
#include "support/scene_file.h"
#include "world/media_builder.h"
#include "world/scene_maker.h"

namespace lumirank::world {
namespace {

using namespace test;
using Form = sd::MediumDesc::Form;

struct Built {
  std::vector<media::Medium> media;
  explicit Built(const sd::SceneDesc& desc) {
    std::vector<sd::Warning> warnings;
    Notes notes(warnings, false);
    media = MediaBuilder(desc, notes).build(Units{});
  }
};

sd::SceneDesc read_again(const sd::SceneDesc& desc, const TemporaryFolder& folder) {
  const sd::WrittenScene written = sd::write_mitsuba(desc, folder / "out.xml");
  for (const sd::WrittenFile& file : written.files)
    std::ofstream(folder / file.name, std::ios::binary) << file.bytes;
  return sd::parse_mitsuba(written.xml, folder / "out.xml");
}

int add_grid(sd::SceneDesc& desc, std::array<int, 3> size, int channels, sd::GridSampling sampling,
             bool nearest) {
  Rng rng(desc.volumes.size() + 1, Stage::test);
  sd::GridData grid;
  grid.size = size, grid.channels = channels;
  grid.lo = {-1, 0, 2}, grid.hi = {1, 4, 3};
  for (int k = 0; k < size[0] * size[1] * size[2] * channels; ++k) {
    const float u = rng.next_float();
    grid.values.push_back(u < 0.3f ? 0.0f : u);  // with holes
  }
  sd::VolumeDesc& v = desc.volumes.emplace_back();
  v.kind = std::make_shared<const sd::GridData>(std::move(grid));
  v.sampling = sampling, v.nearest = nearest;
  v.to_world = Transform::rotate(1, 2, 3, 40) * Transform::scale(2, 1, 0.5);
  return static_cast<int>(desc.volumes.size()) - 1;
}

// All but the albedo of sums of two grids, which is the quotient of what is interpolated and not the
// interpolated quotient.
TEST(WrittenMedia, HaveTheSameCoefficientsWithinTheirBoxes) {
  for (const sd::GridSampling sampling :
       {sd::GridSampling::centers, sd::GridSampling::corners, sd::GridSampling::fading_cells})
    for (const bool nearest : {false, true}) {
      sd::SceneDesc desc = empty_scene();
      const std::array<int, 3> size{4, 3, 1};
      const int gray = add_grid(desc, size, 1, sampling, nearest),
                color = add_grid(desc, size, 3, sampling, nearest);
      const auto add = [&](Form form, sd::VolumeInput first, sd::VolumeInput second) {
        sd::MediumDesc& m = desc.media.emplace_back();
        m.form = form;
        const bool sum = form == Form::absorption_and_scattering;
        (sum ? m.absorption : m.extinction) = first, (sum ? m.scattering : m.albedo) = second;
      };
      add(Form::extinction_and_albedo, {Rgb(3), gray}, {Rgb(1), color});
      add(Form::extinction_and_albedo, {{1, 2, 3}, gray}, {Rgb(0.5f), color});
      add(Form::extinction_and_albedo, {{1, 2, 3}, color}, {{0.3f, 0.5f, 0.7f}});
      add(Form::extinction_and_albedo, {{1, 2, 3}}, {{0.3f, 0.5f, 0.7f}, color});
      add(Form::absorption_and_scattering, {{1, 2, 3}, color}, {{4, 1, 0}, color});
      add(Form::absorption_and_scattering, {Rgb(0)}, {Rgb(2), gray});
      add(Form::absorption_and_scattering, {Rgb(2), gray}, {Rgb(0)});
      const std::size_t exact = nearest ? 99 : desc.media.size();
      add(Form::absorption_and_scattering, {Rgb(2), gray}, {{1, 2, 3}, color});
      add(Form::absorption_and_scattering, {Rgb(2), gray}, {{1, 0, 3}});
      add(Form::absorption_and_scattering, {{0.5f, 1, 0}}, {Rgb(2), color});

      const TemporaryFolder folder;
      const Built before(desc), after(read_again(desc, folder));
      ASSERT_EQ(after.media.size(), before.media.size());
      Rng rng(9, Stage::test);
      double difference = 0, total = 0;  // of what scatters in the inexact ones
      for (int k = 0; k < 2000; ++k) {
        // Not within rounding of the faces of the box or of nearest cells.
        const auto coordinate = [&](float lo, float hi) {
          return lo + (hi - lo) * (0.001f + 0.998f * rng.next_float());
        };
        const Vec3f own{coordinate(-1, 1), coordinate(0, 4), coordinate(2, 3)};
        const Vec3f place = desc.volumes[0].to_world.point(own);
        for (std::size_t m = 0; m < before.media.size(); ++m) {
          const media::Coefficients a = before.media[m].at(place), b = after.media[m].at(place);
          for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(a.extinction[c], b.extinction[c], 2e-5f)
                << "medium " << m << (nearest ? ", nearest" : "");
            if (m < exact) {
              EXPECT_NEAR(a.scattering[c], b.scattering[c], 2e-5f) << "medium " << m;
            } else {
              difference += std::abs(a.scattering[c] - b.scattering[c]), total += a.scattering[c];
            }
          }
        }
      }
      EXPECT_LE(difference, 0.15 * total);
    }
}

// A number at a corner ends there, and Mitsuba's grids go on for half a cell: no more.
TEST(WrittenMedia, ReachNoFurtherThanTheirWarningsSay) {
  for (const sd::GridSampling sampling : {sd::GridSampling::corners, sd::GridSampling::fading_cells}) {
    sd::SceneDesc desc = empty_scene();
    desc.media.emplace_back().extinction.volume = add_grid(desc, {3, 3, 3}, 1, sampling, false);
    const TemporaryFolder folder;
    const Built after(read_again(desc, folder));
    // Along x the box is 2 wide: cells of 1 between numbers at corners, else of 2/3.
    const float half = sampling == sd::GridSampling::corners ? 0.5f : 1.0f / 3;
    for (int k = 0; k < 100; ++k)
      for (int j = 0; j < 100; ++j) {
        const Vec3f own{1 + half + 1e-3f, 4 * static_cast<float>(k) / 100, 2 + static_cast<float>(j) / 100};
        EXPECT_EQ(after.media[0].at(desc.volumes[0].to_world.point(own)).extinction, Rgb(0));
      }
  }
}

}  // namespace
}  // namespace lumirank::world
