// How much one BSDF, texture or group stands for once every use of a shared part counts. A few lines of a
// scene file can double a part twenty times: the file is small, and every look-up takes a million steps.
#include "scenedesc/schema/expansion.h"

#include <algorithm>
#include <vector>

#include "base/error.h"

namespace lumirank::scenedesc {
namespace {

template <typename... Visitors>
struct ExpansionCases : Visitors... {
  using Visitors::operator()...;
};
template <typename... Visitors>
ExpansionCases(Visitors...) -> ExpansionCases<Visitors...>;

// The same limits as pbrt's mixtures and textures have had; scenes of artists have some ten.
constexpr std::size_t kPlainBsdfs = 64;     // behind one BSDF
constexpr std::size_t kBsdfLevels = 100;    // nested in each other: as deep as Mitsuba's elements may refer
constexpr std::size_t kLookUps = 1'000;     // of textures, for one of a texture
constexpr std::size_t kPlaced = 8'000'000;  // shapes by all instances; each takes some hundred bytes

struct Size {
  std::size_t parts = 0, levels = 0;
};

// Sizes of the entries of a list whose entries name each other by index: each is worked out once, however
// often it is named. `measure(index, size_of)` asks size_of for the entries that it names.
template <typename Measure, typename Refuse>
class Sizes {
 public:
  Sizes(std::size_t count, Measure measure, Refuse refuse)
      : sizes_(count), state_(count, kNew), measure_(measure), refuse_(refuse) {
    for (std::size_t i = 0; i < count; ++i) of(static_cast<int>(i), 0);
  }

 private:
  enum State : char { kNew, kOpen, kDone };

  // References out of the list are found, with their message, when the world is built.
  Size of(int index, std::size_t level) {
    if (index < 0 || static_cast<std::size_t>(index) >= sizes_.size()) return {};
    const auto slot = static_cast<std::size_t>(index);
    if (state_[slot] == kOpen || level > kLookUps) refuse_(slot);
    if (state_[slot] == kDone) return sizes_[slot];
    state_[slot] = kOpen;
    sizes_[slot] = measure_(slot, [&](int other) { return of(other, level + 1); });
    state_[slot] = kDone;
    return sizes_[slot];
  }

  std::vector<Size> sizes_;
  std::vector<State> state_;
  Measure measure_;
  Refuse refuse_;
};

std::string expansion_name(const std::string& id) { return id.empty() ? "" : " \"" + id + "\""; }

void check_bsdfs(const SceneDesc& scene) {
  const auto refuse = [&](std::size_t slot) {
    const BsdfDesc& b = scene.bsdfs[slot];
    throw InputError(b.where,
                     "the BSDF" + expansion_name(b.id) + " is made of itself or of more than " +
                         std::to_string(kPlainBsdfs) + " others, or of more than " +
                         std::to_string(kBsdfLevels) + " in each other",
                     "mixtures of mixtures multiply; simplify them");
  };
  const auto measure = [&](std::size_t slot, auto size_of) {
    const auto& kind = scene.bsdfs[slot].kind;
    // A mixture stands for all its parts together, another BSDF for the largest of those nested in it.
    const bool sums = std::holds_alternative<MixtureDesc>(kind);
    Size out{sums ? std::size_t{0} : std::size_t{1}, 1};
    for_each_nested(kind, [&](int bsdf) {
      if (out.parts > kPlainBsdfs) return;  // a list of ten thousand parts is no reason to go on
      const Size in = size_of(bsdf);
      out.parts = sums ? out.parts + std::max<std::size_t>(in.parts, 1) : std::max(out.parts, in.parts);
      out.levels = std::max(out.levels, in.levels + 1);
    });
    if (out.parts > kPlainBsdfs || out.levels > kBsdfLevels) refuse(slot);
    return out;
  };
  Sizes(scene.bsdfs.size(), measure, refuse);
}

void check_textures(const SceneDesc& scene) {
  const auto refuse = [&](std::size_t slot) {
    const TextureDesc& t = scene.textures[slot];
    throw InputError(t.where,
                     "the texture" + expansion_name(t.id) + " is made of itself or of more than 1,000 others",
                     "textures of textures multiply; simplify them");
  };
  const auto measure = [&](std::size_t slot, auto size_of) {
    const auto looked_up = [&](const ColorInput& input) { return size_of(input.texture).parts; };
    const Size out{
        1 + std::visit(
                ExpansionCases{[&](const CheckerboardTextureDesc& x) {
                                 return std::max(looked_up(x.color0), looked_up(x.color1));
                               },
                               [&](const ScaleTextureDesc& x) { return looked_up(x.input); },
                               [&](const ProductTextureDesc& x) { return looked_up(x.a) + looked_up(x.b); },
                               [&](const MixTextureDesc& x) {
                                 return looked_up(x.a) + looked_up(x.b) + looked_up(x.amount);
                               },
                               [&](const RootTextureDesc& x) { return looked_up(x.input); },
                               [&](const ThresholdTextureDesc& x) { return looked_up(x.input); },
                               [](const auto&) { return std::size_t{0}; }},
                scene.textures[slot].kind),
        0};
    if (out.parts > kLookUps) refuse(slot);
    return out;
  };
  Sizes(scene.textures.size(), measure, refuse);
}

void check_instances(const SceneDesc& scene) {
  std::size_t placed = 0;
  for (const ShapeDesc& shape : scene.shapes) {
    const auto* instance = std::get_if<InstanceDesc>(&shape.kind);
    if (!instance || instance->group < 0 || static_cast<std::size_t>(instance->group) >= scene.shapes.size())
      continue;
    const auto& target = scene.shapes[static_cast<std::size_t>(instance->group)].kind;
    if (const auto* group = std::get_if<ShapeGroupDesc>(&target)) placed += group->shapes.size();
    if (placed > kPlaced)
      throw InputError(shape.where, "with this instance the scene places more than 8 million shapes",
                       "join the shapes of a group into fewer meshes, or place it less often");
  }
}

}  // namespace

void check_expansion(const SceneDesc& scene) {
  check_bsdfs(scene);
  check_textures(scene);
  check_instances(scene);
}

}  // namespace lumirank::scenedesc
