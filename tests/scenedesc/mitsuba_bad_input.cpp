// Every file of tests/data/bad is refused with an InputError that names the line and says what is wrong.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>

#include "scenedesc/bad_files.h"
#include "scenedesc/readers.h"

namespace lumirank::scenedesc {
namespace {

// clang-format off
const BadFile kBadMitsuba[] = {
    {"empty", 1, "the file is empty"},
    {"blank", 1, "the file is empty"},
    {"truncated", 3, "not well-formed XML"},
    {"garbage", -1, ""},
    {"not_xml", 1, "not well-formed XML"},
    {"wrong_root", 2, "root element is <mesh>"},
    {"two_roots", 2, "second root element"},
    {"no_version", 1, "has no version"},
    {"odd_version", 1, "not a version number"},
    {"future_version", 1, "is not known"},
    {"doctype", 2, "DOCTYPE"},
    {"no_sensor", 1, "no sensor"},
    {"unknown_element", 3, "<shpae> is not an element"},
    {"stray_text", 3, "stray text"},
    {"no_type", 3, R"(no attribute "type")"},
    {"no_property_name", 3, "has no name"},
    {"no_value", 4, R"(no attribute "value")"},
    {"twice_attribute", 3, "twice"},
    {"nan", 4, "not a finite number"},
    {"infinite", 4, "not a finite number"},
    {"word_for_number", 4, R"("big", which is not a number)"},
    {"fraction_for_integer", 4, "not a whole number"},
    {"word_for_boolean", 4, "not true or false"},
    {"wrong_kind", 4, "is a <string>"},
    {"short_vector", 4, "has 2 numbers; 3 are needed"},
    {"short_matrix", 5, "has 6 numbers"},
    {"short_rgb", 4, "has 2 numbers"},
    {"negative_radius", 4, "is not positive"},
    {"twice_property", 5, "given twice"},
    {"no_filename", 3, R"(has no "filename")"},
    {"missing_mesh", 4, "mesh file not found"},
    {"mesh_is_folder", 4, "is a folder"},
    {"missing_texture", 5, "texture not found"},
    {"missing_envmap", 4, "environment map not found"},
    {"missing_include", 3, "file not found"},
    {"missing_spd", 4, "file not found"},
    {"include_itself", 3, "in a loop"},
    {"include_loop_a", -1, "in a loop"},
    {"include_loop_b", -1, "in a loop"},
    {"undefined_parameter", 5, "known are: $known"},
    {"duplicate_id", 4, "used twice"},
    {"dangling_ref", 4, "names nothing"},
    {"ref_loop", 3, "refers to itself"},
    {"texture_for_bsdf", 4, "has no BSDF in it"},
    {"negative_film", 5, R"("width" of <film type="hdrfilm"> is -640)"},
    {"huge_film", 5, "65536"},
    {"crop_outside", 5, "reaches beyond the film"},
    {"fov_flat", 4, "not between 0 and 180"},
    {"fov_axis", 5, R"("fov_axis")"},
    {"singular_transform", 4, "is singular"},
    {"zero_axis", 5, "axis of <rotate> is zero"},
    {"lookat_nowhere", 5, "the same point"},
    {"lookat_up", 5, "parallel"},
    {"unknown_step", 5, "<shear> is not a part"},
    {"negative_reflectance", 4, "is negative"},
    {"negative_radiance", 4, "is negative"},
    {"ior_zero", 4, "is not positive"},
    {"unknown_glass", 4, R"("kryptonite" is not known)"},
    {"negative_alpha", 4, "is negative"},
    {"unknown_distribution", 4, R"("gauss" is not known)"},
    {"opacity_two", 4, "not between 0 and 1"},
    {"mask_of_nothing", 3, "has no BSDF in it"},
    {"mixture_weights", 4, "3 weights and 1 BSDFs"},
    {"blend_of_one", 3, "2 are needed"},
    {"two_bsdfs", 5, "more than one BSDF"},
    {"lone_area_emitter", 3, "belongs to no shape"},
    {"point_in_shape", 4, "only area emitters"},
    {"instance_of_nothing", 3, "names no shapegroup"},
    {"empty_group", 3, "holds no shapes"},
    {"nested_group", 4, "cannot be nested"},
    {"flat_cylinder", 4, "the same point"},
    {"spectrum_order", 4, "do not increase"},
    {"spectrum_pairs", 4, "not wavelength:value"},
    {"cold_blackbody", 4, "not positive"},
    {"sun_at_night", 4, "below the horizon"},
    {"turbidity", 4, "between 1 and 10"},
    {"spot_angles", 4, R"(above its "cutoff_angle")"},
    {"aperture", 3, R"(no "aperture_radius")"},
    {"deep", 66, "nested more than 64 deep"},
    {"parameter_bomb", 8, "more than 64 MiB"},
    {"weird_sensor", 2, R"("fisheye" is not known)"},
};
// clang-format on

class BadInput : public testing::TestWithParam<BadFile> {};

TEST_P(BadInput, IsRefusedWithItsLine) {
  const BadFile& bad = GetParam();
  try {
    read_scene(kBadFolder + bad.name + ".xml");
    FAIL() << bad.name << " was read";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(bad.phrase), std::string::npos) << error.what();
    if (bad.line >= 0) {
      EXPECT_EQ(error.where().line, bad.line) << error.what();
    }
    EXPECT_NE(error.where().file, "") << error.what();
  }
}
INSTANTIATE_TEST_SUITE_P(Corpus, BadInput, testing::ValuesIn(kBadMitsuba), name_of);

TEST(BadInputCorpus, EveryXmlFileIsInTheTable) {
  std::set<std::string> listed;
  for (const BadFile& bad : kBadMitsuba) listed.insert(bad.name);
  for (const auto& entry : std::filesystem::directory_iterator(kBadFolder)) {
    const std::string name = entry.path().stem().string();
    EXPECT_TRUE(entry.path().extension() != ".xml" || listed.count(name)) << name;
  }
}

TEST(BadInputCorpus, AnIncludeLoopShowsItsChain) {
  try {
    read_scene(kBadFolder + "include_loop_a.xml");
    FAIL();
  } catch (const InputError& error) {
    const std::string what = error.what();
    const auto a = what.find("include_loop_a.xml →"), b = what.find("include_loop_b.xml →");
    EXPECT_NE(a, std::string::npos) << what;
    EXPECT_NE(b, std::string::npos) << what;
    EXPECT_NE(error.where().file.find("include_loop_b.xml"), std::string::npos);
    EXPECT_EQ(error.where().line, 3);
  }
}

TEST(BadInputCorpus, MissingFileAndFolder) {
  EXPECT_THROW(read_scene(kBadFolder + "no_such.xml"), InputError);
  EXPECT_THROW(read_mitsuba(kBadFolder), InputError);
  EXPECT_THROW(read_scene("scene.unknown"), InputError);
}

// Every way of cutting a good file short gives an InputError or, at the very end, the scene.
TEST(BadInputCorpus, TruncationAnywhere) {
  const std::string good =
      "<scene version=\"3.0.0\"><sensor type=\"perspective\"><float name=\"fov\" "
      "value=\"40\"/></sensor><shape type=\"sphere\"/>"
      "</scene>";
  for (std::size_t n = 0; n < good.size(); ++n)
    EXPECT_THROW(parse_mitsuba(good.substr(0, n), "cut.xml"), InputError) << n;
  EXPECT_EQ(parse_mitsuba(good, "cut.xml").shapes.size(), 1u);
}

}  // namespace
}  // namespace lumirank::scenedesc
