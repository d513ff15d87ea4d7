// Morph targets by their weights, and skins in the pose of their nodes.
#include <algorithm>

#include "scenedesc/gltf/reader.h"

namespace lumirank::scenedesc::gltf {

std::vector<float> Reader::morph_weights(const Node& node, const Element& mesh) {
  std::vector<float> weights;
  for (const Element* owner : {&mesh, &node.element})
    if (const auto given = owner->find("weights")) {
      weights.clear();
      for (std::size_t k = 0; k < given->size(); ++k) weights.push_back(given->item(k).real());
    }
  return weights;
}

void Reader::morph(const Element& primitive, const std::vector<float>& weights, MeshData& mesh) {
  const std::vector<Element> targets = primitive.list("targets");
  if (!targets.empty() && weights.size() > targets.size())
    primitive.fail("has " + std::to_string(targets.size()) + " morph targets for " +
                       std::to_string(weights.size()) + " weights",
                   "give as many of one as of the other");
  for (std::size_t t = 0; t < targets.size() && t < weights.size(); ++t) {
    if (weights[t] == 0) continue;
    const auto add = [&](const char* name, std::vector<Vec3f>& to) {
      const auto attribute = targets[t].find(name);
      if (!attribute || to.empty()) return;
      const Numbers n = accessors_.floats(*attribute, 3, 3);
      if (n.count != to.size())
        attribute->fail(
            "has " + std::to_string(n.count) + " elements for " + std::to_string(to.size()) + " vertices",
            "a target has the primitive's vertices");
      for (std::size_t k = 0; k < n.count; ++k)
        to[k] += Vec3f{n.values[3 * k], n.values[3 * k + 1], n.values[3 * k + 2]} * weights[t];
    };
    add("POSITION", mesh.positions);
    add("NORMAL", mesh.normals);
  }
}

std::vector<Transform> Reader::joint_matrices(const Node& node) {
  const auto index = node.element.find("skin");
  if (!index) return {};
  const Element& skin = skins_[index_of(*index, skins_.size(), "skin")];
  const Element joints = skin.at("joints");
  if (joints.size() == 0) joints.fail("is empty", "a skin has joints");
  Numbers bind;
  if (const auto inverse = skin.find("inverseBindMatrices")) {
    bind = accessors_.floats(*inverse, 16, 16);
    if (bind.count < joints.size())
      inverse->fail(
          "has " + std::to_string(bind.count) + " matrices for " + std::to_string(joints.size()) + " joints",
          "give one for each");
  }
  std::vector<Transform> out;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    Transform m = nodes_[index_of(joints.item(j), nodes_.size(), "node")].world;
    if (bind.count > 0) {
      Transform inverse;
      for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 4; ++column)
          inverse.m[row * 4 + column] = bind.values[16 * j + column * 4 + row];
      m = m * inverse;
    }
    out.push_back(m);
  }
  return out;
}

void Reader::skin(const Element& primitive, const std::vector<Transform>& joints, MeshData& mesh) {
  if (joints.empty()) return;
  const Element attributes = primitive.at("attributes");
  const std::size_t vertices = mesh.positions.size();
  // Sums over all sets of four joints.
  buffers_.budget().take(static_cast<double>(vertices) * sizeof(Transform), primitive);
  std::vector<Transform> blended(vertices);
  for (Transform& t : blended) t.m.fill(0);
  std::vector<double> total(vertices, 0);
  for (int set = 0; set < 16; ++set) {
    const auto which = attributes.find("JOINTS_" + std::to_string(set));
    const auto how_much = attributes.find("WEIGHTS_" + std::to_string(set));
    if (!which && !how_much) break;
    if (!which || !how_much)
      attributes.fail("has JOINTS or WEIGHTS number " + std::to_string(set) + " without the other",
                      "give both");
    const std::vector<std::uint32_t> joint = accessors_.integers(*which, 4);
    const Numbers weight = accessors_.floats(*how_much, 4, 4);
    if (joint.size() != 4 * vertices || weight.count != vertices)
      which->fail("and its weights are not one set for each of the " + std::to_string(vertices) + " vertices",
                  "all attributes of a primitive have the same count");
    for (std::size_t k = 0; k < 4 * vertices; ++k) {
      const double w = weight.values[k];
      if (w == 0) continue;
      if (joint[k] >= joints.size())
        which->fail("names joint " + std::to_string(joint[k]) + " of " + std::to_string(joints.size()),
                    "joints are counted from 0");
      for (std::size_t i = 0; i < 12; ++i) blended[k / 4].m[i] += w * joints[joint[k]].m[i];
      total[k / 4] += w;
    }
  }
  std::vector<Vec3d> places(mesh.positions.begin(), mesh.positions.end());
  for (std::size_t k = 0; k < vertices; ++k) {
    if (!(total[k] > 0)) continue;  // bound to nothing: it stays where it is
    Transform t = blended[k];
    for (std::size_t i = 0; i < 12; ++i) t.m[i] /= total[k];
    t.m[15] = 1;
    places[k] = t.place(mesh.positions[k]);
    if (mesh.normals.empty()) continue;
    if (const auto inverse = t.inverse()) mesh.normals[k] = Transform::normal(*inverse, mesh.normals[k]);
  }
  auto [positions, origin] = near_positions(places);
  mesh.positions = std::move(positions), mesh.origin = origin;
}

}  // namespace lumirank::scenedesc::gltf
