// Participating media of a scene description: how much they absorb and scatter, where, and in which
// directions. Lengths are the file's; coefficients are per length of the file.
#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/rgb.h"
#include "base/transform.h"
#include "scenedesc/schema/textures.h"

namespace lumirank::scenedesc {

// What the numbers of a grid are taken at, and what lies beyond them.
enum class GridSampling : std::uint8_t {
  corners,       // the first and the last number lie on the faces of the box (Mitsuba 0.6)
  centers,       // in the middle of cells; between there and a face the outermost number holds (Mitsuba 3)
  fading_cells,  // in the middle of cells; towards the faces it fades to half (pbrt: beyond them are zeros)
};

// Numbers on a regular grid in the unit cube, interpolated linearly in all three directions: x runs fastest,
// then y, then z; `channels` (1 or 3) numbers at each place.
struct GridData {
  std::array<int, 3> size{};
  int channels = 1;
  std::vector<float> values;  // size[0]·size[1]·size[2]·channels, finite
  // The box in the coordinates of the file that it came from; the unit cube if that states none.
  Vec3f lo{0, 0, 0}, hi{1, 1, 1};
};

struct GridFileDesc {
  std::string filename;       // Mitsuba's .vol, OpenVDB's .vdb or NanoVDB's .nvdb
  bool use_grid_box = false;  // the file's box is where the grid is; false: the unit cube
  std::string grid = {};      // which of several in a sparse file; "": "density", or the only one
  // Of a numbered sequence (frame_files.h) all files, the first one first. Their boxes may differ.
  std::vector<std::string> sequence = {};

  // By the name of the file. Numbers of sparse grids belong to whole indices: their volumes are sampled at
  // corners.
  bool sparse() const {
    std::string end = filename.substr(filename.size() - std::min<std::size_t>(filename.size(), 5));
    for (char& c : end) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return end == ".nvdb" || end.ends_with(".vdb");
  }
};

// A quantity that varies in space. Beyond its box it is 0 if it is a density, and otherwise what its
// faces have.
struct VolumeDesc {
  std::string id;
  SourceLocation where;
  Transform to_world;  // from the unit cube, or with `use_grid_box` from the file's coordinates
  GridSampling sampling = GridSampling::centers;
  bool nearest = false;  // no interpolation
  std::variant<GridFileDesc, std::shared_ptr<const GridData>> kind;
};

// A constant, times a volume if there is one (an index into SceneDesc::volumes).
struct VolumeInput {
  Rgb value{1};
  int volume = kNone;
};

// A part of a phase function, by the angle between the directions before and after.
struct PhaseLobeDesc {
  enum class Kind : std::uint8_t { henyey_greenstein, schlick };
  Kind kind = Kind::henyey_greenstein;
  Rgb g{0};  // mean cosine for each channel, within (-1, 1): 0 scatters evenly, 1 goes straight on
  float weight = 1;
};

struct MediumDesc {
  std::string id;
  SourceLocation where;
  // Which two of the four coefficients are stated: formats differ, and products of two grids are none.
  enum class Form : std::uint8_t { extinction_and_albedo, absorption_and_scattering };
  Form form = Form::extinction_and_albedo;
  VolumeInput extinction, albedo{Rgb(0.75f)};
  VolumeInput absorption{Rgb(0)}, scattering;
  VolumeInput emission{Rgb(0)};      // radiance added for each length
  std::vector<PhaseLobeDesc> phase;  // empty: isotropic; weights sum to 1

  bool homogeneous() const {
    for (const VolumeInput* input : {&extinction, &albedo, &absorption, &scattering, &emission})
      if (input->volume != kNone) return false;
    return true;
  }
};

// Which media a surface divides; indices into SceneDesc::media, kNone: empty space. A ray that leaves a
// surface that divides nothing stays in the medium that it was in.
struct MediumInterfaceDesc {
  bool divides = false;
  int inside = kNone, outside = kNone;  // against the normals, and along them
};

}  // namespace lumirank::scenedesc
