// Participating media. What pbrt adds to radiance for each length is "Le" times the absorption there
// (VolPathIntegrator::Li), and its grids are 0 beyond their cells (SampledGrid::Lookup).
#include <algorithm>
#include <cmath>

#include "scenedesc/pbrt/glow.h"
#include "scenedesc/pbrt/media_parts.h"
#include "scenedesc/pbrt/reader.h"
#include "scenedesc/pbrt/version3.h"

namespace lumirank::scenedesc::pbrt {

namespace {

VolumeInput even(Rgb value) { return {value, kNone}; }

std::array<int, 3> grid_size(Params& p) {
  std::array<int, 3> size{};
  constexpr const char* kNames[] = {"nx", "ny", "nz"};
  for (std::size_t k = 0; k < 3; ++k) {
    size[k] = p.integer(kNames[k], 1);
    if (size[k] < 1) p.fail(kNames[k], "is not positive", "it counts the cells of a grid");
  }
  return size;
}

void check_count(Params& p, const char* name, std::size_t have, const std::array<int, 3>& size) {
  // In floating point: the product may be beyond all integers.
  if (static_cast<double>(have) == static_cast<double>(size[0]) * size[1] * size[2]) return;
  p.fail(name,
         "has " + std::to_string(have) + (have == 1 ? " value; " : " values; ") + std::to_string(size[0]) +
             " × " + std::to_string(size[1]) + " × " + std::to_string(size[2]) + " are needed",
         "\"nx\", \"ny\" and \"nz\" are the size of the grid");
}

// A number for each cell; empty if there is no such parameter.
std::vector<float> numbers(Params& p, const char* name, const std::array<int, 3>& size) {
  const auto& given = p.numbers(name, ParamType::number);
  if (given.empty()) return {};
  check_count(p, name, given.size(), size);
  std::vector<float> out(given.begin(), given.end());
  if (std::any_of(out.begin(), out.end(), [](float v) { return v < 0; }))
    p.fail(name, "is negative in places", "give 0 or more");
  return out;
}

// A color for each cell.
std::vector<Rgb> colors(Params& p, const char* name, const std::array<int, 3>& size, Intent intent) {
  const auto& given = p.numbers(name, ParamType::rgb);
  if (given.empty()) return {};
  check_count(p, name, given.size() / 3, size);
  std::vector<Rgb> out(given.size() / 3);
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (int c = 0; c < 3; ++c) out[i][c] = static_cast<float>(given[3 * i + static_cast<std::size_t>(c)]);
    if (out[i].r < 0 || out[i].g < 0 || out[i].b < 0) p.fail(name, "is negative in places", "give 0 or more");
    out[i] = from_space(out[i], p.reader().state().space, intent);
  }
  return out;
}

// A medium whose quantities have grids over one box.
class GridMaker {
 public:
  GridMaker(Reader& reader, Params& p, const Transform& to_world)
      : reader_(reader), p_(p), size_(grid_size(p)) {
    to_world_ = read_box(p).to_world(p, to_world);
  }

  void uniform(MediumDesc& out) {
    std::vector<float> density = numbers(p_, "density", size_);
    if (density.empty())
      throw InputError(p_.where(), p_.title() + " has no \"density\"",
                       "give a number for each cell: \"float density\" [ … ]");
    const float scale = not_negative(p_, "scale", 1);
    const Rgb absorption = constant(p_, "sigma_a", Rgb(1), Intent::unbounded) * scale;
    const Rgb scattering = constant(p_, "sigma_s", Rgb(1), Intent::unbounded) * scale;
    const Rgb shine = constant(p_, "Le", Rgb(0), Intent::illuminant) * absorption;
    const std::vector<float> shares = numbers(p_, "Lescale", size_);
    if (!is_black(shine)) out.emission = {shine, add_volume(shining(density, shares))};
    if (p_.has("temperature")) glowing(density, shares, absorption, out);
    p_.ignore({"temperaturescale", "temperatureoffset", "temperaturecutoff"});
    const int volume = add_volume(std::move(density));
    out.absorption = {absorption, volume}, out.scattering = {scattering, volume};
  }

