#include "scenedesc/gltf/buffers.h"

#include "scenedesc/gltf/uri.h"

namespace lumirank::scenedesc::gltf {

void Budget::take(double bytes, const Element& user) {
  taken_ += bytes;
  if (taken_ > max_)
    user.fail("makes the decoded data larger than 2 GiB plus 64 times the size of the files",
              "let meshes share their data through nodes instead of repeating it");
}

Buffers::Buffers(const Element& root, std::string_view binary, bool is_glb)
    : buffers_(root.list("buffers")), views_(root.list("bufferViews")), binary_(binary), is_glb_(is_glb) {
  budget_.read(binary.size());
}

std::string_view Buffers::buffer(std::int64_t index, const Element& user) {
  if (index >= static_cast<std::int64_t>(buffers_.size()))
    user.fail(
        "names buffer " + std::to_string(index) + ", and the file has " + std::to_string(buffers_.size()),
        "buffers are counted from 0");
  const Element& buffer = buffers_[static_cast<std::size_t>(index)];
  const auto length = static_cast<std::size_t>(buffer.at("byteLength").integer(1, kMaxBytes));
  const auto uri = buffer.find("uri");
  std::string_view bytes;
  if (uri) {
    const auto [found, fresh] = loaded_.try_emplace(index);
    if (fresh) {
      Resource resource = resolve_uri(*uri);
      found->second = resource.embedded ? std::move(resource.bytes) : read_resource(resource.filename, *uri);
      budget_.read(found->second.size());
    }
    bytes = found->second;
  } else if (index == 0 && is_glb_) {
    bytes = binary_;
  } else {
    buffer.fail("has no \"uri\", and is not the first buffer of a .glb file", "name a file");
  }
  if (length > bytes.size())
    buffer.fail("has a byteLength of " + std::to_string(length) + ", and its data have " +
                    std::to_string(bytes.size()) + " bytes",
                "the file may be truncated: export it again");
  return bytes.substr(0, length);
}

std::string_view Buffers::range(const Element& part) {
  const Element index = part.at("buffer");
  const auto length = static_cast<std::size_t>(part.at("byteLength").integer(1, kMaxBytes));
  const auto at = part.find("byteOffset");
  const auto offset = static_cast<std::size_t>(at ? at->integer(0, kMaxBytes) : 0);
  const std::string_view bytes = buffer(index.integer(0, kMaxBytes), index);
  if (offset + length > bytes.size())
    part.fail("reaches to byte " + std::to_string(offset + length) + " of a buffer of " +
                  std::to_string(bytes.size()) + " bytes",
              "make byteOffset + byteLength fit into the buffer");
  return bytes.substr(offset, length);
}

Buffers::View Buffers::view(std::int64_t index, const Element& user) {
  if (index < 0 || index >= static_cast<std::int64_t>(views_.size()))
    user.fail(
        "names bufferView " + std::to_string(index) + ", and the file has " + std::to_string(views_.size()),
        "bufferViews are counted from 0");
  const Element& view = views_[static_cast<std::size_t>(index)];
  View out;
  if (const auto stride = view.find("byteStride"))
    out.stride = static_cast<std::size_t>(stride->integer(1, 1 << 16));
  if (const auto packed = view.extension("EXT_meshopt_compression")) {
    const auto [found, fresh] = decoded_.try_emplace(index);
    if (fresh) found->second = decode_meshopt(*packed, range(*packed), budget_);
    out.bytes = found->second;
  } else {
    out.bytes = range(view);
  }
  return out;
}

}  // namespace lumirank::scenedesc::gltf
