// What doubles itself, or goes on without end; and what pbrt reads of textures.
#include "world/loading_corpus.h"

namespace lumirank::test {

namespace {

using enum LoadingCase::Format;
using enum LoadingCase::Outcome;

// `levels` lines from line 3 on: of each the text `make` returns of the name of the one before and its own.
template <typename Make>
std::string doubling(int levels, Make make) {
  std::string out;
  for (int k = 1; k <= levels; ++k) out += make("m" + std::to_string(k - 1), "m" + std::to_string(k)) + "\n";
  return out;
}

std::string bsdf_text(const std::string& type, const std::string& id, const std::string& inner) {
  return "<bsdf type=\"" + type + "\" id=\"" + id + "\">" + inner + "</bsdf>";
}
std::string named_ref(const std::string& id, const std::string& name = "") {
  return "<ref " + (name.empty() ? "" : "name=\"" + name + "\" ") + "id=\"" + id + "\"/>";
}

}  // namespace

std::vector<LoadingCase> nested_without_end() {
  const std::string m0 = bsdf_text("diffuse", "m0", "");
  const auto use = [](int level) {
    return "<shape type=\"cube\">" + named_ref("m" + std::to_string(level)) + "</shape>";
  };
  const auto blend = [](const std::string& a, const std::string& b) {
    return bsdf_text("blendbsdf", b, "<float name=\"weight\" value=\"0.5\"/>" + named_ref(a) + named_ref(a));
  };
  // Every second level is a blend, the others are wrapped.
  const auto wrapped = [&](const std::string& type, const std::string& property = "") {
    return [=](const std::string& a, const std::string& b) {
      return bsdf_text(
          type, b,
          property + bsdf_text("blendbsdf", "in" + b,
                               "<float name=\"weight\" value=\"0.5\"/>" + named_ref(a) + named_ref(a)));
    };
  };
  const auto chain = [&](const std::string& type, const std::string& property = "") {
    return [=](const std::string& a, const std::string& b) {
      return bsdf_text(type, b, property + named_ref(a));
    };
  };
  const std::string more = "is made of itself or of more than 64 others";
  const std::string picture = "<texture type=\"checkerboard\"/>";
  const auto mix = [](const std::string& a, const std::string& b) {
    return "MakeNamedMaterial \"" + b + "\" \"string type\" \"mix\" \"string materials\" [ \"" + a + "\" \"" +
           a + "\" ]";
  };
  const std::string p0 = "MakeNamedMaterial \"m0\" \"string type\" \"diffuse\"\n";
  const auto texture = [](const std::string& kind, const std::string& one, const std::string& two) {
    return [=](const std::string& a, const std::string& b) {
      return "Texture \"" + b + "\" \"float\" \"" + kind + "\" \"texture " + one + "\" \"" + a +
             "\" \"texture " + two + "\" \"" + a + "\"";
    };
  };
  const std::string t0 = "Texture \"m0\" \"float\" \"checkerboard\"\n";
  std::string weights = "1", parts = named_ref("m0");
  for (int k = 0; k < 99; ++k) weights += " 1", parts += named_ref("m0");
  return {
      {"blend_3", xml, xml_scene(m0 + "\n" + doubling(3, blend) + use(3)), loads},
      {"blend_6", xml, xml_scene(m0 + "\n" + doubling(6, blend) + use(6)), loads},
      {"blend_7", xml, xml_scene(m0 + "\n" + doubling(7, blend) + use(7)), refused, "\"m7\" " + more, 10},
      {"blend_16", xml, xml_scene(m0 + "\n" + doubling(16, blend) + use(16)), refused, more, 10},
      {"blend_40", xml, xml_scene(m0 + "\n" + doubling(40, blend) + use(40)), refused, more, 10},
      {"blend_40_unused", xml, xml_scene(m0 + "\n" + doubling(40, blend)), refused, more, 10},
      {"mask_40", xml, xml_scene(m0 + "\n" + doubling(40, wrapped("mask")) + use(40)), refused, more, 10},
      {"twosided_40", xml, xml_scene(m0 + "\n" + doubling(40, wrapped("twosided")) + use(40)), refused, more,
       10},
      {"coating_40", xml, xml_scene(m0 + "\n" + doubling(40, wrapped("coating")) + use(40)), refused, more,
       10},
      {"bump_40", xml, xml_scene(m0 + "\n" + doubling(40, wrapped("bumpmap", picture)) + use(40)), refused,
       more, 10},
      {"normal_map_40", xml, xml_scene(m0 + "\n" + doubling(40, wrapped("normalmap", picture)) + use(40)),
       refused, more, 10},
      {"mixture_100", xml,
       xml_scene(
           m0 + "\n" +
           bsdf_text("mixturebsdf", "m1", "<string name=\"weights\" value=\"" + weights + "\"/>" + parts) +
           use(1)),
       refused, more, 4},
      {"two_sides_30", xml,
       xml_scene(m0 + "\n" +
                 doubling(30,
                          [](const std::string& a, const std::string& b) {
                            return bsdf_text("twosided", b, named_ref(a) + named_ref(a));
                          }) +
                 use(30)),
       loads},
      {"mask_chain_60", xml, xml_scene(m0 + "\n" + doubling(60, chain("mask")) + use(60)), loads},
      {"mask_chain_200", xml, xml_scene(m0 + "\n" + doubling(200, chain("mask")) + use(200)), refused,
       "in each other", 103},
      {"bump_chain_90", xml, xml_scene(m0 + "\n" + doubling(90, chain("bumpmap", picture)) + use(90)), loads},
      {"blend_itself", xml,
       xml_scene(bsdf_text("blendbsdf", "m1",
                           "<float name=\"weight\" value=\"0.5\"/>" + named_ref("m1") + named_ref("m1"))),
       refused, "refers to itself", 3},
      {"scaled_chain_40", xml,
       xml_scene(
           "<texture type=\"bitmap\" id=\"m0\"><string name=\"filename\" value=\"good.pfm\"/></texture>\n" +
           doubling(40,
                    [](const std::string& a, const std::string& b) {
                      return "<texture type=\"scale\" id=\"" + b +
                             "\"><float name=\"scale\" value=\"0.9\"/>" + named_ref(a) + "</texture>";
                    }) +
           "<shape type=\"cube\"><bsdf type=\"diffuse\">" + named_ref("m40", "reflectance") +
           "</bsdf></shape>"),
       loads},
      {"checkerboards_40", xml,
       xml_scene("<texture type=\"checkerboard\" id=\"m0\"/>\n" +
                 doubling(40,
                          [](const std::string& a, const std::string& b) {
                            return "<texture type=\"checkerboard\" id=\"" + b + "\">" +
                                   named_ref(a, "color0") + named_ref(a, "color1") + "</texture>";
                          }) +
                 "<shape type=\"cube\"><bsdf type=\"diffuse\">" + named_ref("m40", "reflectance") +
                 "</bsdf><emitter type=\"area\">" + named_ref("m40", "radiance") + "</emitter></shape>"),
       loads},
      {"pbrt_mix_5", pbrt, pbrt_scene(p0 + doubling(5, mix) + "NamedMaterial \"m5\" Shape \"disk\""), loads},
      {"pbrt_mix_30", pbrt, pbrt_scene(p0 + doubling(30, mix) + "NamedMaterial \"m30\" Shape \"disk\""),
       refused, "more than 64 materials"},
      {"pbrt_scale_30", pbrt, pbrt_scene(t0 + doubling(30, texture("scale", "tex", "scale"))), refused,
       "more than 1,000 others"},
      {"pbrt_mix_texture_30", pbrt, pbrt_scene(t0 + doubling(30, texture("mix", "tex1", "tex2"))), refused,
       "more than 1,000 others"},
      {"pbrt_amount_30", pbrt, pbrt_scene(t0 + doubling(30, texture("mix", "tex1", "amount"))), refused,
       "more than 1,000 others"},
      {"pbrt_checkerboard_30", pbrt,
       pbrt_scene(t0 + doubling(30, texture("checkerboard", "tex1", "tex2")) +
                  "Shape \"disk\" \"texture alpha\" \"m30\""),
       loads},
      {"instances", pbrt,
       pbrt_scene("ObjectBegin \"o\"\n" +
                  doubling(3000, [](const std::string&,
                                    const std::string&) { return std::string("Shape \"disk\""); }) +
                  "ObjectEnd\n" +
                  doubling(3000, [](const std::string&,
                                    const std::string&) { return std::string("ObjectInstance \"o\""); })),
       refused, "more than 8 million shapes"},
      {"gltf_instances", gltf,
       gltf_scene("{\"attributes\": {\"POSITION\": 0}}")
           .replace(gltf_scene("").find("\"mesh\": 1, "), 10,
                    "\"mesh\": 1, \"extensions\": {\"EXT_mesh_gpu_instancing\": {\"attributes\": "
                    "{\"TRANSLATION\": 3}}},"),
       refused, "larger than 2 GiB", 2},
  };
}

std::vector<LoadingCase> odd_scenes() {
  // A disk whose reflectance is the spectrum texture "s" of that text on line 4; "f" is a float texture,
  // "c" one of colors.
  const auto textured = [](const std::string& text) {
    return pbrt_scene(
        "Texture \"f\" \"float\" \"checkerboard\" Texture \"c\" \"spectrum\" \"checkerboard\"\n"
        "Texture \"s\" \"spectrum\" " +
        text + "\nMaterial \"diffuse\" \"texture reflectance\" \"s\" Shape \"disk\"");
  };
  const auto number = [](const std::string& text) {
    return pbrt_scene(
        "Texture \"f\" \"float\" \"checkerboard\" Texture \"c\" \"spectrum\" \"checkerboard\"\n"
        "Texture \"s\" \"float\" " +
        text + "\nMaterial \"coateddiffuse\" \"texture roughness\" \"s\" Shape \"disk\"");
  };
  const auto cube = [](const std::string& more) {
    return xml_scene("\n<shape type=\"cube\">" + more + "</shape>");
  };
  const auto place = [&](const std::string& step) {
    return cube("<transform name=\"to_world\">" + step + "</transform>");
  };
  return {
      {"scale_float", pbrt, textured("\"scale\" \"texture tex\" \"c\" \"float scale\" 0.5"), loads},
      {"scale_float_texture", pbrt, textured("\"scale\" \"texture tex\" \"c\" \"texture scale\" \"f\""),
       loads},
      {"scale_rgb", pbrt, textured("\"scale\" \"texture tex\" \"c\" \"rgb scale\" [ 1 0 0 ]"), loads},
      {"scale_color_texture", pbrt, textured("\"scale\" \"texture tex\" \"c\" \"texture scale\" \"c\""),
       loads},
      {"scale_rgb_by_float", pbrt, textured("\"scale\" \"rgb tex\" [ .5 .5 1 ] \"float scale\" 0.5"), loads},
      {"scale_rgb_by_texture", pbrt, textured("\"scale\" \"rgb tex\" [ .5 .5 1 ] \"texture scale\" \"f\""),
       loads},
      {"scale_float_by_texture", pbrt, textured("\"scale\" \"float tex\" 0.5 \"texture scale\" \"f\""),
       loads},
      {"scale_of_nothing", pbrt, textured("\"scale\""), loads},
      {"scale_negative", pbrt, textured("\"scale\" \"texture tex\" \"c\" \"float scale\" -1"), refused,
       "\"scale\" of Texture \"scale\" is negative", 4},
      {"scale_undefined", pbrt, textured("\"scale\" \"texture tex\" \"c\" \"texture scale\" \"x\""), refused,
       "is the texture \"x\", which is not defined", 4},
      {"scale_tex_is_float", pbrt, textured("\"scale\" \"texture tex\" \"f\""), refused,
       "it is a float texture", 4},
      {"scale_text", pbrt, textured("\"scale\" \"texture tex\" \"c\" \"string scale\" \"f\""), refused,
       "a color is needed", 4},
      {"mix_amount_float", pbrt, textured("\"mix\" \"texture tex1\" \"c\" \"float amount\" 0.5"), loads},
      {"mix_amount_texture", pbrt, textured("\"mix\" \"texture tex1\" \"c\" \"texture amount\" \"f\""),
       loads},
      {"mix_floats", pbrt, textured("\"mix\" \"float tex1\" 0 \"float tex2\" 1 \"texture amount\" \"f\""),
       loads},
      {"mix_amount_color", pbrt, textured("\"mix\" \"texture amount\" \"c\""), refused,
       "it is a spectrum texture", 4},
      {"constant_float", pbrt, textured("\"constant\" \"float value\" 0.5"), loads},
      {"constant_rgb", pbrt, textured("\"constant\" \"rgb value\" [ 1 0 0 ]"), loads},
      {"checkerboard_floats", pbrt, textured("\"checkerboard\" \"float tex1\" 0.1 \"float tex2\" 0.9"),
       loads},
      {"checkerboard_mixed", pbrt, textured("\"checkerboard\" \"texture tex1\" \"c\" \"float tex2\" 0.9"),
       loads},
      {"imagemap_float", pbrt, number("\"imagemap\" \"string filename\" \"good.pfm\""), loads},
      {"imagemap_scaled", pbrt, number("\"imagemap\" \"string filename\" \"good.pfm\" \"float scale\" 0.1"),
       loads},
      {"imagemap_both", pbrt,
       textured(
           "\"imagemap\" \"string filename\" \"good.pfm\"\nTexture \"s\" \"float\" \"imagemap\" \"string "
           "filename\" \"good.pfm\""),
       loads},
      {"float_scaled", pbrt, number("\"scale\" \"texture tex\" \"f\" \"float scale\" 0.5"), loads},
      {"float_scaled_by_color", pbrt, number("\"scale\" \"texture tex\" \"f\" \"texture scale\" \"c\""),
       refused, "it is a spectrum texture", 4},
      {"float_rgb", pbrt, number("\"constant\" \"rgb value\" [ 1 0 0 ]"), refused, "\"value\"", 4},
      {"far_away", xml, place("<translate x=\"1e38\"/><scale value=\"10\"/>"), refused, "", 4},
      {"flat_place", xml, place("<scale x=\"0\"/>"), refused, "is singular", 4},
      {"matrix_of_nothing", xml, place("<matrix value=\"0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\"/>"), refused, "",
       4},
      {"huge_sphere", xml,
       xml_scene("\n<shape type=\"sphere\"><float name=\"radius\" value=\"1e39\"/></shape>"), refused, "", 4},
      {"no_name", xml, xml_scene("\n<shape type=\"obj\"><string name=\"filename\" value=\"\"/></shape>"),
       refused, "is a folder", 4},
      {"group_of_itself", xml,
       xml_scene(
           "<shape type=\"shapegroup\" id=\"g\">\n<shape type=\"instance\"><ref id=\"g\"/></shape></shape>"),
       refused, "", 4},
      {"instance_of_cube", xml,
       xml_scene("<shape type=\"cube\" id=\"c\"/>\n<shape type=\"instance\"><ref id=\"c\"/></shape>"),
       refused, "not a shapegroup", 4},
      {"unknown_shape", xml, xml_scene("\n<shape type=\"teapot\"/>"), warned, "teapot", 4},
      {"unknown_bsdf", xml, cube("<bsdf type=\"velvet\"/>"), warned, "velvet", 4},
      {"texture_of_bsdf", xml,
       cube("<bsdf type=\"diffuse\"><bsdf type=\"diffuse\" name=\"reflectance\"/></bsdf>"), refused,
       "a color or a texture", 4},
      {"pbrt_empty_object", pbrt, pbrt_scene("ObjectBegin \"o\" ObjectEnd\nObjectInstance \"o\""), loads},
      {"pbrt_own_instance", pbrt, pbrt_scene("ObjectBegin \"o\"\nObjectInstance \"o\"\nObjectEnd"), refused,
       "objects cannot hold instances", 4},
      {"pbrt_sphere_of_nothing", pbrt, pbrt_scene("\nShape \"sphere\" \"float radius\" 0"), refused,
       "not positive", 4},
      {"gltf_mesh_of_nothing", gltf, gltf_scene(""), loads},
  };
}

}  // namespace lumirank::test
