// pbrt's clouds: a density that is computed at every place. Here it is computed once, on a grid that is as
// fine as the density's finest noise.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "scenedesc/pbrt/media_parts.h"
#include "scenedesc/pbrt/perlin_noise.h"

namespace lumirank::scenedesc::pbrt {
namespace {

// Each octave of noise is this much finer than the one before.
constexpr float kFiner = 1.99f;
constexpr int kOctaves = 5;
// Of a grid along one axis.
constexpr double kFewestCells = 32, kMostCells = 192;

struct Cloud {
  float density, wispiness, frequency;

  // At a place of the medium's own coordinates, in which clouds end at the height 1.
  float at(Vec3f p) const {
    Vec3f place = p * frequency;
    float size = 0.05f * wispiness, finer = 10;
    for (int k = 0; k < 2 && wispiness > 0; ++k, size *= 0.5f, finer *= kFiner)
      place += perlin_slope(place * finer) * size;
    float noise = 0;
    size = 0.5f, finer = 1;
    for (int k = 0; k < kOctaves; ++k, size *= 0.5f, finer *= kFiner)
      noise += size * perlin_noise(place * finer);
    const float billows = std::clamp((1 - p.y) * 4.5f * density * noise, 0.0f, 1.0f);
    return std::clamp(billows + 2 * std::max(0.0f, 0.5f - p.y), 0.0f, 1.0f);
  }
};

// Two for each cell of the finest octave's lattice.
int cloud_cells(double edge, float frequency) {
  const double finest = static_cast<double>(frequency) * std::pow(static_cast<double>(kFiner), kOctaves - 1);
  return static_cast<int>(std::clamp(std::ceil(2 * finest * edge), kFewestCells, kMostCells));
}

}  // namespace

void add_cloud(Reader& reader, Params& p, const Transform& to_world, MediumDesc& out) {
  const Cloud cloud{not_negative(p, "density", 1), not_negative(p, "wispiness", 1),
                    p.positive("frequency", 5)};
  const Box box = read_box(p);
  coefficients(reader, p, out);
  auto grid = std::make_shared<GridData>();
  const Vec3d size = box.hi - box.lo;
  for (int axis = 0; axis < 3; ++axis)
    grid->size[static_cast<std::size_t>(axis)] = cloud_cells(size[axis], cloud.frequency);
  const auto [nx, ny, nz] = grid->size;
  grid->values.resize(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny) *
                      static_cast<std::size_t>(nz));
  const auto rows = static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz);
  parallel_for(rows, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (int x = 0; x < grid->size[0]; ++x) {
        const auto width = static_cast<std::size_t>(grid->size[1]);
        const int cell[3] = {x, static_cast<int>(row % width), static_cast<int>(row / width)};
        Vec3f place;
        for (int axis = 0; axis < 3; ++axis)
          place[axis] = static_cast<float>(box.lo[axis] + size[axis] * (cell[axis] + 0.5) /
                                                              grid->size[static_cast<std::size_t>(axis)]);
        grid->values[row * static_cast<std::size_t>(grid->size[0]) + static_cast<std::size_t>(x)] =
            cloud.at(place);
      }
  });
  reader.warn(p.where(), "a cloud that is computed at every place (" + p.title() + ")",
              "its density at " + std::to_string(nx) + " × " + std::to_string(ny) + " × " +
                  std::to_string(nz) + " places and what is between them");
  VolumeDesc volume;
  volume.where = p.where();
  volume.to_world = box.to_world(p, to_world);
  volume.kind = std::shared_ptr<const GridData>(grid);
  auto& volumes = reader.scene().volumes;
  volumes.push_back(std::move(volume));
  out.absorption.volume = out.scattering.volume = static_cast<int>(volumes.size()) - 1;
}

}  // namespace lumirank::scenedesc::pbrt
