#include "matrix/synthetic.h"

#include <cmath>

#include "base/random.h"

namespace lumirank::matrix {

namespace {

// Pixels of a square image, two rows each.
std::vector<Vec2f> square_pixels(std::size_t rows) {
  const auto width = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(rows) / 2)));
  std::vector<Vec2f> pixel(rows);
  for (std::size_t i = 0; i < rows; ++i)
    pixel[i] = {static_cast<float>((i / 2) % width) + 0.5f, static_cast<float>((i / 2) / width) + 0.5f};
  return pixel;
}

float image_width(const std::vector<Vec2f>& pixel) {
  float w = 1;
  for (Vec2f p : pixel) w = std::max(w, std::max(p.x, p.y) + 0.5f);
  return w;
}

float log_uniform(Rng& rng, float low, float high) { return low * std::pow(high / low, rng.next_float()); }

Rgb bright_color(Rng& rng) {
  const float r = rng.next_float(), g = rng.next_float(), b = rng.next_float();
  return {0.5f + r, 0.5f + g, 0.5f + b};
}

}  // namespace

DenseMatrix clustered_matrix(const SyntheticSize& size, std::size_t clusters) {
  std::vector<Rgb> entries(size.rows * size.columns);
  std::vector<float> scale(size.columns);
  for (std::size_t j = 0; j < size.columns; ++j) {
    Rng rng(size.seed, Stage::test, 1, j);
    scale[j] = log_uniform(rng, 0.1f, 10.0f);
  }
  for (std::size_t k = 0; k < clusters; ++k) {
    Rng rng(size.seed, Stage::test, 2, k);
    const Rgb color = bright_color(rng);
    for (std::size_t i = 0; i < size.rows; ++i) {
      const float v = rng.next_float();
      for (std::size_t j = k; j < size.columns; j += clusters)
        entries[i * size.columns + j] = color * (v * scale[j]);
    }
  }
  DenseMatrix m(size.rows, size.columns, std::move(entries));
  m.pixel = square_pixels(size.rows);
  m.power = scale;
  return m;
}

DenseMatrix low_rank_matrix(const SyntheticSize& size, std::size_t rank, std::size_t groups) {
  const auto pixel = square_pixels(size.rows);
  const float width = image_width(pixel);
  std::vector<Rgb> entries(size.rows * size.columns);
  std::vector<float> power(size.columns);
  std::vector<Rgb> color(size.columns);
  for (std::size_t j = 0; j < size.columns; ++j) {
    Rng rng(size.seed, Stage::test, 3, j);
    power[j] = log_uniform(rng, 0.2f, 5.0f);
    color[j] = bright_color(rng) * (power[j] * (0.5f + rng.next_float()));
  }
  for (std::size_t k = 0; k < rank; ++k) {
    Rng rng(size.seed, Stage::test, 4, k);
    const float cx = rng.next_float(), cy = rng.next_float(), center = rng.next_float();
    const float radius = log_uniform(rng, 0.1f, 0.5f), spread = log_uniform(rng, 0.05f, 0.3f);
    std::vector<Rgb> over_columns(size.columns);
    for (std::size_t j = 0; j < size.columns; ++j) {
      const float t = (static_cast<float>(j) + 0.5f) / static_cast<float>(size.columns) - center;
      over_columns[j] = color[j] * std::exp(-t * t / (2 * spread * spread));
    }
    for (std::size_t i = 0; i < size.rows; ++i) {
      const float dx = pixel[i].x / width - cx, dy = pixel[i].y / width - cy;
      const float over_image = std::exp(-(dx * dx + dy * dy) / (2 * radius * radius));
      for (std::size_t j = 0; j < size.columns; ++j)
        entries[i * size.columns + j] += over_columns[j] * over_image;
    }
  }
  DenseMatrix m(size.rows, size.columns, std::move(entries));
  m.pixel = pixel;
  m.power = power;
  if (groups > 1) {
    m.group.resize(size.columns);
    for (std::size_t j = 0; j < size.columns; ++j) m.group[j] = static_cast<std::uint16_t>(j % groups);
  }
  return m;
}

DenseMatrix sparse_matrix(const SyntheticSize& size, double share) {
  std::vector<Rgb> entries(size.rows * size.columns);
  std::vector<float> visible(size.rows * size.columns);
  std::vector<float> power(size.columns);
  const auto patch = static_cast<std::size_t>(share * static_cast<double>(size.rows)) + 1;
  for (std::size_t j = 0; j < size.columns; ++j) {
    Rng rng(size.seed, Stage::test, 5, j);
    const Rgb color = bright_color(rng) * log_uniform(rng, 0.2f, 5.0f);
    const std::size_t start = rng.next_below(size.rows);
    if (j % 17 == 0) continue;  // no power, no light
    power[j] = norm2(color);
    for (std::size_t i = 0; i < size.rows; ++i) {
      entries[i * size.columns + j] = color * (0.2f + rng.next_float());
      const bool in_patch = (i + size.rows - start) % size.rows < patch;
      visible[i * size.columns + j] = in_patch && j % 13 != 0 ? 1.0f : 0.0f;
    }
  }
  DenseMatrix m(size.rows, size.columns, std::move(entries), std::move(visible));
  m.pixel = square_pixels(size.rows);
  m.power = power;
  return m;
}

