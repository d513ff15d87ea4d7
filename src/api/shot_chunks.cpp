#include "api/shot_chunks.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "base/error.h"
#include "image/image_io.h"
#include "image/pfm.h"

namespace lumirank::api {

Chunk ShotChunks::of(int frame) const {
  Chunk chunk;
  chunk.first = first_key_ + (frame - first_key_) / length_ * length_;
  chunk.last = std::min(chunk.first + length_ - 1, std::max(last_key_, frame));
  chunk.tail_last = std::max(chunk.last, std::min(chunk.last + overlap_, last_key_));
  return chunk;
}

double ShotChunks::part(int frame) const {
  const Chunk chunk = of(frame);
  if (chunk.first == first_key_ || frame - chunk.first >= overlap_) return 1;
  return static_cast<double>(frame - chunk.first + 1) / (overlap_ + 1);
}

TailPicture::TailPicture(const std::string& folder, int frame) {
  char name[32];
  std::snprintf(name, sizeof name, "tail_%04d.pfm", frame);
  file_ = (std::filesystem::path(folder) / name).string();
}

bool TailPicture::exists() const {
  std::error_code error;
  return std::filesystem::is_regular_file(file_, error);
}

void TailPicture::write(const Picture& picture) const {
  image::Image image(picture.width, picture.height);
  const auto& rgb = picture.planes[0].rgb;
  for (std::size_t p = 0; p < image.pixels.size(); ++p)
    image.pixels[p] = {rgb[3 * p], rgb[3 * p + 1], rgb[3 * p + 2]};
  image::write_pfm(file_, image);
}

void TailPicture::blend_into(Picture& picture, double part) const {
  const image::Image tail = image::read_image(file_).color;
  if (tail.width != picture.width || tail.height != picture.height)
    throw InputError({file_, 0}, "is a picture of another size", "remove it; it is made again");
  const auto own = static_cast<float>(part), other = static_cast<float>(1 - part);
  auto& rgb = picture.planes[0].rgb;
  for (std::size_t p = 0; p < tail.pixels.size(); ++p)
    for (std::size_t c = 0; c < 3; ++c)
      rgb[3 * p + c] = own * rgb[3 * p + c] + other * tail.pixels[p][static_cast<int>(c)];
}

void TailPicture::remove() const {
  std::error_code error;
  std::filesystem::remove(file_, error);
}

}  // namespace lumirank::api
