#include "emitters/profile.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace lumirank::emitters {
namespace {

constexpr float kTurn = 2 * kPi;

// acos would lose half of the digits near the poles.
float polar_angle(Vec3f d) { return std::atan2(std::sqrt(d.x * d.x + d.y * d.y), d.z); }

float azimuth(Vec3f d) {
  const float phi = std::atan2(d.y, d.x);
  return std::clamp(phi < 0 ? phi + kTurn : phi, 0.0f, kTurn);
}

bool ascending(const std::vector<float>& angles) {
  return std::adjacent_find(angles.begin(), angles.end(), [](float a, float b) { return !(a < b); }) ==
         angles.end();
}

}  // namespace

AngularProfile::AngularProfile(std::vector<float> theta, std::vector<float> phi, std::vector<float> values)
    : theta_(std::move(theta)), phi_(std::move(phi)), values_(std::move(values)) {
  const bool good =
      theta_.size() >= 2 && phi_.size() >= 2 && values_.size() == theta_.size() * phi_.size() &&
      ascending(theta_) && ascending(phi_) && theta_.front() >= 0 && theta_.back() <= kPi &&
      phi_.front() == 0 && phi_.back() == kTurn &&
      std::all_of(values_.begin(), values_.end(), [](float x) { return x >= 0 && std::isfinite(x); });
  if (!good) throw InternalError("emitters::AngularProfile: a table that is not one");
  for (const float angle : theta_) cos_theta_.push_back(static_cast<float>(std::cos(double{angle})));
  std::vector<float> row_weights, weights(phi_.size() - 1);
  for (std::size_t r = 0; r + 1 < theta_.size(); ++r) {
    double sum = 0;
    for (std::size_t c = 0; c < weights.size(); ++c) {
      const double cell = cell_integral(r, c);
      weights[c] = static_cast<float>(cell), sum += cell;
    }
    row_weights.push_back(static_cast<float>(sum));
    columns_.emplace_back(weights);
  }
  rows_ = Distribution1D(row_weights);
  max_value_ = *std::max_element(values_.begin(), values_.end());
  std::size_t first = 0, last = row_weights.size();
  while (first < last && !(row_weights[first] > 0)) ++first;
  while (last > first && !(row_weights[last - 1] > 0)) --last;
  min_theta_ = theta_[first], max_theta_ = theta_[last];
}

// The mean over phi is linear in theta: a + (b - a)·t, t = (θ - θ0)/h. By parts, ∫ sinθ dθ = cosθ0 - cosθ1
// and ∫ t·sinθ dθ = (sinθ1 - sinθ0)/h - cosθ1.
double AngularProfile::cell_integral(std::size_t row, std::size_t column) const {
  const double a = 0.5 * (double{value(row, column)} + value(row, column + 1));
  const double b = 0.5 * (double{value(row + 1, column)} + value(row + 1, column + 1));
  if (!(a > 0 || b > 0)) return 0;
  const double t0 = theta_[row], t1 = theta_[row + 1];
  const double whole = std::cos(t0) - std::cos(t1);
  const double rising = (std::sin(t1) - std::sin(t0)) / (t1 - t0) - std::cos(t1);
  return std::max(0.0, (a * whole + (b - a) * rising) * (double{phi_[column + 1]} - phi_[column]));
}

// cosθ0 - cosθ1, without the loss of digits near the poles.
float AngularProfile::cell_solid_angle(std::size_t row, std::size_t column) const {
  const float t0 = theta_[row], t1 = theta_[row + 1];
  return 2 * std::sin(0.5f * (t0 + t1)) * std::sin(0.5f * (t1 - t0)) * (phi_[column + 1] - phi_[column]);
}

AngularProfile::Place AngularProfile::locate(const std::vector<float>& angles, float x) {
  const auto above = std::upper_bound(angles.begin() + 1, angles.end() - 1, x);
  const auto i = static_cast<std::size_t>(above - angles.begin()) - 1;
  return {i, std::clamp((x - angles[i]) / (angles[i + 1] - angles[i]), 0.0f, 1.0f)};
}

float AngularProfile::eval(Vec3f local) const {
  const float theta = polar_angle(local);
  if (theta < theta_.front() || theta > theta_.back()) return 0;
  const Place r = locate(theta_, theta), c = locate(phi_, azimuth(local));
  const auto across = [&](std::size_t row) {
    const float a = value(row, c.index), b = value(row, c.index + 1);
    return a + (b - a) * c.fraction;
  };
  const float a = across(r.index), b = across(r.index + 1);
  return std::max(0.0f, a + (b - a) * r.fraction);
}

IntensityProfile::Sample AngularProfile::sample(Vec2f u) const {
  if (!(integral() > 0)) return {};
  const auto row = rows_.sample(u.x);
  const auto column = columns_[row.index].sample(u.y);
  const float z0 = cos_theta_[row.index], z1 = cos_theta_[row.index + 1];
  const float z = std::clamp(z0 + (z1 - z0) * row.remapped, -1.0f, 1.0f);
  const float p0 = phi_[column.index], p1 = phi_[column.index + 1];
  const float phi = p0 + (p1 - p0) * column.remapped;
  const float radius = std::sqrt(std::max(0.0f, (1 - z) * (1 + z)));
  return {{radius * std::cos(phi), radius * std::sin(phi), z},
          row.pmf * column.pmf / cell_solid_angle(row.index, column.index)};
}

float AngularProfile::pdf(Vec3f local) const {
  const float theta = polar_angle(local);
  if (!(integral() > 0) || theta < theta_.front() || theta > theta_.back()) return 0;
  const std::size_t row = locate(theta_, theta).index, column = locate(phi_, azimuth(local)).index;
  const float row_pmf = rows_.pmf(row);
  return row_pmf > 0 ? row_pmf * columns_[row].pmf(column) / cell_solid_angle(row, column) : 0;
}

std::size_t AngularProfile::memory_bytes() const {
  const std::size_t cells = (theta_.size() - 1) * (phi_.size() - 1);
  return (theta_.size() * 2 + phi_.size() + values_.size()) * sizeof(float) + cells * sizeof(double);
}

}  // namespace lumirank::emitters
