// The sampled rows of all frames of a lighting tensor, as the clustering of its columns reads them (Hašan et
// al. 2008, section 4.3): for every light in every frame its weight w = ‖ρ‖, and its information vector x =
// ρ/w over the rows that were read. ρ holds 2-norms of RGB entries.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/rgb.h"

namespace lumirank::linalg {

class ReducedTensor {
 public:
  enum class Precision { bits16, bits32 };  // of x: within 2⁻¹⁷ of each component, or as floats
  struct Shape {
    std::size_t rows, columns, frames;
    Precision precision = Precision::bits16;
  };
  explicit ReducedTensor(const Shape& shape);

  // All rows of a frame at once: rows × columns entries, row by row. Frames may be set in any order.
  void set_frame(std::size_t frame, std::span<const Rgb> entries);

  std::size_t rows() const { return shape_.rows; }
  std::size_t columns() const { return shape_.columns; }
  std::size_t frames() const { return shape_.frames; }
  float weight(std::size_t column, std::size_t frame) const { return norms_[at(column, frame)].all; }
  // Norm of one channel of the column over the rows.
  float channel(std::size_t column, std::size_t frame, std::size_t c) const {
    return norms_[at(column, frame)].channel[c];
  }
  // Sum of one channel of the column over the rows.
  float sum(std::size_t column, std::size_t frame, std::size_t c) const {
    return norms_[at(column, frame)].sum[c];
  }
  // x of a light in a frame, rows() numbers; zeros where its weight is 0.
  void information(std::size_t column, std::size_t frame, float* out) const;

  std::size_t memory_bytes() const;
  static double memory_bytes(const Shape& shape);

 private:
  struct Norms {
    float all = 0, channel[3] = {}, sum[3] = {};
  };
  // All that belongs to a light lies together, frame after frame.
  std::size_t at(std::size_t column, std::size_t frame) const { return column * shape_.frames + frame; }

  Shape shape_;
  std::vector<Norms> norms_;
  std::vector<std::uint16_t> short_;  // one of the two
  std::vector<float> long_;
};

}  // namespace lumirank::linalg
