// One scene in Mitsuba's, pbrt's and glTF's format renders to the same picture: a corner of a room with a
// lamp, a point light, matt walls and a rough metal.
#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "support/same_pictures.h"
#include "support/scene_file.h"

namespace lumirank::test {
namespace {

constexpr int kFilmWidth = 48, kFilmHeight = 36;

using Point = std::array<float, 3>;
struct NamedQuad {
  const char* name;
  Point p[4];  // counter-clockwise seen from the front
};
// The metal reflects all light at every angle, so that Fresnel's and Schlick's formulas agree.
const NamedQuad kQuads[] = {
    {"floor", {{-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2}}},
    {"wall", {{-2, 0, -2}, {2, 0, -2}, {2, 3, -2}, {-2, 3, -2}}},
    {"side", {{-2, 0, 2}, {-2, 0, -2}, {-2, 3, -2}, {-2, 3, 2}}},
    {"metal", {{0.2f, 0.1f, 0.5f}, {1.6f, 0.1f, 0.1f}, {1.5f, 1.3f, -0.5f}, {0.1f, 1.3f, -0.1f}}},
    {"lamp", {{-0.8f, 2.8f, -0.6f}, {0.2f, 2.8f, -0.6f}, {0.2f, 2.8f, 0.2f}, {-0.8f, 2.8f, 0.2f}}},
};
const Point kColors[] = {{0.7f, 0.6f, 0.5f}, {0.2f, 0.4f, 0.7f}, {0.7f, 0.2f, 0.1f}};

std::string text(const Point& p) {
  return std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]);
}

std::string mitsuba_file(const TemporaryFolder& folder) {
  std::string xml =
      "<scene version=\"3.0.0\"><sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/>"
      "<string name=\"fov_axis\" value=\"y\"/><transform name=\"to_world\">"
      "<lookat origin=\"1, 1.6, 5\" target=\"0, 1.3, 0\" up=\"0, 1, 0\"/></transform>"
      "<film type=\"hdrfilm\"><integer name=\"width\" value=\"48\"/><integer name=\"height\" value=\"36\"/>"
      "<rfilter type=\"box\"/></film></sensor>"
      "<emitter type=\"point\"><point name=\"position\" x=\"1.5\" y=\"2.5\" z=\"1\"/>"
      "<rgb name=\"intensity\" value=\"2, 1, 0.5\"/></emitter>";
  for (std::size_t k = 0; k < 5; ++k) {
    const std::string ply = std::string(kQuads[k].name) + ".ply";
    std::ofstream out(folder / ply);
    out << "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
    for (const Point& p : kQuads[k].p) out << text(p) << "\n";
    out << "3 0 1 2\n3 0 2 3\n";
    xml += "<shape type=\"ply\"><string name=\"filename\" value=\"" + ply + "\"/>";
    if (k < 3)
      xml += "<bsdf type=\"twosided\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"" +
             text(kColors[k]) + "\"/></bsdf></bsdf>";
    else if (k == 3)
      xml +=
          "<bsdf type=\"twosided\"><bsdf type=\"roughconductor\"><string name=\"material\" value=\"none\"/>"
          "<string name=\"distribution\" value=\"ggx\"/><float name=\"alpha\" value=\"0.04\"/></bsdf></bsdf>";
    else
      xml += "<emitter type=\"area\"><rgb name=\"radiance\" value=\"9, 8, 6\"/></emitter>";
    xml += "</shape>";
  }
  std::ofstream(folder / "scene.xml") << xml << "</scene>";
  return folder / "scene.xml";
}

std::string pbrt_file(const TemporaryFolder& folder) {
  std::string s =
      "Scale -1 1 1\nLookAt 1 1.6 5  0 1.3 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\n"
      "Film \"rgb\" \"integer xresolution\" 48 \"integer yresolution\" 36\nPixelFilter \"box\"\nWorldBegin\n"
      "LightSource \"point\" \"point3 from\" [ 1.5 2.5 1 ] \"rgb I\" [ 2 1 0.5 ]\n";
  for (std::size_t k = 0; k < 5; ++k) {
    s += "AttributeBegin\n";
    if (k < 3)
      s += "Material \"diffuse\" \"rgb reflectance\" [ " + text(kColors[k]) + " ]\n";
    else if (k == 3)
      s += "Material \"conductor\" \"bool remaproughness\" false \"float roughness\" 0.04 \"rgb eta\" [ 0 0 "
           "0 ] "
           "\"rgb k\" [ 1 1 1 ]\n";
    else
      s += "Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\nAreaLightSource \"diffuse\" \"rgb L\" [ 9 8 "
           "6 ]\n";
    s += "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 0 2 3 ] \"point3 P\" [";
    for (const Point& p : kQuads[k].p) s += " " + text(p);
    s += " ]\nAttributeEnd\n";
  }
  std::ofstream(folder / "scene.pbrt") << s;
  return folder / "scene.pbrt";
}

