// Descriptions of textures → a TextureSet: only those in use, inputs before their users, every file read
// once.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "scatter/material.h"
#include "scatter/texture.h"
#include "scenedesc/scene_desc.h"

namespace lumirank::world {

class TextureBuilder {
 public:
  explicit TextureBuilder(const scenedesc::SceneDesc& desc);

  // Index in the finished set. InputError at `user` for an index out of range, at the texture for a cycle.
  int use(int texture, const SourceLocation& user);
  // The value is checked: finite and not negative.
  scatter::ColorInput color(const scenedesc::ColorInput& input, const SourceLocation& user);
  scatter::FloatInput number(const scenedesc::FloatInput& input, const SourceLocation& user);

  // Reads all files in parallel and hands the set over. InputError (at the texture) for the first file that
  // fails.
  scatter::TextureSet finish();
  std::size_t memory_bytes() const;  // of the pixels, after finish()

 private:
  // Name, embedded bytes, raw, channel, whether that may be an alpha that the file lacks.
  using FileKey = std::tuple<std::string, const std::string*, bool, scenedesc::TextureChannel, bool>;
  struct File {
    SourceLocation where;
    std::shared_ptr<scatter::TexturePixels> pixels;
  };
  int add(scatter::Texture texture);
  int operand(const scenedesc::ColorInput& input, const SourceLocation& user);

  const scenedesc::SceneDesc& desc_;
  scatter::TextureSet set_;
  std::vector<int> index_;  // of each description: ≥ 0 built, -1 not yet, -2 being built
  std::map<FileKey, File> files_;
};

}  // namespace lumirank::world
