// Participating media. Mitsuba 3 has extinction and albedo, each a constant or a grid, and grids whose
// numbers lie in the middle of cells; beyond its box an extinction is 0 there too. Whatever else there is
// becomes that: exactly where it can.
#include <algorithm>
#include <cmath>
#include <map>

#include "scenedesc/volumes/grid_file.h"
#include "scenedesc/volumes/vol_file.h"
#include "scenedesc/writer/writer.h"

namespace lumirank::scenedesc {
namespace {

bool is_gray(Rgb c) { return c.r == c.g && c.g == c.b; }

// 0 of nothing.
Rgb share(Rgb part, Rgb whole) {
  Rgb out{0};
  for (int c = 0; c < 3; ++c)
    if (whole[c] > 0) out[c] = part[c] / whole[c];
  return out;
}

std::size_t places(const GridData& grid) {
  return grid.values.size() / static_cast<std::size_t>(grid.channels);
}

Rgb color_at(const GridData& grid, std::size_t place) {
  if (grid.channels == 1) return Rgb(grid.values[place]);
  return {grid.values[3 * place], grid.values[3 * place + 1], grid.values[3 * place + 2]};
}

Rgb at_least_black(Rgb c) { return {std::max(c.r, 0.0f), std::max(c.g, 0.0f), std::max(c.b, 0.0f)}; }

// Other numbers at the places of a grid; one channel is enough for grays.
GridData with_numbers(const GridData& at, const std::vector<Rgb>& colors) {
  GridData out;
  out.size = at.size, out.lo = at.lo, out.hi = at.hi;
  out.channels = std::all_of(colors.begin(), colors.end(), is_gray) ? 1 : 3;
  out.values.reserve(colors.size() * static_cast<std::size_t>(out.channels));
  for (const Rgb& c : colors)
    for (int channel = 0; channel < out.channels; ++channel) out.values.push_back(c[channel]);
  return out;
}

// Whether all its outermost numbers are 0.
bool dark_outside(const GridData& grid) {
  std::size_t k = 0;
  const auto outermost = [&](int n, std::size_t axis) { return n == 0 || n == grid.size[axis] - 1; };
  for (int z = 0; z < grid.size[2]; ++z)
    for (int y = 0; y < grid.size[1]; ++y)
      for (int x = 0; x < grid.size[0]; ++x, ++k)
        if ((outermost(x, 0) || outermost(y, 1) || outermost(z, 2)) && !is_black(color_at(grid, k)))
          return false;
  return true;
}

// With zeros all around, in the same box.
GridData with_rim(const GridData& grid) {
  GridData out;
  out.channels = grid.channels, out.lo = grid.lo, out.hi = grid.hi;
  for (std::size_t axis = 0; axis < 3; ++axis) out.size[axis] = grid.size[axis] + 2;
  const auto wide = [](int n) { return static_cast<std::size_t>(n); };
  const std::size_t row = wide(grid.size[0]) * wide(grid.channels);
  out.values.assign(wide(out.size[0]) * wide(out.size[1]) * wide(out.size[2]) * wide(out.channels), 0.0f);
  for (std::size_t z = 0; z < wide(grid.size[2]); ++z)
    for (std::size_t y = 0; y < wide(grid.size[1]); ++y) {
      const auto from = grid.values.begin() + static_cast<std::ptrdiff_t>((z * wide(grid.size[1]) + y) * row);
      const std::size_t to =
          (((z + 1) * wide(out.size[1]) + y + 1) * wide(out.size[0]) + 1) * wide(out.channels);
      std::copy_n(from, row, out.values.begin() + static_cast<std::ptrdiff_t>(to));
    }
  return out;
}

}  // namespace

void MitsubaWriter::take_sparse_grids() {
  struct Taken {
    std::shared_ptr<const GridData> grid;
    Transform to_file;
  };
  std::map<std::pair<std::string, std::string>, Taken> taken;
  for (VolumeDesc& volume : volumes_) {
    const auto* file = std::get_if<GridFileDesc>(&volume.kind);
    if (!file || !file->sparse()) continue;
    const auto [at, fresh] = taken.try_emplace({file->filename, file->grid});
    Taken& known = at->second;
    if (fresh) {
      GridFile read = read_grid_file(*file);
      if (!read.too_fine.empty()) out_.warnings.push_back({volume.where, read.too_fine, read.coarser});
      known.to_file = read.to_file, known.grid = std::make_shared<const GridData>(std::move(read.numbers));
    }
    const Vec3d lo(known.grid->lo), size = Vec3d(known.grid->hi) - lo;
    volume.to_world =
        volume.to_world * (file->use_grid_box ? known.to_file
                                              : Transform::scale(1 / size.x, 1 / size.y, 1 / size.z) *
                                                    Transform::translate(lo * -1));
    volume.kind = known.grid;
  }
}

const MitsubaWriter::VolumeNumbers& MitsubaWriter::numbers(const VolumeDesc& volume) {
  if (const auto* held = std::get_if<std::shared_ptr<const GridData>>(&volume.kind)) {
    VolumeNumbers& out = numbers_[held->get()];
    out.grid = *held;
    return out;
  }
  const auto& file = std::get<GridFileDesc>(volume.kind);
  VolumeNumbers& out = file_numbers_[{file.filename, file.use_grid_box}];
  if (!out.grid) {
    GridData grid = read_vol(file.filename, &out.floats);
    if (!file.use_grid_box) grid.lo = {0, 0, 0}, grid.hi = {1, 1, 1};
    out.grid = std::make_shared<const GridData>(std::move(grid));
  }
  return out;
}

int MitsubaWriter::add_volume(VolumeDesc volume, GridData grid) {
  volume.kind = std::make_shared<const GridData>(std::move(grid));
  volume_ids_.push_back(unique_id(volume.id, "volume_" + std::to_string(volumes_.size())));
  volumes_.push_back(std::move(volume));
  return static_cast<int>(volumes_.size()) - 1;
}

// The same with its numbers in the middle of cells. What is inside the box stays; `ends`: whether there is
// nothing outside, for which a grid of this kind may be too large.
int MitsubaWriter::centered(int index, bool ends) {
  const VolumeDesc& v = volumes_[static_cast<std::size_t>(index)];
  const bool corners = v.sampling == GridSampling::corners;
  const bool fading = v.sampling == GridSampling::fading_cells && !v.nearest;
  const GridData& grid = *numbers(v).grid;
  // Of the box: half a cell more on both sides, or a whole one for the zeros.
  Vec3d stretch{1, 1, 1};
  for (int axis = 0; axis < 3; ++axis) {
    const int n = grid.size[static_cast<std::size_t>(axis)];
    if (corners && n > 1) stretch[axis] = n / (n - 1.0);
    if (fading) stretch[axis] = (n + 2.0) / n;
  }
  const bool larger = !(stretch == Vec3d{1, 1, 1});
  if (ends && larger && corners && !dark_outside(grid))
    warn(v.where, "a density that ends at the outermost numbers of its grid",
         "a grid that goes on for half a cell and is the same up to there");
  if (ends && fading)
    warn(v.where, "a density that ends where it has faded to half",
         "a grid that fades to nothing in another half cell and is the same up to there");
  const auto [known, fresh] = centered_.try_emplace(index, index);
  const bool floats = std::holds_alternative<std::shared_ptr<const GridData>>(v.kind) || numbers(v).floats;
  if (!fresh || (v.sampling == GridSampling::centers && floats)) return known->second;
  VolumeDesc out = v;
  out.sampling = GridSampling::centers;
  if (larger) {
    const Vec3d middle = (Vec3d(grid.lo) + Vec3d(grid.hi)) * 0.5;
    out.to_world = v.to_world * Transform::translate(middle) *
                   Transform::scale(stretch.x, stretch.y, stretch.z) * Transform::translate(middle * -1);
  }
  if (fading) return known->second = add_volume(std::move(out), with_rim(grid));
  if (!floats) return known->second = add_volume(std::move(out), grid);
  volume_ids_.push_back(volume_ids_[static_cast<std::size_t>(index)]);  // which itself is not written
  volumes_.push_back(std::move(out));
  return known->second = static_cast<int>(volumes_.size()) - 1;
}

// A grid times a color, where Mitsuba has no place for that.
int MitsubaWriter::times(int index, Rgb factor) {
  const VolumeDesc& v = volumes_[static_cast<std::size_t>(index)];
  const GridData& grid = *numbers(v).grid;
  std::vector<Rgb> products(places(grid));
  for (std::size_t k = 0; k < products.size(); ++k) products[k] = color_at(grid, k) * factor;
  return add_volume(v, with_numbers(grid, products));
}

MitsubaWriter::MediumInputs MitsubaWriter::extinction_and_albedo(const MediumDesc& m) {
  if (m.form == MediumDesc::Form::extinction_and_albedo) return {m.extinction, m.albedo};
  const VolumeInput &a = m.absorption, &s = m.scattering;
  if (is_black(a.value)) return {s, {Rgb(1)}};
  if (is_black(s.value)) return {a, {Rgb(0)}};
  if (a.volume == s.volume) {
    const Rgb sum = a.value + s.value;
    return {{sum, a.volume}, {share(s.value, sum)}};
  }
  return sum_of_grids(m);
}

// Of two grids, or of one and of a constant, which is where the grid is.
MitsubaWriter::MediumInputs MitsubaWriter::sum_of_grids(const MediumDesc& m) {
  VolumeInput a = m.absorption, s = m.scattering;
  for (VolumeInput* input : {&a, &s})
    if (input->volume != kNone) input->volume = centered(input->volume, true);
  const VolumeDesc& at = volumes_[static_cast<std::size_t>(s.volume != kNone ? s.volume : a.volume)];
  const GridData& grid = *numbers(at).grid;
  if (a.volume != kNone && s.volume != kNone) {
    const VolumeDesc& other = volumes_[static_cast<std::size_t>(a.volume)];
    const GridData& its = *numbers(other).grid;
    if (!(its.size == grid.size && its.lo == grid.lo && its.hi == grid.hi && other.to_world == at.to_world &&
          other.nearest == at.nearest)) {
      warn(m.where, "grids of absorption and of scattering that do not have the same places",
           "the mean of the absorption");
      double sum[3] = {};
      for (std::size_t k = 0; k < places(its); ++k)
        for (int c = 0; c < 3; ++c) sum[c] += std::max(color_at(its, k)[c], 0.0f);
      for (int c = 0; c < 3; ++c) a.value[c] *= static_cast<float>(sum[c] / static_cast<double>(places(its)));
      a.volume = kNone;
    }
  }
  const auto value = [&](const VolumeInput& input, std::size_t place) {
    if (input.volume == kNone) return input.value;
    return at_least_black(input.value *
                          color_at(*numbers(volumes_[static_cast<std::size_t>(input.volume)]).grid, place));
  };
  std::vector<Rgb> extinction(places(grid)), albedo(places(grid));
  double scattered[3] = {}, all[3] = {};
  for (std::size_t k = 0; k < albedo.size(); ++k) {
    const Rgb here = value(s, k);
    extinction[k] = value(a, k) + here, albedo[k] = share(here, extinction[k]);
    for (int c = 0; c < 3; ++c) scattered[c] += here[c], all[c] += extinction[k][c];
  }
  // What there is nothing of has no albedo, but the interpolation beside it has.
  for (std::size_t k = 0; k < albedo.size(); ++k)
    for (int c = 0; c < 3; ++c)
      if (extinction[k][c] == 0 && all[c] > 0) albedo[k][c] = static_cast<float>(scattered[c] / all[c]);
  if (!at.nearest)
    warn(m.where, "a grid of absorption beside one of scattering",
         "their sum and its albedo, which between the grid's numbers is nearly theirs");
  const int sum = add_volume(at, with_numbers(grid, extinction));
  return {{Rgb(1), sum}, {Rgb(1), add_volume(at, with_numbers(grid, albedo))}};
}

void MitsubaWriter::volume(int index) {
  if (!written_volumes_.insert(index).second) return;
  const VolumeDesc& v = volumes_[static_cast<std::size_t>(index)];
  xml_.open("volume", {{"type", "gridvolume"}, {"id", volume_ids_[static_cast<std::size_t>(index)]}});
  const auto* file = std::get_if<GridFileDesc>(&v.kind);
  if (file) {
    xml_.string("filename", relative(file->filename));
  } else {
    const GridData& grid = *std::get<std::shared_ptr<const GridData>>(v.kind);
    std::string& name = stored_[&grid];
    if (name.empty()) name = add_file("volume_" + std::to_string(out_.files.size()), ".vol", vol_bytes(grid));
    xml_.string("filename", name);
  }
  xml_.flag("use_grid_bbox", !file || file->use_grid_box);
  xml_.string("filter_type", v.nearest ? "nearest" : "trilinear");
  xml_.transform("to_world", v.to_world);
  xml_.close();
}

void MitsubaWriter::phase_function(const MediumDesc& m, std::size_t from, double sum, const char* name) {
  const PhaseLobeDesc& lobe = m.phase[from];
  const auto attributes = [&](const char* type) {
    return name ? Xml::Attributes{{"name", name}, {"type", type}} : Xml::Attributes{{"type", type}};
  };
  if (from + 1 < m.phase.size()) {
    // The first against the rest; Mitsuba tells the two apart by the order of their names.
    const double rest = sum - lobe.weight;
    xml_.open("phase", attributes("blendphase"));
    xml_.number("weight", static_cast<float>(sum > 0 ? std::clamp(rest / sum, 0.0, 1.0) : 0.0));
    phase_lobe(m, lobe, {{"name", "phase_0"}});
    phase_function(m, from + 1, rest, "phase_1");
    return xml_.close();
  }
  phase_lobe(m, lobe, name ? Xml::Attributes{{"name", name}} : Xml::Attributes{});
}

void MitsubaWriter::phase_lobe(const MediumDesc& m, const PhaseLobeDesc& lobe, Xml::Attributes attributes) {
  if (is_black(lobe.g)) {
    attributes.push_back({"type", "isotropic"});
    return xml_.leaf("phase", attributes);
  }
  if (lobe.kind == PhaseLobeDesc::Kind::schlick)
    warn(m.where, "Schlick's phase function", "that of Henyey and Greenstein of the same mean cosine");
  if (!is_gray(lobe.g)) warn(m.where, "a phase function for each color", "that of the mean cosine of all");
  attributes.push_back({"type", "hg"});
  xml_.open("phase", attributes);
  xml_.number("g", is_gray(lobe.g) ? lobe.g.r : mean(lobe.g));
  xml_.close();
}

void MitsubaWriter::medium(int index) {
  const MediumDesc& m = scene_.media[static_cast<std::size_t>(index)];
  if (!is_black(m.emission.value)) warn(m.where, "light that a medium gives off", "");
  auto [extinction, albedo] = extinction_and_albedo(m);
  if (extinction.volume != kNone) {
    extinction.volume = centered(extinction.volume, true);
    // A gray factor is the medium's scale.
    if (!is_gray(extinction.value)) extinction = {Rgb(1), times(extinction.volume, extinction.value)};
    volume(extinction.volume);
  }
  if (albedo.volume != kNone) {
    albedo.volume = centered(albedo.volume, false);
    if (!(albedo.value == Rgb(1))) albedo = {Rgb(1), times(albedo.volume, albedo.value)};
    volume(albedo.volume);
  }
  // A constant extinction goes with an albedo of any kind; it has no end.
  xml_.open("medium", {{"type", extinction.volume == kNone ? "homogeneous" : "heterogeneous"},
                       {"id", medium_ids_[static_cast<std::size_t>(index)]}});
  float scale = 1;
  if (extinction.volume != kNone) {
    xml_.reference(volume_ids_[static_cast<std::size_t>(extinction.volume)], "sigma_t");
    scale = extinction.value.r;
  } else if (is_gray(extinction.value)) {
    xml_.number("sigma_t", extinction.value.r);
  } else {
    // Colors above 1 are refused by most versions of Mitsuba 3. Powers of two change no digit.
    scale = std::exp2(std::ceil(std::log2(std::max(1.0f, max_component(extinction.value)))));
    xml_.color("sigma_t", extinction.value * (1 / scale));
  }
  if (scale != 1) xml_.number("scale", scale);
  if (albedo.volume != kNone)
    xml_.reference(volume_ids_[static_cast<std::size_t>(albedo.volume)], "albedo");
  else
    xml_.color("albedo", clamp_below(albedo.value, 1));
  if (!m.phase.empty()) {
    double sum = 0;
    for (const PhaseLobeDesc& lobe : m.phase) sum += lobe.weight;
    phase_function(m, 0, sum, nullptr);
  }
  xml_.close();
}

void MitsubaWriter::divided_media(const MediumInterfaceDesc& media) {
  if (!media.divides) return;
  if (media.inside != kNone) xml_.reference(medium_ids_[static_cast<std::size_t>(media.inside)], "interior");
  if (media.outside != kNone)
    xml_.reference(medium_ids_[static_cast<std::size_t>(media.outside)], "exterior");
  if (media.inside != kNone || media.outside != kNone) return;
  // Without any, it would divide nothing.
  xml_.open("medium", {{"name", "interior"}, {"type", "homogeneous"}});
  xml_.number("sigma_t", 0);
  xml_.close();
}

}  // namespace lumirank::scenedesc
