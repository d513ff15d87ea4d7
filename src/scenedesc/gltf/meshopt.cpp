// EXT_meshopt_compression: checked here after the extension's rules, decoded by meshoptimizer.
#include <meshoptimizer.h>

#include "scenedesc/gltf/buffers.h"

namespace lumirank::scenedesc::gltf {

std::string decode_meshopt(const Element& extension, std::string_view packed, Budget& budget) {
  const auto stride = static_cast<std::size_t>(extension.at("byteStride").integer(1, 256));
  const auto count = static_cast<std::size_t>(extension.at("count").integer(1, kMaxBytes));
  const Element mode_element = extension.at("mode");
  const std::string& mode = mode_element.text();
  const std::string filter = extension.text("filter", "NONE");
  const bool attributes = mode == "ATTRIBUTES", triangles = mode == "TRIANGLES";
  if (!attributes && !triangles && mode != "INDICES")
    mode_element.fail("is \"" + mode + "\"", "ATTRIBUTES, TRIANGLES and INDICES are known");
  if (attributes ? stride % 4 != 0 : stride != 2 && stride != 4)
    extension.fail("has a byteStride of " + std::to_string(stride),
                   attributes ? "attributes have a multiple of 4" : "indices have 2 or 4");
  if (triangles && count % 3 != 0)
    extension.fail("has " + std::to_string(count) + " indices", "three make a triangle");
  const bool octahedral = filter == "OCTAHEDRAL", quaternion = filter == "QUATERNION",
             exponential = filter == "EXPONENTIAL";
  if ((!octahedral && !quaternion && !exponential && filter != "NONE") || (!attributes && filter != "NONE") ||
      (octahedral && stride != 4 && stride != 8) || (quaternion && stride != 8))
    extension.fail(
        "has the filter \"" + filter + "\" where it cannot be",
        "NONE, OCTAHEDRAL (stride 4 or 8), QUATERNION (8) and EXPONENTIAL are known, for attributes");
  // Attributes take at least two bits for each sixteen deltas of a byte, triangles and indices a byte each,
  // so a promise far beyond that is broken before any memory is taken.
  const double size = static_cast<double>(stride) * static_cast<double>(count);
  if (size > 256.0 * static_cast<double>(packed.size()) + 65536)
    extension.fail(
        "promises " + std::to_string(count) + " elements in " + std::to_string(packed.size()) + " bytes",
        "the file is damaged: export it again");
  budget.take(size, extension);
  std::string out(stride * count, '\0');
  const auto* from = reinterpret_cast<const unsigned char*>(packed.data());
  const int failed = attributes ? meshopt_decodeVertexBuffer(out.data(), count, stride, from, packed.size())
                     : triangles
                         ? meshopt_decodeIndexBuffer(out.data(), count, stride, from, packed.size())
                         : meshopt_decodeIndexSequence(out.data(), count, stride, from, packed.size());
  if (failed != 0)
    extension.fail("does not hold what it says (meshoptimizer's error " + std::to_string(failed) + ")",
                   "the file is damaged: export it again");
  if (octahedral) meshopt_decodeFilterOct(out.data(), count, stride);
  if (quaternion) meshopt_decodeFilterQuat(out.data(), count, stride);
  if (exponential) meshopt_decodeFilterExp(out.data(), count, stride);
  return out;
}

}  // namespace lumirank::scenedesc::gltf
