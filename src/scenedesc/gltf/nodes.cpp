// The tree of nodes.
#include <cmath>

#include "scenedesc/gltf/reader.h"

namespace lumirank::scenedesc::gltf {
namespace {

Transform local_transform(const Element& node) {
  if (const auto matrix = node.find("matrix")) {
    for (const char* other : {"translation", "rotation", "scale"})
      if (node.has(other))
        node.fail(std::string("has both \"matrix\" and \"") + other + "\"", "keep one of them");
    const std::vector<double> columns = matrix->numbers(16);
    Transform t;
    for (std::size_t row = 0; row < 4; ++row)
      for (std::size_t column = 0; column < 4; ++column) t.m[row * 4 + column] = columns[column * 4 + row];
    if (t.m[12] != 0 || t.m[13] != 0 || t.m[14] != 0 || t.m[15] != 1)
      matrix->fail("is not affine", "numbers 4, 8 and 12 must be 0, number 16 must be 1");
    return t;
  }
  Transform t;
  if (const auto translation = node.find("translation")) {
    const auto v = translation->numbers(3);
    t = Transform::translate(v[0], v[1], v[2]);
  }
  if (const auto turn = node.find("rotation")) {
    const auto q = turn->numbers(4);
    t = t * rotation(q[0], q[1], q[2], q[3], *turn);
  }
  if (const auto scale = node.find("scale")) {
    const auto v = scale->numbers(3);
    t = t * Transform::scale(v[0], v[1], v[2]);
  }
  return t;
}

}  // namespace

Transform rotation(double x, double y, double z, double w, const Element& where) {
  const double size = x * x + y * y + z * z + w * w;
  if (!(size > 0))
    where.fail("is a rotation of zeros", "a rotation is a unit quaternion: [0, 0, 0, 1] is none");
  const double s = 2 / size;
  Transform t;
  t.m = {1 - s * (y * y + z * z),
         s * (x * y - w * z),
         s * (x * z + w * y),
         0,
         s * (x * y + w * z),
         1 - s * (x * x + z * z),
         s * (y * z - w * x),
         0,
         s * (x * z - w * y),
         s * (y * z + w * x),
         1 - s * (x * x + y * y),
         0,
         0,
         0,
         0,
         1};
  return t;
}

void Reader::build_nodes() {
  for (const Element& element : root_.list("nodes"))
    nodes_.push_back({element, local_transform(element), {}, kNone, false, {}});
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    for (const Element& child : nodes_[k].element.list("children")) {
      const std::size_t c = index_of(child, nodes_.size(), "node");
      if (nodes_[c].parent != kNone)
        child.fail("makes " + nodes_[c].element.path() + " a child for the second time",
                   "a node has one parent");
      nodes_[c].parent = static_cast<int>(k);
      nodes_[k].children.push_back(static_cast<int>(c));
    }
  // Parents before children. Whoever is not reached has no end to its parents.
  std::vector<int> order;
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    if (nodes_[k].parent == kNone) order.push_back(static_cast<int>(k));
  for (std::size_t k = 0; k < order.size(); ++k) {
    Node& node = nodes_[static_cast<std::size_t>(order[k])];
    node.world =
        node.parent == kNone ? node.local : nodes_[static_cast<std::size_t>(node.parent)].world * node.local;
    order.insert(order.end(), node.children.begin(), node.children.end());
  }
  if (order.size() == nodes_.size()) return;
  std::vector<bool> reached(nodes_.size());
  for (const int k : order) reached[static_cast<std::size_t>(k)] = true;
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    if (!reached[k]) nodes_[k].element.fail("is, through its children, its own child", "break the cycle");
}

void Reader::build_scene() {
  const std::vector<Element> scenes = root_.list("scenes");
  std::vector<int> open;
  if (const auto chosen = root_.find("scene"); chosen || !scenes.empty()) {
    const Element& scene =
        scenes.empty() || chosen ? scenes.at(index_of(*chosen, scenes.size(), "scene")) : scenes[0];
    for (const Element& top : scene.list("nodes")) {
      const std::size_t k = index_of(top, nodes_.size(), "node");
      if (nodes_[k].parent != kNone)
        top.fail("names " + nodes_[k].element.path() + ", which is a child of another node",
                 "scenes list the tops of trees");
      if (nodes_[k].in_scene) top.fail("names a node for the second time", "name it once");
      nodes_[k].in_scene = true;
      open.push_back(static_cast<int>(k));
    }
    if (scenes.size() > 1)
      warn(scene, "a file of " + std::to_string(scenes.size()) + " scenes", "this one alone");
  } else {
    for (std::size_t k = 0; k < nodes_.size(); ++k)
      if (nodes_[k].parent == kNone) open.push_back(static_cast<int>(k));
  }
  for (std::size_t k = 0; k < open.size(); ++k) {
    Node& node = nodes_[static_cast<std::size_t>(open[k])];
    // KHR_node_visibility: what is not visible hides all below it.
    if (const auto shown = node.element.extension("KHR_node_visibility");
        shown && !shown->flag("visible", true)) {
      node.in_scene = false;
      continue;
    }
    node.in_scene = true;
    open.insert(open.end(), node.children.begin(), node.children.end());
  }
  // In the order of the file.
  for (const Node& node : nodes_) {
    if (!node.in_scene) continue;
    if (!node.world.is_finite())
      node.element.fail("has a transform that overflows", "reduce its scale and translation");
    if (const auto mesh = node.element.find("mesh")) build_shapes(node, *mesh);
    if (const auto camera = node.element.find("camera")) build_camera(node, *camera);
    if (const auto punctual = node.element.extension("KHR_lights_punctual"))
      build_light(node, punctual->at("light"));
  }
}

}  // namespace lumirank::scenedesc::gltf
