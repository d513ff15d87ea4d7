// KHR_draco_mesh_compression, decoded by Draco.
#include <draco/compression/decode.h>

#include "scenedesc/gltf/reader.h"

namespace lumirank::scenedesc::gltf {
namespace {

std::vector<float> values_of(const draco::PointAttribute& attribute, std::size_t points, int components,
                             const Element& user) {
  std::vector<float> out(points * static_cast<std::size_t>(components));
  for (std::size_t p = 0; p < points; ++p) {
    const draco::AttributeValueIndex at =
        attribute.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(p)));
    if (at.value() >= attribute.size() ||
        !attribute.ConvertValue<float>(at, static_cast<std::int8_t>(components),
                                       &out[p * static_cast<std::size_t>(components)]))
      user.fail("has an attribute that cannot be read", "the file is damaged: export it again");
  }
  return out;
}

}  // namespace

void Reader::decode_draco(const Element& primitive, const Element& extension, int uv_set, MeshData& mesh) {
  const Element view = extension.at("bufferView"), attributes = extension.at("attributes");
  const std::string_view packed = buffers_.view(view.integer(0, kMaxBytes), view).bytes;
  const Element stated = primitive.at("attributes");
  const std::size_t vertices = accessors_.count(stated.at("POSITION"));
  // Draco takes memory by the counts in its own header; what glTF says of them comes first.
  buffers_.budget().take(64.0 * static_cast<double>(vertices), extension);
  draco::DecoderBuffer buffer;
  buffer.Init(packed.data(), packed.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok())
    extension.fail("cannot be decoded: " + decoded.status().error_msg_string(),
                   "the file is damaged: export it again");
  const std::unique_ptr<draco::Mesh> source = std::move(decoded).value();
  const std::size_t points = source->num_points();
  if (points != vertices)
    extension.fail(
        "holds " + std::to_string(points) + " vertices, and the accessor says " + std::to_string(vertices),
        "export the file again");
  const auto read = [&](const std::string& name, int components) {
    const auto id = attributes.find(name);
    if (!id) return std::vector<float>();
    const auto* attribute =
        source->GetAttributeByUniqueId(static_cast<std::uint32_t>(id->integer(0, 0x7fffffff)));
    if (!attribute)
      id->fail("names an attribute that the compressed mesh does not have", "export the file again");
    if (attribute->num_components() < components)
      id->fail("names an attribute of " + std::to_string(attribute->num_components()) + " components",
               "it must have " + std::to_string(components));
    return values_of(*attribute, points, components, extension);
  };
  const auto vectors = [&](const std::string& name) {
    const std::vector<float> v = read(name, 3);
    std::vector<Vec3f> out;
    for (std::size_t k = 0; k + 2 < v.size(); k += 3) out.push_back({v[k], v[k + 1], v[k + 2]});
    return out;
  };
  mesh.positions = vectors("POSITION");
  if (mesh.positions.empty()) attributes.fail("lacks \"POSITION\"", "export the file again");
  mesh.normals = vectors("NORMAL");
  for (const Vec3f& c : vectors("COLOR_0")) mesh.colors.push_back({c.x, c.y, c.z});
  const std::vector<float> uvs = read("TEXCOORD_" + std::to_string(uv_set), 2);
  for (std::size_t k = 0; k + 1 < uvs.size(); k += 2) mesh.uvs.push_back({uvs[k], uvs[k + 1]});
  for (std::uint32_t f = 0; f < source->num_faces(); ++f)
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t corner = source->face(draco::FaceIndex(f))[static_cast<std::size_t>(c)].value();
      if (corner >= points)
        extension.fail("has a face beyond its vertices", "the file is damaged: export it again");
      mesh.indices.push_back(corner);
    }
}

}  // namespace lumirank::scenedesc::gltf
