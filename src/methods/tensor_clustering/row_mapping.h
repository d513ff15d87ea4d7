// Which row of one frame shows what a row of another shows (Hašan et al. 2008, sections 4.4 and 5): the
// nearest among them by place, normal and diffuse reflectance. So a column that was computed in one frame can
// be used in another.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "base/rgb.h"

#include "matrix/lighting_matrix.h"

namespace lumirank::methods {

struct RowMapping {
  std::vector<matrix::Index> from;  // of every row of the later frame, say, its row in the earlier one
  // To it, over the distance from the row to the nearest of those that are its neighbors by number in its own
  // frame: 0 where the same point is seen, about 1 where the view moved, large where something was hidden
  // before, infinite where nothing was seen at all.
  std::vector<float> distance;

  // Through both: rows of c to rows of a, where this maps b to a and `next` maps c to b. The greater distance
  // counts: what was hidden at one step has been hidden.
  RowMapping then(const RowMapping& next) const;
  static RowMapping identity(std::size_t rows);
};

// Mappings of all frames' rows, both ways between neighbors.
struct FrameMappings {
  std::vector<RowMapping> to_later;    // [k]: rows of frame k + 1 to those of frame k
  std::vector<RowMapping> to_earlier;  // [k]: rows of frame k to those of frame k + 1
};

// Whether a mapping to a frame of `rows` rows is no longer than `max_distance`, in distances of neighboring
// rows in pictures of up to 256² rows; in larger ones it is as large a part of the picture, since light is
// not rougher where it is sampled more densely. 0: any that there is.
bool reaches(float distance, double max_distance, std::size_t rows);

// What a row shows as a mixture of what rows of another frame show (ours): weights sum to 1, some may be
// negative. Of one row alone where it shows the very same place.
struct RowBlend {
  static constexpr std::size_t kRows = 4;
  std::array<matrix::Index, kRows> from{};
  std::array<float, kRows> weight{1};
};

// The rows of one frame, to be looked for and to look from. Distances are of 9-vectors: place, normal times
// an eighth of `scale`, reflectance times a 64th of `scale`; `scale` is the diagonal of the scene. (Weights
// are ours, the paper states none. Reflectance counts for less, since light is divided by it: relight()
// below.) Features that are unknown count for nothing; where no place is known, rows map to their own number,
// which needs as many in both frames.
class FrameRows {
 public:
  FrameRows(const matrix::LightingMatrix& matrix, float scale);
  FrameRows(const matrix::RowFeatures& features, std::size_t rows, float scale);
  ~FrameRows();

  // For each row of this frame the nearest of `to`, exactly. Fast where rows that are neighbors by number are
  // neighbors in space, and rows of one number in both frames are near each other.
  RowMapping nearest(const FrameRows& to) const;
  // What a row that shows another place than all rows of `to` is made of: its nearest ones there, with the
  // weights by which their 9-vectors sum up to its own as well as they can (the local weights of Roweis and
  // Saul 2000, Locally Linear Embedding, equation 2), so that light that changes evenly in between comes out
  // right. Both frames have places.
  RowBlend blend(std::size_t row, const FrameRows& to) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};
inline RowMapping nearest_rows(const matrix::LightingMatrix& of, const matrix::LightingMatrix& to,
                               float scale) {
  return FrameRows(of, scale).nearest(FrameRows(to, scale));
}

// What light at a row of one diffuse reflectance would be at a row of another, so that textures stay sharp
// (ours): exact for lambertian surfaces under the same light.
inline Rgb relight(const Rgb& light, const Rgb& from, const Rgb& to) {
  constexpr float kBlack = 0.004f, kMaxRatio = 8;
  Rgb out = light;
  for (int c = 0; c < 3; ++c)
    if (from[c] > kBlack) out[c] *= std::min(kMaxRatio, to[c] / from[c]);
  return out;
}

// The diagonal of the box of all places of a frame's rows; 0 where they are unknown.
float diagonal_of_rows(const matrix::RowFeatures& features);

}  // namespace lumirank::methods
