// Listings: a scene's content, the methods with their parameters, the error of one picture against another.
// Typed values, and the same as text or JSON with stable keys.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "lumirank/export.h"

namespace lumirank {

// Of a scene after it was built. Lengths in the units of its file.
struct LUMIRANK_API SceneInfo {
  std::string file, format;
  std::uint64_t triangles = 0, unique_triangles = 0;  // with and without counting every instance
  std::uint64_t fiber_segments = 0;
  std::uint64_t meshes = 0;
  std::uint64_t meshes_left_out = 0;  // without a triangle, or without a file
  std::uint64_t instances = 0, textures = 0, materials = 0;
  std::uint64_t media = 0;  // participating ones

  struct Emitter {
    std::string name;
    int group = 0;                  // with --aov lights, emitters of one group are one layer
    std::array<double, 3> power{};  // W, linear RGB
  };
  std::vector<Emitter> emitters;

  std::array<std::array<double, 3>, 2> bounds{};  // lowest and highest corner

  struct Camera {
    std::string id;
    int width = 0, height = 0;
    double fov_x = 0;  // degrees
  };
  std::vector<Camera> cameras;

  int max_depth = -1;                       // of paths, as the file says; -1: unlimited
  std::uint64_t scene_bytes = 0;            // of memory
  double motion_begin = 0, motion_end = 0;  // seconds of the first and the last key; equal: nothing moves
  std::vector<std::string> moving;          // what moves, by name
  std::vector<std::string> clips;           // names for LoadOptions::clip

  // What the file has and Lumirank does not, with what is used instead; and what no picture shows.
  std::vector<std::string> warnings, notes;
  std::string listing;  // every sensor, emitter, texture, BSDF, volume, medium and shape, a line each

  std::string json() const;  // without the listing
  std::string text() const;  // with it
};

// A parameter of a method, for MethodSettings::parameters.
struct MethodParameter {
  std::string key;           // "rows"
  std::string type;          // "integer", "number", "choice"
  std::string default_text;  // "300"
  std::string range;         // "1 … 1000000", "cost|random"
  std::string unit;          // "" or "rows"
  std::string help;          // what it does and what it costs
  bool experiment = false;   // switches off a step: for experiments
};

struct MethodDescription {
  std::string name;     // for MethodSettings::name, unless of_shots
  std::string summary;  // one sentence
  std::string paper;    // "" for a baseline without one
  std::vector<MethodParameter> parameters;
  bool of_shots = false;  // makes a shot's frames together (AnimateSettings::tensor), and no single picture
};

// All methods with all their parameters.
LUMIRANK_API std::vector<MethodDescription> list_methods();
// The same for a person, and as JSON; `all`: also the parameters for experiments.
LUMIRANK_API std::string methods_text(bool all = false);
LUMIRANK_API std::string methods_json(bool all = false);

// Of a picture I against a reference R, over all pixels and channels.
struct LUMIRANK_API PictureError {
  double relative_l1 = 0;  // Σ|I-R| / ΣR
  double relative_l2 = 0;  // ‖I-R‖₂ / ‖R‖₂
  double rmse = 0;
  double relmse = 0;  // mean of (I-R)²/(R² + 0.01²·mean(R)²)
  double bias = 0;    // Σ(I-R) / ΣR
  // How different they look, 0 … 1: mean of LDR-FLIP (Andersson et al. 2020) at 67 pixels per degree, both
  // tone-mapped with one exposure, which R sets (docs/command-line.md). NaN where R is known at some pixels
  // only: the eye's filters need their neighbors.
  double flip = 0;

  std::string json() const;  // one line; null for what is not finite
};

// Of one image file against another. Throws InputError if one cannot be read, their sizes differ, or either
// has pixels that are not finite.
LUMIRANK_API PictureError error_of_file(const std::string& image_file, const std::string& reference_file);

}  // namespace lumirank
