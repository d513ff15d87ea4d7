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
#include "scenedesc/schema/scene_desc.h"

namespace lumirank::world {

class TextureBuilder {
 public:
  explicit TextureBuilder(const scenedesc::SceneDesc& desc);

  // The shape that everything is for that is used from here on: messages about broken files name it.
  void needed_by(const scenedesc::ShapeDesc& shape) { shape_ = &shape; }
  // Index in the finished set. InputError at `user` for an index out of range, at the texture for a cycle.
  int use(int texture, const SourceLocation& user);
  // The value is checked: finite and not negative. Squares of magenta and gray stand in for a picture whose
  // file is missing, and `stand_in` where a number is wanted of it.
  scatter::ColorInput color(const scenedesc::ColorInput& input, const SourceLocation& user);
  scatter::FloatInput number(const scenedesc::FloatInput& input, const SourceLocation& user,
                             float stand_in = 0.5f);
  // Whether the texture, or one that it is made of, lacks its file. It has been use()d.
  bool is_missing(int texture) const { return missing_[static_cast<std::size_t>(texture)]; }

  // Reads all files in parallel and hands the set over. InputError (at the texture, with the shape that needs
  // it) for the first file that fails.
  scatter::TextureSet finish();
  std::size_t memory_bytes() const;  // of the pixels, after finish()

 private:
  // Name, embedded bytes, raw, channel, whether that may be an alpha that the file lacks.
  using FileKey = std::tuple<std::string, const std::string*, bool, scenedesc::TextureChannel, bool>;
  struct File {
    const scenedesc::TextureDesc* texture = nullptr;
    const scenedesc::ShapeDesc* shape = nullptr;  // the first that needs it, if that is known
    bool missing = false;
    std::shared_ptr<scatter::TexturePixels> pixels;
  };
  int add(scatter::Texture texture);
  int operand(const scenedesc::ColorInput& input, const SourceLocation& user);
  bool lacks_file(const scenedesc::TextureDesc& texture) const;

  const scenedesc::SceneDesc& desc_;
  const scenedesc::ShapeDesc* shape_ = nullptr;
  scatter::TextureSet set_;
  std::vector<int> index_;     // of each description: ≥ 0 built, -1 not yet, -2 being built
  std::vector<bool> missing_;  // of each description that is built
  std::map<FileKey, File> files_;
};

}  // namespace lumirank::world
