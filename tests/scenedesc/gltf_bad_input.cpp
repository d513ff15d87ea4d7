// The corpus of bad glTF files: every one is an InputError that names the file and the place in it.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "gltf_maker.h"
#include "scenedesc/bad_files.h"

namespace lumirank::scenedesc {
namespace {

struct BadGltf {
  std::string name;
  std::string phrase;  // in the message
};

// clang-format off
const std::vector<BadGltf> kBadGltf = {
    {"glb_bad_json.glb", R"(not valid JSON)"},
    {"glb_chunk_too_long.glb", R"(a chunk)"},
    {"glb_empty.glb", R"(no JSON)"},
    {"glb_header.glb", R"(header)"},
    {"glb_no_json.glb", R"(not its JSON)"},
    {"glb_short_binary.glb", R"(buffers[0])"},
    {"glb_truncated.glb", R"(truncated)"},
    {"glb_version.glb", R"(version 1)"},
    {"gltf_absolute_buffer.gltf", R"(buffers[0].uri)"},
    {"gltf_accessor_beyond_view.gltf", R"(accessors[0])"},
    {"gltf_accessor_component.gltf", R"(accessors[0].componentType)"},
    {"gltf_accessor_count_overflow.gltf", R"(accessors[0].count)"},
    {"gltf_accessor_huge_count.gltf", R"(accessors[0])"},
    {"gltf_accessor_of_no_view.gltf", R"(accessors[0].bufferView)"},
    {"gltf_accessor_offset.gltf", R"(accessors[0])"},
    {"gltf_accessor_type.gltf", R"(accessors[0].type)"},
    {"gltf_alpha_mode.gltf", R"(materials[0].alphaMode)"},
    {"gltf_attenuation_color.gltf", R"(KHR_materials_volume.attenuationColor[1])"},
    {"gltf_attenuation_distance.gltf", R"(KHR_materials_volume.attenuationDistance)"},
    {"gltf_bad_base64.gltf", R"(buffers[0].uri)"},
    {"gltf_buffer_from_afar.gltf", R"(buffers[0].uri)"},
    {"gltf_buffer_is_folder.gltf", R"(buffers[0].uri)"},
    {"gltf_buffer_without_uri.gltf", R"(buffers[0])"},
    {"gltf_camera_flat.gltf", R"(cameras[0].perspective.yfov)"},
    {"gltf_camera_kind.gltf", R"(cameras[0].type)"},
    {"gltf_camera_of_nothing.gltf", R"(nodes[0].camera)"},
    {"gltf_color_of_two.gltf", R"(materials[0].pbrMetallicRoughness.baseColorFactor)"},
    {"gltf_data_without_comma.gltf", R"(buffers[0].uri)"},
    {"gltf_draco_damaged.gltf", R"(KHR_draco_mesh_compression)"},
    {"gltf_float_indices.gltf", R"(meshes[0].primitives[0].indices)"},
    {"gltf_fraction_for_index.gltf", R"(nodes[0].mesh)"},
    {"gltf_image_of_no_kind.gltf", R"(images[0])"},
    {"gltf_image_of_nothing.gltf", R"(textures[0].source)"},
    {"gltf_index_out_of_range.gltf", R"(meshes[0].primitives[0].indices)"},
    {"gltf_instances_of_nothing.gltf", R"(EXT_mesh_gpu_instancing.attributes)"},
    {"gltf_ior_below_one.gltf", R"(KHR_materials_ior.ior)"},
    {"gltf_joint_out_of_range.gltf", R"(JOINTS_0)"},
    {"gltf_json_comma.gltf", R"(not valid JSON)"},
    {"gltf_json_deep.gltf", R"(nested)"},
    {"gltf_json_empty.gltf", R"(not valid JSON)"},
    {"gltf_json_garbage.gltf", R"(not valid JSON)"},
    {"gltf_json_huge_number.gltf", R"(not valid JSON)"},
    {"gltf_json_key_twice.gltf", R"(given twice)"},
    {"gltf_json_list.gltf", R"(the file)"},
    {"gltf_json_truncated.gltf", R"(not valid JSON)"},
    {"gltf_light_kind.gltf", R"(lights[0].type)"},
    {"gltf_light_negative.gltf", R"(lights[0].intensity)"},
    {"gltf_list_for_object.gltf", R"(meshes[0])"},
    {"gltf_material_of_nothing.gltf", R"(meshes[0].primitives[0].material)"},
    {"gltf_matrix_and_scale.gltf", R"(nodes[0])"},
    {"gltf_mesh_of_nothing.gltf", R"(nodes[0].mesh)"},
    {"gltf_meshopt_damaged.gltf", R"(bufferViews[0].extensions.EXT_meshopt_compression)"},
    {"gltf_meshopt_mode.gltf", R"(EXT_meshopt_compression.mode)"},
    {"gltf_meshopt_promises.gltf", R"(bufferViews[0].extensions.EXT_meshopt_compression)"},
    {"gltf_metallic_two.gltf", R"(materials[0].pbrMetallicRoughness.metallicFactor)"},
    {"gltf_missing_buffer.gltf", R"(buffers[0].uri)"},
    {"gltf_missing_image.gltf", R"(images[0].uri)"},
    {"gltf_negative_color.gltf", R"(materials[0].pbrMetallicRoughness.baseColorFactor[1])"},
    {"gltf_negative_length.gltf", R"(buffers[0].byteLength)"},
    {"gltf_no_asset.gltf", R"("asset")"},
    {"gltf_no_attributes.gltf", R"(meshes[0].primitives[0])"},
    {"gltf_no_such_scene.gltf", R"(scene)"},
    {"gltf_node_cycle.gltf", R"(nodes[1])"},
    {"gltf_node_of_itself.gltf", R"(nodes[1])"},
    {"gltf_node_of_two_parents.gltf", R"(nodes[2].children[0])"},
    {"gltf_normals_too_few.gltf", R"(meshes[0].primitives[0].attributes.NORMAL)"},
    {"gltf_number_for_version.gltf", R"(asset.version)"},
    {"gltf_object_for_list.gltf", R"(nodes)"},
    {"gltf_old_version.gltf", R"(asset.version)"},
    {"gltf_position_of_no_accessor.gltf", R"(meshes[0].primitives[0].attributes.POSITION)"},
    {"gltf_positions_of_two.gltf", R"(meshes[0].primitives[0].attributes.POSITION)"},
    {"gltf_projective_matrix.gltf", R"(nodes[0].matrix)"},
    {"gltf_required_extension.gltf", R"(extensionsRequired[0])"},
    {"gltf_scene_of_child.gltf", R"(scenes[0].nodes[0])"},
    {"gltf_scene_of_nothing.gltf", R"(scenes[0].nodes[0])"},
    {"gltf_short_base64.gltf", R"(buffers[0].uri)"},
    {"gltf_short_buffer.gltf", R"(buffers[0])"},
    {"gltf_short_matrix.gltf", R"(nodes[0].matrix)"},
    {"gltf_skin_without_joints.gltf", R"(skins[0].joints)"},
    {"gltf_sparse_out_of_range.gltf", R"(accessors[0].sparse.indices)"},
    {"gltf_sparse_too_long.gltf", R"(accessors[0].sparse.indices)"},
    {"gltf_spot_angles.gltf", R"(lights[0].spot)"},
    {"gltf_stride_too_small.gltf", R"(accessors[0])"},
    {"gltf_target_too_short.gltf", R"(targets[0].POSITION)"},
    {"gltf_text_for_number.gltf", R"(meshes[0].primitives[0].indices)"},
    {"gltf_texture_of_nothing.gltf", R"(materials[0].normalTexture.index)"},
    {"gltf_thickness_negative.gltf", R"(KHR_materials_volume.thicknessFactor)"},
    {"gltf_unknown_mode.gltf", R"(meshes[0].primitives[0].mode)"},
    {"gltf_vertex_not_finite.gltf", R"(meshes[0].primitives[0])"},
    {"gltf_view_beyond_buffer.gltf", R"(bufferViews[1])"},
    {"gltf_view_of_no_buffer.gltf", R"(bufferViews[0].buffer)"},
    {"gltf_view_offset_overflow.gltf", R"(bufferViews[1].byteOffset)"},
    {"gltf_weights_without_targets.gltf", R"(meshes[0].primitives[0])"},
    {"gltf_wrap_mode.gltf", R"(samplers[0].wrapS)"},
    {"gltf_zero_rotation.gltf", R"(nodes[0].rotation)"},
    {"gltf_zeros_without_end.gltf", R"(accessors[0])"},
};
// clang-format on

// What only the world finds when it decodes the image.
const std::set<std::string> kFoundLater = {"gltf_image_is_no_image.gltf", "gltf_truncated_image.gltf"};

class BadGltfInput : public testing::TestWithParam<BadGltf> {};

TEST_P(BadGltfInput, IsRefusedWithItsPlace) {
  const BadGltf& bad = GetParam();
  try {
    read_scene(kBadFolder + bad.name);
    FAIL() << bad.name << " was read";
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find(bad.phrase), std::string::npos) << what;
    EXPECT_NE(what.find(bad.name), std::string::npos) << what;
    EXPECT_NE(what.find("; "), std::string::npos) << "no remedy: " << what;
  }
}
INSTANTIATE_TEST_SUITE_P(Corpus, BadGltfInput, testing::ValuesIn(kBadGltf),
                         [](const testing::TestParamInfo<BadGltf>& file) {
                           std::string name = file.param.name;
                           for (char& c : name)
                             if (c == '.') c = '_';
                           return name;
                         });

TEST(BadGltfCorpus, EveryFileIsInTheTable) {
  std::set<std::string> listed = kFoundLater;
  for (const BadGltf& bad : kBadGltf) listed.insert(bad.name);
  std::set<std::string> there;
  for (const auto& entry : std::filesystem::directory_iterator(kBadFolder))
    if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb")
      there.insert(entry.path().filename().string());
  EXPECT_EQ(there, listed);
}

TEST(BadGltfCorpus, SyntaxErrorsHaveTheirLine) {
  EXPECT_EQ(
      failure("{\n\"asset\": {\"version\": \"2.0\"},\n\"nodes\": [}\n}").find("made.gltf:3: not valid JSON"),
      0u)
      << failure("{\n\"asset\": {\"version\": \"2.0\"},\n\"nodes\": [}\n}");
  EXPECT_EQ(failure("{\n\"asset\": {\n\"version\": 2\n}}").find("made.gltf:3: asset.version"), 0u)
      << failure("{\n\"asset\": {\n\"version\": 2\n}}");
}

// Whatever byte is lost or changed, nothing but an InputError comes out; and a cut file is never a whole one.
TEST(BadGltfCorpus, CutAndChangedContainers) {
  GltfMaker m = square();
  m.root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
      m.accessor("VEC3", std::vector<std::int8_t>{0, 0, 127, 0, 0, 127, 0, 0, 127, 0, 0, 127}, true);
  const std::string whole = m.glb();
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_NE(failure(whole.substr(0, length)), "") << length;
  std::size_t refused = 0;
  for (std::size_t k = 0; k < whole.size(); ++k)
    for (const int flip : {1, 16, 255}) {
      std::string changed = whole;
      changed[k] = static_cast<char>(changed[k] ^ flip);
      refused += failure(changed).empty() ? 0 : 1;
    }
  EXPECT_GT(refused, 0u);
}

TEST(BadGltfCorpus, NoFileNoScene) {
  EXPECT_THROW(read_gltf(kBadFolder + "no_such.gltf"), InputError);
  EXPECT_THROW(read_gltf(kBadFolder), InputError);
  EXPECT_THROW(read_scene(kBadFolder + "no_such.glb"), InputError);
}

}  // namespace
}  // namespace lumirank::scenedesc
