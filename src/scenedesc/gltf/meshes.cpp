// Primitives as triangle meshes, and the shapes that show them.
#include <algorithm>

#include "scenedesc/gltf/reader.h"
#include "scenedesc/gltf/uri.h"
#include "scenedesc/schema/lamp_back.h"
#include "scenedesc/schema/mesh_cache.h"

namespace lumirank::scenedesc::gltf {
namespace {

enum Mode { kPoints, kLines, kLineLoop, kLineStrip, kTriangles, kStrip, kFan };

std::vector<Vec3f> vec3s(const Numbers& n) {
  std::vector<Vec3f> out(n.count);
  for (std::size_t k = 0; k < n.count; ++k)
    out[k] = {n.values[3 * k], n.values[3 * k + 1], n.values[3 * k + 2]};
  return out;
}

void check_count(const Element& attribute, std::size_t count, std::size_t vertices) {
  if (count != vertices)
    attribute.fail("has " + std::to_string(count) + " elements for " + std::to_string(vertices) + " vertices",
                   "all attributes of a primitive have the same count");
}

}  // namespace

std::vector<std::uint32_t> Reader::triangles(const Element& primitive, std::vector<std::uint32_t> corners,
                                             int mode) {
  const std::size_t n = corners.size();
  if (mode == kTriangles) {
    if (n % 3 != 0) {
      warn(primitive, std::to_string(n % 3) + " corners beyond the last triangle", "");
      corners.resize(n - n % 3);
    }
    return corners;
  }
  std::vector<std::uint32_t> out;
  for (std::size_t k = 2; k < n; ++k) {
    // Every second triangle of a strip runs the other way round (glTF 2.0, section 3.7.2.1).
    const bool odd = k % 2 == 1;
    const std::uint32_t a = mode == kFan ? corners[0] : corners[k - 2];
    const std::uint32_t b = corners[k - 1], c = corners[k];
    if (mode == kStrip && odd)
      out.insert(out.end(), {b, a, c});
    else
      out.insert(out.end(), {a, b, c});
  }
  return out;
}

std::vector<std::uint32_t> Reader::read_attributes(const Element& primitive, const Element& attributes,
                                                   int uv_set, MeshData& mesh) {
  mesh.positions = vec3s(accessors_.floats(attributes.at("POSITION"), 3, 3));
  const std::size_t vertices = mesh.positions.size();
  if (const auto normals = attributes.find("NORMAL")) {
    check_count(*normals, accessors_.count(*normals), vertices);
    mesh.normals = vec3s(accessors_.floats(*normals, 3, 3));
  }
  if (const auto uvs = attributes.find("TEXCOORD_" + std::to_string(uv_set))) {
    check_count(*uvs, accessors_.count(*uvs), vertices);
    const Numbers n = accessors_.floats(*uvs, 2, 2);
    for (std::size_t k = 0; k < n.count; ++k) mesh.uvs.push_back({n.values[2 * k], n.values[2 * k + 1]});
  }
  if (const auto colors = attributes.find("COLOR_0")) {
    check_count(*colors, accessors_.count(*colors), vertices);
    const Numbers n = accessors_.floats(*colors, 3, 4);
    bool clear = false;
    for (std::size_t k = 0; k < n.count; ++k) {
      const float* c = &n.values[k * n.components];
      mesh.colors.push_back({c[0], c[1], c[2]});
      clear = clear || (n.components == 4 && c[3] < 1);
    }
    if (clear) warn(*colors, "the alpha of vertex colors", "1");
  }
  std::vector<std::uint32_t> corners;
  if (const auto indices = primitive.find("indices")) {
    corners = accessors_.integers(*indices);
    for (std::size_t k = 0; k < corners.size(); ++k)
      if (corners[k] >= vertices)
        indices->fail("names vertex " + std::to_string(corners[k]) + " of " + std::to_string(vertices) +
                          " (its element " + std::to_string(k) + ")",
                      "vertices are counted from 0");
  } else {
    corners.resize(vertices);
    for (std::size_t k = 0; k < vertices; ++k) corners[k] = static_cast<std::uint32_t>(k);
  }
  return corners;
}

std::shared_ptr<const MeshData> Reader::build_mesh(const Element& primitive, int uv_set,
                                                   const std::vector<float>& weights,
                                                   const std::vector<Transform>& joints) {
  const auto mode_element = primitive.find("mode");
  const int mode =
      mode_element ? static_cast<int>(mode_element->integer(0, 6)) : static_cast<int>(kTriangles);
  if (mode < kTriangles) {
    warn(primitive, mode == kPoints ? "points" : "lines", "");
    return nullptr;
  }
  const Element attributes = primitive.at("attributes");
  if (!attributes.has("POSITION")) {
    warn(primitive, "a primitive without positions", "");
    return nullptr;
  }
  MeshData mesh;
  std::vector<std::uint32_t> corners;
  if (const auto draco = primitive.extension("KHR_draco_mesh_compression")) {
    decode_draco(primitive, *draco, uv_set, mesh);
    corners = std::move(mesh.indices);
  } else {
    corners = read_attributes(primitive, attributes, uv_set, mesh);
  }
  mesh.indices = triangles(primitive, std::move(corners), mode);
  morph(primitive, weights, mesh);
  skin(primitive, joints, mesh);
  try {
    return std::make_shared<const MeshData>(check_mesh(std::move(mesh), primitive.where()));
  } catch (const InputError& error) {
    // The path besides the line: in a .glb all is on one line.
    std::string what = error.what();
    if (const std::string place = to_string(primitive.where()) + ": "; what.starts_with(place))
      what.erase(0, place.size());
    throw InputError(primitive.where(), primitive.path() + ": " + what);
  }
}

std::vector<Transform> Reader::instances(const Node& node) {
  const auto instancing = node.element.extension("EXT_mesh_gpu_instancing");
  if (!instancing) return {node.world};
  const Element attributes = instancing->at("attributes");
  std::size_t count = 0;
  const auto read = [&](const char* name, std::size_t components) {
    const auto attribute = attributes.find(name);
    Numbers n;
    if (!attribute) return n;
    // Each becomes a shape, of which a file without data (see Accessors::read) could ask for millions.
    if (count == 0)
      buffers_.budget().take(static_cast<double>(accessors_.count(*attribute)) * sizeof(ShapeDesc),
                             *attribute);
    n = accessors_.floats(*attribute, components, components);
    if (count > 0) check_count(*attribute, n.count, count);
    count = n.count;
    return n;
  };
  const Numbers move = read("TRANSLATION", 3), turn = read("ROTATION", 4), scale = read("SCALE", 3);
  if (count == 0) attributes.fail("places no instance", "give TRANSLATION, ROTATION or SCALE");
  std::vector<Transform> out;
  for (std::size_t k = 0; k < count; ++k) {
    Transform t = node.world;
    if (move.count > 0)
      t = t * Transform::translate(move.values[3 * k], move.values[3 * k + 1], move.values[3 * k + 2]);
    if (const float* q = turn.count > 0 ? &turn.values[4 * k] : nullptr)
      t = t * rotation(q[0], q[1], q[2], q[3], attributes);
    if (scale.count > 0)
      t = t * Transform::scale(scale.values[3 * k], scale.values[3 * k + 1], scale.values[3 * k + 2]);
    if (!t.is_finite())
      attributes.fail("gives an instance a transform that overflows", "reduce its scale and translation");
    out.push_back(t);
  }
  return out;
}

// What no time changes: readings of other moments share it.
std::shared_ptr<const MeshData> Reader::still_mesh(const Element& primitive, int uv_set,
                                                   const std::vector<float>& weights) {
  const std::string key = primitive.path() + " uv " + std::to_string(uv_set);
  if (options_.meshes)
    if (auto kept = options_.meshes->find(key)) return kept;
  auto made = build_mesh(primitive, uv_set, weights, {});
  if (options_.meshes) options_.meshes->keep(key, made);
  return made;
}

// A buffer that does not exist takes along all that it holds: the mesh is left out and counted.
void Reader::build_shapes(const Node& node, const Element& mesh_index) {
  const std::size_t before = scene_.shapes.size();
  try {
    build_present_shapes(node, mesh_index);
  } catch (const MissingFile& error) {
    if (!options_.allow_missing) throw;
    const std::string text = what_is_missing(error);
    if (is_new(text)) missing_file(error.where(), text, "");
    scene_.shapes.resize(before);
    ShapeDesc shape;
    shape.id = name_of(node);
    shape.where = mesh_index.where();
    shape.kind = InlineMeshDesc{nullptr, meshes_[index_of(mesh_index, meshes_.size(), "mesh")].path()};
    scene_.shapes.push_back(std::move(shape));
  }
}

// Of the shape that was built last; what is the same for all places of a mesh is found once.
void Reader::build_back(const std::shared_ptr<const MeshData>& mesh) {
  const ShapeDesc& front = scene_.shapes.back();
  const auto [back, fresh] = built_backs_.try_emplace(mesh);
  if (fresh && mesh->triangle_count() > 0 && !is_closed_outwards(*mesh)) back->second = back_of(front).kind;
  if (!back->second) return;
  ShapeDesc shape = front;
  shape.flip_normals = !front.flip_normals;
  std::swap(shape.media.inside, shape.media.outside);
  shape.kind = *back->second;
  scene_.shapes.push_back(std::move(shape));
}

void Reader::build_present_shapes(const Node& node, const Element& mesh_index) {
  const Element& mesh = meshes_[index_of(mesh_index, meshes_.size(), "mesh")];
  const std::vector<Element> primitives = mesh.list("primitives");
  const std::vector<float> weights = morph_weights(node, mesh);
  const std::vector<Transform> joints = joint_matrices(node);
  // Whoever has a pose of its own has a mesh of its own, in the world already if a skin made it.
  const bool posed = node.element.has("weights") || !joints.empty();
  const std::vector<Transform> places =
      joints.empty() ? instances(node) : std::vector<Transform>{Transform{}};
  for (std::size_t k = 0; k < primitives.size(); ++k) {
    const Element& primitive = primitives[k];
    const auto index = primitive.find("material");
    const int material = index ? static_cast<int>(index_of(*index, materials_.size(), "material")) : kNone;
    const Element attributes = primitive.at("attributes");
    const BuiltMaterial& built = build_material(material, attributes.has("COLOR_0"));
    std::shared_ptr<const MeshData> data;
    if (posed) {
      data = build_mesh(primitive, built.uv_set, weights, joints);
    } else {
      const auto [found, fresh] = built_meshes_.try_emplace({primitive.path(), built.uv_set});
      if (fresh) found->second = still_mesh(primitive, built.uv_set, weights);
      data = found->second;
    }
    if (!data) continue;
    for (const Transform& place : places) {
      ShapeDesc shape;
      shape.id = name_of(node) + (primitives.size() > 1 ? "." + std::to_string(k) : "");
      shape.where = primitive.where();
      shape.to_world = place;
      shape.bsdf = built.bsdf;
      if (built.medium != kNone) shape.media = {true, built.medium, kNone};
      shape.kind = InlineMeshDesc{data, primitive.path()};
      if (built.emission) shape.emitter = AreaEmitterDesc{*built.emission, shape.id, primitive.where()};
      scene_.shapes.push_back(std::move(shape));
      if (built.emits_both_ways) build_back(data);
    }
  }
}

}  // namespace lumirank::scenedesc::gltf