  void colored(MediumDesc& out) {
    const std::vector<Rgb> absorption = colors(p_, "sigma_a", size_, Intent::unbounded);
    const std::vector<Rgb> scattering = colors(p_, "sigma_s", size_, Intent::unbounded);
    std::vector<Rgb> shine = colors(p_, "Le", size_, Intent::illuminant);
    const float scale = not_negative(p_, "scale", 1), shine_scale = not_negative(p_, "Lescale", 1);
    if (absorption.empty() && scattering.empty())
      throw InputError(p_.where(), p_.title() + " has neither \"sigma_a\" nor \"sigma_s\"",
                       "give a color for each cell: \"rgb sigma_s\" [ … ]");
    if (absorption.empty() && !shine.empty())
      p_.fail("Le", "is given without \"sigma_a\"", "what does not absorb does not shine");
    // What is not given is 1, as in pbrt; MediaBuilder lets it end at the box.
    const auto quantity = [&](const std::vector<Rgb>& cells) -> VolumeInput {
      return {Rgb(scale), cells.empty() ? kNone : add_volume(cells)};
    };
    out.absorption = quantity(absorption), out.scattering = quantity(scattering);
    if (shine.empty() || shine_scale == 0 || scale == 0) return;
    for (std::size_t i = 0; i < shine.size(); ++i) shine[i] *= absorption[i];
    out.emission = {Rgb(scale * shine_scale * kUndivided), add_volume(shine)};
  }

 private:
  // The density times what "Lescale" makes of "Le": a grid has the product at the places of the two grids'
  // numbers, and in straight lines between them.
  std::vector<float> shining(const std::vector<float>& density, const std::vector<float>& shares) const {
    std::vector<float> out = density;
    if (!shares.empty()) {
      for (std::size_t i = 0; i < out.size(); ++i) out[i] *= shares[i];
      return out;
    }
    // pbrt's default is a grid of one cell, which fades from the middle of the box to half at its faces.
    const auto share = [&](int k, int axis) {
      const auto n = static_cast<float>(size_[static_cast<std::size_t>(axis)]);
      return 1 - std::abs((static_cast<float>(k) + 0.5f) / n - 0.5f);
    };
    std::size_t i = 0;
    for (int z = 0; z < size_[2]; ++z)
      for (int y = 0; y < size_[1]; ++y)
        for (int x = 0; x < size_[0]; ++x) out[i++] *= share(x, 0) * share(y, 1) * share(z, 2);
    return out;
  }

  // Unlike "Le", what shines by its temperature is not divided by its luminance.
  void glowing(const std::vector<float>& density, const std::vector<float>& shares, Rgb absorption,
               MediumDesc& out) {
    if (p_.has("Le")) p_.fail("temperature", "is given beside \"Le\"", "keep one of them");
    const std::vector<float> given = numbers(p_, "temperature", size_);
    const Glow glow(TemperatureScale(p_), given);
    if (glow.is_dark() || is_black(absorption)) return;
    const std::vector<float> thickness = shining(density, shares);
    std::vector<Rgb> cells(given.size());
    for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = glow.at(given[i]) * thickness[i];
    out.emission = {absorption * kUndivided, add_volume(cells)};
  }

  int add_volume(std::vector<float> values, int channels = 1) {
    GridData grid;
    grid.size = size_, grid.channels = channels, grid.values = std::move(values);
    for (const float v : grid.values)
      if (!std::isfinite(v)) throw InputError(p_.where(), p_.title() + " overflows", "give smaller numbers");
    VolumeDesc out;
    out.where = p_.where();
    out.to_world = to_world_;
    out.sampling = GridSampling::fading_cells;
    out.kind = std::make_shared<const GridData>(std::move(grid));
    auto& volumes = reader_.scene().volumes;
    volumes.push_back(std::move(out));
    return static_cast<int>(volumes.size()) - 1;
  }
  int add_volume(const std::vector<Rgb>& cells) {
    std::vector<float> values;
    values.reserve(3 * cells.size());
    for (const Rgb& c : cells) values.insert(values.end(), {c.r, c.g, c.b});
    return add_volume(std::move(values), 3);
  }

