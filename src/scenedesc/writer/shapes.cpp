#include <cstring>

#include "scenedesc/meshes/mesh_reader.h"
#include "scenedesc/writer/writer.h"

namespace lumirank::scenedesc {
namespace {

// A cubic Bézier piece as a uniform b-spline with the same four-point span: b-spline points from the Bézier
// points of one piece, by inverting the change of basis.
void bezier_to_bspline(const float b[4], float s[4]) {
  s[0] = 6 * b[0] - 7 * b[1] + 2 * b[2];
  s[1] = 2 * b[1] - b[2];
  s[2] = -b[1] + 2 * b[2];
  s[3] = 2 * b[1] - 7 * b[2] + 6 * b[3];
}

}  // namespace

std::string ply_bytes(const MeshData& mesh) {
  const std::size_t n = mesh.positions.size(), triangles = mesh.triangle_count();
  const bool normals = !mesh.normals.empty(), uvs = !mesh.uvs.empty(), colors = !mesh.colors.empty();
  std::string out = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(n) + "\n";
  const auto properties = [&](std::initializer_list<const char*> names) {
    for (const char* name : names) out += std::string("property float ") + name + "\n";
  };
  properties({"x", "y", "z"});
  if (normals) properties({"nx", "ny", "nz"});
  if (uvs) properties({"u", "v"});
  if (colors) properties({"r", "g", "b"});
  out +=
      "element face " + std::to_string(triangles) + "\nproperty list uchar int vertex_indices\nend_header\n";
  const auto put = [&](float x) {
    char bytes[4];
    std::memcpy(bytes, &x, 4);
    out.append(bytes, 4);
  };
  for (std::size_t k = 0; k < n; ++k) {
    for (int i = 0; i < 3; ++i) put(mesh.positions[k][i]);
    if (normals)
      for (int i = 0; i < 3; ++i) put(mesh.normals[k][i]);
    if (uvs) put(mesh.uvs[k].x), put(mesh.uvs[k].y);
    if (colors)
      for (int i = 0; i < 3; ++i) put(mesh.colors[k][i]);
  }
  for (std::size_t t = 0; t < triangles; ++t) {
    out += '\3';
    char bytes[12];
    std::memcpy(bytes, &mesh.indices[3 * t], 12);
    out.append(bytes, 12);
  }
  return out;
}

void MitsubaWriter::open_shape(const char* type, const std::string& id) {
  xml_.open("shape", {{"type", type}, {"id", id}});
}

void MitsubaWriter::mesh(const MeshFileDesc& file, const std::string& id) {
  // Written with the normals as they come out of it.
  // Mitsuba unpacks no files.
  if (file.filename.ends_with(".gz") || file.max_smooth_angle ||
      (!file.smooth_without_normals && !file.face_normals))
    return ply(read_mesh(file), id, "");
  const char* types[] = {"obj", "ply", "serialized"};
  open_shape(types[static_cast<int>(file.format)], id);
  xml_.string("filename", relative(file.filename));
  if (file.format == MeshFormat::serialized) xml_.integer("shape_index", file.shape_index);
  xml_.flag("face_normals", file.face_normals);
  xml_.flag("flip_tex_coords", file.flip_tex_coords);
}

void MitsubaWriter::ply(const MeshData& mesh, const std::string& id, std::string name) {
  if (name.empty()) name = add_file("mesh_" + std::to_string(out_.files.size()), ".ply", ply_bytes(mesh));
  origin_ = mesh.origin;
  open_shape("ply", id);
  xml_.string("filename", name);
  xml_.flag("face_normals", mesh.normals.empty());
  xml_.flag("flip_tex_coords", false);
}

// A text file of lines "x y z radius", an empty line between curves.
void MitsubaWriter::curves(const ShapeDesc& s, const CurvesDesc& c, const std::string& id) {
  const bool linear = c.basis == CurvesDesc::Basis::linear;
  std::string name;
  if (!c.filename.empty()) {
    if (c.file_radius > 0) warn(s.where, "curve files without radii", "the file, which it may refuse");
    name = relative(c.filename);
  } else {
    std::string text;
    const auto line = [&](const float p[4]) {
      for (int i = 0; i < 4; ++i) text += digits(p[i]) + (i < 3 ? " " : "\n");
    };
    for (std::size_t k = 0; k + 1 < c.first.size(); ++k) {
      const std::size_t begin = c.first[k], end = c.first[k + 1];
      const auto point = [&](std::size_t i, float out[4]) {
        for (int a = 0; a < 3; ++a) out[a] = c.points[i][a];
        out[3] = c.radii[i];
      };
      if (c.basis == CurvesDesc::Basis::bezier) {
        for (std::size_t i = begin; i + 3 < end; i += 3) {  // each piece by itself
          float b[4][4], spline[4][4];
          for (std::size_t j = 0; j < 4; ++j) point(i + j, b[j]);
          for (int a = 0; a < 4; ++a) {
            const float from[4] = {b[0][a], b[1][a], b[2][a], b[3][a]};
            float to[4];
            bezier_to_bspline(from, to);
            for (int j = 0; j < 4; ++j) spline[j][a] = to[j];
          }
          for (const auto& p : spline) line(p);
          text += "\n";
        }
      } else {
        for (std::size_t i = begin; i < end; ++i) {
          float p[4];
          point(i, p), line(p);
        }
        text += "\n";
      }
    }
    origin_ = c.origin;
    name = add_file("curves_" + std::to_string(out_.files.size()), ".txt", std::move(text));
  }
  open_shape(linear ? "linearcurve" : "bsplinecurve", id);
  xml_.string("filename", name);
}

void MitsubaWriter::shape(int index) {
  const ShapeDesc& s = scene_.shapes[static_cast<std::size_t>(index)];
  const std::string& id = shape_ids_[static_cast<std::size_t>(index)];
  bool group = false, instance = false;
  if (const auto* held = std::get_if<InlineMeshDesc>(&s.kind))
    if (!held->mesh || held->mesh->triangle_count() == 0)
      return warn(s.where, "shapes without a triangle (" + held->name + ")", "");
  origin_ = {};
  if (const auto* file = std::get_if<MeshFileDesc>(&s.kind)) {
    mesh(*file, id);
  } else if (const auto* held = std::get_if<InlineMeshDesc>(&s.kind)) {
    std::string& name = stored_[held->mesh.get()];  // shapes may share it
    if (name.empty())
      name = add_file("mesh_" + std::to_string(out_.files.size()), ".ply", ply_bytes(*held->mesh));
    ply(*held->mesh, id, name);
  } else if (std::holds_alternative<RectangleDesc>(s.kind)) {
    open_shape("rectangle", id);
  } else if (std::holds_alternative<CubeDesc>(s.kind)) {
    open_shape("cube", id);
  } else if (const auto* sphere = std::get_if<SphereDesc>(&s.kind)) {
    open_shape("sphere", id);
    xml_.place("point", "center", sphere->center);
    xml_.number("radius", sphere->radius);
  } else if (std::holds_alternative<DiskDesc>(s.kind)) {
    open_shape("disk", id);
  } else if (const auto* cylinder = std::get_if<CylinderDesc>(&s.kind)) {
    open_shape("cylinder", id);
    xml_.place("point", "p0", cylinder->p0), xml_.place("point", "p1", cylinder->p1);
    xml_.number("radius", cylinder->radius);
  } else if (const auto* fibers = std::get_if<CurvesDesc>(&s.kind)) {
    curves(s, *fibers, id);
  } else if (const auto* members = std::get_if<ShapeGroupDesc>(&s.kind)) {
    group = true;
    open_shape("shapegroup", id);
    for (const int member : members->shapes) shape(member);
  } else if (const auto* copy = std::get_if<InstanceDesc>(&s.kind)) {
    instance = true;
    open_shape("instance", id);
    xml_.reference(shape_ids_[static_cast<std::size_t>(copy->group)]);
  }
  if (!group)
    xml_.transform("to_world", origin_ == Vec3d{} ? s.to_world : s.to_world * Transform::translate(origin_));
  if (!group && !instance) {
    if (s.flip_normals) xml_.flag("flip_normals", true);
    if (s.bsdf != kNone) xml_.reference(bsdf_ids_[static_cast<std::size_t>(s.bsdf)]);
    divided_media(s.media);
    if (s.emitter) {
      if (s.emitter->id.empty() || s.emitter->id == s.id)
        xml_.open("emitter", {{"type", "area"}});
      else
        xml_.open("emitter", {{"type", "area"}, {"id", unique_id(s.emitter->id, "")}});
      color("radiance", s.emitter->radiance);
      if (!s.emitter->seen) warn(s.emitter->where, "a lamp that cannot be seen", "one that can");
      xml_.close();
    }
  }
  xml_.close();
}

}  // namespace lumirank::scenedesc
