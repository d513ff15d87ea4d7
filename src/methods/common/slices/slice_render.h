// What lightslice and adaptive-lightslice do with the columns of a slice: they are rendered.
#pragma once

#include <memory>
#include <vector>

#include "matrix/entry_reader.h"
#include "methods/common/slices/slice_pass.h"

namespace lumirank::methods {

struct SliceRenderWorkspace {
  explicit SliceRenderWorkspace(const matrix::LightingMatrix& matrix) : reader(matrix.reader()) {}
  std::unique_ptr<matrix::EntryReader> reader;
  SliceLights::Workspace lights;
  SliceCosts costs;
  std::vector<Rgb> entries;
};

Estimate render_slices(const matrix::LightingMatrix& matrix, const RunOptions& options,
                       const SliceLightSettings& settings);

}  // namespace lumirank::methods