DenseMatrix hazy_matrix(const SyntheticSize& size) {
  DenseMatrix clear = low_rank_matrix(size, 4);
  std::vector<Rgb> entries(size.rows * size.columns);
  std::vector<float> visible(size.rows * size.columns);
  for (std::size_t i = 0; i < size.rows; ++i) {
    Rng rng(size.seed, Stage::test, 10, i);
    for (std::size_t j = 0; j < size.columns; ++j) {
      entries[i * size.columns + j] = clear.at(i, j);
      visible[i * size.columns + j] = std::exp(-2 * rng.next_float());
    }
  }
  DenseMatrix m(size.rows, size.columns, std::move(entries), std::move(visible));
  m.pixel = clear.pixel;
  m.power = clear.power;
  return m;
}

DenseMatrix recess_matrix(const SyntheticSize& size) {
  DenseMatrix smooth = low_rank_matrix(size, 3);
  std::vector<Rgb> entries(size.rows * size.columns);
  for (std::size_t i = 0; i < size.rows; ++i)
    for (std::size_t j = 0; j < size.columns; ++j) entries[i * size.columns + j] = smooth.at(i, j);
  for (std::size_t j = 0; j < size.columns; ++j) {
    Rng rng(size.seed, Stage::test, 6, j);
    for (int k = 0; k < 3; ++k)
      entries[rng.next_below(size.rows) * size.columns + j] += Rgb(30.0f * smooth.power[j]);
  }
  DenseMatrix m(size.rows, size.columns, std::move(entries));
  m.pixel = smooth.pixel;
  m.power = smooth.power;
  return m;
}

namespace {
struct Occluder {
  Vec3f center;
  float radius;
  bool round;
};

bool blocks(const Occluder& o, Vec3f from, Vec3f to) {
  const float t = (o.center.z - from.z) / (to.z - from.z);
  const float x = from.x + t * (to.x - from.x) - o.center.x, y = from.y + t * (to.y - from.y) - o.center.y;
  return o.round ? x * x + y * y < o.radius * o.radius : std::max(std::abs(x), std::abs(y)) < o.radius;
}
}  // namespace

DenseMatrix occluded_matrix(const SyntheticSize& size, std::size_t occluders) {
  const auto pixel = square_pixels(size.rows);
  const float width = image_width(pixel);
  std::vector<Vec3f> receivers(size.rows), lamps(size.columns);
  std::vector<Rgb> color(size.columns);
  std::vector<float> power(size.columns);
  for (std::size_t i = 0; i < size.rows; ++i) {
    Rng rng(size.seed, Stage::test, 7, i);
    const Vec2f jitter = rng.next_2d();
    receivers[i] = {(pixel[i].x - 0.5f + jitter.x) / width, (pixel[i].y - 0.5f + jitter.y) / width, 0};
  }
  for (std::size_t j = 0; j < size.columns; ++j) {
    Rng rng(size.seed, Stage::test, 8, j);
    const Vec2f place = rng.next_2d();
    lamps[j] = {place.x, place.y, 1};
    color[j] = bright_color(rng) * log_uniform(rng, 0.5f, 2.0f);
    power[j] = luminance(color[j]);
  }
  std::vector<Occluder> in_the_way;
  for (std::size_t k = 0; k < occluders; ++k) {
    Rng rng(size.seed, Stage::test, 9, k);
    const Vec2f place = rng.next_2d();
    in_the_way.push_back(
        {{place.x, place.y, 0.2f + 0.6f * rng.next_float()}, 0.05f + 0.1f * rng.next_float(), k % 2 == 0});
  }
  std::vector<Rgb> entries(size.rows * size.columns);
  std::vector<float> visible(size.rows * size.columns);
  for (std::size_t i = 0; i < size.rows; ++i)
    for (std::size_t j = 0; j < size.columns; ++j) {
      const Vec3f to = lamps[j] - receivers[i];
      const float d2 = length_squared(to);
      entries[i * size.columns + j] = color[j] * (to.z * to.z / (d2 * d2) * kInvPi);
      bool seen = true;
      for (const Occluder& o : in_the_way) seen = seen && !blocks(o, receivers[i], lamps[j]);
      visible[i * size.columns + j] = seen ? 1.0f : 0.0f;
    }
  DenseMatrix m(size.rows, size.columns, std::move(entries), std::move(visible));
  m.pixel = pixel;
  m.row_position = receivers;
  m.row_normal.assign(size.rows, {0, 0, 1});
  m.column_position = lamps;
  m.column_normal.assign(size.columns, {0, 0, -1});
  m.power = power;
  m.emitted = color;
  return m;
}

}  // namespace lumirank::matrix
