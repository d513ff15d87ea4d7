#include "geometry/fibers.h"

#include <cmath>

#include "base/error.h"

namespace lumirank::geometry {
namespace {

constexpr float kTurnPerSegment = 5 * kPi / 180;
constexpr int kMaxSegments = 24;

struct Cubic {  // Bernstein form
  Vec3f p[4];
  float r[4];

  Fibers::Point at(float t) const {
    const float s = 1 - t, b0 = s * s * s, b1 = 3 * s * s * t, b2 = 3 * s * t * t, b3 = t * t * t;
    return {p[0] * b0 + p[1] * b1 + p[2] * b2 + p[3] * b3,
            std::max(0.0f, r[0] * b0 + r[1] * b1 + r[2] * b2 + r[3] * b3)};
  }

  // The angles of the control polygon add up to no less than the curve turns by.
  float turn() const {
    float sum = 0;
    Vec3f last{};
    for (int k = 0; k < 3; ++k) {
      const Vec3f edge = p[k + 1] - p[k];
      if (!(length_squared(edge) > 0)) continue;
      if (length_squared(last) > 0) sum += std::atan2(length(cross(last, edge)), dot(last, edge));
      last = edge;
    }
    return sum;
  }
};

Cubic bezier_piece(const Vec3f* p, const float* r) {
  return {{p[0], p[1], p[2], p[3]}, {r[0], r[1], r[2], r[3]}};
}

template <typename T>
void bspline_to_bernstein(const T* c, T* out) {
  const T inner0 = c[1] * (2.0f / 3) + c[2] * (1.0f / 3), inner1 = c[1] * (1.0f / 3) + c[2] * (2.0f / 3);
  const T before = c[0] * (1.0f / 3) + c[1] * (2.0f / 3), after = c[2] * (2.0f / 3) + c[3] * (1.0f / 3);
  out[0] = (before + inner0) * 0.5f, out[1] = inner0, out[2] = inner1, out[3] = (inner1 + after) * 0.5f;
}

Cubic bspline_piece(const Vec3f* p, const float* r) {
  Cubic out;
  bspline_to_bernstein(p, out.p);
  bspline_to_bernstein(r, out.r);
  return out;
}

// Appends points; a point equal to the one before begins no segment.
class Chain {
 public:
  explicit Chain(Fibers& out) : out_(out) {}
  // A curve of so many pieces follows.
  void start(std::size_t pieces) { open_ = false, piece_ = 0, pieces_ = static_cast<float>(pieces); }
  void add(const Fibers::Point& p, float piece) {
    if (open_ && out_.points.back().position == p.position) return;
    if (open_) out_.segments.push_back(static_cast<std::uint32_t>(out_.points.size() - 1));
    out_.points.push_back(p);
    out_.parameter.push_back(piece / pieces_);
    open_ = true;
  }
  void add(const Cubic& piece) {
    const int n = std::clamp(static_cast<int>(std::ceil(piece.turn() / kTurnPerSegment)), 1, kMaxSegments);
    if (!open_) add(piece.at(0), piece_);
    for (int k = 1; k <= n; ++k) {
      const float t = static_cast<float>(k) / static_cast<float>(n);
      add(piece.at(t), piece_ + t);
    }
    piece_ += 1;
  }

 private:
  Fibers& out_;
  bool open_ = false;
  float piece_ = 0, pieces_ = 1;
};

Vec3f unit_or(Vec3f v, Vec3f fallback) {
  const float len = length(v);
  return len > 0 && std::isfinite(len) ? v / len : fallback;
}

}  // namespace

double Fibers::area() const {
  double sum = 0;
  for (const std::uint32_t i : segments)
    sum += static_cast<double>(kPi) * length(points[i + 1].position - points[i].position) *
           (points[i].radius + points[i + 1].radius);
  return sum;
}

Bounds3f Fibers::bounds() const {
  Bounds3f box;
  for (const Point& p : points) {
    const Vec3f r{p.radius, p.radius, p.radius};
    box.extend(p.position - r), box.extend(p.position + r);
  }
  return box;
}

void Fibers::transform(const Transform& t) {
  const auto scale = static_cast<float>(std::cbrt(std::abs(t.determinant3())));
  for (Point& p : points) p = {t.point(p.position), p.radius * scale};
}

Fibers make_fibers(CurveBasis basis, std::span<const Vec3f> points, std::span<const float> radii,
                   std::span<const std::uint32_t> first) {
  if (radii.size() != points.size() || first.empty() || first.back() != points.size())
    throw InternalError("make_fibers: the lists do not fit together");
  Fibers out;
  out.smooth = basis != CurveBasis::linear;
  Chain chain(out);
  for (std::size_t c = 0; c + 1 < first.size(); ++c) {
    if (first[c] > first[c + 1]) throw InternalError("make_fibers: curves are not in order");
    const std::size_t n = first[c + 1] - first[c];
    const bool fits = basis == CurveBasis::linear    ? n >= 2
                      : basis == CurveBasis::bspline ? n >= 4
                                                     : n >= 4 && n % 3 == 1;
    if (!fits) throw InternalError("make_fibers: a curve of " + std::to_string(n) + " points");
    const Vec3f* p = &points[first[c]];
    const float* r = &radii[first[c]];
    chain.start(basis == CurveBasis::linear ? n - 1 : basis == CurveBasis::bspline ? n - 3 : (n - 1) / 3);
    if (basis == CurveBasis::linear)
      for (std::size_t k = 0; k < n; ++k) chain.add({p[k], std::max(0.0f, r[k])}, static_cast<float>(k));
    else if (basis == CurveBasis::bspline)
      for (std::size_t k = 0; k + 3 < n; ++k) chain.add(bspline_piece(p + k, r + k));
    else
      for (std::size_t k = 0; k + 3 < n; k += 3) chain.add(bezier_piece(p + k, r + k));
  }
  return out;
}

FiberPoint fiber_point(const Fibers& fibers, std::uint32_t segment, float u) {
  const std::uint32_t i = fibers.segments[segment];
  const Fibers::Point &a = fibers.points[i], &b = fibers.points[i + 1];
  FiberPoint out;
  // In double precision: to within one rounding on the segment, however long it is.
  for (int k = 0; k < 3; ++k) {
    const double from = a.position[k], to = b.position[k];
    out.axis[k] = static_cast<float>(from + static_cast<double>(u) * (to - from));
  }
  out.radius = lerp(a.radius, b.radius, u);
  out.parameter = lerp(fibers.parameter[i], fibers.parameter[i + 1], u);
  out.along = out.tangent = unit_or(b.position - a.position, {0, 0, 1});
  if (!fibers.smooth) return out;
  const Vec3f at_a =
      fibers.follows(segment) ? unit_or(b.position - fibers.points[i - 1].position, out.along) : out.along;
  const Vec3f at_b =
      fibers.goes_on(segment) ? unit_or(fibers.points[i + 2].position - a.position, out.along) : out.along;
  out.tangent = unit_or(lerp(at_a, at_b, u), out.along);
  return out;
}

}  // namespace lumirank::geometry
