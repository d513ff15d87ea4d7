#include "scenedesc/gltf/reader.h"

#include <algorithm>
#include <array>

#include "scenedesc/gltf/animation.h"
#include "scenedesc/gltf/container.h"
#include "scenedesc/gltf/read_gltf.h"
#include "scenedesc/gltf/uri.h"
#include "scenedesc/schema/expansion.h"
#include "scenedesc/schema/warnings.h"

namespace lumirank::scenedesc::gltf {
namespace {

constexpr std::array kExtensions = {"KHR_materials_emissive_strength",
                                    "KHR_materials_transmission",
                                    "KHR_materials_ior",
                                    "KHR_materials_specular",
                                    "KHR_materials_clearcoat",
                                    "KHR_materials_anisotropy",
                                    "KHR_materials_sheen",
                                    "KHR_materials_unlit",
                                    "KHR_materials_volume",
                                    "KHR_materials_pbrSpecularGlossiness",
                                    "KHR_materials_diffuse_transmission",
                                    "EXT_texture_webp",
                                    "KHR_texture_transform",
                                    "KHR_lights_punctual",
                                    "KHR_draco_mesh_compression",
                                    "EXT_meshopt_compression",
                                    "EXT_mesh_gpu_instancing",
                                    "KHR_mesh_quantization",
                                    "KHR_animation_pointer",
                                    "KHR_node_visibility"};
// Variants leave the primitives' own materials, metadata are words.
constexpr std::array kWithoutEffect = {"KHR_materials_variants", "KHR_xmp_json_ld", "KHR_xmp"};

template <typename List>
bool contains(const List& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

}  // namespace

Reader::Reader(const Element& root, std::string_view binary, bool is_glb, const std::string& filename,
               const ReadOptions& options, float lumens_per_unit)
    : SceneReader(filename, "glTF 2.0", options),
      root_(root),
      lumens_per_unit_(lumens_per_unit),
      buffers_(root, binary, is_glb),
      accessors_(root, buffers_),
      meshes_(root.list("meshes")),
      materials_(root.list("materials")),
      textures_(root.list("textures")),
      images_(root.list("images")),
      samplers_(root.list("samplers")),
      cameras_(root.list("cameras")),
      skins_(root.list("skins")) {
  scene_.lumens_per_unit = lumens_per_unit;
  if (const auto punctual = root.extension("KHR_lights_punctual")) lights_ = punctual->list("lights");
}

void Reader::warn(const Element& at, const std::string& what, const std::string& used_instead) {
  SceneReader::warn(at.where(), what + " (" + at.path() + ")", used_instead);
}

void Reader::warn_once(const Element& at, const std::string& what, const std::string& used_instead) {
  if (is_new(what)) warn(at, what, used_instead);
}

void Reader::note(const Element& at, const std::string& what) {
  if (is_new(what)) add_note(scene_, at.where(), what + " (" + at.path() + ")");
}

std::size_t Reader::index_of(const Element& index, std::size_t count, const char* what) const {
  const std::int64_t value = index.integer(0, kMaxBytes);
  if (value >= static_cast<std::int64_t>(count))
    index.fail("names " + std::string(what) + " " + std::to_string(value) + ", and the file has " +
                   std::to_string(count),
               "they are counted from 0");
  return static_cast<std::size_t>(value);
}

std::string Reader::name_of(const Node& node) const {
  const std::string name = node.element.text("name", "");
  return name.empty() ? node.element.path() : name;
}

void Reader::check_asset() {
  const Element asset = root_.at("asset"), version = asset.at("version");
  if (!version.text().starts_with("2."))
    version.fail("is \"" + version.text() + "\"", "glTF 2.0 can be read: convert the file");
  if (const auto min_version = asset.find("minVersion"); min_version && min_version->text() != "2.0")
    min_version->fail("is \"" + min_version->text() + "\"", "glTF 2.0 can be read");
}

void Reader::check_extensions() {
  for (const Element& name : root_.list("extensionsRequired"))
    if (!contains(kExtensions, name.text()) && !contains(kWithoutEffect, name.text()))
      name.fail("is \"" + name.text() + "\", which Lumirank does not have", "export the scene without it");
  for (const Element& name : root_.list("extensionsUsed"))
    if (!contains(kExtensions, name.text()) && !contains(kWithoutEffect, name.text()))
      warn_once(name, "the extension " + name.text(), "");
}

void Reader::warn_unused() {
  if (const auto animations = root_.find("animations");
      !options_.time && animations && animations->size() > 0)
    note(*animations, "animations: this is the pose in which the nodes stand; --at SECONDS shows another");
}

SceneDesc Reader::read() {
  check_asset();
  check_extensions();
  build_nodes();
  build_scene();
  warn_unused();
  check_expansion(scene_);
  if (scene_.sensors.empty()) add_default_camera(scene_, root_);
  return std::move(scene_);
}

}  // namespace lumirank::scenedesc::gltf

namespace lumirank::scenedesc {
namespace gltf {
namespace {

Motion motion_of(const Animation& animation, const Element& root) {
  return {animation.begin(), animation.end(), animation.moving(), clip_names(root)};
}

}  // namespace
}  // namespace gltf

SceneDesc parse_gltf(const std::string& bytes, const std::string& filename, const ReadOptions& options) {
  const gltf::Container container = gltf::open_container(bytes, filename);
  const gltf::Json json = gltf::parse_json(container.json, filename);
  const gltf::Element root(json, "", filename);
  const float lumens = gltf::lumens_per_unit_of(root);
  if (!root.find("animations") && options.clip.empty())
    return gltf::Reader(root, container.binary, container.is_glb, filename, options, lumens).read();
  gltf::Buffers buffers(root, container.binary, container.is_glb);
  gltf::Accessors accessors(root, buffers);
  if (options.time) {
    const gltf::Animation animation(root, accessors, options.clip);
    const gltf::Json posed = animation.at(json, *options.time);
    const gltf::Element shown(posed, "", filename);
    SceneDesc scene =
        gltf::Reader(shown, container.binary, container.is_glb, filename, options, lumens).read();
    scene.motion = gltf::motion_of(animation, root);
    return scene;
  }
  SceneDesc scene = gltf::Reader(root, container.binary, container.is_glb, filename, options, lumens).read();
  try {
    scene.motion = gltf::motion_of(gltf::Animation(root, accessors, options.clip), root);
  } catch (const InputError& error) {  // a still picture does not need it
    if (!options.clip.empty()) throw;
    add_note(scene, error.where(), std::string("an animation that cannot be shown: ") + error.what());
  }
  return scene;
}

SceneDesc read_gltf(const std::string& filename, const ReadOptions& options) {
  return parse_gltf(gltf::read_scene_file(filename), filename, options);
}

}  // namespace lumirank::scenedesc
