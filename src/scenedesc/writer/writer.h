// The state of one conversion. Internal to this folder.
#pragma once

#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "scenedesc/writer/mitsuba_writer.h"
#include "scenedesc/writer/xml.h"

namespace lumirank::scenedesc {

class MitsubaWriter {
 public:
  MitsubaWriter(const SceneDesc& scene, const std::string& filename, const Painter& painter);
  WrittenScene write();

 private:
  // An input as Mitsuba 3 has it: another texture, or a constant.
  struct Input {
    Rgb value;
    int texture = kNone;
  };

  void warn(const SourceLocation& where, const std::string& what, const std::string& instead);
  std::string unique_id(const std::string& wanted, const std::string& otherwise);
  std::string relative(const std::string& file) const;
  std::string add_file(const std::string& what, const std::string& extension, std::string bytes);

  // textures.cpp
  Input resolve(int texture);
  Input resolve(const ColorInput& input);
  // Whether a picture that is painted takes the place of the texture.
  bool painted(int index);
  void bitmap(const BitmapTextureDesc& desc, const SourceLocation& where, const std::string& id);
  void texture(int index);
  // The texture by its name, and its definition along with all that are asked for.
  void reference(int texture, const char* name);
  std::string asked_textures();
  void color(const char* name, const ColorInput& input);
  void scalar(const char* name, const FloatInput& input);
  // The scalar as a constant where Mitsuba 3 takes no texture.
  void constant(const char* name, const FloatInput& input, const SourceLocation& where, const char* what);
  std::string picture_of(const BitmapTextureDesc& bitmap);

  // bsdfs.cpp
  void bsdf(int index);
  void kind_of(const BsdfDesc& desc, const std::string& id);
  void open_bsdf(const char* type, const std::string& id);
  void nested(int index);
  // All fields of roles that readers treat alike.
  template <typename Desc>
  void fields(const Desc& d);
  template <typename Desc>
  static ColorInput matt_color(const Desc& d);
  // A BSDF by its fields, and those that take more.
  template <typename Desc>
  void write(const Desc& d, const BsdfDesc& desc, const std::string& id);
  void write(const PlasticDesc& d, const BsdfDesc& desc, const std::string& id);
  void write(const PhongDesc& d, const BsdfDesc& desc, const std::string& id);
  void write(const WardDesc& d, const BsdfDesc& desc, const std::string& id);
  void write(const HairDesc& d, const BsdfDesc& desc, const std::string& id);
  void write(const HairFiberDesc& d, const BsdfDesc& desc, const std::string& id);
  void write(const CoatingDesc& d, const BsdfDesc& desc, const std::string& id);
  void write(const SheenDesc& d, const BsdfDesc& desc, const std::string& id);
  void write(const TwoSidedDesc& d, const BsdfDesc& desc, const std::string& id);
  void write(const BumpMapDesc& d, const BsdfDesc& desc, const std::string& id);
  void write(const NormalMapDesc& d, const BsdfDesc& desc, const std::string& id);
  void write(const TurnedTangentDesc& d, const BsdfDesc& desc, const std::string& id);
  void warn_of_stretch(const FloatInput& stretch, const SourceLocation& where);
  void write(const MixtureDesc& d, const BsdfDesc& desc, const std::string& id);
  void roughness(Distribution distribution, const FloatInput& alpha_u, const FloatInput& alpha_v);
  bool transmits(int index) const;
  void dull_and_glossy(const std::string& id, const ColorInput& dull, const ColorInput& glossy,
                       const FloatInput& alpha_u, const FloatInput& alpha_v);
  void lossless_plastic(const PlasticDesc& d, const BsdfDesc& desc, const std::string& id);
  void blend_rest(const MixtureDesc& d, std::size_t from, double sum, const std::string& id);

  // media.cpp
  // A volume's numbers, in its box: what VolumeDesc::to_world is applied to.
  struct VolumeNumbers {
    std::shared_ptr<const GridData> grid;
    bool floats = true;  // as a file, which Mitsuba 3 then reads
  };
  struct MediumInputs {  // their volumes are indices into volumes_
    VolumeInput extinction, albedo;
  };
  const VolumeNumbers& numbers(const VolumeDesc& volume);
  // Sparse grids, which Mitsuba does not read, are taken into memory.
  void take_sparse_grids();
  // The index of a new one: where `volume` is, with these numbers.
  int add_volume(VolumeDesc volume, GridData grid);
  int centered(int volume, bool ends);
  int times(int volume, Rgb factor);
  MediumInputs extinction_and_albedo(const MediumDesc& medium);
  MediumInputs sum_of_grids(const MediumDesc& medium);
  void volume(int index);
  // The lobes of a medium from one on, whose weights add up to `sum`. name: in what they are part of.
  void phase_function(const MediumDesc& medium, std::size_t from, double sum, const char* name);
  void phase_lobe(const MediumDesc& medium, const PhaseLobeDesc& lobe, Xml::Attributes attributes);
  void medium(int index);
  void divided_media(const MediumInterfaceDesc& media);

  // shapes.cpp
  void shape(int index);
  void mesh(const MeshFileDesc& file, const std::string& id);
  // name: of the file, if it has been written.
  void ply(const MeshData& mesh, const std::string& id, std::string name);
  void curves(const ShapeDesc& shape, const CurvesDesc& curves, const std::string& id);
  void open_shape(const char* type, const std::string& id);

  // lights.cpp
  static bool is_map(const EmitterDesc& emitter);
  // Writes the one map that stands for all that surrounds the scene; false if they are written as they are.
  bool environment();
  void emitter(const EmitterDesc& emitter);
  void sky(const SunSkyDesc& d, const EmitterDesc& from, const std::string& id);
  void sensor(const SensorDesc& sensor);
  void filter(const FilterDesc& filter, const SourceLocation& where);

  const SceneDesc& scene_;
  std::filesystem::path filename_;
  Xml xml_;
  WrittenScene out_;
  std::vector<std::string> texture_ids_, bsdf_ids_, volume_ids_, medium_ids_, shape_ids_;
  std::set<std::string> taken_, warned_;
  const Painter& painter_;
  std::map<int, std::optional<BitmapTextureDesc>> painted_;
  std::vector<int> asked_;          // textures that something reads
  std::set<int> written_;           // of these
  std::deque<VolumeDesc> volumes_;  // the scene's, and those that are made of them: these stay where they are
  std::map<const GridData*, VolumeNumbers> numbers_;
  std::map<std::pair<std::string, bool>, VolumeNumbers>
      file_numbers_;  // by name and GridFileDesc::use_grid_box
  std::map<int, int> centered_;
  std::set<int> written_volumes_;
  Vec3d origin_;                               // of the positions of the mesh or curves written last
  std::map<const void*, std::string> stored_;  // meshes and pictures that are used more than once
};

}  // namespace lumirank::scenedesc
