#include "methods/lightslice/lightslice.h"

#include "methods/common/slices/slice_render.h"

namespace lumirank::methods {

namespace {

class LightSlice final : public Method {
 public:
  explicit LightSlice(const SliceLightSettings& settings) : settings_(settings) {}
  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    return render_slices(matrix, options, settings_);
  }

 private:
  SliceLightSettings settings_;
};

}  // namespace

MethodInfo lightslice_info() {
  return method_info<LightSlice>(
      {"lightslice", "Clusters columns for every slice of receivers on their own.",
       "Ou, Pellacini 2011, LightSlice: matrix slice sampling for the many-lights problem", "columns"},
      slice_light_fields());
}

}  // namespace lumirank::methods
