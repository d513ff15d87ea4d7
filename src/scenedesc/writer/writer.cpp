#include "scenedesc/writer/writer.h"

#include <algorithm>

namespace lumirank::scenedesc {

MitsubaWriter::MitsubaWriter(const SceneDesc& scene, const std::string& filename, const Painter& painter)
    : scene_(scene),
      filename_(filename),
      painter_(painter),
      volumes_(scene.volumes.begin(), scene.volumes.end()) {
  // Names that the scene states are kept before any is made up.
  const auto name_all = [&](const auto& list, const char* what, std::vector<std::string>& ids) {
    ids.assign(list.size(), {});
    for (std::size_t k = 0; k < list.size(); ++k)
      if (!list[k].id.empty()) ids[k] = unique_id(list[k].id, what);
    for (std::size_t k = 0; k < list.size(); ++k)
      if (ids[k].empty()) ids[k] = unique_id("", what + std::to_string(k));
  };
  name_all(scene.shapes, "shape_", shape_ids_);
  name_all(scene.bsdfs, "bsdf_", bsdf_ids_);
  name_all(scene.textures, "texture_", texture_ids_);
  name_all(scene.volumes, "volume_", volume_ids_);
  name_all(scene.media, "medium_", medium_ids_);
}

WrittenScene MitsubaWriter::write() {
  take_sparse_grids();
  xml_.open("scene", {{"version", "3.0.0"}});
  // Mitsuba's path tracer does not see media.
  xml_.open("integrator", {{"type", scene_.media.empty() ? "path" : "volpathmis"}});
  xml_.integer("max_depth", scene_.max_depth);
  if (scene_.hide_emitters) xml_.flag("hide_emitters", true);
  xml_.close();
  if (scene_.lumens_per_unit != kLumensPerUnit)
    warn({scene_.source_file, 0}, "photometric units", "the numbers as they are, which stand for W/nm there");
  for (std::size_t k = 0; k < scene_.media.size(); ++k) medium(static_cast<int>(k));
  for (const SensorDesc& s : scene_.sensors) sensor(s);
  const bool surrounded = environment();
  for (const EmitterDesc& e : scene_.emitters)
    if (!(surrounded && is_map(e))) emitter(e);
  // Only textures that something reads are written, before what reads them.
  const std::string head = xml_.take();
  for (std::size_t k = 0; k < scene_.bsdfs.size(); ++k) bsdf(static_cast<int>(k));
  for (std::size_t k = 0; k < scene_.shapes.size(); ++k)
    if (!scene_.shapes[k].in_group) shape(static_cast<int>(k));
  const std::string body = xml_.take(), textures = asked_textures();
  xml_.close();
  out_.xml = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n" + head + textures + body + xml_.take();
  return std::move(out_);
}

void MitsubaWriter::warn(const SourceLocation& where, const std::string& what, const std::string& instead) {
  if (!warned_.insert(to_string(where) + what).second) return;
  Warning& w = out_.warnings.emplace_back();
  w.where = where, w.what = "Mitsuba 3 has no place for " + what, w.used_instead = instead;
}

// Mitsuba keeps leading underscores for itself and takes dots for paths.
std::string MitsubaWriter::unique_id(const std::string& wanted, const std::string& otherwise) {
  std::string base = wanted.empty() ? otherwise : wanted;
  std::replace(base.begin(), base.end(), '.', '_');
  if (base.front() == '_') base.insert(0, "id");
  std::string id = base;
  for (int k = 2; !taken_.insert(id).second; ++k) id = base + "_" + std::to_string(k);
  return id;
}

std::string MitsubaWriter::relative(const std::string& file) const {
  std::error_code error;
  const auto folder = std::filesystem::absolute(filename_, error).parent_path();
  const auto path = std::filesystem::proximate(file, folder, error);
  return error ? file : path.generic_string();
}

std::string MitsubaWriter::add_file(const std::string& what, const std::string& extension,
                                    std::string bytes) {
  std::string name = filename_.stem().string() + "." + what + extension;
  out_.files.push_back({name, std::move(bytes)});
  return name;
}

WrittenScene write_mitsuba(const SceneDesc& scene, const std::string& filename, const Painter& painter) {
  return MitsubaWriter(scene, filename, painter).write();
}

std::vector<std::string> files_of(const SceneDesc& scene) {
  std::vector<std::string> files{scene.source_file};
  for (const TextureDesc& t : scene.textures)
    if (const auto* bitmap = std::get_if<BitmapTextureDesc>(&t.kind); bitmap && !bitmap->bytes)
      files.push_back(bitmap->filename);
  for (const BsdfDesc& b : scene.bsdfs)
    for_each_file(b.kind, [&](const FileInput& file) { files.push_back(file.name); });
  for (const VolumeDesc& v : scene.volumes)
    if (const auto* grid = std::get_if<GridFileDesc>(&v.kind)) {
      files.push_back(grid->filename);
      files.insert(files.end(), grid->sequence.begin(), grid->sequence.end());
    }
  for (const ShapeDesc& s : scene.shapes) {
    if (const auto* mesh = std::get_if<MeshFileDesc>(&s.kind)) {
      files.push_back(mesh->filename);
      files.insert(files.end(), mesh->sequence.begin(), mesh->sequence.end());
    }
    if (const auto* curves = std::get_if<CurvesDesc>(&s.kind); curves && !curves->filename.empty())
      files.push_back(curves->filename);
  }
  for (const EmitterDesc& e : scene.emitters) {
    if (const auto* map = std::get_if<EnvironmentMapDesc>(&e.kind)) files.push_back(map->filename);
    if (const auto* profile = std::get_if<ProfileLightDesc>(&e.kind)) files.push_back(profile->filename);
  }
  return files;
}

}  // namespace lumirank::scenedesc
