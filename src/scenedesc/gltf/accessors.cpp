#include "scenedesc/gltf/accessors.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace lumirank::scenedesc::gltf {
namespace {

enum Component { kByte = 5120, kUByte = 5121, kShort = 5122, kUShort = 5123, kUInt = 5125, kFloat = 5126 };

std::size_t bytes_of(int component) {
  return component == kByte || component == kUByte ? 1
                                                   : (component == kShort || component == kUShort ? 2 : 4);
}

int component_type(const Element& element) {
  const int type = static_cast<int>(element.integer(0, 1 << 20));
  if (type < kByte || type > kFloat || type == 5124)
    element.fail("is " + std::to_string(type), "5120 to 5123, 5125 and 5126 are component types");
  return type;
}

std::size_t component_count(const Element& type) {
  constexpr std::pair<const char*, std::size_t> kTypes[] = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
  for (const auto& [name, count] : kTypes)
    if (type.text() == name) return count;
  type.fail("is \"" + type.text() + "\"", "SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 and MAT4 are known");
}

template <typename T>
T from_bytes(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

// One component as stored, or with `normalized` as the fraction that it stands for
// (glTF 2.0, section 3.6.2.2).
template <typename T>
T component(const char* at, int type, bool normalized) {
  const auto scaled = [&](float value, float max_value) {
    return static_cast<T>(normalized ? std::max(value / max_value, -1.0f) : value);
  };
  switch (type) {
    case kByte:
      return scaled(from_bytes<std::int8_t>(at), 127.0f);
    case kUByte:
      return scaled(from_bytes<std::uint8_t>(at), 255.0f);
    case kShort:
      return scaled(from_bytes<std::int16_t>(at), 32767.0f);
    case kUShort:
      return scaled(from_bytes<std::uint16_t>(at), 65535.0f);
    case kUInt:
      if constexpr (std::is_same_v<T, std::uint32_t>) return from_bytes<std::uint32_t>(at);
      return scaled(static_cast<float>(from_bytes<std::uint32_t>(at)), 4294967295.0f);
    default:
      return static_cast<T>(from_bytes<float>(at));
  }
}

// Where element 0 is, and how far apart the elements are; all of them lie within the view.
struct Strided {
  const char* first = nullptr;
  std::size_t stride = 0;
};

Strided strided(const Buffers::View& view, const Element& part, std::size_t offset, std::size_t element,
                std::size_t count) {
  const std::size_t stride = view.stride > 0 ? view.stride : element;
  if (stride < element)
    part.fail(
        "has elements of " + std::to_string(element) + " bytes every " + std::to_string(stride) + " bytes",
        "make byteStride at least as large");
  const std::size_t end = offset + (count > 0 ? stride * (count - 1) + element : 0);
  if (end > view.bytes.size())
    part.fail("reaches to byte " + std::to_string(end) + " of a bufferView of " +
                  std::to_string(view.bytes.size()) + " bytes",
              "make count and byteOffset fit into the bufferView");
  return {view.bytes.data() + offset, stride};
}

std::size_t offset_of(const Element& part) {
  const auto offset = part.find("byteOffset");
  return static_cast<std::size_t>(offset ? offset->integer(0, kMaxBytes) : 0);
}

}  // namespace

struct Accessors::Layout {
  const Element& element;
  int component = kFloat;
  bool normalized = false;
  std::size_t components = 1, count = 0;
  std::size_t bytes = 4;  // of one element
};

const Element& Accessors::find(const Element& user) const {
  const std::int64_t index = user.integer(0, kMaxBytes);
  if (index >= static_cast<std::int64_t>(accessors_.size()))
    user.fail(
        "names accessor " + std::to_string(index) + ", and the file has " + std::to_string(accessors_.size()),
        "accessors are counted from 0");
  return accessors_[static_cast<std::size_t>(index)];
}

Accessors::Layout Accessors::layout(const Element& user) {
  const Element& accessor = find(user);
  Layout out{accessor};
  out.component = component_type(accessor.at("componentType"));
  out.normalized = accessor.flag("normalized", false);
  out.components = component_count(accessor.at("type"));
  out.count = static_cast<std::size_t>(accessor.at("count").integer(1, 0xffffffff));
  out.bytes = out.components * bytes_of(out.component);
  // Columns of matrices of small integers are padded; nothing that is read here has such.
  if (accessor.at("type").text().starts_with("MAT") && bytes_of(out.component) != 4)
    accessor.fail("is a matrix of small integers", "matrices of floats can be read");
  return out;
}

std::size_t Accessors::count(const Element& user) const {
  return static_cast<std::size_t>(find(user).at("count").integer(1, 0xffffffff));
}

template <typename T>
std::vector<T> Accessors::read(const Layout& layout) {
  const Element& accessor = layout.element;
  const auto index = accessor.find("bufferView");
  const auto sparse = accessor.find("sparse");
  Strided from;
  if (index) {
    const Buffers::View view = buffers_.view(index->integer(0, kMaxBytes), *index);
    from = strided(view, accessor, offset_of(accessor), layout.bytes, layout.count);
  } else if (layout.count > std::size_t{1} << 24) {
    // Zeros cost a file nothing.
    accessor.fail("has " + std::to_string(layout.count) + " elements and no bufferView",
                  "16 million zeros are allowed");
  }
  buffers_.budget().take(
      static_cast<double>(layout.count) * static_cast<double>(layout.components) * sizeof(T), accessor);
  std::vector<T> values(layout.count * layout.components, T{});
  if (index)
    for (std::size_t k = 0; k < layout.count; ++k)
      for (std::size_t c = 0; c < layout.components; ++c)
        values[k * layout.components + c] =
            component<T>(from.first + k * from.stride + c * bytes_of(layout.component), layout.component,
                         layout.normalized);
  if (sparse) replace_sparse(layout, *sparse, values);
  return values;
}

template <typename T>
void Accessors::replace_sparse(const Layout& layout, const Element& sparse, std::vector<T>& values) {
  const auto count = static_cast<std::size_t>(sparse.at("count").integer(1, 0xffffffff));
  const Element indices = sparse.at("indices"), replaced = sparse.at("values");
  const int type = component_type(indices.at("componentType"));
  if (type != kUByte && type != kUShort && type != kUInt)
    indices.at("componentType").fail("is not an unsigned integer type", "5121, 5123 or 5125");
  // Both are tightly packed.
  const auto packed = [&](const Element& part, std::size_t bytes) {
    const Element index = part.at("bufferView");
    Buffers::View view = buffers_.view(index.integer(0, kMaxBytes), index);
    view.stride = 0;
    return strided(view, part, offset_of(part), bytes, count);
  };
  const Strided at = packed(indices, bytes_of(type)), from = packed(replaced, layout.bytes);
  for (std::size_t k = 0; k < count; ++k) {
    const auto target = component<std::uint32_t>(at.first + k * at.stride, type, false);
    if (target >= layout.count)
      indices.fail("names element " + std::to_string(target) + " of " + std::to_string(layout.count),
                   "elements are counted from 0");
    for (std::size_t c = 0; c < layout.components; ++c)
      values[target * layout.components + c] = component<T>(
          from.first + k * from.stride + c * bytes_of(layout.component), layout.component, layout.normalized);
  }
}

Numbers Accessors::floats(const Element& user, std::size_t min_components, std::size_t max_components) {
  const Layout from = layout(user);
  if (from.components < min_components || from.components > max_components)
    user.fail("names " + from.element.path() + ", which has " + std::to_string(from.components) +
                  " components where " + std::to_string(min_components) +
                  (max_components > min_components ? " to " + std::to_string(max_components) : "") +
                  " are wanted",
              "correct its \"type\"");
  return {from.components, from.count, read<float>(from)};
}

std::vector<std::uint32_t> Accessors::integers(const Element& user, std::size_t components) {
  const Layout from = layout(user);
  if (from.components != components || from.component == kFloat || from.component == kByte ||
      from.component == kShort)
    user.fail("names " + from.element.path() + ", which is not made of unsigned integers, " +
                  std::to_string(components) + " at a time",
              "correct its \"type\" and \"componentType\"");
  Layout plain = from;
  plain.normalized = false;
  return read<std::uint32_t>(plain);
}

}  // namespace lumirank::scenedesc::gltf
