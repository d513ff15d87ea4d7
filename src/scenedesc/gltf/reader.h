// State of one reading of a glTF file: what it refers to, what has been built so far, warnings. Each build_*
// is in a file of its own.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "scenedesc/gltf/accessors.h"
#include "scenedesc/gltf/buffers.h"
#include "scenedesc/gltf/element.h"
#include "scenedesc/meshes/mesh_reader.h"
#include "scenedesc/schema/scene_reader.h"

namespace lumirank::scenedesc::gltf {

// A node of the scene that is read.
struct Node {
  Element element;
  Transform local, world;
  int parent = kNone;
  bool in_scene = false;
  std::vector<int> children;
};

class Reader : public SceneReader {
 public:
  // `root` and what `binary` points to must outlive this.
  Reader(const Element& root, std::string_view binary, bool is_glb, const std::string& filename,
         const ReadOptions& options, float lumens_per_unit);

  SceneDesc read();

 private:
  // As SceneReader's, with the element's path; notes are for what no picture shows, once for each text.
  void warn(const Element& at, const std::string& what, const std::string& used_instead);
  void warn_once(const Element& at, const std::string& what, const std::string& used_instead);
  void note(const Element& at, const std::string& what);

  // reader.cpp
  void check_asset();
  void check_extensions();
  void warn_unused();
  std::size_t index_of(const Element& index, std::size_t count, const char* what) const;

  // nodes.cpp: local and world transforms, the tree checked, which nodes the scene shows.
  void build_nodes();
  void build_scene();  // shapes, cameras and lights of those nodes

  // meshes.cpp
  void build_shapes(const Node& node, const Element& mesh_index);
  void build_present_shapes(const Node& node, const Element& mesh_index);
  void build_back(const std::shared_ptr<const MeshData>& mesh);
  std::vector<Transform> instances(const Node& node);  // EXT_mesh_gpu_instancing, or the node alone
  // Null if there is nothing to show. `weights`: of the morph targets; `joints`: a matrix for each joint of
  // the skin, or empty.
  std::shared_ptr<const MeshData> build_mesh(const Element& primitive, int uv_set,
                                             const std::vector<float>& weights,
                                             const std::vector<Transform>& joints);
  std::shared_ptr<const MeshData> still_mesh(const Element& primitive, int uv_set,
                                             const std::vector<float>& weights);
  // Positions, normals, uvs and colors of the accessors; the vertices of the corners.
  std::vector<std::uint32_t> read_attributes(const Element& primitive, const Element& attributes, int uv_set,
                                             MeshData& mesh);
  std::vector<std::uint32_t> triangles(const Element& primitive, std::vector<std::uint32_t> corners,
                                       int mode);
  // skins.cpp
  std::vector<float> morph_weights(const Node& node, const Element& mesh);
  std::vector<Transform> joint_matrices(const Node& node);
  void morph(const Element& primitive, const std::vector<float>& weights, MeshData& mesh);
  void skin(const Element& primitive, const std::vector<Transform>& joints, MeshData& mesh);
  // draco.cpp: positions, normals, uvs, colors and indices from KHR_draco_mesh_compression.
  void decode_draco(const Element& primitive, const Element& extension, int uv_set, MeshData& mesh);

  // materials.cpp: `colored` if the primitive has vertex colors. kNone: the default material.
  struct BuiltMaterial {
    int bsdf = kNone;
    int medium = kNone;  // inside
    int uv_set = 0;
    std::optional<ColorInput> emission;
    bool emits_both_ways = false;
    std::string name;
  };
  const BuiltMaterial& build_material(int material, bool colored);
  BuiltMaterial make_material(const Element& material, bool colored);
  int uv_set_of(const Element& material);
  struct Surface;    // a material's inputs on their way to a BSDF
  struct BaseColor;  // where a material has it
  Surface surface_of(const Element& material, const BaseColor& base, bool colored);
  void read_roughness(const Element& material, const BaseColor& base, Surface& surface);
  int lit_bsdf(const Element& material, const Surface& surface);
  std::optional<ColorInput> emission_of(const Element& material);
  int opaque_bsdf(const Element& material, const Surface& surface);
  int transmitting_bsdf(const Element& material, const Surface& surface, const Element& transmission);
  int leaf_bsdf(const Element& material, const Surface& surface, const Element& transmission);  // layers.cpp
  int sheen_bsdf(const Element& material, const Surface& surface, const Element& sheen);        // layers.cpp
  int turned_bsdf(const Element& anisotropy, int base);                                         // layers.cpp
  int coated_bsdf(const Element& clearcoat, int base);                                          // layers.cpp
  int two_sided(const Element& at, int bsdf);
  int normal_mapped(const Element& material, int base);
  int cut_out(const Element& material, const BaseColor& color, int base);
  int mix(const Element& at, FloatInput weight, int one, int other);  // weight · one + (1 - weight) · other
  int add_bsdf(const Element& at, decltype(BsdfDesc::kind) kind);

  // media.cpp
  std::optional<Element> volume_of(const Element& material);  // the extension, if the material is of a solid
  int medium_of(const Element& material);  // what fills it; kNone: nothing that absorbs light

  // textures.cpp: each takes a textureInfo and returns an index into the scene's textures.
  int build_texture(const Element& info, bool raw, TextureChannel channel);
  bool without_alpha(int texture) const;  // certainly: it is a JPEG file
  int scaled(const Element& at, int texture, Rgb scale);
  int product(const Element& at, ColorInput a, ColorInput b);
  FloatInput squared(const Element& at, FloatInput input);
  FloatInput complement(const Element& at, FloatInput input);  // 1 - input
  int add_texture(const Element& at, decltype(TextureDesc::kind) kind);
  FloatInput float_input(const Element& object, const std::string& factor, float fallback,
                         const std::string& texture, TextureChannel channel, float max_value = 1);
  ColorInput color_input(const Element& object, const std::string& factor, Rgb fallback,
                         const std::string& texture);

  void build_camera(const Node& node, const Element& camera_index);  // cameras.cpp
  void build_light(const Node& node, const Element& light_index);    // lights.cpp

  std::string name_of(const Node& node) const;

  Element root_;
  float lumens_per_unit_;
  Buffers buffers_;
  Accessors accessors_;
  std::vector<Element> meshes_, materials_, textures_, images_, samplers_, cameras_, skins_, lights_;
  std::vector<Node> nodes_;
  std::map<std::pair<int, bool>, BuiltMaterial> built_materials_;
  std::map<std::tuple<std::string, bool, int, std::vector<float>>, int> built_textures_;
  std::map<std::size_t, BitmapTextureDesc> built_images_;
  std::map<std::pair<std::string, int>, std::shared_ptr<const MeshData>> built_meshes_;
  std::map<std::array<float, 3>, int> built_media_;  // by extinction
  // Of double-sided lamps, by the mesh of their front; none where nobody sees it.
  std::map<std::shared_ptr<const MeshData>, std::optional<decltype(ShapeDesc::kind)>> built_backs_;
};

// Lumens that are one unit of power in the file as it stands, whatever moves (lights.cpp).
float lumens_per_unit_of(const Element& root);

// The rotation of a quaternion (x, y, z, w) of any length but zero, which is an InputError at `where`.
Transform rotation(double x, double y, double z, double w, const Element& where);

// Where the scene has no camera: one in front of everything (in the direction of +z, which is where glTF
// models look), a little to the side and above, so near that all of it is just inside the picture.
void add_default_camera(SceneDesc& scene, const Element& root);

}  // namespace lumirank::scenedesc::gltf
