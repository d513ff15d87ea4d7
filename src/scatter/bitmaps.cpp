// Which bitmaps a material reads, so that they can be fetched before it does.
#include <algorithm>

#include "base/members.h"
#include "scatter/material.h"

namespace lumirank::scatter {
namespace {

// More would be asked for than is on its way at once.
constexpr std::size_t kMostBitmaps = 4;

class BitmapList {
 public:
  explicit BitmapList(const MaterialSet& set) : set_(set) {}

  template <typename Kind>
  void operator()(const Kind& m) {
    if constexpr (std::is_same_v<Kind, MixtureMaterial>) {
      for (const auto& part : m.parts) read(part.weight), nest(part.nested);
    } else {
      for_each_member(m, [&](const auto& member) { read(member); });
    }
    if constexpr (requires { m.texture; }) add(m.texture);
    if constexpr (requires { m.nested; }) nest(m.nested);
    if constexpr (requires { m.front; }) nest(m.front), nest(m.back);
  }

  std::vector<int> take() {
    std::sort(list_.begin(), list_.end());
    list_.erase(std::unique(list_.begin(), list_.end()), list_.end());
    if (list_.size() > kMostBitmaps) list_.resize(kMostBitmaps);
    return std::move(list_);
  }

 private:
  void read(const ColorInput& input) { add(input.texture); }
  void read(const FloatInput& input) { add(input.texture); }
  void read(const auto&) {}
  void add(int texture) {
    if (texture >= 0) set_.textures.add_bitmaps(texture, list_);
  }
  // Those before it are listed already.
  void nest(int material) {
    if (material < 0) return;
    const auto& nested = set_.bitmaps[static_cast<std::size_t>(material)];
    list_.insert(list_.end(), nested.begin(), nested.end());
  }

  const MaterialSet& set_;
  std::vector<int> list_;
};

}  // namespace

void MaterialSet::note_bitmaps() {
  bitmaps.clear();
  for (const Material& material : materials) {
    BitmapList list(*this);
    std::visit(list, material);
    bitmaps.push_back(list.take());
  }
}

}  // namespace lumirank::scatter
