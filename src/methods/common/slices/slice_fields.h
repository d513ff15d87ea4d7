// Parameters of methods that work slice by slice, against patterns in their error: a denoiser takes edges of
// slices and shadows of single representatives for shape, and noise for what it is.
#pragma once

#include "methods/parameters.h"

namespace lumirank::methods {

template <typename S, typename B>
Field<S> slice_overlap_field(double B::*member) {
  return number_field<S>(
      {"slice-overlap", "of a slice's side",
       "How far slices reach into each other, a pixel here and a pixel there, so that what "
       "differs between them is noise and no edge. 0: not at all."},
      member, 0, 1);
}

inline constexpr std::size_t kMaxDrawings = 64;

// As asked for, or (0) `of_passes` in passes and 1 in a single picture. Eight take two fifths more time than
// one: rays that are traced together come from farther apart.
inline std::size_t drawings_of(std::size_t asked, const RunOptions& options, std::size_t of_passes = 8) {
  return asked > 0 ? asked : options.one_of_passes ? of_passes : 1;
}

template <typename S, typename B>
Field<S> drawings_field(std::size_t B::*member) {
  return count_field<S>(
      {"drawings", "",
       "Representatives of each cluster, of which every pixel of a slice has one: where one is "
       "wrong is noise then, and no shadow across the slice. As many entries, and rays that are "
       "less coherent. 0: in passes, whose mean is denoised, 8 (4 in sampling-recovery); 1 in a single "
       "picture."},
      member, 0, kMaxDrawings);
}

}  // namespace lumirank::methods
