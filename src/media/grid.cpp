#include "media/grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lumirank::media {

Grid::Grid(std::array<int, 3> size, int channels, std::vector<float> values, Sampling sampling, bool nearest)
    : size_(size), channels_(channels), values_(std::move(values)), sampling_(sampling), nearest_(nearest) {
  const float beside = sampling == Sampling::corners ? 1.0f : 0.0f;
  steps_ = {static_cast<float>(size[0]) - beside, static_cast<float>(size[1]) - beside,
            static_cast<float>(size[2]) - beside};
  shift_ = sampling == Sampling::corners ? 0.0f : -0.5f;
}

Rgb Grid::value(int x, int y, int z) const {
  if (sampling_ == Sampling::fading_cells) {
    if (x < 0 || y < 0 || z < 0 || x >= size_[0] || y >= size_[1] || z >= size_[2]) return Rgb{0};
  } else {
    x = std::clamp(x, 0, size_[0] - 1), y = std::clamp(y, 0, size_[1] - 1),
    z = std::clamp(z, 0, size_[2] - 1);
  }
  const auto at =
      ((static_cast<std::size_t>(z) * static_cast<std::size_t>(size_[1]) + static_cast<std::size_t>(y)) *
           static_cast<std::size_t>(size_[0]) +
       static_cast<std::size_t>(x)) *
      static_cast<std::size_t>(channels_);
  return channels_ == 1 ? Rgb(values_[at]) : Rgb{values_[at], values_[at + 1], values_[at + 2]};
}

Vec3f Grid::index(Vec3f unit) const {
  return {std::clamp(unit.x, 0.0f, 1.0f) * steps_.x + shift_,
          std::clamp(unit.y, 0.0f, 1.0f) * steps_.y + shift_,
          std::clamp(unit.z, 0.0f, 1.0f) * steps_.z + shift_};
}

Rgb Grid::at(Vec3f unit) const {
  const Vec3f p = index(unit);
  if (nearest_)
    return value(static_cast<int>(std::floor(p.x + 0.5f)), static_cast<int>(std::floor(p.y + 0.5f)),
                 static_cast<int>(std::floor(p.z + 0.5f)));
  const int x = static_cast<int>(std::floor(p.x)), y = static_cast<int>(std::floor(p.y)),
            z = static_cast<int>(std::floor(p.z));
  const Vec3f f{p.x - static_cast<float>(x), p.y - static_cast<float>(y), p.z - static_cast<float>(z)};
  if (channels_ == 1 && x >= 0 && y >= 0 && z >= 0 && x + 1 < size_[0] && y + 1 < size_[1] &&
      z + 1 < size_[2]) {
    // Most look-ups: one channel, and no face of the box near.
    const auto row = static_cast<std::size_t>(size_[0]), slice = row * static_cast<std::size_t>(size_[1]);
    const float* at = values_.data() + (static_cast<std::size_t>(z) * slice +
                                        static_cast<std::size_t>(y) * row + static_cast<std::size_t>(x));
    const auto along_x = [&](std::size_t k) { return lerp(at[k], at[k + 1], f.x); };
    return Rgb(
        lerp(lerp(along_x(0), along_x(row), f.y), lerp(along_x(slice), along_x(slice + row), f.y), f.z));
  }
  const auto along_x = [&](int dy, int dz) {
    return lerp(value(x, y + dy, z + dz), value(x + 1, y + dy, z + dz), f.x);
  };
  return lerp(lerp(along_x(0, 0), along_x(1, 0), f.y), lerp(along_x(0, 1), along_x(1, 1), f.y), f.z);
}

Grid::Range Grid::range(Vec3f lo, Vec3f hi) const {
  // The numbers on whose interpolation any place in the box can depend, with a little for rounding.
  const Vec3f begin = index(lo), end = index(hi);
  constexpr float kSlack = 1e-3f;
  int from[3], to[3];
  for (int axis = 0; axis < 3; ++axis) {
    from[axis] = static_cast<int>(std::floor(begin[axis] - kSlack));
    to[axis] = static_cast<int>(std::floor(end[axis] + kSlack)) + 1;
  }
  Range out{Rgb(kInfinity), Rgb(-kInfinity)};
  for (int z = from[2]; z <= to[2]; ++z)
    for (int y = from[1]; y <= to[1]; ++y)
      for (int x = from[0]; x <= to[0]; ++x) {
        const Rgb v = value(x, y, z);
        for (int c = 0; c < 3; ++c) {
          out.least[c] = std::min(out.least[c], v[c]);
          out.most[c] = std::max(out.most[c], v[c]);
        }
      }
  return out;
}

Rgb Field::in_grid(Vec3f place) const {
  const Vec3f unit = to_unit.point(place);
  if (zero_outside &&
      !(unit.x >= 0 && unit.x <= 1 && unit.y >= 0 && unit.y <= 1 && unit.z >= 0 && unit.z <= 1))
    return Rgb{0};
  return scale * grid->at(unit);
}

}  // namespace lumirank::media
