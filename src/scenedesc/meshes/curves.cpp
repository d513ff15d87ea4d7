// Files of curves: the text form of Mitsuba 3 ("bsplinecurve", "linearcurve"), and the two forms of Mitsuba
// 0.6 ("hair"), in which all curves have one radius.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "scenedesc/meshes/mesh_parts.h"
#include "scenedesc/meshes/mesh_reader.h"
#include "scenedesc/meshes/scan.h"
#include "scenedesc/schema/files.h"

namespace lumirank::scenedesc {
namespace {

constexpr std::string_view kBinary = "BINARY_HAIR";

class CurveParser {
 public:
  CurveParser(const std::string& bytes, const CurvesDesc& curves)
      : bytes_(bytes), p_(bytes.data()), end_(bytes.data() + bytes.size()), out_(curves) {
    out_.points.clear(), out_.radii.clear();
    out_.first = {0};
  }

  CurvesDesc parse() {
    if (out_.file_radius > 0 && std::string_view(bytes_).starts_with(kBinary))
      binary();
    else
      text();
    auto [points, origin] = near_positions(places_);
    out_.points = std::move(points), out_.origin = origin;
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError({out_.filename, line_}, message, "repair or export the file again");
  }

  void text() {
    while (p_ != end_) {
      ++line_;
      skip_blanks(p_, end_);
      if (p_ == end_ || *p_ == '\n') {
        finish_curve();
      } else {
        Vec3d point;
        for (int k = 0; k < 3; ++k) point[k] = number<double>();
        add(point, out_.file_radius > 0 ? out_.file_radius : number());
        skip_blanks(p_, end_);
        if (p_ != end_ && *p_ != '\n')
          fail("there is more in the line than a point: " + quoted_word(take_word(p_, end_)));
      }
      if (p_ != end_) ++p_;
    }
    finish_curve();
  }

  template <typename Real = float>
  Real number() {
    skip_blanks(p_, end_);
    if (p_ == end_ || *p_ == '\n')
      fail(out_.file_radius > 0 ? "the line has too few numbers; a point is \"x y z\""
                                : "the line has too few numbers; a point is \"x y z radius\"");
    const char* word = p_;
    Real value;
    if (!parse_float(p_, end_, value) || (p_ != end_ && !is_blank(*p_) && *p_ != '\n')) {
      p_ = word;
      fail(quoted_word(take_word(p_, end_)) + " is not a number");
    }
    return value;
  }

  // "BINARY_HAIR", the number of points (32 bits), then x y z of each; +infinity in place of an x begins a
  // new curve.
  void binary() {
    p_ += kBinary.size();
    std::uint32_t count;
    if (!take(count)) fail("the file ends within its header");
    for (std::uint32_t k = 0; k < count; ++k) {
      Vec3f point;
      if (!take(point.x)) fail_short(k, count);
      if (point.x == kInfinity) {
        finish_curve();
        if (!take(point.x)) fail_short(k, count);
      }
      if (!take(point.y) || !take(point.z)) fail_short(k, count);
      add(point, out_.file_radius);
    }
    finish_curve();
  }
  template <typename T>
  bool take(T& value) {
    if (static_cast<std::size_t>(end_ - p_) < sizeof value) return false;
    std::memcpy(&value, p_, sizeof value);
    p_ += sizeof value;
    return true;
  }
  [[noreturn]] void fail_short(std::uint32_t k, std::uint32_t count) const {
    fail("the file ends at point " + std::to_string(k) + " of " + std::to_string(count));
  }

  void add(Vec3d point, float radius) {
    if (!is_finite(static_cast<Vec3f>(point))) fail("a point is not finite");
    if (!(radius >= 0) || !std::isfinite(radius)) fail("a radius is negative or not finite");
    if (places_.size() >= 0xfffffff0u) fail("there are more than 2^32 points");
    places_.push_back(point), out_.radii.push_back(radius);
  }

  void finish_curve() {
    const std::size_t n = places_.size() - out_.first.back();
    if (n == 0) return;
    const std::size_t min_points = out_.basis == CurvesDesc::Basis::linear ? 2 : 4;
    if (n < min_points)
      fail("the curve that ends here has " + std::to_string(n) + (n == 1 ? " point" : " points") +
           "; it needs " + std::to_string(min_points) + " or more");
    if (out_.basis == CurvesDesc::Basis::bezier && n % 3 != 1)
      fail("the bezier curve that ends here has " + std::to_string(n) + " points; 4, 7, 10, … are possible");
    out_.first.push_back(static_cast<std::uint32_t>(places_.size()));
  }

  const std::string& bytes_;
  const char *p_, *end_;
  int line_ = 0;
  std::vector<Vec3d> places_;
  CurvesDesc out_;
};

}  // namespace

CurvesDesc parse_curves(const std::string& bytes, const CurvesDesc& curves) {
  return CurveParser(bytes, curves).parse();
}

CurvesDesc read_curves(const CurvesDesc& curves) {
  return curves.filename.empty() ? curves
                                 : parse_curves(read_file(curves.filename, {curves.filename, 0}), curves);
}

}  // namespace lumirank::scenedesc
