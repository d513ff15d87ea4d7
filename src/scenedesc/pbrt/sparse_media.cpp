// Media in files of sparse grids. The density waits for the world like all volumes; what glows with its
// temperature is made of two grids of the file, and has to be known here.
#include <algorithm>
#include <cmath>

#include "scenedesc/pbrt/glow.h"
#include "scenedesc/pbrt/media_parts.h"
#include "scenedesc/schema/files.h"
#include "scenedesc/volumes/grid_file.h"

namespace lumirank::scenedesc::pbrt {
namespace {

// A grid of one channel at a place of its file: between its numbers in straight lines, the outermost ones
// beyond.
float interpolated(const GridData& grid, const Vec3d& place) {
  std::size_t at[3], next[3];
  float share[3];
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    const double clamped = std::clamp(place[axis], 0.0, static_cast<double>(grid.size[k] - 1));
    at[k] = static_cast<std::size_t>(clamped);
    next[k] = std::min(at[k] + 1, static_cast<std::size_t>(grid.size[k] - 1));
    share[k] = static_cast<float>(clamped - static_cast<double>(at[k]));
  }
  const auto row = [&](std::size_t y, std::size_t z) {
    const std::size_t first =
        (z * static_cast<std::size_t>(grid.size[1]) + y) * static_cast<std::size_t>(grid.size[0]);
    return std::lerp(grid.values[first + at[0]], grid.values[first + next[0]], share[0]);
  };
  return std::lerp(std::lerp(row(at[1], at[2]), row(next[1], at[2]), share[1]),
                   std::lerp(row(at[1], next[2]), row(next[1], next[2]), share[1]), share[2]);
}

// What the medium gives off at the places of its density, for an absorption of 1.
GridData glowing(const GridFile& density, const GridFile& temperature, const Glow& glow) {
  GridData out;
  out.size = density.numbers.size, out.lo = density.numbers.lo, out.hi = density.numbers.hi, out.channels = 3;
  out.values.reserve(3 * density.numbers.values.size());
  const Transform to_temperature = *temperature.to_file.inverse() * density.to_file;
  std::size_t k = 0;
  for (int z = 0; z < out.size[2]; ++z)
    for (int y = 0; y < out.size[1]; ++y)
      for (int x = 0; x < out.size[0]; ++x) {
        const float thickness = density.numbers.values[k++];
        Rgb here{0};
        if (thickness > 0) {
          const Vec3d place =
              to_temperature.place({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
          here = glow.at(interpolated(temperature.numbers, place)) * thickness;
        }
        out.values.insert(out.values.end(), {here.r, here.g, here.b});
      }
  return out;
}

void one_channel(const GridFile& file, Params& p, const char* parameter, const std::string& grid) {
  if (file.numbers.channels != 1)
    throw InputError(p.where_of(parameter),
                     "the grid " + in_quotes(grid) + " of " + p.title() + " has three channels",
                     "name one of numbers");
}

}  // namespace

bool add_sparse_grids(Reader& reader, Params& p, const Transform& to_world, MediumDesc& out) {
  const std::string name = p.required_text("filename");
  const std::string path = resolve_path(name, SourceLocation(p.where_of("filename")).file);
  const std::string now = reader.path_at_time(path);
  const auto file = reader.file(now == path ? name : now, p.where_of("filename"), "volume", "empty space");
  const std::string grid = p.text("gridname", "density"), hot = p.text("temperaturename", "temperature");
  coefficients(reader, p, out);
  const float shine = not_negative(p, "Lescale", 1);
  const TemperatureScale scale(p);
  if (!to_world.is_finite() || !to_world.inverse())
    throw InputError(p.where(), "the transform of " + p.title() + " is singular", "a Scale by 0 perhaps");
  if (file.missing) {
    p.ignore({"g"});
    return false;
  }
  auto& volumes = reader.scene().volumes;
  const auto add = [&](decltype(VolumeDesc::kind) kind, const Transform& transform) {
    VolumeDesc volume;
    volume.where = p.where();
    volume.to_world = transform;
    volume.sampling = GridSampling::corners;
    volume.kind = std::move(kind);
    volumes.push_back(std::move(volume));
    return static_cast<int>(volumes.size()) - 1;
  };
  const GridFileDesc desc{file.name, true, grid, Reader::sequence(path)};
  if (!desc.sparse())
    p.fail("filename", "names a file of another kind", "files in .nvdb and .vdb can be read");
  out.absorption.volume = out.scattering.volume = add(desc, to_world);

  const Rgb strength = out.absorption.value * shine;
  const std::vector<std::string> names = grid_names(file.name);
  if (is_black(strength) || std::find(names.begin(), names.end(), hot) == names.end()) return true;
  const GridFile temperature = read_grid_file({file.name, true, hot});
  one_channel(temperature, p, "temperaturename", hot);
  const Glow glow(scale, temperature.numbers.values);
  if (glow.is_dark()) return true;
  const GridFile density = read_grid_file(desc);
  one_channel(density, p, "gridname", grid);
  out.emission = {
      strength * kUndivided,
      add(std::make_shared<const GridData>(glowing(density, temperature, glow)), to_world * density.to_file)};
  return true;
}

}  // namespace lumirank::scenedesc::pbrt
