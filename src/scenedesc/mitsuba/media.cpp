// Participating media, their phase functions and their volumes.
#include <cmath>

#include "scenedesc/data/media.h"
#include "scenedesc/mitsuba/plugin.h"
#include "scenedesc/schema/files.h"

namespace lumirank::scenedesc::mitsuba {

namespace {

// A coefficient or an albedo: colors that are negative are an error.
VolumeInput amount(Reader& reader, Plugin& p, const std::string& name, Rgb fallback) {
  if (p.names_object(name, "volume")) return reader.volume_input(*p.take_named(name, "volume"));
  // As Mitsuba's RGB modes: coefficients are spectra without a unit, like indices.
  const Rgb value = p.constant_color(name, fallback, Intent::index);
  if (value.r < 0 || value.g < 0 || value.b < 0)
    throw InputError(p.where_of(name), "\"" + name + "\" of " + p.title() + " is negative",
                     "use values of 0 or more");
  return {value, kNone};
}

// 0.6's and 3.x's "material": a named medium, whose coefficients are for each millimeter. "scale" says how
// many millimeters a unit of the scene is, like everywhere.
bool by_name(Plugin& p, MediumDesc& out) {
  const auto name = p.text("material");
  if (!name) return false;
  const auto known = named_medium(*name);
  if (!known)
    throw InputError(p.where_of("material"), "the medium \"" + *name + "\" is not known",
                     medium_names() + " are");
  out.form = MediumDesc::Form::absorption_and_scattering;
  out.absorption = {known->absorption, kNone}, out.scattering = {known->scattering, kNone};
  out.phase = {{PhaseLobeDesc::Kind::henyey_greenstein, known->mean_cosine, 1}};
  return true;
}

void coefficients(Reader& reader, Plugin& p, MediumDesc& out) {
  const bool parts = p.has("sigma_a") || p.has("sigma_s");
  if (parts && (p.has("sigma_t") || p.has("albedo") || p.has("density")))
    throw InputError(p.where(),
                     p.title() + " has both \"sigma_t\" or \"albedo\" and \"sigma_a\" or \"sigma_s\"",
                     "keep one of the pairs");
  if (parts) {
    out.form = MediumDesc::Form::absorption_and_scattering;
    out.absorption = amount(reader, p, "sigma_a", Rgb(0));
    out.scattering = amount(reader, p, "sigma_s", Rgb(0));
    return;
  }
  // 0.6's heterogeneous medium says "density" of what 3.x calls "sigma_t".
  out.extinction = amount(reader, p, p.has("density") ? "density" : "sigma_t", Rgb(1));
  out.albedo = amount(reader, p, "albedo", Rgb(0.75f));
}

}  // namespace

VolumeInput Reader::volume_input(const Element& element) {
  Plugin p(*this, element);
  if (p.type() == "constvolume") {
    const VolumeInput out{p.constant_color("value", Rgb(1), Intent::index), kNone};
    p.finish();
    return out;
  }
  if (p.type() != "gridvolume") {
    warn(p.where(), "the volume \"" + p.type() + "\"", "1 everywhere");
    p.ignore_all();
    return {Rgb(1), kNone};
  }
  if (const auto found = volumes_.find(&element); found != volumes_.end()) return {Rgb(1), found->second};
  VolumeDesc out;
  out.id = p.id(), out.where = p.where();
  out.to_world = p.regular_transform();
  GridFileDesc grid;
  const std::string name = p.required_text("filename");
  const SourceLocation where = p.where_of("filename");
  const std::string path = resolve_path(name, where.file);
  const auto file = named_file(path_at_time(path), where, "volume", "1 everywhere");
  // In 0.6 a grid is where its file says, and the first and the last number lie on the faces of its box.
  // Sparse grids, which Mitsuba does not have, are where their files say in 3.x as well.
  const bool old = dialect().camel_case();
  grid.filename = file.name;
  grid.sequence = sequence(path);
  grid.use_grid_box = p.flag("use_grid_bbox", old || grid.sparse());
  if (grid.sparse()) grid.grid = p.text("grid").value_or("");
  out.sampling = old || grid.sparse() ? GridSampling::corners : GridSampling::centers;
  const std::string filter = p.text("filter_type").value_or("trilinear");
  out.nearest = filter == "nearest";
  if (filter != "nearest" && filter != "trilinear")
    throw InputError(p.where_of("filter_type"),
                     "the filter \"" + filter + "\" of " + p.title() + " is not known",
                     "trilinear and nearest are");
  if (const auto wrap = p.text("wrap_mode"); wrap && *wrap != "clamp")
    warn(p.where_of("wrap_mode"), "the wrap mode \"" + *wrap + "\" of volumes", "clamp");
  p.ignore({"raw", "accel"});
  p.finish();
  if (file.missing) return {Rgb(1), kNone};
  out.kind = grid;
  scene_.volumes.push_back(std::move(out));
  return {Rgb(1), volumes_[&element] = static_cast<int>(scene_.volumes.size()) - 1};
}

std::vector<PhaseLobeDesc> Reader::phase_function(const Element& element) {
  const OpenGuard guard(*this, element);
  Plugin p(*this, element);
  std::vector<PhaseLobeDesc> out;
  if (p.type() == "hg") {
    const float g = p.number("g", 0.8f);
    if (!(g > -1 && g < 1))
      throw InputError(p.where_of("g"), "\"g\" of " + p.title() + " is not between -1 and 1",
                       "0 is isotropic");
    out.push_back({PhaseLobeDesc::Kind::henyey_greenstein, Rgb(g), 1});
  } else if (p.type() == "blendphase") {
    const auto parts = p.take_all("phase");
    const float weight = p.number("weight", 0.5f);
    if (parts.size() != 2)
      throw InputError(p.where(), p.title() + " has " + std::to_string(parts.size()) + " nested <phase>s",
                       "nest two");
    if (!(weight >= 0 && weight <= 1))
      throw InputError(p.where_of("weight"), "\"weight\" of " + p.title() + " is not between 0 and 1");
    for (std::size_t k = 0; k < 2; ++k)
      for (PhaseLobeDesc lobe : phase_function(*parts[k])) {
        lobe.weight *= k == 0 ? 1 - weight : weight;
        if (lobe.weight > 0) out.push_back(lobe);
      }
  } else {
    if (p.type() != "isotropic") {
      warn(p.where(), "the phase function \"" + p.type() + "\"", "an isotropic one");
      p.ignore_all();
    }
    out.emplace_back();
  }
  p.finish();
  return out;
}

int Reader::build_medium(const Element& element) {
  if (const auto found = media_.find(&element); found != media_.end()) return found->second;
  Plugin p(*this, element);
  MediumDesc out;
  out.id = p.id(), out.where = p.where();
  if (p.type() != "homogeneous" && p.type() != "heterogeneous") {
    warn(p.where(), "the medium \"" + p.type() + "\"", "empty space");
    p.ignore_all();
    return media_[&element] = kNone;
  }
  if (!by_name(p, out)) coefficients(*this, p, out);
  const float scale = p.number("scale", 1);
  if (!(scale >= 0) || !std::isfinite(scale))
    throw InputError(p.where_of("scale"), "\"scale\" of " + p.title() + " is negative",
                     "use a value of 0 or more");
  for (VolumeInput* input : {&out.extinction, &out.absorption, &out.scattering}) input->value *= scale;
  if (const Element* phase = p.take_one("phase")) out.phase = phase_function(*phase);
  p.ignore({"method", "step_size", "sample_emitters", "has_spectral_extinction"});
  p.finish();
  scene_.media.push_back(std::move(out));
  return media_[&element] = static_cast<int>(scene_.media.size()) - 1;
}

void Reader::add_media(Plugin& p, ShapeDesc& shape) {
  const Element* inside = p.take_named("interior", "medium");
  const Element* outside = p.take_named("exterior", "medium");
  if (!inside && !outside) return;
  shape.media.divides = true;
  if (inside) shape.media.inside = build_medium(*inside);
  if (outside) shape.media.outside = build_medium(*outside);
}

}  // namespace lumirank::scenedesc::mitsuba
