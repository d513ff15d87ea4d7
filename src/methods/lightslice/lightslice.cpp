#include "methods/lightslice/lightslice.h"

#include "methods/common/slices/slice_render.h"

namespace lumirank::methods {

namespace {

const Fields<SliceRenderSettings>& fields() {
  static const Fields<SliceRenderSettings> all = with_slice_render_fields<SliceRenderSettings>({});
  return all;
}

class LightSlice final : public Method {
 public:
  explicit LightSlice(const SliceRenderSettings& settings) : settings_(settings) {}
  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    return render_slices(matrix, options, settings_);
  }

 private:
  SliceRenderSettings settings_;
};

}  // namespace

MethodInfo lightslice_info() {
  return method_info<LightSlice>(
      {"lightslice", "Clusters columns for every slice of receivers on their own.",
       "Ou, Pellacini 2011, LightSlice: matrix slice sampling for the many-lights problem", "columns"},
      fields());
}

}  // namespace lumirank::methods
