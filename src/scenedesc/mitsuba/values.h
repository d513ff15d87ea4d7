// Texts of attributes as numbers, lists, colors and transforms; every failure names the file, the line and
// the text.
#pragma once

#include <string>
#include <vector>

#include "base/rgb.h"
#include "base/transform.h"
#include "scenedesc/mitsuba/element.h"

namespace lumirank::scenedesc::mitsuba {

// `what` names the value in messages: "radius", say. Numbers must be finite.
float parse_float(const std::string& text, const SourceLocation& where, const std::string& what);
double parse_double(const std::string& text, const SourceLocation& where, const std::string& what);
int parse_int(const std::string& text, const SourceLocation& where, const std::string& what);
bool parse_bool(const std::string& text, const SourceLocation& where, const std::string& what);
// Numbers separated by commas, spaces or both.
std::vector<double> parse_list(const std::string& text, const SourceLocation& where, const std::string& what);

// <point>, <vector>: x, y, z (0 if absent) or value="x, y, z".
Vec3d parse_vec3(const Element& element);
// The children of <transform>, each applied after the ones before it.
Transform parse_transform(const Element& element);

// What a spectrum stands for decides how it becomes RGB (base/spectrum.h).
enum class Intent { reflectance, emission, index };
// <rgb>, <srgb>, <spectrum value|filename>, <blackbody>, <float>, <integer>.
Rgb parse_color(const Element& element, Intent intent);
// Whether it is a <spectrum> of one number for all wavelengths, and what white of equal energy is then.
bool is_even_spectrum(const Element& element);
inline constexpr Rgb kEqualEnergy{1.20479f, 0.948315f, 0.908916f};
bool is_color_tag(const std::string& tag);

}  // namespace lumirank::scenedesc::mitsuba
