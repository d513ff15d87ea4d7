// No picture with values that are no numbers is given out.
#include "pipeline/sound_pixels.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "pipeline/develop.h"

namespace lumirank::test {
namespace {

TEST(SoundPixels, OthersAreCountedAndRefused) {
  image::Image image(4, 3, Rgb(1e30f));
  EXPECT_NO_THROW(pipeline::check_pixels(image));
  image.at(2, 1).g = kInfinity;
  image.at(3, 2).b = std::nanf("");
  for (const bool as_picture : {false, true}) try {
      if (as_picture)
        pipeline::to_picture(image);
      else
        pipeline::check_pixels(image);
      ADD_FAILURE() << "taken";
    } catch (const InputError& e) {
      const std::string text = e.what();
      EXPECT_NE(text.find("2 of 12 pixels"), std::string::npos) << text;
      EXPECT_NE(text.find("column 2, row 1"), std::string::npos) << text;
      EXPECT_NE(text.find("light"), std::string::npos) << text;
    }
}

}  // namespace
}  // namespace lumirank::test
