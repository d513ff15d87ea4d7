#include <cmath>

#include "base/near_origin.h"
#include "scenedesc/gltf/reader.h"
#include "scenedesc/schema/warnings.h"

namespace lumirank::scenedesc::gltf {
namespace {

constexpr int kLongerSide = 768;  // pixels, unless --size says otherwise

// glTF's cameras look along -z with +x to the right, Lumirank's along +z with +x to the left.
Transform turned(const Transform& world, const Element& node) {
  // A camera's scale means nothing (glTF 2.0, section 3.10.1), so the axes are made unit vectors at right
  // angles.
  const Vec3f back = world.vector({0, 0, 1}), up = world.vector({0, 1, 0});
  const Vec3f side = cross(up, back);
  if (!(length(side) > 0) || !(length(back) > 0))
    node.fail("flattens its camera", "give it a scale without zeros");
  const Vec3f z = back / length(back), x = side / length(side), y = cross(z, x);
  const Vec3d at = world.origin();
  Transform t;
  t.m = {-x.x, y.x, -z.x, at.x, -x.y, y.y, -z.y, at.y, -x.z, y.z, -z.z, at.z, 0, 0, 0, 1};
  return t;
}

void set_film(SensorDesc& sensor, double aspect) {
  sensor.film.width =
      aspect >= 1 ? kLongerSide : std::max(1, static_cast<int>(std::lround(kLongerSide * aspect)));
  sensor.film.height =
      aspect >= 1 ? std::max(1, static_cast<int>(std::lround(kLongerSide / aspect))) : kLongerSide;
}

}  // namespace

void Reader::build_camera(const Node& node, const Element& camera_index) {
  const Element& camera = cameras_[index_of(camera_index, cameras_.size(), "camera")];
  SensorDesc sensor;
  sensor.id = camera.text("name", name_of(node));
  sensor.where = camera.where();
  sensor.to_world = turned(node.world, node.element);
  const Element type = camera.at("type");
  if (type.text() == "perspective") {
    const Element lens = camera.at("perspective");
    const Element yfov = lens.at("yfov");
    const double angle = yfov.real();
    if (!(angle > 0 && angle < kPiD))
      yfov.fail("is not between 0 and pi", "it is the vertical angle in radians");
    sensor.kept_axis = FieldAxis::y;
    const double aspect = lens.real("aspectRatio", 4.0f / 3, 0.001f, 1000);
    set_film(sensor, aspect);
    sensor.fov_x = static_cast<float>(2 * std::atan(std::tan(angle / 2) * aspect) * 180 / kPiD);
    sensor.near_clip = lens.at("znear").real();
    if (!(sensor.near_clip > 0)) lens.at("znear").fail("is not positive", "give a small distance");
    sensor.far_clip = lens.real("zfar", 1e30f);
  } else if (type.text() == "orthographic") {
    const Element lens = camera.at("orthographic");
    sensor.kind = SensorKind::orthographic;
    const double x = std::abs(lens.at("xmag").real()), y = std::abs(lens.at("ymag").real());
    if (!(x > 0 && y > 0)) lens.fail("shows no area", "xmag and ymag must not be 0");
    if (!(x / y < 1000 && y / x < 1000)) lens.fail("is a slit", "make xmag and ymag more alike");
    set_film(sensor, x / y);
    sensor.kept_axis = FieldAxis::all;
    sensor.to_world = sensor.to_world * Transform::scale(x, x, 1);
    sensor.near_clip = lens.at("znear").real();
    if (!(sensor.near_clip >= 0)) lens.at("znear").fail("is negative", "give 0 or more");
    sensor.far_clip = lens.at("zfar").real();
  } else {
    type.fail("is \"" + type.text() + "\"", "perspective and orthographic are known");
  }
  if (!(sensor.far_clip > sensor.near_clip))
    camera.fail("has a zfar that is not beyond its znear", "make zfar larger");
  scene_.sensors.push_back(std::move(sensor));
}

void add_default_camera(SceneDesc& scene, const Element& root) {
  Bounds3d box;
  for (const ShapeDesc& shape : scene.shapes) {
    const auto* held = std::get_if<InlineMeshDesc>(&shape.kind);
    if (!held || !held->mesh) continue;
    for (const Vec3f& p : held->mesh->positions) box.extend(shape.to_world.place(p + held->mesh->origin));
  }
  if (box.empty()) return;  // nothing to see: the world says so
  constexpr double kHalfHeight = 20 * kPiD / 180;
  SensorDesc sensor;
  sensor.id = "default";
  sensor.kept_axis = FieldAxis::all;
  sensor.where = root.where();
  set_film(sensor, 4.0 / 3);
  const double tan_y = std::tan(kHalfHeight), tan_x = tan_y * 4 / 3;
  sensor.fov_x = static_cast<float>(2 * std::atan(tan_x) * 180 / kPiD);
  const Vec3d center = box.center();
  const Vec3f towards = normalize(Vec3f{0.4f, 0.3f, 1});
  const Vec3f right = normalize(cross(Vec3f{0, 1, 0}, towards)), up = cross(towards, right);
  double distance = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d &low = box.lo, &high = box.hi;
    const Vec3d p{corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z};
    const auto d = static_cast<Vec3f>(p - center);
    const double across = std::max(std::abs(dot(d, right)) / tan_x, std::abs(dot(d, up)) / tan_y);
    distance = std::max(distance, dot(d, towards) + across * 1.05);
  }
  if (!(distance > 0)) distance = 1;  // a single point
  sensor.to_world = Transform::aimed(center + Vec3d(towards) * distance, -towards, {0, 1, 0});
  sensor.near_clip = static_cast<float>(distance) * 1e-3f;
  sensor.far_clip = 1e30f;
  scene.sensors.push_back(std::move(sensor));
  add_note(scene, root.where(), "the scene has no camera and gets one that frames all of it");
}

}  // namespace lumirank::scenedesc::gltf
