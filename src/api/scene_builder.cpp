#include "lumirank/scene_builder.h"

#include <cmath>

#include "api/scene.h"
#include "base/error.h"
#include "base/vec.h"
#include "image/file_identity.h"
#include "scenedesc/readers.h"

namespace lumirank {

struct SceneBuilder::Impl {
  scenedesc::SceneDesc desc;
  int meshes = 0;
};

namespace {

bool finite(Vec3f v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void require_color(const std::string& what, Rgb c, float max_value) {
  for (int k = 0; k < 3; ++k)
    if (!(c[k] >= 0 && c[k] <= max_value))
      throw InputError(what + " is " + std::to_string(c[k]),
                       max_value < kInfinity ? "give numbers from 0 to 1" : "give finite numbers from 0 on");
}

void require_share(const char* what, float x) {
  if (!(x >= 0 && x <= 1))
    throw InputError(std::string(what) + " is " + std::to_string(x), "give a number from 0 to 1");
}

template <typename Kind>
void add_emitter(scenedesc::SceneDesc& desc, Kind kind, const std::string& name) {
  scenedesc::EmitterDesc emitter;
  emitter.id = name;
  emitter.kind = std::move(kind);
  desc.emitters.push_back(std::move(emitter));
}

}  // namespace

SceneBuilder::SceneBuilder() : impl_(std::make_unique<Impl>()) {
  impl_->desc.source_file = "scene in memory";
  impl_->desc.format = "memory";
}
SceneBuilder::~SceneBuilder() = default;
SceneBuilder::SceneBuilder(SceneBuilder&&) noexcept = default;
SceneBuilder& SceneBuilder::operator=(SceneBuilder&&) noexcept = default;

int SceneBuilder::add_material(const Material& material) {
  require_color("a material's base color", material.base_color, 1);
  require_share("a material's roughness", material.roughness);
  require_share("a material's metallic", material.metallic);
  require_share("a material's transmission", material.transmission);
  require_share("a material's clearcoat", material.clearcoat);
  if (!(material.index_of_refraction >= 1 && material.index_of_refraction < 10))
    throw InputError("a material's index of refraction is " + std::to_string(material.index_of_refraction),
                     "give a number from 1 to 10");
  scenedesc::PrincipledDesc principled;
  principled.base_color.value = material.base_color;
  principled.roughness.value = material.roughness;
  principled.metallic.value = material.metallic;
  principled.spec_trans.value = material.transmission;
  principled.clearcoat.value = material.clearcoat;
  principled.eta = material.index_of_refraction;
  auto& bsdfs = impl_->desc.bsdfs;
  const auto add = [&](auto kind) {
    scenedesc::BsdfDesc bsdf;
    bsdf.id = "material " + std::to_string(bsdfs.size());
    bsdf.kind = std::move(kind);
    bsdfs.push_back(std::move(bsdf));
    return static_cast<int>(bsdfs.size()) - 1;
  };
  const int index = add(principled);
  if (!material.two_sided || material.transmission > 0) return index;
  scenedesc::TwoSidedDesc both;
  both.front = both.back = index;
  return add(both);
}

void SceneBuilder::add_mesh(Mesh mesh, int material, Rgb emitted, const std::string& name) {
  auto& desc = impl_->desc;
  const std::string called = name.empty() ? "mesh " + std::to_string(impl_->meshes) : name;
  if (material < 0 || static_cast<std::size_t>(material) >= desc.bsdfs.size())
    throw InputError("'" + called + "' has material " + std::to_string(material) + ", which does not exist",
                     "give a number that add_material() returned");
  require_color("the radiance of '" + called + "'", emitted, kInfinity);
  scenedesc::MeshData data;
  data.positions = std::move(mesh.positions);
  data.normals = std::move(mesh.normals);
  data.uvs = std::move(mesh.uvs);
  for (const auto& triangle : mesh.triangles)
    data.indices.insert(data.indices.end(), triangle.begin(), triangle.end());
  scenedesc::InlineMeshDesc kind;
  kind.name = called;
  kind.mesh = std::make_shared<scenedesc::MeshData>(
      scenedesc::check_mesh(std::move(data), SourceLocation{"'" + called + "'", 0}));
  scenedesc::ShapeDesc shape;
  shape.id = called;
  shape.bsdf = material;
  shape.kind = std::move(kind);
  if (emitted.r > 0 || emitted.g > 0 || emitted.b > 0) {
    scenedesc::AreaEmitterDesc lamp;
    lamp.radiance.value = emitted;
    lamp.id = called;
    shape.emitter = lamp;
  }
  desc.shapes.push_back(std::move(shape));
  ++impl_->meshes;
}

void SceneBuilder::add_point_light(Vec3f position, Rgb intensity, const std::string& name) {
  if (!finite(position)) throw InputError("a point light's position is not finite");
  require_color("a point light's intensity", intensity, kInfinity);
  scenedesc::PointLightDesc light;
  light.position = {position.x, position.y, position.z};
  light.intensity = intensity;
  add_emitter(impl_->desc, light, name);
}

void SceneBuilder::add_directional_light(Vec3f direction, Rgb irradiance, const std::string& name) {
  if (!finite(direction) || !(length_squared(direction) > 0))
    throw InputError("a directional light has no direction", "give a vector that is finite and not zero");
  require_color("a directional light's irradiance", irradiance, kInfinity);
  scenedesc::DirectionalLightDesc light;
  light.direction = normalize(direction);
  light.irradiance = irradiance;
  add_emitter(impl_->desc, light, name);
}

namespace {
void require_no_environment(const scenedesc::SceneDesc& desc) {
  for (const auto& e : desc.emitters)
    if (std::holds_alternative<scenedesc::ConstantEnvironmentDesc>(e.kind) ||
        std::holds_alternative<scenedesc::EnvironmentMapDesc>(e.kind))
      throw InputError("the scene has an environment already", "set one");
}
}  // namespace

void SceneBuilder::set_environment(Rgb radiance, const std::string& name) {
  require_no_environment(impl_->desc);
  require_color("the environment's radiance", radiance, kInfinity);
  scenedesc::ConstantEnvironmentDesc light;
  light.radiance = radiance;
  add_emitter(impl_->desc, light, name);
}

void SceneBuilder::set_environment(const std::string& image_file, float scale, const std::string& name) {
  require_no_environment(impl_->desc);
  if (!(scale >= 0 && std::isfinite(scale)))
    throw InputError("the environment's scale is not a number from 0 on");
  scenedesc::SceneDesc lit;
  scenedesc::replace_environment(lit, image_file);
  for (auto& emitter : lit.emitters) {
    if (auto* map = std::get_if<scenedesc::EnvironmentMapDesc>(&emitter.kind)) map->scale *= scale;
    emitter.id = name;
    impl_->desc.emitters.push_back(std::move(emitter));
  }
}

void SceneBuilder::set_camera(const PerspectiveCamera& camera) {
  const Vec3f ahead = camera.target - camera.origin;
  if (!finite(camera.origin) || !finite(camera.target) || !finite(camera.up) ||
      !(length_squared(cross(ahead, camera.up)) > 0))
    throw InputError("the camera looks nowhere, or along its 'up'",
                     "give an origin and a target apart from each other, and an 'up' across them");
  if (!(camera.horizontal_field > 0 && camera.horizontal_field < 180))
    throw InputError("the camera's field is " + std::to_string(camera.horizontal_field) + " degrees",
                     "give a number between 0 and 180");
  if (camera.width < 1 || camera.height < 1 || camera.width > 65536 || camera.height > 65536)
    throw InputError("the camera's picture has " + std::to_string(camera.width) + "x" +
                         std::to_string(camera.height) + " pixels",
                     "width and height lie in 1 … 65536");
  scenedesc::SensorDesc sensor;
  sensor.to_world = Transform::look_at(camera.origin, camera.target, camera.up);
  sensor.fov_x = camera.horizontal_field;
  sensor.film.width = camera.width, sensor.film.height = camera.height;
  impl_->desc.sensors = {sensor};
}

Scene SceneBuilder::build() const {
  if (impl_->desc.sensors.empty()) throw InputError("the scene has no camera", "call set_camera()");
  auto impl = std::make_shared<Scene::Impl>();
  impl->desc = impl_->desc;
  scenedesc::light_if_dark(impl->desc, {});
  return Scene(std::move(impl));
}

}  // namespace lumirank
