#include <algorithm>
#include <cmath>

#include "scenedesc/ies/ies.h"

namespace lumirank::scenedesc {
namespace {

constexpr float kTurn = 2 * kPi;
constexpr float kSame = 1e-3f;  // degrees: angles that are meant to be equal

bool is(float angle, float wanted) { return std::abs(angle - wanted) < kSame; }

std::string degrees(float angle) {
  std::string text = std::to_string(angle);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text + "°";
}

// Column of the table for each angle around the whole circle.
struct Column {
  float angle;  // degrees
  std::size_t from;
};

void add(std::vector<Column>& columns, float angle, std::size_t from) {
  angle = std::fmod(angle + 720.0f, 360.0f);
  columns.push_back({is(angle, 360) ? 0 : angle, from});
}

// In ascending order; of equal angles the one that was added first.
void sort(std::vector<Column>& columns) {
  std::stable_sort(columns.begin(), columns.end(),
                   [](const Column& a, const Column& b) { return a.angle < b.angle; });
  columns.erase(std::unique(columns.begin(), columns.end(),
                            [](const Column& a, const Column& b) { return is(b.angle, a.angle); }),
                columns.end());
}

// LM-63: the last horizontal angle tells the symmetry.
std::vector<Column> whole_circle(IesData& data, const std::string& filename) {
  const auto& h = data.horizontal;
  std::vector<Column> columns;
  const auto mirrored = [&](std::initializer_list<float> axes) {
    for (std::size_t k = 0; k < h.size(); ++k) add(columns, h[k], k);
    for (const float axis : axes)  // mirror planes at axis/2: angle → axis - angle
      for (std::size_t k = 0; k < h.size(); ++k) add(columns, axis - h[k], k);
  };
  if (h.size() == 1) {
    add(columns, 0, 0);
  } else if (is(h.front(), 0) && is(h.back(), 90)) {
    mirrored({180, 360});
    for (std::size_t k = 0; k < h.size(); ++k) add(columns, h[k] + 180, k);
  } else if (is(h.front(), 0) && is(h.back(), 180)) {
    mirrored({360});
  } else if (is(h.front(), 90) && is(h.back(), 270)) {
    mirrored({180});
  } else if (is(h.front(), 0) && h.back() > 180) {
    mirrored({});
    float step = 0;
    for (std::size_t k = 1; k < h.size(); ++k) step = std::max(step, h[k] - h[k - 1]);
    if (!is(h.back(), 360)) {
      if (360 - h.back() > 1.5f * step)
        throw InputError({filename, 0},
                         "the horizontal angles end at " + degrees(h.back()) + " and leave a gap up to 360°",
                         "let them end at 0, 90, 180 or 360");
      data.warn({filename, 0}, "horizontal angles that end at " + degrees(h.back()),
                "values between those there and at 0° up to 360°");
    }
  } else {
    throw InputError({filename, 0},
                     "the horizontal angles go from " + degrees(h.front()) + " to " + degrees(h.back()) +
                         ", which tells no symmetry",
                     "let them go from 0 to 0, 90, 180 or 360, or from 90 to 270");
  }
  return columns;
}

PolarTable from_type_c(IesData& data, const std::string& filename) {
  std::vector<Column> columns = whole_circle(data, filename);
  // Horizontal angles turn the other way about the local +z, which points down: phi = 360° - angle.
  for (Column& c : columns) c.angle = c.angle > 0 ? 360 - c.angle : 0;
  sort(columns);
  columns.push_back({360, columns.front().from});
  PolarTable out;
  for (const Column& c : columns) out.phi.push_back(c.angle * (kPi / 180));
  out.phi.front() = 0, out.phi.back() = kTurn;
  for (std::size_t v = 0; v < data.vertical.size(); ++v) {
    out.theta.push_back(std::min(data.vertical[v] * (kPi / 180), kPi));
    for (const Column& c : columns) out.values.push_back(data.candela[c.from * data.vertical.size() + v]);
  }
  const auto edge = [](float angle) { return is(angle, 0) || is(angle, 90) || is(angle, 180); };
  if (!edge(data.vertical.front()) || !edge(data.vertical.back()))
    data.warn(
        {filename, 0},
        "vertical angles from " + degrees(data.vertical.front()) + " to " + degrees(data.vertical.back()),
        "no light beyond them");
  return out;
}

// Bilinear in the file's own angles; 0 beyond them.
float look_up(const IesData& data, float vertical, float horizontal) {
  const auto place = [](const std::vector<float>& angles, float x, std::size_t& index) {
    // Half a degree's rounding must not darken the edge.
    if (x < angles.front() - kSame || x > angles.back() + kSame) return -1.0f;
    if (angles.size() == 1) return index = 0, 0.0f;
    const auto above = std::upper_bound(angles.begin() + 1, angles.end() - 1, x);
    index = static_cast<std::size_t>(above - angles.begin()) - 1;
    return std::clamp((x - angles[index]) / (angles[index + 1] - angles[index]), 0.0f, 1.0f);
  };
  std::size_t v = 0, h = 0;
  const float tv = place(data.vertical, vertical, v), th = place(data.horizontal, horizontal, h);
  if (tv < 0 || th < 0) return 0;
  const auto along = [&](std::size_t column) {
    const float* c = &data.candela[column * data.vertical.size()];
    return c[v] + (c[v + 1] - c[v]) * tv;
  };
  return th > 0 ? along(h) * (1 - th) + along(h + 1) * th : along(h);
}

// LM-63-2002, 3.0: in types A and B horizontal angles turn clockwise seen from above, and type B's planes
// share a horizontal axis. With x towards horizontal angle 0 and z to the nadir, "clockwise from x" is
// towards +y.
PolarTable from_other_poles(const IesData& data, const std::string& filename) {
  const bool lone = data.horizontal.size() == 1;
  const bool symmetric = is(data.horizontal.front(), 0) && !lone;
  if (lone || data.horizontal.front() > kSame)
    throw InputError({filename, 0},
                     "the horizontal angles of photometric type A or B begin at " +
                         degrees(data.horizontal.front()) + (lone ? " and end there" : ""),
                     "let them begin at 0 (symmetric) or below");
  constexpr int kSteps = 360;  // of theta; twice as many of phi
  PolarTable out;
  for (int r = 0; r <= kSteps; ++r) out.theta.push_back(kPi * static_cast<float>(r) / kSteps);
  for (int c = 0; c <= 2 * kSteps; ++c) out.phi.push_back(kPi * static_cast<float>(c) / kSteps);
  out.theta.back() = kPi, out.phi.back() = kTurn;
  for (const float theta : out.theta)
    for (const float phi : out.phi) {
      const double x = std::sin(double{theta}) * std::cos(double{phi}),
                   y = std::sin(double{theta}) * std::sin(double{phi}), z = std::cos(double{theta});
      double v = 0, h = 0;
      if (data.type == IesData::Type::B) {
        v = std::atan2(x, z), h = std::asin(std::clamp(y, -1.0, 1.0));
        // On the axis that all planes share, v is any.
        if (std::hypot(x, z) < 1e-6) v = 0;
      } else {
        v = std::asin(std::clamp(-z, -1.0, 1.0)), h = std::atan2(y, x);
        if (std::hypot(x, y) < 1e-6) h = 0;
      }
      const double degrees = 180 / 3.14159265358979323846;
      out.values.push_back(look_up(data, static_cast<float>(v * degrees),
                                   static_cast<float>((symmetric ? std::abs(h) : h) * degrees)));
    }
  return out;
}

}  // namespace

PolarTable to_polar(IesData& data, const std::string& filename) {
  return data.type == IesData::Type::C ? from_type_c(data, filename) : from_other_poles(data, filename);
}

}  // namespace lumirank::scenedesc
