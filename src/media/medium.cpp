#include "media/medium.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lumirank::media {
namespace {

constexpr int kMaxCells = 32;  // of the bounds, along each axis
constexpr int kPlacesPerCell = 4;

// Bounds of c·x for x within [least, most].
void add_scaled(ExtinctionBounds::Range& out, const Grid::Range& values, Rgb scale) {
  for (int c = 0; c < 3; ++c) {
    out.least[c] += scale[c] * std::max(0.0f, values.least[c]);
    out.most[c] += scale[c] * std::max(0.0f, values.most[c]);
  }
}

}  // namespace

Medium::Medium(Form form, Field first, Field second, Field emission, const PhaseFunction& phase)
    : form_(form),
      first_(std::move(first)),
      second_(std::move(second)),
      emission_(std::move(emission)),
      phase_(phase) {
  const bool sum = form == Form::absorption_and_scattering;
  if (!sum) {
    max_albedo_ = not_negative(second_.scale);
    if (second_.grid) max_albedo_ *= not_negative(second_.grid->range(Vec3f{}, Vec3f{1, 1, 1}).most);
    max_albedo_ = clamp_below(max_albedo_, 1);
  }
  if (!first_.grid && !(sum && second_.grid)) {
    even_ = extinction({});
    return;
  }
  const Field& box = first_.grid ? first_ : second_;
  to_unit_ = box.to_unit;
  std::array<int, 3> size{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    size[axis] = std::clamp(box.grid->size()[axis] / kPlacesPerCell, 1, kMaxCells);
  std::vector<ExtinctionBounds::Range> cells;
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x) {
        const Vec3f n{static_cast<float>(size[0]), static_cast<float>(size[1]), static_cast<float>(size[2])};
        const Vec3f at{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
        const Vec3f lo{at.x / n.x, at.y / n.y, at.z / n.z};
        const Vec3f hi{(at.x + 1) / n.x, (at.y + 1) / n.y, (at.z + 1) / n.z};
        ExtinctionBounds::Range range{};
        add_scaled(range, first_.grid ? first_.grid->range(lo, hi) : Grid::Range{Rgb(1), Rgb(1)},
                   first_.scale);
        if (sum)
          add_scaled(range, second_.grid ? second_.grid->range(lo, hi) : Grid::Range{Rgb(1), Rgb(1)},
                     second_.scale);
        // What interpolation rounds is not to pass the bounds.
        cells.push_back({range.least * (1 - 1e-5f), range.most * (1 + 1e-5f)});
      }
  bounds_.emplace(size, std::move(cells));
}

Coefficients Medium::at(Vec3f place) const {
  Coefficients out;
  const Rgb first = not_negative(first_.at(place)), second = not_negative(second_.at(place));
  if (form_ == Form::extinction_and_albedo) {
    out.extinction = first;
    out.scattering = first * clamp_below(second, 1);
  } else {
    out.extinction = first + second;
    out.scattering = second;
  }
  if (emits()) out.emission = emission_.at(place);
  return out;
}

Medium::Scattering Medium::max_scattering(Vec3f origin, Vec3f direction, float length) const {
  Scattering out{Rgb(0), Rgb(0)};
  // Of what is the same everywhere it is known what of it scatters.
  const bool known = homogeneous() && form_ == Form::absorption_and_scattering && !second_.grid;
  Walk walk(*this, origin, direction, length);
  Walk::Piece piece;
  while (walk.next(piece)) {
    const Rgb most = known ? not_negative(second_.scale) : piece.extinction.most * max_albedo_;
    out.total += most * std::max(0.0f, piece.end - piece.begin);
    for (int c = 0; c < 3; ++c) out.most[c] = std::max(out.most[c], most[c]);
  }
  return out;
}

float Medium::Walk::places_per_length() const {
  float most = 0;
  const Field* const box = medium_.first_.grid ? &medium_.first_ : &medium_.second_;
  for (int axis = 0; axis < 3; ++axis)
    most = std::max(most, std::abs(unit_direction_[axis]) *
                              static_cast<float>(box->grid->size()[static_cast<std::size_t>(axis)]));
  for (const Field* field : {&medium_.first_, &medium_.second_}) {
    if (!field->grid || field == box) continue;
    const Vec3f along = field->to_unit.vector(direction_);
    for (int axis = 0; axis < 3; ++axis)
      most = std::max(most, std::abs(along[axis]) *
                                static_cast<float>(field->grid->size()[static_cast<std::size_t>(axis)]));
  }
  return most;
}

std::size_t Medium::memory_bytes() const { return sizeof(Medium) + (bounds_ ? bounds_->memory_bytes() : 0); }

Medium::Walk::Walk(const Medium& medium, Vec3f origin, Vec3f direction, float t_max)
    : medium_(medium), origin_(origin), direction_(direction), t_end_(t_max) {
  if (medium.homogeneous()) return;
  unit_origin_ = medium.to_unit_.point(origin), unit_direction_ = medium.to_unit_.vector(direction);
  const Vec3f o = unit_origin_, d = unit_direction_;
  for (int axis = 0; axis < 3; ++axis) {
    if (d[axis] == 0) {
      if (!(o[axis] >= 0 && o[axis] <= 1)) t_end_ = -1;
      continue;
    }
    const float a = (0 - o[axis]) / d[axis], b = (1 - o[axis]) / d[axis];
    t_ = std::max(t_, std::min(a, b));
    t_end_ = std::min(t_end_, std::max(a, b));
  }
  if (!(t_ < t_end_)) {
    done_ = true;
    return;
  }
  const auto& size = medium.bounds_->size();
  const int strides[3] = {1, size[0], size[0] * size[1]};
  for (int axis = 0; axis < 3; ++axis) {
    const auto count = size[static_cast<std::size_t>(axis)];
    const auto n = static_cast<float>(count);
    const float p = (o[axis] + t_ * d[axis]) * n;
    const int cell = std::clamp(static_cast<int>(p), 0, count - 1);
    index_ += cell * strides[axis];
    if (d[axis] == 0) {
      next_t_[axis] = delta_t_[axis] = kInfinity;
      continue;
    }
    const bool up = d[axis] > 0;
    const float one = 1 / d[axis];
    left_[axis] = up ? count - cell : cell + 1;
    stride_[axis] = up ? strides[axis] : -strides[axis];
    next_t_[axis] = (static_cast<float>(cell + (up ? 1 : 0)) / n - o[axis]) * one;
    delta_t_[axis] = std::abs(one) / n;
  }
}

}  // namespace lumirank::media
