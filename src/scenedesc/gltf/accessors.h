// Typed arrays of numbers in a glTF file, with all that they may be: strided, normalized, sparse.
#pragma once

#include <cstdint>
#include <vector>

#include "scenedesc/gltf/buffers.h"

namespace lumirank::scenedesc::gltf {

struct Numbers {
  std::size_t components = 1;  // SCALAR 1, VEC2 2, …, MAT4 16 (column by column)
  std::size_t count = 0;
  std::vector<float> values;  // count × components
};

class Accessors {
 public:
  Accessors(const Element& root, Buffers& buffers) : accessors_(root.list("accessors")), buffers_(buffers) {}

  // The accessor that `user` (an index in the file) names, as floats: normalized integers within [0, 1] or
  // [-1, 1], others by their value. InputError at `user` unless it has from `least` to `most` components.
  Numbers floats(const Element& user, std::size_t min_components, std::size_t max_components);
  // Unsigned integers of one component (indices); with `most` = 4 also of four (joints).
  std::vector<std::uint32_t> integers(const Element& user, std::size_t components = 1);
  // How many elements it has, nothing decoded.
  std::size_t count(const Element& user) const;

 private:
  struct Layout;
  const Element& find(const Element& user) const;
  Layout layout(const Element& user);
  template <typename T>
  std::vector<T> read(const Layout& layout);
  template <typename T>
  void replace_sparse(const Layout& layout, const Element& sparse, std::vector<T>& values);

  std::vector<Element> accessors_;
  Buffers& buffers_;
};

}  // namespace lumirank::scenedesc::gltf
