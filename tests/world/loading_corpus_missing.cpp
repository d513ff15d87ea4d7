// Files that do not exist: an error with the way out, or a stand-in.
#include "world/loading_corpus.h"

namespace lumirank::test {

namespace {

using enum LoadingCase::Format;
using enum LoadingCase::Outcome;

// Every case twice: refused without --allow-missing, with the way out in the message; warned of with it.
void add_missing(std::vector<LoadingCase>& cases, const char* name, const char* strict_name,
                 LoadingCase::Format format, const std::string& text, const std::string& says, int line,
                 std::size_t left_out = 0) {
  cases.push_back({strict_name, format, text, refused, "--allow-missing", line});
  cases.push_back({name, format, text, warned, says, line, left_out, true});
}

}  // namespace

std::vector<LoadingCase> missing_files() {
  const auto shape = [](const std::string& type, const std::string& more = "") {
    return xml_scene("\n<shape type=\"" + type +
                     "\" id=\"cup\"><string name=\"filename\" value=\"absent\"/>" + more + "</shape>");
  };
  const auto bsdf = [](const std::string& inner) {
    return xml_scene("<shape type=\"cube\"><bsdf type=\"" + inner + "</bsdf></shape>");
  };
  const auto picture = [](const std::string& name) {
    return "\n<texture type=\"bitmap\" name=\"" + name +
           "\"><string name=\"filename\" value=\"absent.png\"/></texture>\n";
  };
  const std::string squares = "squares of magenta and gray";
  std::vector<LoadingCase> cases;
  add_missing(cases, "obj", "obj_refused", xml, shape("obj"), "mesh file not found: ", 4, 1);
  add_missing(cases, "ply", "ply_refused", xml, shape("ply"), "mesh file not found: ", 4, 1);
  add_missing(cases, "serialized", "serialized_refused", xml, shape("serialized"), "mesh file not found: ", 4,
              1);
  add_missing(cases, "curves", "curves_refused", xml, shape("bsplinecurve"), "curve file not found: ", 4, 1);
  add_missing(cases, "hair", "hair_refused", xml, shape("hair"), "curve file not found: ", 4, 1);
  add_missing(cases, "lamp", "lamp_refused", xml, shape("obj", "<emitter type=\"area\"/>"),
              "is missing: the shape \"cup\" is left out, and its light is gone too", 4, 1);
  add_missing(cases, "color", "color_refused", xml, bsdf("diffuse\">" + picture("reflectance")), squares, 4);
  add_missing(cases, "roughness", "roughness_refused", xml, bsdf("roughconductor\">" + picture("alpha")),
              squares, 4);
  add_missing(cases, "measured", "measured_refused", xml,
              bsdf("merl\">\n<string name=\"filename\" value=\"absent\"/>"), "BRDF table not found: ", 4);
  cases.push_back({"cut_table", xml, bsdf("merl\">\n<string name=\"filename\" value=\"cut.binary\"/>"),
                   refused, "ends within its header", 3});
  add_missing(cases, "opacity", "opacity_refused", xml,
              bsdf("mask\">" + picture("opacity") + "<bsdf type=\"diffuse\"/>"), squares, 4);
  add_missing(cases, "bump", "bump_refused", xml,
              bsdf("bumpmap\">" + picture("map") + "<bsdf type=\"diffuse\"/>"), squares, 4);
  add_missing(cases, "normal_map", "normal_map_refused", xml,
              bsdf("normalmap\">" + picture("normalmap") + "<bsdf type=\"diffuse\"/>"), squares, 4);
  add_missing(cases, "blend", "blend_refused", xml,
              bsdf("blendbsdf\">" + picture("weight") + "<bsdf type=\"diffuse\"/><bsdf type=\"diffuse\"/>"),
              squares, 4);
  add_missing(
      cases, "bright_picture", "bright_picture_refused", xml,
      xml_scene("<shape type=\"disk\"><emitter type=\"area\">" + picture("radiance") + "</emitter></shape>"),
      squares, 4);
  add_missing(
      cases, "sky", "sky_refused", xml,
      xml_scene("\n<emitter type=\"envmap\"><string name=\"filename\" value=\"absent.exr\"/></emitter>"),
      "a gray sky", 4);
  add_missing(cases, "ies", "ies_refused", xml,
              xml_scene("\n<emitter type=\"ies\"><string name=\"filename\" value=\"absent.ies\"/></emitter>"),
              "IES profile not found: ", 4);
  add_missing(cases, "pbrt_ply", "pbrt_ply_refused", pbrt,
              pbrt_scene("\nShape \"plymesh\" \"string filename\" \"absent.ply\""),
              "mesh file not found: ", 4, 1);
  add_missing(
      cases, "pbrt_lamp", "pbrt_lamp_refused", pbrt,
      pbrt_scene("AreaLightSource \"diffuse\" \"float power\" 5 \"bool twosided\" true\nShape \"plymesh\" "
                 "\"string filename\" \"absent.ply\""),
      "its light is gone too", 4, 1);
  add_missing(
      cases, "pbrt_picture", "pbrt_picture_refused", pbrt,
      pbrt_scene(
          "\nTexture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"absent.png\" \"bool invert\" "
          "true\nMaterial \"diffuse\" \"texture reflectance\" \"t\" Shape \"disk\""),
      squares, 4);
  add_missing(cases, "pbrt_alpha", "pbrt_alpha_refused", pbrt,
              pbrt_scene("\nTexture \"t\" \"float\" \"imagemap\" \"string filename\" \"absent.png\"\n"
                         "Shape \"disk\" \"texture alpha\" \"t\""),
              squares, 4);
  add_missing(cases, "pbrt_normal_map", "pbrt_normal_map_refused", pbrt,
              pbrt_scene("\nMaterial \"diffuse\" \"string normalmap\" \"absent.png\" Shape \"disk\""),
              "the surface without it", 4);
  add_missing(
      cases, "pbrt_sky", "pbrt_sky_refused", pbrt,
      pbrt_scene("\nLightSource \"infinite\" \"string filename\" \"absent.exr\" \"float illuminance\" 9"),
      "a gray sky", 4);
  add_missing(
      cases, "pbrt_goniometric", "pbrt_goniometric_refused", pbrt,
      pbrt_scene("\nLightSource \"goniometric\" \"string filename\" \"absent.exr\" \"float power\" 9"),
      "the same intensity in all directions", 4);
  add_missing(cases, "pbrt_lamp_picture", "pbrt_lamp_picture_refused", pbrt,
              pbrt_scene("\nAreaLightSource \"diffuse\" \"string filename\" \"absent.png\"\nShape \"disk\""),
              squares, 4);
  const std::string textured = "{\"attributes\": {\"POSITION\": 0}, \"material\": 0}";
  const std::string material =
      "\"materials\": [{\"alphaMode\": \"BLEND\", \"normalTexture\": {\"index\": 0}, "
      "\"pbrMetallicRoughness\": "
      "{\"baseColorTexture\": {\"index\": 0}, \"metallicRoughnessTexture\": {\"index\": "
      "0}}}],\n\"textures\": "
      "[{\"source\": 0}],\n";
  add_missing(cases, "gltf_picture", "gltf_picture_refused", gltf,
              gltf_scene(textured, material + "\"images\": [{\"uri\": \"absent.png\"}]"), squares, 11);
  add_missing(
      cases, "gltf_buffer", "gltf_buffer_refused", gltf,
      gltf_scene("{\"attributes\": {\"POSITION\": 2}}", "", "{\"byteLength\": 48, \"uri\": \"absent.bin\"}"),
      "absent.bin, which does not exist", 5, 1);
  add_missing(
      cases, "gltf_picture_in_buffer", "gltf_picture_in_buffer_refused", gltf,
      gltf_scene(textured, material + "\"images\": [{\"bufferView\": 2, \"mimeType\": \"image/png\"}]",
                 "{\"byteLength\": 48, \"uri\": \"absent.bin\"}"),
      squares, 0);
  cases.push_back({"gltf_picture_from_afar", gltf,
                   gltf_scene(textured, material + "\"images\": [{\"uri\": \"http://host/a.png\"}]"), warned,
                   "images[0].uri is not a file name", 11, 0, true});
  cases.push_back({"gltf_buffer_from_afar", gltf,
                   gltf_scene("{\"attributes\": {\"POSITION\": 2}}", "",
                              "{\"byteLength\": 48, \"uri\": \"http://host/a.bin\"}"),
                   warned, "buffers[1].uri is not a file name", 5, 1, true});
  // What nothing can stand in for stays an error.
  cases.push_back(
      {"include", xml, xml_scene("\n<include filename=\"absent.xml\"/>"), refused, "absent.xml", 4, 0, true});
  cases.push_back(
      {"pbrt_include", pbrt, pbrt_scene("\nInclude \"absent.pbrt\""), refused, "absent.pbrt", 4, 0, true});
  cases.push_back(
      {"folder", xml,
       xml_scene("\n<shape type=\"obj\"><string name=\"filename\" value=\"folder.obj\"/></shape>"), refused,
       "is a folder", 4, 0, true});
  cases.push_back({"strict", xml, shape("obj"), refused, "mesh file not found: ", 4, 0, true, true});
  cases.push_back({"nothing_else", xml,
                   "<scene version=\"3.0.0\"><sensor type=\"perspective\"/>\n<shape type=\"obj\"><string "
                   "name=\"filename\" value=\"absent\"/></shape></scene>",
                   refused, "no shape of the scene has any area", 0, 0, true});
  return cases;
}

}  // namespace lumirank::test
