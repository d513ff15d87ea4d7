// Meshes that have nothing to show, and files that are broken.
#include "world/loading_corpus.h"

namespace lumirank::test {

namespace {

using enum LoadingCase::Format;
using enum LoadingCase::Outcome;

// A shape on line 4 of a Mitsuba scene whose file is `file`.
std::string xml_mesh(const std::string& type, const std::string& file, const std::string& more = "") {
  return xml_scene("\n<shape type=\"" + type + "\" id=\"cup\"><string name=\"filename\" value=\"" + file +
                   "\"/>" + more + "</shape>");
}
const std::string kAreaLight = "<emitter type=\"area\"/>";

// A shape of that text on line 4 of a pbrt scene.
std::string pbrt_shape(const std::string& shape) { return pbrt_scene("\nShape " + shape); }
std::string pbrt_lamp(const std::string& shape, const std::string& light = "\"rgb L\" [ 1 1 1 ]") {
  return pbrt_scene("AttributeBegin AreaLightSource \"diffuse\" " + light + "\nShape " + shape +
                    "\nAttributeEnd");
}

}  // namespace

std::vector<LoadingCase> meshes_without_triangles() {
  const std::string nothing = "has no triangle to show", gone = "its light is gone too";
  const std::string flat =
      "\"trianglemesh\" \"point3 P\" [ 0 0 0  1 0 0  2 0 0 ] \"integer indices\" [ 0 1 2 ]";
  return {
      {"obj_empty", xml, xml_mesh("obj", "empty.obj"), warned, "empty.obj " + nothing, 4, 1},
      {"obj_points", xml, xml_mesh("obj", "points.obj"), warned, "the shape \"cup\" is left out", 4, 1},
      {"obj_lines", xml, xml_mesh("obj", "lines.obj"), warned, nothing, 4, 1},
      {"obj_two_corners", xml, xml_mesh("obj", "two_corners.obj"), warned, "1 face with fewer than 3 corners",
       4, 1},
      {"obj_flat", xml, xml_mesh("obj", "flat.obj"), warned, "(2 degenerate triangles)", 4, 1},
      {"obj_some_flat", xml, xml_mesh("obj", "some_flat.obj"), loads},
      {"obj_lamp", xml, xml_mesh("obj", "flat.obj", kAreaLight), warned, gone, 4, 1},
      {"obj_smooth", xml, xml_mesh("obj", "flat.obj", "<float name=\"max_smooth_angle\" value=\"30\"/>"),
       warned, nothing, 4, 1},
      {"obj_strict", xml, xml_mesh("obj", "flat.obj"), refused, nothing, 4, 0, false, true},
      {"ply_points", xml, xml_mesh("ply", "points.ply"), warned, nothing, 4, 1},
      {"ply_nothing", xml, xml_mesh("ply", "nothing.ply"), warned, nothing, 4, 1},
      {"ply_no_face", xml, xml_mesh("ply", "no_face.ply"), warned, nothing, 4, 1},
      {"ply_flat", xml, xml_mesh("ply", "flat.ply"), warned, "(1 degenerate triangle)", 4, 1},
      {"ply_two_corners", xml, xml_mesh("ply", "two_corners.ply"), warned, "fewer than 3 corners", 4, 1},
      {"ply_lamp", xml, xml_mesh("ply", "no_face.ply", kAreaLight), warned, gone, 4, 1},
      {"serialized_flat", xml, xml_mesh("serialized", "flat.serialized"), warned, nothing, 4, 1},
      {"serialized_no_face", xml, xml_mesh("serialized", "no_face.serialized", kAreaLight), warned, gone, 4,
       1},
      {"curves_empty", xml, xml_mesh("linearcurve", "empty.curves"), warned, nothing, 4, 1},
      {"curves_blank", xml, xml_mesh("bsplinecurve", "blank.curves"), warned, nothing, 4, 1},
      {"three_times", xml,
       xml_scene("\n<shape type=\"obj\"><string name=\"filename\" value=\"flat.obj\"/></shape>\n"
                 "<shape type=\"obj\"><string name=\"filename\" value=\"flat.obj\"/><emitter "
                 "type=\"area\"/></shape>\n"
                 "<shape type=\"obj\"><string name=\"filename\" value=\"flat.obj\"/></shape>"),
       warned, "3 shapes are left out, and the light of 1 of them is gone too", 4, 1},
      {"in_a_group", xml,
       xml_scene("<shape type=\"shapegroup\" id=\"g\">\n"
                 "<shape type=\"obj\"><string name=\"filename\" value=\"flat.obj\"/></shape></shape>\n"
                 "<shape type=\"instance\"><ref id=\"g\"/></shape>\n"
                 "<shape type=\"instance\"><ref id=\"g\"/></shape>"),
       warned, "2 shapes are left out", 4, 1},
      {"nothing_else", xml,
       "<scene version=\"3.0.0\"><sensor type=\"perspective\"/>\n<shape type=\"obj\"><string "
       "name=\"filename\" "
       "value=\"flat.obj\"/></shape></scene>",
       refused, "no shape of the scene has any area: "},
      {"pbrt_ply", pbrt, pbrt_shape("\"plymesh\" \"string filename\" \"flat.ply\""), warned, nothing, 4, 1},
      {"pbrt_ply_lamp", pbrt, pbrt_lamp("\"plymesh\" \"string filename\" \"no_face.ply\""), warned, gone, 4,
       1},
      {"pbrt_ply_power", pbrt, pbrt_lamp("\"plymesh\" \"string filename\" \"flat.ply\"", "\"float power\" 5"),
       warned, gone, 4, 1},
      {"pbrt_ply_two_sided", pbrt,
       pbrt_lamp("\"plymesh\" \"string filename\" \"nothing.ply\"", "\"bool twosided\" true"), warned, gone,
       4, 1},
      {"pbrt_flat", pbrt, pbrt_shape(flat), warned, "Shape \"trianglemesh\" " + nothing, 4, 1},
      {"pbrt_flat_lamp", pbrt, pbrt_lamp(flat), warned, gone, 4, 1},
      {"pbrt_flat_power", pbrt, pbrt_lamp(flat, "\"float power\" 5 \"bool twosided\" true"), warned, gone, 4,
       1},
      {"pbrt_bilinear", pbrt, pbrt_shape("\"bilinearmesh\" \"point3 P\" [ 0 0 0  1 0 0  2 0 0  3 0 0 ]"),
       warned, nothing, 4, 1},
      {"pbrt_loop", pbrt,
       pbrt_shape("\"loopsubdiv\" \"point3 P\" [ 0 0 0  1 0 0  2 0 0 ] \"integer indices\" [ 0 1 2 ]"),
       warned, nothing, 4, 1},
      {"pbrt_in_object", pbrt,
       pbrt_scene("ObjectBegin \"o\"\nShape " + flat + "\nObjectEnd\nObjectInstance \"o\""), warned,
       "the shape is left out", 4, 1},
      {"gltf_flat", gltf, gltf_scene("{\"attributes\": {\"POSITION\": 0}, \"indices\": 1}"), warned,
       "meshes[1].primitives[0] " + nothing + " (1 degenerate triangle): the shape \"cup\" is left out", 4,
       1},
      {"gltf_lamp", gltf,
       gltf_scene("{\"attributes\": {\"POSITION\": 0}, \"indices\": 1, \"material\": 0}",
                  "\"materials\": [{\"emissiveFactor\": [1, 1, 1]}]"),
       warned, gone, 4, 1},
      {"gltf_strip_of_two", gltf, gltf_scene("{\"attributes\": {\"POSITION\": 4}, \"mode\": 5}"), warned,
       nothing, 4, 1},
      {"gltf_two_corners", gltf, gltf_scene("{\"attributes\": {\"POSITION\": 4}}"), warned, nothing, 4, 1},
      {"gltf_points", gltf, gltf_scene("{\"attributes\": {\"POSITION\": 0}, \"mode\": 0}"), warned, "points",
       4, 0},
      {"gltf_no_positions", gltf, gltf_scene("{\"attributes\": {}}"), warned, "without positions", 4, 0},
  };
}

std::vector<LoadingCase> broken_files() {
  const auto texture = [](const std::string& file, const std::string& more = "") {
    return xml_scene("<texture type=\"bitmap\" id=\"wood\">\n<string name=\"filename\" value=\"" + file +
                     "\"/>" + more +
                     "</texture>\n<shape type=\"cube\" id=\"table\"><bsdf type=\"diffuse\">"
                     "<ref name=\"reflectance\" id=\"wood\"/></bsdf></shape>");
  };
  const auto needed = [](const std::string& name) {
    return "the picture of the texture \"wood\", which the shape \"table\" at " + name;
  };
  const auto emitter = [](const std::string& type, const std::string& file) {
    return xml_scene("\n<emitter type=\"" + type + "\"><string name=\"filename\" value=\"" + file +
                     "\"/></emitter>");
  };
  const std::string cup = "the mesh of the shape \"cup\": ";
  return {
      {"obj_far_index", xml, xml_mesh("obj", "far_index.obj"), refused,
       "far_index.obj:4: a face names vertex 9", 4},
      {"obj_zero_index", xml, xml_mesh("obj", "zero_index.obj"), refused, cup, 4},
      {"obj_nan", xml, xml_mesh("obj", "nan.obj"), refused, "nan.obj:2: a vertex is not finite", 4},
      {"obj_word", xml, xml_mesh("obj", "word.obj"), refused, "word.obj:2: 'o' is not a number", 4},
      {"obj_folder", xml, xml_mesh("obj", "folder.obj"), refused, "is a folder", 4},
      {"obj_is_ply", xml, xml_mesh("ply", "good.obj"), refused, "not a PLY", 4},
      {"ply_far_index", xml, xml_mesh("ply", "far_index.ply"), refused, "no vertex 7", 4},
      {"ply_cut", xml, xml_mesh("ply", "cut.ply"), refused, cup, 4},
      {"ply_text", xml, xml_mesh("ply", "text.ply"), refused, "not a PLY", 4},
      {"ply_empty", xml, xml_mesh("ply", "empty.ply"), refused, "does not end", 4},
      {"ply_lamp_cut", xml, xml_mesh("ply", "cut.ply", kAreaLight), refused, cup, 4},
      {"serialized_far_index", xml, xml_mesh("serialized", "far_index.serialized"), refused, "no vertex 5",
       4},
      {"serialized_cut", xml, xml_mesh("serialized", "cut.serialized"), refused, cup, 4},
      {"serialized_empty", xml, xml_mesh("serialized", "empty.serialized"), refused, "too short", 4},
      {"serialized_shape_7", xml,
       xml_mesh("serialized", "good.serialized", "<integer name=\"shape_index\" value=\"7\"/>"), refused,
       "there is no mesh 7", 4},
      {"curves_short", xml, xml_mesh("bsplinecurve", "short.curves"), refused, "has 2 points; it needs 4", 4},
      {"curves_word", xml, xml_mesh("linearcurve", "good.obj"), refused, "'v' is not a number", 4},
      {"in_a_group_cut", xml,
       xml_scene(
           "<shape type=\"shapegroup\" id=\"g\">\n<shape type=\"ply\" id=\"leaf\"><string name=\"filename\" "
           "value=\"cut.ply\"/></shape></shape>\n<shape type=\"instance\"><ref id=\"g\"/></shape>"),
       refused, "the mesh of the shape \"leaf\": ", 4},
      {"picture_empty", xml, texture("empty.png"), refused, needed(""), 3},
      {"picture_text", xml, texture("text.png"), refused, needed(""), 3},
      {"picture_cut", xml, texture("cut.png"), refused, "cut.png", 3},
      {"picture_cut_exr", xml, texture("cut.exr"), refused, needed(""), 3},
      {"picture_cut_pfm", xml, texture("cut.pfm"), refused, needed(""), 3},
      {"picture_folder", xml, texture("folder.png"), refused, "is a folder", 4},
      {"picture_nan", xml, texture("nan.pfm"), refused, "not finite", 3},
      {"picture_no_alpha", xml, texture("good.pfm", "<string name=\"channel\" value=\"a\"/>"), refused,
       "no alpha channel", 3},
      {"picture_unused", xml,
       xml_scene("<texture type=\"bitmap\"><string name=\"filename\" value=\"text.png\"/></texture>"), loads},
      {"sky_text", xml, emitter("envmap", "text.png"), refused, "text.png", 4},
      {"sky_empty", xml, emitter("envmap", "empty.exr"), refused, "empty.exr", 4},
      {"ies_cut", xml, emitter("ies", "cut.ies"), refused, "cut.ies", 4},
      {"ies_empty", xml, emitter("ies", "empty.ies"), refused, "empty.ies", 4},
      {"pbrt_ply_cut", pbrt, pbrt_shape("\"plymesh\" \"string filename\" \"cut.ply\""), refused, "cut.ply",
       4},
      {"pbrt_ply_power_cut", pbrt,
       pbrt_lamp("\"plymesh\" \"string filename\" \"cut.ply\"", "\"float power\" 5"), refused,
       "the mesh of Shape \"plymesh\": ", 4},
      {"pbrt_picture", pbrt,
       pbrt_scene(
           "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"text.png\"\nMaterial \"diffuse\" "
           "\"texture reflectance\" \"t\"\nShape \"disk\""),
       refused, "pbrt_picture.pbrt:5 needs: ", 3},
      {"pbrt_normal_map", pbrt,
       pbrt_scene("Material \"diffuse\" \"string normalmap\" \"cut.png\"\nShape \"disk\""), refused,
       "pbrt_normal_map.pbrt:4 needs: ", 3},
      {"pbrt_sky", pbrt, pbrt_scene("\nLightSource \"infinite\" \"string filename\" \"cut.exr\""), refused,
       "cut.exr", 4},
      {"pbrt_goniometric", pbrt, pbrt_scene("\nLightSource \"goniometric\" \"string filename\" \"text.png\""),
       refused, "text.png", 4},
      {"pbrt_lamp_picture", pbrt, pbrt_lamp("\"disk\"", "\"string filename\" \"text.png\""), refused,
       "text.png", 3},
      {"gltf_picture", gltf,
       gltf_scene("{\"attributes\": {\"POSITION\": 0}, \"material\": 0}",
                  "\"materials\": [{\"pbrMetallicRoughness\": {\"baseColorTexture\": {\"index\": 0}}}],\n"
                  "\"textures\": [{\"source\": 0}],\n\"images\": [{\"uri\": \"cut.png\"}]"),
       refused, "which the shape \"cup\" at ", 10},
      {"gltf_indices", gltf, gltf_scene("{\"attributes\": {\"POSITION\": 0}, \"indices\": 7}"), refused,
       "meshes[1].primitives[0].indices", 4},
      {"gltf_buffer", gltf,
       gltf_scene("{\"attributes\": {\"POSITION\": 2}}", "", "{\"byteLength\": 48, \"uri\": \"cut.png\"}"),
       refused, "buffers[1]", 5},
  };
}

}  // namespace lumirank::test
