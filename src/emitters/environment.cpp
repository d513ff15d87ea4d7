// Environment light. Radiance is interpolated bilinearly between texel centers (periodic in longitude, held
// at the poles), and the sampling density is constant over each texel's solid angle, in proportion to the
// exact integral of the interpolated luminance there. So the density is zero only where the radiance is, and
// every estimator stays unbiased.
#include "emitters/environment.h"

#include <array>

#include "base/error.h"
#include "base/parallel.h"
#include "base/prefetch.h"

namespace lumirank::emitters {

namespace {

// No further off than one period.
int wrap(int x, int n) { return x < 0 ? x + n : (x >= n ? x - n : x); }

// ∫ sinθ dθ and ∫ θ sinθ dθ between a and b.
double moment0(double a, double b) { return std::cos(a) - std::cos(b); }
double moment1(double a, double b) {
  return (std::sin(b) - b * std::cos(b)) - (std::sin(a) - a * std::cos(a));
}

// Integrals over row `y` of the hat functions of the rows y-1, y, y+1 times sinθ dθ.
std::array<double, 3> row_weights(int y, int height) {
  const double step = 3.14159265358979323846 / height;
  const double a = y * step, mid = a + 0.5 * step, b = a + step;
  const double up0 = moment0(a, mid), up1 = moment1(a, mid), down0 = moment0(mid, b), down1 = moment1(mid, b);
  const double prev = (mid * up0 - up1) / step;  // weight (mid - θ)/step of the row above, on the upper half
  const double next =
      (down1 - mid * down0) / step;  // weight (θ - mid)/step of the row below, on the lower half
  return {prev, up0 + down0 - prev - next, next};
}

// Integral of the interpolated radiance over the solid angle of texel (x, y).
Rgb texel_integral(const EnvironmentEmitter& e, int x, int y, const std::array<double, 3>& weights) {
  const int xs[3] = {wrap(x - 1, e.width), x, wrap(x + 1, e.width)};
  const int ys[3] = {std::max(y - 1, 0), y, std::min(y + 1, e.height - 1)};
  const double across[3] = {0.125, 0.75, 0.125};  // ∫ of the three hats over the texel's width
  const double width = 2 * 3.14159265358979323846 / e.width;
  Rgb sum;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      sum += e.radiance[static_cast<std::size_t>(ys[j]) * e.width + xs[i]] *
             static_cast<float>(weights[j] * across[i] * width);
  return sum;
}

}  // namespace

Vec2f map_position(Vec3f d, int width, int height) {
  float u = std::atan2(d.x, -d.z) * (0.5f * kInvPi);
  if (u < 0) u += 1;
  // acos is inaccurate near the poles; atan2 of the two legs is not.
  const float v = std::atan2(std::sqrt(d.x * d.x + d.z * d.z), d.y) * kInvPi;
  return {u * static_cast<float>(width), v * static_cast<float>(height)};
}

Vec3f map_direction(Vec2f position, int width, int height) {
  const float phi = position.x / static_cast<float>(width) * 2 * kPi;
  const float theta = position.y / static_cast<float>(height) * kPi;
  const float s = std::sin(theta);
  return {s * std::sin(phi), std::cos(theta), -s * std::cos(phi)};
}

EnvironmentEmitter make_environment(int width, int height, std::vector<Rgb> radiance, const Frame& to_world) {
  if (width < 1 || height < 1 || radiance.size() != static_cast<std::size_t>(width) * height)
    throw InternalError("make_environment: the size does not fit the pixels");
  EnvironmentEmitter e;
  e.width = width, e.height = height;
  e.radiance = std::move(radiance);
  e.to_world = to_world;
  for (const Rgb& c : e.radiance)
    if (!is_finite(c) || c.r < 0 || c.g < 0 || c.b < 0)
      throw InternalError("make_environment: a radiance is negative or not finite");
  e.columns.resize(static_cast<std::size_t>(height));
  std::vector<float> row_sums(static_cast<std::size_t>(height));
  parallel_for(static_cast<std::size_t>(height), 8, [&](std::size_t begin, std::size_t end) {
    std::vector<float> weights(static_cast<std::size_t>(width));
    for (std::size_t y = begin; y < end; ++y) {
      const auto hats = row_weights(static_cast<int>(y), height);
      for (int x = 0; x < width; ++x)
        weights[static_cast<std::size_t>(x)] = luminance(texel_integral(e, x, static_cast<int>(y), hats));
      e.columns[y] = Distribution1D(weights);
      row_sums[y] = static_cast<float>(e.columns[y].total());
    }
  });
  e.rows = Distribution1D(row_sums);
  const double step = 3.14159265358979323846 / height;
  for (int y = 0; y <= height; ++y) e.edges.push_back(std::cos(y * step));
  for (std::size_t y = 0; y < e.columns.size(); ++y)
    e.solid_angles.push_back(
        static_cast<float>((e.edges[y] - e.edges[y + 1]) * 2 * 3.14159265358979323846 / width));
  return e;
}

Rgb total_radiance(const EnvironmentEmitter& e) {
  double sum[3] = {0, 0, 0};
  for (int y = 0; y < e.height; ++y) {
    const auto hats = row_weights(y, e.height);
    for (int x = 0; x < e.width; ++x) {
      const Rgb c = texel_integral(e, x, y, hats);
      for (int k = 0; k < 3; ++k) sum[k] += c[k];
    }
  }
  return {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
}

namespace {

Rgb lookup(const EnvironmentEmitter& e, Vec2f position) {
  const float x = position.x - 0.5f, y = position.y - 0.5f;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
  const auto texel = [&](int i, int j) {
    return e.radiance[static_cast<std::size_t>(std::clamp(j, 0, e.height - 1)) * e.width + wrap(i, e.width)];
  };
  return lerp(lerp(texel(x0, y0), texel(x0 + 1, y0), fx), lerp(texel(x0, y0 + 1), texel(x0 + 1, y0 + 1), fx),
              fy);
}

}  // namespace

Vec2f EnvironmentEmitter::position_of(Vec3f direction) const {
  return map_position(to_world.to_local(direction), width, height);
}

Rgb EnvironmentEmitter::eval(Vec3f direction) const {
  return width == 1 && height == 1 ? radiance[0] : lookup(*this, position_of(direction));
}

Rgb EnvironmentEmitter::eval_at(Vec2f position) const {
  return width == 1 && height == 1 ? radiance[0] : lookup(*this, position);
}

EnvironmentEmitter::Seen EnvironmentEmitter::look(Vec3f direction) const {
  const Vec2f position = position_of(direction);
  return {eval_at(position), pdf_at(position)};
}

Vec2f EnvironmentEmitter::fetch_position(Vec3f direction) const {
  const Vec2f position = position_of(direction);
  const auto row = static_cast<std::size_t>(std::clamp(static_cast<int>(position.y), 0, height - 1));
  const auto column = static_cast<std::size_t>(std::clamp(static_cast<int>(position.x), 0, width - 1));
  columns[row].fetch_pmf(column);
  fetch_around(row, column);
  return position;
}

// Interpolated with its neighbors: with one of those above and below, which may begin another line of memory.
void EnvironmentEmitter::fetch_around(std::size_t row, std::size_t column) const {
  const Rgb* texel = &radiance[row * static_cast<std::size_t>(width) + column];
  prefetch(texel);
  if (row + 1 < columns.size()) prefetch(texel + width);
  if (row > 0) prefetch(texel - width);
}

EnvironmentEmitter::Sample EnvironmentEmitter::sample(Vec2f u) const {
  if (!(rows.total() > 0)) return {{0, 1, 0}, Rgb{}, 0};
  const auto row = rows.sample(u.y);
  return sample_in({row, columns[row.index].sample(u.x)});
}

EnvironmentEmitter::Sample EnvironmentEmitter::sample_in(const Texel& texel) const {
  if (!(rows.total() > 0)) return {{0, 1, 0}, Rgb{}, 0};
  const auto& [row, column] = texel;
  // Uniform in solid angle within the texel: the cosine of the polar angle is linear.
  const double c0 = edges[row.index], c1 = edges[row.index + 1];
  const double cosine = std::clamp(c0 + (c1 - c0) * row.remapped, -1.0, 1.0);
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const double x = static_cast<double>(column.index) + column.remapped;
  const double phi = x / width * 2 * 3.14159265358979323846;
  const Vec3f local{static_cast<float>(sine * std::sin(phi)), static_cast<float>(cosine),
                    static_cast<float>(-sine * std::cos(phi))};
  Sample s;
  s.direction = to_world.to_world(local);
  const double y = std::atan2(sine, cosine) / 3.14159265358979323846 * height;
  s.radiance = eval_at({static_cast<float>(x), static_cast<float>(y)});
  s.pdf = row.pmf * column.pmf / solid_angles[row.index];
  return s;
}

Distribution1D::Sample EnvironmentEmitter::fetch_row(Vec2f u) const {
  if (!(rows.total() > 0)) return {};
  const auto row = rows.sample(u.y);
  columns[row.index].fetch(u.x);
  return row;
}

void EnvironmentEmitter::fetch_column(Vec2f u, const Distribution1D::Sample& row) const {
  if (rows.total() > 0) columns[row.index].fetch_bins(u.x);
}

EnvironmentEmitter::Texel EnvironmentEmitter::fetch_texel(Vec2f u, const Distribution1D::Sample& row) const {
  if (!(rows.total() > 0)) return {};
  const Texel texel{row, columns[row.index].sample(u.x)};
  fetch_around(row.index, texel.column.index);
  return texel;
}

float EnvironmentEmitter::pdf(Vec3f direction) const { return pdf_at(position_of(direction)); }

float EnvironmentEmitter::pdf_at(Vec2f position) const {
  if (!(rows.total() > 0)) return 0;
  const int x = std::clamp(static_cast<int>(position.x), 0, width - 1);
  const int y = std::clamp(static_cast<int>(position.y), 0, height - 1);
  const auto row = static_cast<std::size_t>(y);
  return rows.pmf(row) * columns[row].pmf(static_cast<std::size_t>(x)) / solid_angles[row];
}

}  // namespace lumirank::emitters
