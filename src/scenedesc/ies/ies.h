// Photometric data files of luminaires: ANSI/IES LM-63 of 1986, 1991, 1995, 2002 and 2019.
#pragma once

#include <string>
#include <vector>

#include "base/vec.h"
#include "scenedesc/schema/scene_desc.h"

namespace lumirank::scenedesc {

// What a file says, its factors applied.
struct IesData {
  // How the two angles turn into a direction (LM-63-2002, 3.0 and Annex). C: vertical angle from the nadir,
  // horizontal angle about it. B: vertical angle about a horizontal axis, 0 at the nadir; horizontal angle
  // away from the plane across that axis. A: horizontal angle about the vertical axis, vertical angle above
  // the horizon.
  enum class Type { C = 1, B = 2, A = 3 };

  int year = 1986;  // of the edition
  Type type = Type::C;
  std::vector<float> vertical, horizontal;  // degrees, ascending
  // Of horizontal angle h and vertical angle v at [h · vertical.size() + v]: in candela, multiplier and
  // ballast factors included.
  std::vector<float> candela;
  int lamps = 1;
  float lumens_per_lamp = 0;  // -1: absolute photometry
  Vec3f opening;              // width, length and height in meters as the file states them
  // How the output depends on the luminaire's tilt. Empty: it does not.
  std::vector<float> tilt_angles, tilt_factors;
  std::string tilt_file;  // of TILT=FILE, as long as it has not been read
  std::vector<Warning> warnings;

  void warn(const SourceLocation& where, const std::string& what, const std::string& instead) {
    Warning& w = warnings.emplace_back();
    w.where = where, w.what = what, w.used_instead = instead;
  }
  float tilt_factor(float degrees) const;  // between the stated angles; beyond them that of the nearest
};

// InputError with file and line for whatever is not such a file. TILT=FILE is looked for in the same folder.
IesData read_ies(const std::string& filename);
// From memory; `filename` only names the source. A tilt file is not opened.
IesData parse_ies(const std::string& text, const std::string& filename);
// The contents of a tilt file: geometry, number of pairs, angles, factors.
void parse_tilt(const std::string& text, const std::string& filename, IesData& out);

// The whole sphere of directions (or the part that is not dark) in radians: theta from the local +z, phi from
// +x towards +y, in the frame of ProfileLightDesc. phi runs from 0 to 2π. values: candela, theta.size() ×
// phi.size().
struct PolarTable {
  std::vector<float> theta, phi, values;
};
// Completes symmetric type C tables exactly; samples types A and B, whose poles lie elsewhere, every half
// degree. Throws InputError if the angles do not tell the whole distribution; notes what it had to assume.
PolarTable to_polar(IesData& data, const std::string& filename);

}  // namespace lumirank::scenedesc
