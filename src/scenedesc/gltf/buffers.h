// The bytes behind a glTF file: buffers (files, data: URIs, the block of a .glb) and views of them.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scenedesc/gltf/element.h"

namespace lumirank::scenedesc::gltf {

// A small file can name the same bytes ten thousand times, or promise bytes that it does not have. So what
// is decoded is counted, and there is an end to it: 2 GiB, and 64 times the size of all files read.
class Budget {
 public:
  void read(std::size_t bytes) { max_ += 64.0 * static_cast<double>(bytes); }
  void take(double bytes, const Element& user);

 private:
  double max_ = 2.0 * (1u << 30), taken_ = 0;
};

class Buffers {
 public:
  // `binary` is the block of bytes of a .glb. `root` must outlive this.
  Buffers(const Element& root, std::string_view binary, bool is_glb);

  struct View {
    std::string_view bytes;
    std::size_t stride = 0;  // 0: tightly packed
  };
  // A buffer view, decompressed if it is compressed (EXT_meshopt_compression). Files are read when they are
  // first asked for. InputError at `user` for an index that there is not, and at the view for anything beyond
  // its buffer.
  View view(std::int64_t index, const Element& user);
  Budget& budget() { return budget_; }

 private:
  std::string_view buffer(std::int64_t index, const Element& user);
  // `length` bytes at `offset` of the buffer that `part` names: a view, or its compressed form.
  std::string_view range(const Element& part);

  std::vector<Element> buffers_, views_;
  std::string_view binary_;
  bool is_glb_;
  std::map<std::int64_t, std::string> loaded_, decoded_;
  Budget budget_;
};

// The view as EXT_meshopt_compression packs it (meshoptimizer decodes it).
std::string decode_meshopt(const Element& extension, std::string_view packed, Budget& budget);

// Sizes and offsets beyond this are no sizes; sums and products of a few of them fit into 64 bits.
inline constexpr std::int64_t kMaxBytes = std::int64_t{1} << 40;

}  // namespace lumirank::scenedesc::gltf