std::string gltf_file(const TemporaryFolder& folder) {
  std::string buffer, accessors, meshes, nodes, list;
  const std::uint16_t corners[6] = {0, 1, 2, 0, 2, 3};
  buffer.append(reinterpret_cast<const char*>(corners), 12);
  std::string views = "{\"buffer\":0,\"byteLength\":12}";
  accessors = "{\"bufferView\":0,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}";
  for (int k = 0; k < 5; ++k) {
    Point min = kQuads[k].p[0], max = min;
    for (const Point& p : kQuads[k].p)
      for (std::size_t a = 0; a < 3; ++a) min[a] = std::min(min[a], p[a]), max[a] = std::max(max[a], p[a]);
    const auto numbers = [](const Point& p) {
      char out[96];
      std::snprintf(out, sizeof out, "[%.9g,%.9g,%.9g]", double{p[0]}, double{p[1]}, double{p[2]});
      return std::string(out);
    };
    const std::string index = std::to_string(k), next = std::to_string(k + 1);
    views += ",{\"buffer\":0,\"byteOffset\":" + std::to_string(buffer.size()) + ",\"byteLength\":48}";
    buffer.append(reinterpret_cast<const char*>(kQuads[k].p), 48);
    accessors += ",{\"bufferView\":" + next +
                 ",\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"min\":" + numbers(min) +
                 ",\"max\":" + numbers(max) + "}";
    meshes += std::string(k ? "," : "") + "{\"primitives\":[{\"attributes\":{\"POSITION\":" + next +
              "},\"indices\":0,\"material\":" + index + "}]}";
    nodes += "{\"mesh\":" + index + "},";
    list += index + ",";
  }
  const auto matt = [](const Point& c) {
    return "{\"doubleSided\":true,\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"baseColorFactor\":[" +
           std::to_string(c[0]) + "," + std::to_string(c[1]) + "," + std::to_string(c[2]) +
           ",1]},\"extensions\":{\"KHR_materials_specular\":{\"specularFactor\":0}}},";
  };
  const std::string materials =
      matt(kColors[0]) + matt(kColors[1]) + matt(kColors[2]) +
      "{\"doubleSided\":true,\"pbrMetallicRoughness\":{\"metallicFactor\":1,\"roughnessFactor\":0.2}},"
      "{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"baseColorFactor\":[0,0,0,1]},"
      "\"emissiveFactor\":[1,0.88888889,0.66666667],\"extensions\":{\"KHR_materials_specular\":"
      "{\"specularFactor\":0},\"KHR_materials_emissive_strength\":{\"emissiveStrength\":9}}}";
  // The camera looks along its -z: right, up and back of the view, then its place.
  const double f[3] = {-1, -0.3, -5}, size = std::sqrt(1 + 0.09 + 25), flat = std::hypot(1.0, 5.0);
  const double back[3] = {-f[0] / size, -f[1] / size, -f[2] / size};
  const double right[3] = {5 / flat, 0, -1 / flat};
  const double up[3] = {back[1] * right[2] - back[2] * right[1], back[2] * right[0] - back[0] * right[2],
                        back[0] * right[1] - back[1] * right[0]};
  std::string matrix;
  for (const double* column : {right, up, back}) {
    for (int a = 0; a < 3; ++a) matrix += std::to_string(column[a]) + ",";
    matrix += "0,";
  }
  std::ofstream(folder / "scene.bin", std::ios::binary) << buffer;
  std::ofstream(folder / "scene.gltf")
      << "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_materials_specular\","
         "\"KHR_materials_emissive_strength\",\"KHR_lights_punctual\"],"
         "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\",\"color\":[1,0.5,0.25],"
         "\"intensity\":2}]}},\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.698131701,"
         "\"aspectRatio\":1.33333333,\"znear\":0.01}}],\"scene\":0,\"scenes\":[{\"nodes\":["
      << list << "5,6]}],\"nodes\":[" << nodes << "{\"camera\":0,\"matrix\":[" << matrix
      << "1,1.6,5,1]},{\"translation\":[1.5,2.5,1],\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}],"
         "\"meshes\":["
      << meshes << "],\"materials\":[" << materials << "],\"accessors\":[" << accessors
      << "],\"bufferViews\":[" << views
      << "],\"buffers\":[{\"uri\":\"scene.bin\",\"byteLength\":" << buffer.size() << "}]}";
  return folder / "scene.gltf";
}

std::vector<float> picture(const std::string& file, std::uint64_t seed) {
  LoadOptions strict;
  strict.strict = true;  // nothing is replaced or left out
  RenderSettings settings;
  settings.traced.rest = RestOfPaths::skip;
  settings.view.width = kFilmWidth, settings.view.height = kFilmHeight;
  settings.view.max_depth = 5;
  settings.seed = seed;
  ReferenceSettings how;
  how.spp = 96;
  return reference(Scene::load(file, strict), settings, how).picture.planes.at(0).rgb;
}

TEST(ThreeFormats, OneSceneGivesTheSamePicture) {
  const TemporaryFolder folder;
  const auto mitsuba = picture(mitsuba_file(folder), 1), pbrt = picture(pbrt_file(folder), 2),
             gltf = picture(gltf_file(folder), 3);
  // 10⁻⁴ is left to numbers with six decimals. A lamp twice as bright, a color or a place mixed up would be
  // seen.
  const SamePictures how{
      .width = kFilmWidth, .height = kFilmHeight, .pairs = 3, .slack = 1e-4, .noise_below = 0.35};
  expect_same_pictures(mitsuba, pbrt, how, "mitsuba and pbrt");
  expect_same_pictures(mitsuba, gltf, how, "mitsuba and glTF");
  expect_same_pictures(pbrt, gltf, how, "pbrt and glTF");
}

}  // namespace
}  // namespace lumirank::test
