#include "methods/adaptive_lightslice/adaptive_lightslice.h"

#include "methods/common/slices/slice_render.h"

namespace lumirank::methods {

namespace {

enum class EyeRays { pieces, whole };

struct AdaptiveSettings : SliceRenderSettings {
  // `columns` is but a bound here, and the error decides.
  AdaptiveSettings() { columns = 3000, initial_clusters = 100, enough = 0.02; }
  EyeRays eye_rays = EyeRays::pieces;
};

const Fields<AdaptiveSettings>& adaptive_fields() {
  static const Fields<AdaptiveSettings> all = with_slice_render_fields<AdaptiveSettings>(
      {number_field<AdaptiveSettings>({"error", "of a slice's light",
                                       "A slice splits its clusters until they are estimated to err by less "
                                       "than this, or there are `columns` "
                                       "of them."},
                                      &AdaptiveSettings::enough, 0, 1),
       experiment(choice_field<AdaptiveSettings>(
           {"eye-rays", "",
            "In media. pieces: each a row, those put together that are alike; whole: as in the paper."},
           &AdaptiveSettings::eye_rays, {"pieces", "whole"}))});
  return all;
}

class AdaptiveLightSlice final : public Method {
 public:
  explicit AdaptiveLightSlice(const AdaptiveSettings& settings) : settings_(settings) {}
  Estimate run(const matrix::LightingMatrix& matrix, const RunOptions& options) const override {
    return render_slices(matrix, options, settings_);
  }

 private:
  AdaptiveSettings settings_;
};

}  // namespace

MethodInfo adaptive_lightslice_info() {
  using Segments = matrix::MethodContract::Segments;
  MethodInfo info = method_info<AdaptiveLightSlice>(
      {"adaptive-lightslice",
       "LightSlice whose slices take as many columns as an error needs.",
       "Frederickx, Bartels, Dutré 2015, Adaptive LightSlice for Virtual Ray Lights",
       "error or columns",
       {.needs = {}, .segments = Segments::smooth_pieces}},
      adaptive_fields());
  info.segments_wanted = [name = info.name](const SettingsMap& settings) {
    const auto read = read_settings(name, adaptive_fields(), settings);
    return read.eye_rays == EyeRays::whole ? Segments::whole : Segments::smooth_pieces;
  };
  return info;
}

}  // namespace lumirank::methods
