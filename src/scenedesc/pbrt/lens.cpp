#include "scenedesc/pbrt/lens.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

namespace lumirank::scenedesc::pbrt {
namespace {

struct Surface {
  double radius, way, index, diameter;
};

// A ray near the axis: its height and its slope.
struct Ray {
  double y = 0, u = 0;
  void refract(const Surface& s, double before, double after) {
    if (s.radius != 0)
      u = (before * u - y * (after - before) / s.radius) / after;
    else
      u = before * u / after;
  }
  void travel(double way) { y += way * u; }
};

double index_of(const Surface& s) { return s.index > 0 ? s.index : 1; }

// Through the surfaces [first, last), from just before the first to the last one's vertex, without the way
// behind it.
Ray through(Ray ray, const std::vector<Surface>& lens, std::size_t first, std::size_t last) {
  for (std::size_t k = first; k < last; ++k) {
    ray.refract(lens[k], k > 0 ? index_of(lens[k - 1]) : 1, index_of(lens[k]));
    if (k + 1 < last) ray.travel(lens[k].way);
  }
  return ray;
}

std::vector<Surface> surfaces_of(const std::string& text, const std::string& filename,
                                 const SourceLocation& where) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(where, "the lens file " + filename + " " + what,
                     "give four numbers for each surface: radius, thickness, index and diameter");
  };
  std::vector<double> numbers;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    for (std::string word; words >> word;) {
      std::size_t used = 0;
      double value = 0;
      try {
        value = std::stod(word, &used);
      } catch (const std::exception&) {
        used = 0;
      }
      if (used != word.size() || !std::isfinite(value)) refuse("has '" + word + "' where a number is due");
      numbers.push_back(value);
    }
  }
  if (numbers.empty() || numbers.size() % 4 != 0 || numbers.size() > 4096)
    refuse("has " + std::to_string(numbers.size()) + " numbers");
  std::vector<Surface> out;
  for (std::size_t k = 0; k < numbers.size(); k += 4)
    out.push_back({numbers[k], numbers[k + 1], numbers[k + 2], numbers[k + 3]});
  return out;
}

}  // namespace

// s + s' = D and 1/s + 1/s' = 1/f, D without what lies between the principal planes.
double Lens::image_distance(double film_to_object) const {
  const double between = film_to_object - (rear_principal - front_principal);
  const double root = between * between - 4 * focal_length * between;
  return between > 0 && root >= 0 ? 0.5 * (between - std::sqrt(root)) : 0;
}

Lens parse_lens(const std::string& text, const std::string& filename, double aperture_diameter,
                const SourceLocation& where) {
  const std::vector<Surface> lens = surfaces_of(text, filename, where);
  const std::size_t n = lens.size();
  // The stop: the surface that states neither curvature nor what is behind it. Without one, the narrowest.
  std::size_t stop = n;
  for (std::size_t k = 0; k < n && stop == n; ++k)
    if (lens[k].radius == 0 && lens[k].index == 0) stop = k;
  double stop_diameter = stop < n ? std::min(aperture_diameter, lens[stop].diameter) : aperture_diameter;
  if (stop == n) {
    stop = static_cast<std::size_t>(
        std::min_element(lens.begin(), lens.end(),
                         [](const Surface& a, const Surface& b) { return a.diameter < b.diameter; }) -
        lens.begin());
    stop_diameter = std::min(aperture_diameter, lens[stop].diameter);
  }

  double length = 0;  // from the first to the last surface
  for (std::size_t k = 0; k + 1 < n; ++k) length += lens[k].way;
  const Ray from_afar = through({1, 0}, lens, 0, n);
  Lens out;
  if (from_afar.u < 0) out.focal_length = -1 / from_afar.u;
  if (!(out.focal_length > 0 && out.focal_length < 1e9) || !(stop_diameter > 0))
    throw InputError(where, "the lens of " + filename + " throws no image",
                     "check its surfaces and their signs");
  out.rear_principal = length + (1 - from_afar.y) / from_afar.u;
  // Heights y = y₁ + b·u₁ and slopes u = c·y₁ + d·u₁: the front principal plane is at (d - 1)/c.
  out.front_principal = (through({0, 1}, lens, 0, n).u - 1) / from_afar.u;

  // The stop is crossed at a·y + b·u: it appears where that is 0, by a times as large.
  const auto to_stop = [&](Ray ray) {
    Ray at = through(ray, lens, 0, stop);
    if (stop > 0) at.travel(lens[stop - 1].way);
    return at.y;
  };
  const double a = to_stop({1, 0}), b = to_stop({0, 1});
  if (!(std::abs(a) > 1e-9))
    throw InputError(where, "the stop of " + filename + " is in focus from afar", "check its surfaces");
  out.entrance_pupil = b / a;
  out.entrance_radius = 0.5 * stop_diameter / std::abs(a);
  const Ray middle = through({0, 1}, lens, stop, n), edge = through({1, 0}, lens, stop, n);
  const double behind = middle.u != 0 ? -middle.y / middle.u : 0;
  out.exit_pupil = length + behind;
  out.exit_radius = 0.5 * stop_diameter * std::abs(edge.y + behind * edge.u);
  return out;
}

}  // namespace lumirank::scenedesc::pbrt
