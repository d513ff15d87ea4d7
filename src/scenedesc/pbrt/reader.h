// State of one reading of a pbrt scene: the graphics state and its stack, names, and what has been built.
// The kinds of directives are in files of their own.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scenedesc/meshes/mesh_reader.h"
#include "scenedesc/pbrt/lens.h"
#include "scenedesc/pbrt/params.h"
#include "scenedesc/pbrt/spectra.h"
#include "scenedesc/schema/scene_reader.h"

namespace lumirank::scenedesc::pbrt {

// What AreaLightSource says, before the shape is known.
struct AreaLight {
  Place where;
  ColorInput radiance;  // "scale" included
  float power = -1;     // lumens, of each shape; below 0: not stated
  bool two_sided = false;
};

// What the attribute directives change and AttributeEnd restores.
struct GraphicsState {
  Transform at_start, at_end;  // of the shutter: they differ for what moves (ActiveTransform)
  bool reverse = false;
  int bsdf = kNone;                     // kNone: pbrt's default, made when it is needed
  int inside = kNone, outside = kNone;  // MediumInterface: slots of Reader::media_
  std::shared_ptr<const AreaLight> light;
  bool start_active = true, end_active = true;  // which of them directives change
  ColorSpace space = ColorSpace::srgb;
  // By Attribute: of "shape", "light", "material", "medium", "texture".
  std::map<std::string, std::shared_ptr<const std::vector<Parameter>>, std::less<>> defaults;
};

class Reader : public SceneReader {
 public:
  Reader(const std::string& filename, const ReadOptions& options);
  SceneDesc read(std::string text);

  GraphicsState& state() { return state_; }
  bool version3() const { return version3_; }  // of pbrt-v3
  // Factor of pixel values to radiance: exposure time × ISO / 100.
  float imaging_ratio() const { return imaging_ratio_; }
  // That and what makes the light white for which the camera is balanced, which is done to lights here: pbrt
  // does it to the picture, in a space of cones. Where surfaces are colored the two differ a little.
  Rgb white_balance() const { return white_balance_; }
  Rgb film_response() const { return white_balance_ * imaging_ratio_; }

  // Names are relative to the main file's folder, or else to that of the file that says them. "" if there is
  // no such file.
  std::string resolve(const std::string& name, const Place& where) const;
  std::string existing_file(const std::string& name, const Place& where, const std::string& kind);
  // The same, but what is missing may be a warning that `stand_in` is in its place ("": nothing is).
  NamedFile file(const std::string& name, const Place& where, const std::string& kind,
                 const std::string& stand_in);
  std::string file_text(const std::string& path, const Place& where) const;

  bool material_is_hair() const;  // the current one, if it is defined

  // textures.cpp
  int add_texture(const std::string& id, const Place& where, decltype(TextureDesc::kind) kind);
  void read_texture(Params& p, const std::string& name, const std::string& type, const std::string& kind);
  ColorInput color(Params& p, const char* name, ColorInput fallback, Intent intent);
  FloatInput scalar(Params& p, const char* name, FloatInput fallback);
  bool is_float_texture(const std::string& name) const { return float_textures_.count(name) > 0; }

  // materials.cpp: an index into the scene's BSDFs.
  int make_material(Params& p, const std::string& type, const std::string& id);
  void name_material(Params& p, const std::string& name);
  int named_material(const std::string& name, const Place& where);
  int current_bsdf(const Place& where);

  // shapes.cpp
  void read_shape(Params& p, const std::string& type);
  void begin_object(const std::string& name, const Place& where);
  void end_object(const Place& where);
  void read_instance(const std::string& name, const Place& where);

  // media.cpp: names are slots until everything is read, as media may be used before they are defined.
  int medium_slot(const std::string& name, const Place& where);  // kNone: "", which is empty space
  void name_medium(Params& p, const std::string& name);

  // lights.cpp
  void read_light(Params& p, const std::string& type);
  void read_area_light(Params& p, const std::string& type);

  // camera.cpp
  void read_camera(Params& p, const std::string& type);
  void read_lens(Params& p);
  void read_film(Params& p, const std::string& type);
  void read_filter(Params& p, const std::string& type);
  void read_sampler(Params& p, const std::string& type);
  void read_integrator(Params& p, const std::string& type);
  void finish_camera();

