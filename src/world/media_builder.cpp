#include "world/media_builder.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace lumirank::world {

namespace sd = scenedesc;

namespace {

media::Grid::Sampling sampling(sd::GridSampling given) {
  switch (given) {
    case sd::GridSampling::corners:
      return media::Grid::Sampling::corners;
    case sd::GridSampling::fading_cells:
      return media::Grid::Sampling::fading_cells;
    case sd::GridSampling::centers:
      break;
  }
  return media::Grid::Sampling::centers;
}

media::PhaseFunction phase_function(const sd::MediumDesc& medium) {
  media::PhaseFunction out;
  if (medium.phase.empty()) return out;
  if (medium.phase.size() > media::PhaseFunction::kMaxLobes)
    throw InputError(medium.where,
                     "the phase function mixes " + std::to_string(medium.phase.size()) + " others",
                     std::to_string(media::PhaseFunction::kMaxLobes) + " are the most");
  out.count = static_cast<int>(medium.phase.size());
  for (std::size_t k = 0; k < medium.phase.size(); ++k) {
    const sd::PhaseLobeDesc& lobe = medium.phase[k];
    out.lobes[k] = {lobe.kind == sd::PhaseLobeDesc::Kind::schlick ? media::PhaseLobe::Kind::schlick
                                                                  : media::PhaseLobe::Kind::henyey_greenstein,
                    lobe.g, lobe.weight};
  }
  return out;
}

// A constant where others have a grid: a grid of one number over the same box.
std::shared_ptr<const media::Grid> even_grid() {
  return std::make_shared<const media::Grid>(std::array<int, 3>{1, 1, 1}, 1, std::vector<float>{1},
                                             media::Grid::Sampling::centers);
}

}  // namespace

const MediaBuilder::Volume& MediaBuilder::volume(int index, const SourceLocation& user) {
  if (index < 0 || static_cast<std::size_t>(index) >= desc_.volumes.size())
    throw InputError(user, "a volume is referred to that the scene does not have", "define it");
  const auto [at, fresh] = volumes_.try_emplace(index);
  if (!fresh) return at->second;
  const sd::VolumeDesc& desc = desc_.volumes[static_cast<std::size_t>(index)];
  const sd::GridData* data = nullptr;
  bool use_box = true;
  Transform to_file;
  if (const auto* file = std::get_if<sd::GridFileDesc>(&desc.kind)) {
    const auto [known, first] = files_.try_emplace({file->filename, file->grid});
    if (first) {
      known->second = sd::read_grid_file(*file);
      if (!known->second.too_fine.empty())
        notes_.warn(desc.where, known->second.too_fine, known->second.coarser);
    }
    data = &known->second.numbers, use_box = file->use_grid_box, to_file = known->second.to_file;
  } else {
    data = std::get<std::shared_ptr<const sd::GridData>>(desc.kind).get();
  }
  Volume& out = at->second;
  const auto [least, most] = std::minmax_element(data->values.begin(), data->values.end());
  out.least = *least, out.most = *most;
  if (use_box) {
    const Vec3f size = data->hi - data->lo;
    out.box = to_file * Transform::translate(data->lo) * Transform::scale(size.x, size.y, size.z);
  }
  out.grid = std::make_shared<const media::Grid>(data->size, data->channels, data->values,
                                                 sampling(desc.sampling), desc.nearest);
  memory_bytes_ += out.grid->memory_bytes();
  return out;
}

media::Field MediaBuilder::field(const sd::VolumeInput& input, Meaning meaning, const sd::MediumDesc& medium,
                                 const char* name, const Units& units) {
  const bool albedo = meaning == Meaning::albedo;
  const Rgb value = input.value;
  const std::string what = std::string("the ") + name + " of a medium";
  for (int c = 0; c < 3; ++c)
    if (!std::isfinite(value[c]) || value[c] < 0)
      throw InputError(medium.where, what + " is negative or not finite", "give finite numbers of 0 or more");
  media::Field out;
  // Coefficients are per length.
  out.scale = albedo ? value : value * static_cast<float>(1 / units.scale());
  if (!is_finite(out.scale)) throw InputError(medium.where, what + " is too large", "give a smaller one");
  float most = max_component(value);
  if (input.volume != sd::kNone) {
    const Volume& v = volume(input.volume, medium.where);
    const sd::VolumeDesc& desc = desc_.volumes[static_cast<std::size_t>(input.volume)];
    const std::optional<Transform> inverse = units.to_world(desc.to_world * v.box).inverse();
    if (!inverse || !inverse->is_finite())
      throw InputError(desc.where, "to_world of the volume cannot be inverted", "no scale may be 0");
    out.grid = v.grid, out.to_unit = *inverse, out.zero_outside = !albedo;
    if (v.least < 0)
      notes_.warn(desc.where, what + " is negative in places (" + std::to_string(v.least) + ")", "0 there");
    most *= v.most;
  }
  if (albedo && most > 1.001f)
    notes_.warn(medium.where, what + " is above 1 (it would make light)", "1 there");
  return out;
}

std::vector<media::Medium> MediaBuilder::build(const Units& units) {
  std::vector<media::Medium> out;
  for (const sd::MediumDesc& medium : desc_.media) {
    const bool sum = medium.form == sd::MediumDesc::Form::absorption_and_scattering;
    media::Field first = field(sum ? medium.absorption : medium.extinction, Meaning::coefficient, medium,
                               sum ? "absorption" : "extinction", units);
    media::Field second =
        field(sum ? medium.scattering : medium.albedo, sum ? Meaning::coefficient : Meaning::albedo, medium,
              sum ? "scattering" : "albedo", units);
    const media::Field emission = field(medium.emission, Meaning::coefficient, medium, "emission", units);
    if (sum && !first.grid != !second.grid) {
      media::Field& even = first.grid ? second : first;
      const media::Field& other = first.grid ? first : second;
      even.grid = even_grid(), even.to_unit = other.to_unit, even.zero_outside = true;
    }
    out.emplace_back(
        sum ? media::Medium::Form::absorption_and_scattering : media::Medium::Form::extinction_and_albedo,
        std::move(first), std::move(second), emission, phase_function(medium));
    memory_bytes_ += out.back().memory_bytes();
  }
  return out;
}

}  // namespace lumirank::world
