// What a denoised picture is made of beside the denoiser; skipped where there is none (`make denoiser`).
#include <gtest/gtest.h>

#include <string>

#include "base/error.h"
#include "film/refilter.h"
#include "lumirank/lumirank.h"
#include "support/scene_file.h"

namespace lumirank {
namespace {

using test::load_text;
using test::point_camera;

std::string with_filter(std::string scene, const std::string& kind) {
  const std::string box = "rfilter type=\"box\"";
  return scene.replace(scene.find(box), box.size(), "rfilter type=\"" + kind + "\"");
}

Picture denoised(const std::string& scene) {
  RenderSettings settings;
  settings.denoise = Denoise::on;
  settings.view.spp = 4;
  return render(load_text(scene), settings).picture;
}

const std::string kBall =
    "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"4\"/><translate z=\"-2\"/>"
    "</transform></shape><emitter type=\"constant\"><rgb name=\"radiance\" value=\"1, 2, 3\"/></emitter>"
    "<shape type=\"sphere\"/>";

// Its samples are of a box; then it has the width of the filter that its scene asks for.
TEST(Denoised, HasTheFilterOfItsScene) {
  const std::string fog =
      "<medium type=\"homogeneous\" id=\"fog\"><float name=\"sigma_t\" value=\"0.5\"/></medium><shape "
      "type=\"sphere\"><float name=\"radius\" value=\"1.5\"/><bsdf type=\"null\"/><ref name=\"interior\" "
      "id=\"fog\"/></shape>";
  try {
    for (const std::string& scene : {kBall, kBall + fog}) {
      const std::string whole = point_camera("0,0,4", "0,0,0", 32, 60) + scene;
      const Picture box = denoised(whole), wider = denoised(with_filter(whole, "gaussian"));
      image::Image of_box(box.width, box.height);
      const auto& rgb = box.planes[0].rgb;
      for (std::size_t p = 0; p < of_box.pixels.size(); ++p)
        of_box.pixels[p] = {rgb[3 * p], rgb[3 * p + 1], rgb[3 * p + 2]};
      const image::Image expected =
          film::refiltered(of_box, film::Filter::standard(film::FilterKind::gaussian));
      bool differs = false;
      for (std::size_t p = 0; p < of_box.pixels.size(); ++p)
        for (std::size_t c = 0; c < 3; ++c) {
          ASSERT_EQ(wider.planes[0].rgb[3 * p + c], expected.pixels[p][static_cast<int>(c)]);
          differs |= wider.planes[0].rgb[3 * p + c] != rgb[3 * p + c];
        }
      EXPECT_TRUE(differs);
      ASSERT_EQ(box.planes.back().name, "undenoised");
      EXPECT_EQ(box.planes.back().rgb, wider.planes.back().rgb);
    }
  } catch (const InputError& error) {
    GTEST_SKIP() << error.what();
  }
}

}  // namespace
}  // namespace lumirank
