// The estimate of a method whose slices sum their representatives, with all shadow rays.
#pragma once

#include "methods/common/slices/slice_fields.h"
#include "methods/common/slices/slice_pass.h"

namespace lumirank::methods {

struct SliceRenderSettings : SliceLightSettings {
  std::size_t drawings = 0;  // see drawings_of()
};

template <typename S>
Fields<S> with_slice_render_fields(Fields<S> others) {
  others.insert(others.begin(), drawings_field<S>(&S::drawings));
  return with_slice_light_fields<S>(std::move(others));
}

Estimate render_slices(const matrix::LightingMatrix& matrix, const RunOptions& options,
                       const SliceRenderSettings& settings);

}  // namespace lumirank::methods