  Reader& reader_;
  Params& p_;
  std::array<int, 3> size_;
  Transform to_world_;
};

void homogeneous(Reader& reader, Params& p, MediumDesc& out) {
  coefficients(reader, p, out);
  const Rgb shine = constant(p, "Le", Rgb(0), Intent::illuminant) * not_negative(p, "Lescale", 1);
  out.emission = even(shine * out.absorption.value);
}

void phase_function(Params& p, MediumDesc& out) {
  const float g = p.number("g", 0);
  if (!(g > -1 && g < 1)) p.fail("g", "is not between -1 and 1", "0 is isotropic");
  if (g != 0) out.phase = {{PhaseLobeDesc::Kind::henyey_greenstein, Rgb(g), 1}};
}

}  // namespace

int Reader::make_medium(Params& p, const std::string& name) {
  if (version3_) upgrade_medium(p);
  const std::string type = p.required_text("type");
  MediumDesc out;
  out.id = name, out.where = p.where();
  out.form = MediumDesc::Form::absorption_and_scattering;
  if (type == "homogeneous") {
    homogeneous(*this, p, out);
  } else if (type == "uniformgrid") {
    GridMaker(*this, p, to_world(p.where())).uniform(out);
  } else if (type == "rgbgrid") {
    GridMaker(*this, p, to_world(p.where())).colored(out);
  } else if (type == "cloud") {
    add_cloud(*this, p, to_world(p.where()), out);
  } else if (type == "nanovdb") {
    if (!add_sparse_grids(*this, p, to_world(p.where()), out)) return kNone;
  } else {
    p.fail("type", "is " + in_quotes(type),
           type == "heterogeneous" ? "pbrt-v4 calls it \"uniformgrid\""
                                   : "homogeneous, uniformgrid, rgbgrid, cloud and nanovdb are known");
  }
  phase_function(p, out);
  scene_.media.push_back(std::move(out));
  return static_cast<int>(scene_.media.size()) - 1;
}

int Reader::medium_slot(const std::string& name, const Place& where) {
  if (name.empty()) return kNone;
  const auto [at, fresh] = medium_slots_.try_emplace(name, static_cast<int>(media_.size()));
  if (fresh) media_.push_back({name, where});
  return at->second;
}

void Reader::name_medium(Params& p, const std::string& name) {
  if (name.empty())
    throw InputError(p.where(), "MakeNamedMedium has an empty name", "\"\" is empty space: choose another");
  const auto slot = static_cast<std::size_t>(medium_slot(name, p.where()));
  if (media_[slot].defined)
    throw InputError(p.where(), "the medium " + in_quotes(name) + " is defined twice", "rename one");
  media_[slot].defined = true;
  media_[slot].medium = make_medium(p, name);
}

int Reader::use_medium(int slot) {
  if (slot != kNone) media_[static_cast<std::size_t>(slot)].used = true;
  return slot;
}

MediumInterfaceDesc Reader::current_media() {
  const int inside = use_medium(state_.inside), outside = use_medium(state_.outside);
  // Equal ones divide nothing: a ray stays in its medium, whichever that is.
  return inside == outside ? MediumInterfaceDesc{} : MediumInterfaceDesc{true, inside, outside};
}

void Reader::resolve_media() {
  for (const NamedMedium& medium : media_)
    if (medium.used && !medium.defined)
      throw InputError(medium.first_use, "the medium " + in_quotes(medium.name) + " is not defined",
                       "define it with MakeNamedMedium");
  const auto resolve = [&](int& slot) {
    if (slot != kNone) slot = media_[static_cast<std::size_t>(slot)].medium;
  };
  for (ShapeDesc& shape : scene_.shapes) resolve(shape.media.inside), resolve(shape.media.outside);
  for (SensorDesc& sensor : scene_.sensors) resolve(sensor.medium);
  // Media may come before the camera that says what the film makes of radiance.
  for (MediumDesc& medium : scene_.media) medium.emission.value *= film_response();
}

}  // namespace lumirank::scenedesc::pbrt
