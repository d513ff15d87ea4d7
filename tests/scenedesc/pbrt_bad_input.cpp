// Every pbrt file of tests/data/bad is refused with an InputError that names the line and says what is wrong.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>

#include "scenedesc/bad_files.h"
#include "scenedesc/readers.h"

namespace lumirank::scenedesc {
namespace {

// clang-format off
const BadFile kBadPbrt[] = {
    {"p_active", 3, "ActiveTransform is not followed by StartTime, EndTime or All"},
    {"p_attribute_end", 3, "AttributeEnd without AttributeBegin"},
    {"p_attribute_open", 3, "AttributeBegin without its end"},
    {"p_attribute_target", 3, "Attribute has the target \"camera\""},
    {"p_bad_number", 3, "\"1x\" is not a number"},
    {"p_binary", 4, "the file holds a zero byte"},
    {"p_bright", 4, "\"reflectance\" of Material \"diffuse\" is above 1"},
    {"p_camera_late", 3, "Camera after WorldBegin"},
    {"p_camera_medium", 1, "the medium \"fog\" is not defined"},
    {"p_cold", 4, "\"I\" of LightSource \"point\" is not one temperature above 0"},
    {"p_color_space", 1, "the color space \"cmyk\" is not known"},
    {"p_cone", 4, "\"conedeltaangle\" of LightSource \"spot\" is not between 0 and \"coneangle\""},
    {"p_coordinate_system", 3, "the coordinate system \"nowhere\" is not defined"},
    {"p_crop", 2, "\"cropwindow\" of Film \"rgb\" is no window of the film"},
    {"p_crossed_blocks", 5, "AttributeEnd ends what ObjectBegin began"},
    {"p_curve_basis", 3, "\"basis\" of Shape \"curve\" is \"hermite\""},
    {"p_curve_points", 3, "\"P\" of Shape \"curve\" has 3 points"},
    {"p_declaration", 3, "\"radius\" is not the declaration of a parameter"},
    {"p_depth", 2, "\"maxdepth\" of Integrator \"path\" is negative"},
    {"p_empty", 1, "the scene has no WorldBegin"},
    {"p_escape", 3, "the escape \\q is not known"},
    {"p_eta_zero", 4, "\"eta\" of Material \"dielectric\" is not positive"},
    {"p_few_numbers", 3, "Translate has 2 numbers"},
    {"p_film_size", 2, "\"xresolution\" of Film \"rgb\" is 0"},
    {"p_flat_cylinder", 4, "\"zmax\" of Shape \"cylinder\" is the same as zmin"},
    {"p_float_texture", 5, "\"reflectance\" of Material \"diffuse\" is the texture \"t\", which is not defined"},
    {"p_fov", 2, "\"fov\" of Camera \"perspective\" is not between 0 and 180"},
    {"p_fraction", 3, "\"1.5\" for the integer \"indices\", which needs whole numbers of at most 32 bits"},
    {"p_huge_film", 2, "\"xresolution\" of Film \"rgb\" is 100000"},
    {"p_huge_number", 3, "\"1e99\" is not a finite number that a float can hold"},
    {"p_include_itself", 3, "in a loop"},
    {"p_include_loop_a", -1, "in a loop"},
    {"p_include_loop_b", -1, "in a loop"},
    {"p_index_count", 4, "\"indices\" of Shape \"trianglemesh\" has 4 numbers, no multiple of 3"},
    {"p_index_range", 4, "\"indices\" of Shape \"trianglemesh\" refers to vertex 3 of 3"},
    {"p_infinite", 3, "\"inf\" is not a finite number that a float can hold"},
    {"p_instance_in_object", 4, "ObjectInstance in the object \"a\""},
    {"p_instance_of_nothing", 3, "the object \"a\" is not defined"},
    {"p_lookat_nowhere", 1, "LookAt has the same eye and target"},
    {"p_lookat_up", 1, "the up of LookAt is parallel to its line of sight"},
    {"p_material_twice", 4, "the material \"a\" is defined twice"},
    {"p_material_type", 3, "MakeNamedMaterial \"a\" has no \"type\""},
    {"p_medium_box", 4, "\"p1\" of MakeNamedMedium \"fog\" leaves no room above \"p0\""},
    {"p_medium_cells", 4, "\"density\" of MakeNamedMedium \"fog\" has 3 values; 2 × 1 × 1 are needed"},
    {"p_medium_colors", 4, "\"sigma_s\" of MakeNamedMedium \"fog\" has 1 value; 2 × 1 × 1 are needed"},
    {"p_medium_g", 4, "\"g\" of MakeNamedMedium \"fog\" is not between -1 and 1"},
    {"p_medium_glow", 5, "\"temperature\" of MakeNamedMedium \"fog\" is given beside \"Le\""},
    {"p_medium_glow_alone", 4, "\"Le\" of MakeNamedMedium \"fog\" is given without \"sigma_a\""},
    {"p_medium_glow_cells", 5, "\"Lescale\" of MakeNamedMedium \"fog\" has 1 value; 1 × 2 × 1 are needed"},
    {"p_medium_huge_grid", 4, "has 1 value; 2147483647 × 2147483647 × 2147483647 are needed"},
    {"p_medium_nameless", 3, "MakeNamedMedium has an empty name"},
    {"p_medium_negative", 4, "\"sigma_a\" of MakeNamedMedium \"fog\" is negative"},
    {"p_medium_negative_cell", 4, "\"density\" of MakeNamedMedium \"fog\" is negative in places"},
    {"p_medium_negative_color", 4, "\"sigma_a\" of MakeNamedMedium \"fog\" is negative in places"},
    {"p_medium_negative_scale", 4, "\"scale\" of MakeNamedMedium \"fog\" is negative"},
    {"p_medium_no_cells", 4, "\"nx\" of MakeNamedMedium \"fog\" is not positive"},
    {"p_medium_no_colors", 3, "MakeNamedMedium \"fog\" has neither \"sigma_a\" nor \"sigma_s\""},
    {"p_medium_no_density", 3, "MakeNamedMedium \"fog\" has no \"density\""},
    {"p_medium_no_type", 3, "MakeNamedMedium \"fog\" has no \"type\""},
    {"p_medium_of_nothing", 3, "the medium \"fog\" is not defined"},
    {"p_medium_old", 4, "\"type\" of MakeNamedMedium \"fog\" is \"heterogeneous\"; pbrt-v4 calls it \"uniformgrid\""},
    {"p_medium_singular", 4, "the transform of MakeNamedMedium \"fog\" is singular"},
    {"p_medium_texture", 5, "\"sigma_a\" of MakeNamedMedium \"fog\" is a texture"},
    {"p_medium_twice", 4, "the medium \"fog\" is defined twice"},
    {"p_medium_unknown", 3, "\"type\" of MakeNamedMedium \"fog\" is \"honey\""},
    {"p_missing_include", 3, "included file not found"},
    {"p_missing_map", 3, "environment map not found"},
    {"p_missing_mesh", 4, "mesh file not found"},
    {"p_missing_spectrum", 3, "neither a spectrum that is known nor a file"},
    {"p_missing_texture", 3, "texture not found"},
    {"p_mix_amount", 4, "\"amount\" of Material \"mix\" is not between 0 and 1"},
    {"p_mix_of_one", 3, "\"materials\" of Material \"mix\" names 1 materials"},
    {"p_negative_index", 4, "\"indices\" of Shape \"trianglemesh\" refers to vertex -1 of 3"},
    {"p_negative_light", 4, "\"I\" of LightSource \"point\" is negative"},
    {"p_negative_radius", 3, "\"radius\" of Shape \"sphere\" is not positive"},
    {"p_negative_reflectance", 4, "\"reflectance\" of Material \"diffuse\" is negative"},
    {"p_negative_roughness", 4, "\"roughness\" of Material \"dielectric\" is negative"},
    {"p_negative_scale", 4, "\"scale\" of LightSource \"point\" is negative"},
    {"p_nested_list", 3, "a [ for the float \"radius\", which needs numbers"},
    {"p_nested_object", 4, "ObjectBegin in the object \"a\""},
    {"p_nesting_bomb", 3, "blocks are nested more than 1,000 deep"},
    {"p_no_filename", 3, "Shape \"plymesh\" has no \"filename\""},
    {"p_no_indices", 3, "Shape \"trianglemesh\" has no \"indices\""},
    {"p_no_points", 3, "Shape \"trianglemesh\" has no points"},
    {"p_no_type", 3, "Shape has no type"},
    {"p_no_world", 1, "the scene has no WorldBegin"},
    {"p_normal_count", 4, "\"N\" of Shape \"trianglemesh\" has 1 entries for 3 vertices"},
    {"p_nowhere_light", 4, "\"to\" of LightSource \"distant\" is the same point as \"from\""},
    {"p_number_for_string", 3, "\"3\" for the string \"filename\", which needs a string in quotes"},
    {"p_object_end", 3, "ObjectEnd without ObjectBegin"},
    {"p_object_twice", 5, "the object \"a\" is defined twice"},
    {"p_old_color", 3, "the parameter type \"color\" is not known"},
    {"p_old_film", 1, "the film \"image\" is not known"},
    {"p_open_list", 3, "the list of \"radius\" has no end"},
    {"p_open_string", 3, "the string \"sphere\" has no end"},
    {"p_overflow", 13, "the transform overflows"},
    {"p_pixel_bounds", 2, "\"pixelbounds\" of Film \"rgb\" is no window of the film"},
    {"p_quoted_bool", 3, "the string \"true\" for the bool \"remaproughness\", which needs true or false"},
    {"p_samples", 2, "\"pixelsamples\" of Sampler \"sobol\" is not positive"},
    {"p_shape_early", 1, "Shape before WorldBegin"},
    {"p_short_matrix", 3, "Transform has 12 numbers"},
    {"p_short_point", 3, "the point3 \"from\" has 2 numbers, which is no multiple of 3"},
    {"p_short_rgb", 3, "the rgb \"reflectance\" has 2 numbers, which is no multiple of 3"},
    {"p_shutter", 2, "\"shutterclose\" of Camera \"perspective\" is not after \"shutteropen\""},
    {"p_singular", 4, "the transform of Shape \"sphere\" is singular"},
    {"p_singular_camera", 2, "the camera's transform is singular"},
    {"p_spectrum_odd", 4, "the spectrum \"reflectance\" has 3 numbers, which is no multiple of 2"},
    {"p_spectrum_order", 4, "\"reflectance\" of Material \"diffuse\" has wavelengths that do not increase"},
    {"p_sphere_of_nothing", 4, "\"zmax\" of Shape \"sphere\" leaves nothing of the sphere"},
    {"p_stray_bracket", 3, "a ] where a directive should be"},
    {"p_stray_string", 3, "the string \"float radius\" where a directive should be"},
    {"p_string_for_number", 3, "the string \"1\" for the float \"radius\", which needs numbers"},
    {"p_texture_class", 3, "the texture class \"plaid\" is not"},
    {"p_texture_twice", 4, "the float texture \"t\" is defined twice"},
    {"p_texture_type", 3, "the texture \"t\" is of type \"color\""},
    {"p_three_words", 3, "\"float the radius\" is not the declaration of a parameter"},
    {"p_two_metals", 3, "\"reflectance\" of Material \"conductor\" is given beside \"eta\" or \"k\""},
    {"p_two_radii", 3, "\"radius\" of Shape \"sphere\" has 2 values"},
    {"p_two_skies", 4, "\"L\" of LightSource \"infinite\" is given beside \"filename\""},
    {"p_undefined_material", 3, "the material \"a\" is not defined"},
    {"p_undefined_texture", 4, "\"reflectance\" of Material \"diffuse\" is the texture \"t\", which is not defined"},
    {"p_unknown_area", 3, "the area light \"sphere\" is not"},
    {"p_unknown_camera", 1, "the camera \"fisheye\" is not"},
    {"p_unknown_directive", 3, "\"Shpae\" is not"},
    {"p_unknown_filter", 1, "the filter \"airy\" is not"},
    {"p_unknown_light", 3, "the light \"area\" is not"},
    {"p_unknown_material", 3, "the material \"matte\" is not"},
    {"p_unknown_shape", 3, "the shape \"cube\" is not"},
    {"p_unknown_type", 3, "the parameter type \"double\" is not"},
    {"p_wide_hole", 3, "\"innerradius\" of Shape \"disk\" is not between 0 and the radius"},
    {"p_window", 2, "\"screenwindow\" of Camera \"perspective\" is no window"},
    {"p_word_for_number", 3, "\"big\" is not a number"},
    {"p_world_end", 3, "the material \"diffuse\" of pbrt-v3 is not known"},
    {"p_world_in_block", 2, "WorldBegin in a block of AttributeBegin"},
    {"p_world_twice", 3, "WorldBegin after WorldBegin"},
    {"p_wrong_type", 3, "\"radius\" of Shape \"sphere\" is declared as string, and a float is needed"},
    {"p_zero_axis", 3, "the axis of Rotate is zero"},
    {"p_texture_bomb", 12, "is made of more than 1,000 others"},
    {"p_texture_chain", 1003, "is made of more than 1,000 others"},
    {"p_mix_itself", 3, "holds itself or more than 64 materials"},
    {"p_mix_bomb", 9, "holds itself or more than 64 materials"},
};
// clang-format on

class PbrtBadInput : public testing::TestWithParam<BadFile> {};

TEST_P(PbrtBadInput, IsRefusedWithItsLine) {
  const BadFile& bad = GetParam();
  try {
    read_scene(kBadFolder + bad.name + ".pbrt");
    FAIL() << bad.name << " was read";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(bad.phrase), std::string::npos) << error.what();
    EXPECT_NE(error.where().file, "") << error.what();
    EXPECT_GT(error.where().line, 0) << error.what();
    if (bad.line >= 0) {
      EXPECT_EQ(error.where().line, bad.line) << error.what();
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Corpus, PbrtBadInput, testing::ValuesIn(kBadPbrt), name_of);

TEST(PbrtBadInputCorpus, EveryPbrtFileIsInTheTable) {
  std::set<std::string> listed;
  for (const BadFile& bad : kBadPbrt) listed.insert(bad.name);
  for (const auto& entry : std::filesystem::directory_iterator(kBadFolder)) {
    const std::string name = entry.path().stem().string();
    EXPECT_TRUE(entry.path().extension() != ".pbrt" || listed.count(name)) << name;
  }
}

TEST(PbrtBadInputCorpus, MissingFileAndFolder) {
  EXPECT_THROW(read_scene(kBadFolder + "no_such.pbrt"), InputError);
  EXPECT_THROW(read_pbrt(kBadFolder), InputError);
}

const std::string kGood =
    "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" [ 40 ]\nWorldBegin\n"
    "AttributeBegin\nTranslate 1 2 3\nMaterial \"diffuse\" \"rgb reflectance\" [ .1 .2 .3 ]\n"
    "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0 ] \"integer indices\" [ 0 1 2 "
    "]\nAttributeEnd\n";

// Every way of cutting a good file short is an InputError, but for three: after WorldBegin, with or without
// its line's end, and without the last line's end.
TEST(PbrtBadInputCorpus, TruncationAnywhere) {
  int good = 0;
  for (std::size_t n = 0; n < kGood.size(); ++n) try {
      parse_pbrt(kGood.substr(0, n), "cut.pbrt");
      ++good;
    } catch (const InputError&) {
    }
  EXPECT_EQ(good, 3);
  EXPECT_EQ(parse_pbrt(kGood, "cut.pbrt").shapes.size(), 1u);
}

// Any one byte changed: never anything but a scene or an InputError.
TEST(PbrtBadInputCorpus, AnyByteChanged) {
  for (std::size_t n = 0; n < kGood.size(); ++n)
    for (const char c : {'"', '[', ']', '#', '\0', '-', '9', 'e', '\n', '\xff'}) {
      std::string text = kGood;
      text[n] = c;
      try {
        parse_pbrt(text, "changed.pbrt");
      } catch (const InputError&) {
      }
    }
}

}  // namespace
}  // namespace lumirank::scenedesc