 private:
  struct Saved {
    GraphicsState state;
    const char* by;
    Place where;
  };
  struct Camera {
    std::string type = "perspective";
    Place where;
    Transform to_world;
    std::optional<float> aspect;
    std::vector<float> window;
    int medium = kNone;  // a slot
    float fov = 90, lens_radius = 0, focal_distance = 1e6f, exposure_time = 1;
    std::optional<Lens> lens;   // of "realistic"
    float focus_from_film = 0;  // meters
  };

  void run(const File& file);
  void directive(Tokens& tokens, const Token& word);
  void include(Tokens& tokens, const Token& word, bool import);
  bool transform_directive(Tokens& tokens, const Token& word);
  bool block_directive(Tokens& tokens, const Token& word);
  bool state_directive(Tokens& tokens, const Token& word);
  bool object_directive(Tokens& tokens, const Token& word);
  bool option_directive(Tokens& tokens, const Token& word);
  std::vector<double> take_numbers(Tokens& tokens, const Token& word, std::size_t count);
  std::string take_text(Tokens& tokens, const Token& word, const char* what);
  Params take_params(Tokens& tokens, const Token& word, const std::string& type, const char* defaults);
  void apply(const Transform& step, const Place& where);
  void set_transform(const Transform& at_start, const Transform& at_end);
  // At the time that is read, or the start.
  Transform between(const Transform& at_start, const Transform& at_end, const Place& where);
  Transform to_world(const Place& where) { return between(state_.at_start, state_.at_end, where); }
  void push(const char* by, const Place& where);
  void pop(const char* by, const char* end, const Place& where);
  void inherit(Tokens& tokens, const Token& word);
  void require_world(const Token& word, const Place& where, bool in_world) const;
  void finish();

  int masked(Params& p, const FloatInput& alpha, int bsdf);
  void add_shape(Params& p, ShapeDesc shape, const std::shared_ptr<const AreaLight>& light,
                 bool lamp_is_seen);

  int make_medium(Params& p, const std::string& name);  // kNone: it was left out
  int use_medium(int slot);                             // returns it
  MediumInterfaceDesc current_media();                  // of slots
  void resolve_media();

  const std::string main_file_;
  bool version3_ = false, ended_ = false;  // ended: by WorldEnd

  GraphicsState state_;
  std::vector<Saved> saved_;
  std::deque<File> sources_;  // places refer to their names; the texts go when they are read
  std::vector<std::string> open_files_;
  std::size_t files_ = 0;
  bool in_world_ = false;
  Place world_at_;
  std::map<std::string, std::pair<Transform, Transform>> coordinate_systems_;  // at the start and the end
  double start_time_ = 0, end_time_ = 1;                                       // TransformTimes

  void check_mixtures() const;
  std::size_t parts_of(const ColorInput& input) const;

  // Of each texture, how many look-ups one of it makes: they are nested and may share parts.
  std::vector<std::size_t> texture_parts_;
  std::map<std::string, ColorInput> color_textures_;
  std::map<std::string, FloatInput> float_textures_;
  struct NamedMaterial {
    int bsdf = kNone;  // a slot that the definition fills
    bool defined = false;
    Place first_use;
  };
  std::map<std::string, NamedMaterial> materials_;
  struct NamedMedium {
    std::string name;
    Place first_use;
    bool used = false, defined = false;  // used: by a shape or the camera
    int medium = kNone;                  // an index into the scene's media
  };
  std::vector<NamedMedium> media_;
  std::map<std::string, int> medium_slots_;
  std::map<std::pair<int, int>, int> masks_;  // (bsdf, opacity texture) → bsdf
  int default_bsdf_ = kNone;

  std::string object_;  // being defined; in_object_ tells
  bool in_object_ = false;
  int object_group_ = kNone;
  std::map<std::string, int> objects_;
  std::vector<std::pair<int, std::string>> pending_instances_;  // shapes whose object comes later

  Camera camera_;
  FilmDesc film_;
  float film_diagonal_ = 35;  // mm
  int samples_ = 16;
  bool has_camera_ = false, has_integrator_ = false;
  float iso_ = 100, imaging_ratio_ = 1, film_scale_ = 1;  // the last: of pbrt-v3
  Rgb white_balance_{1};

  friend class ShapeBuilder;
};

}  // namespace lumirank::scenedesc::pbrt
