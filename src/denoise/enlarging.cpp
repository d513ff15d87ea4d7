#include "denoise/enlarging.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"

namespace lumirank::denoise {
namespace {

using image::Image;

// Pixels of the small picture, by which a model is fitted: how far, and the deviation of their weights.
constexpr int kFitReach = 2;
constexpr float kFitDeviation = 1;
// Variances that count as none.
constexpr float kAlbedoRidge = 1e-3f, kNormalRidge = 1e-2f;
constexpr float kLeastOfAround = 0.8f, kMostOfAround = 1.25f;
// Where light is compared by what it is over albedo: what is added to albedos, and the least part of a
// pixel's albedo with which another says anything of it.
constexpr float kAddedAlbedo = 0.05f, kTellingAlbedo = 0.1f;
constexpr std::size_t kRowsOfImage = 4;

// The albedo in one color, and the normal.
constexpr std::size_t kFeatures = 4;
using Features4 = std::array<float, kFeatures>;

Features4 features_at(Rgb albedo, Rgb normal, int color) {
  return {albedo[color], normal.r, normal.g, normal.b};
}

// Sums of one weighted fit. Values are relative to those in the middle, so that variances are exact.
struct Fit {
  float weight = 0, value = 0;
  Features4 feature{}, with_value{};
  std::array<Features4, kFeatures> product{};

  void add(float w, const Features4& f, float v) {
    weight += w, value += w * v;
    for (std::size_t i = 0; i < kFeatures; ++i) {
      feature[i] += w * f[i], with_value[i] += w * f[i] * v;
      for (std::size_t j = 0; j <= i; ++j) product[i][j] += w * f[i] * f[j];
    }
  }

  // By how much the value grows with each feature: (covariance + ridge) x = covariance with the value, solved
  // by Cholesky's factors, which the ridge keeps positive.
  Features4 slopes() const {
    std::array<Features4, kFeatures> factor{};
    Features4 x{};
    for (std::size_t i = 0; i < kFeatures; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        float sum = (product[i][j] - feature[i] * feature[j] / weight) / weight;
        if (i == j) sum = std::max(sum, 0.0f) + (i == 0 ? kAlbedoRidge : kNormalRidge);
        for (std::size_t k = 0; k < j; ++k) sum -= factor[i][k] * factor[j][k];
        factor[i][j] = i == j ? std::sqrt(std::max(sum, 0.1f * kAlbedoRidge)) : sum / factor[j][j];
      }
      float sum = (with_value[i] - feature[i] * value / weight) / weight;
      for (std::size_t k = 0; k < i; ++k) sum -= factor[i][k] * x[k];
      x[i] = sum / factor[i][i];
    }
    for (std::size_t i = kFeatures; i-- > 0;) {
      for (std::size_t k = i + 1; k < kFeatures; ++k) x[i] -= factor[k][i] * x[k];
      x[i] /= factor[i][i];
    }
    return x;
  }
};

// A small picture's pixel, in one color.
struct Model {
  Features4 slopes{};
  float least = 0, most = 0;
};

struct Place {
  std::size_t first, second;
  float part;  // of the second
};

// Values between which light stays.
struct LightRange {
  float least = std::numeric_limits<float>::infinity(), most = 0;
  void extend(float low, float high) { least = std::min(least, low), most = std::max(most, high); }
  bool empty() const { return least > most; }
  // With a margin, for a pixel of such an albedo.
  LightRange widened(float albedo = 1) const {
    return {kLeastOfAround * albedo * least, kMostOfAround * albedo * most};
  }
  float nearest(float value) const { return std::max(least, std::min(value, most)); }
};

// The two pixels of a smaller picture around a center of the larger one.
Place place(std::size_t at, int to, int from) {
  const float x =
      std::clamp((static_cast<float>(at) + 0.5f) * static_cast<float>(from) / static_cast<float>(to) - 0.5f,
                 0.0f, static_cast<float>(from - 1));
  const auto first = static_cast<std::size_t>(x);
  return {first, std::min(first + 1, static_cast<std::size_t>(from - 1)), x - static_cast<float>(first)};
}

struct Reach {
  int begin, end;
};
Reach around(int at, int reach, int size) {
  return {std::max(0, at - reach), std::min(size, at + reach + 1)};
}

std::vector<Model> fitted(const Image& small, const Image& albedo, const Image& normal, int color) {
  std::vector<Model> models(small.pixels.size());
  const auto width = static_cast<std::size_t>(small.width);
  parallel_for(static_cast<std::size_t>(small.height), kRowsOfImage, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (int x = 0; x < small.width; ++x) {
        const int y = static_cast<int>(row);
        const float here = small.at(x, y)[color];
        const Features4 middle = features_at(albedo.at(x, y), normal.at(x, y), color);
        Model& model = models[row * width + static_cast<std::size_t>(x)];
        model.least = model.most = here;
        Fit fit;
        const Reach rows = around(y, kFitReach, small.height), columns = around(x, kFitReach, small.width);
        for (int v = rows.begin; v < rows.end; ++v)
          for (int u = columns.begin; u < columns.end; ++u) {
            const auto d2 = static_cast<float>((u - x) * (u - x) + (v - y) * (v - y));
            Features4 there = features_at(albedo.at(u, v), normal.at(u, v), color);
            for (std::size_t i = 0; i < kFeatures; ++i) there[i] -= middle[i];
            const float value = small.at(u, v)[color];
            fit.add(std::exp(-0.5f * d2 / (kFitDeviation * kFitDeviation)), there, value - here);
            if (std::max(std::abs(u - x), std::abs(v - y)) <= 1)
              model.least = std::min(model.least, value), model.most = std::max(model.most, value);
          }
        model.slopes = fit.slopes();
      }
  });
  return models;
}

// The four pixels of the small picture around one of the large one.
struct FourPixels {
  std::array<std::size_t, 4> at;
  std::array<float, 4> part;
  FourPixels(const Place& row, const Place& column, std::size_t width)
      : at{row.first * width + column.first, row.first * width + column.second,
           row.second * width + column.first, row.second * width + column.second},
        part{(1 - row.part) * (1 - column.part), (1 - row.part) * column.part, row.part * (1 - column.part),
             row.part * column.part} {}
};

Rgb divided(Rgb a, Rgb b) { return {a.r / b.r, a.g / b.g, a.b / b.b}; }

// As bright as `light`, in the color that `around` has at that brightness. Where a bright and a dark surface
// meet, colors that are told apart one by one may be of either, and their mixture of neither.
Rgb in_color_of(std::array<Rgb, 4> around, Rgb light) {
  const float bright = luminance(light);
  std::sort(around.begin(), around.end(), [](Rgb a, Rgb b) { return luminance(a) < luminance(b); });
  Rgb color = bright < luminance(around[3]) ? around[0] : around[3];
  for (std::size_t k = 0; k + 1 < around.size(); ++k) {
    const float low = luminance(around[k]), high = luminance(around[k + 1]);
    if (bright < low || bright >= high) continue;
    const float t = (bright - low) / (high - low);
    color = around[k] * (1 - t) + around[k + 1] * t;
  }
  const float of_color = luminance(color);
  return of_color > 0 ? color * (bright / of_color) : light;
}

class Enlarging {
 public:
  Enlarging(const Image& small, const Image& albedo, const Image& normal)
      : small_(small),
        albedo_(albedo),
        normal_(normal),
        small_albedo_(reduced(albedo, small.width, small.height)),
        small_normal_(reduced(normal, small.width, small.height)) {
    for (int color = 0; color < 3; ++color)
      models_[static_cast<std::size_t>(color)] = fitted(small, small_albedo_, small_normal_, color);
  }

  Image picture() const {
    Image large(albedo_.width, albedo_.height);
    const auto rows = static_cast<std::size_t>(large.height), width = static_cast<std::size_t>(small_.width);
    parallel_for(rows, kRowsOfImage, [&](std::size_t begin, std::size_t end) {
      for (std::size_t y = begin; y < end; ++y) {
        const Place row = place(y, large.height, small_.height);
        for (int x = 0; x < large.width; ++x) {
          const Place column = place(static_cast<std::size_t>(x), large.width, small_.width);
          const std::size_t pixel = static_cast<std::size_t>(large.width) * y + static_cast<std::size_t>(x);
          large.pixels[pixel] = light_of(pixel, FourPixels(row, column, width));
        }
      }
    });
    return large;
  }

 private:
  Rgb light_of(std::size_t pixel, const FourPixels& around) const {
    const Rgb here = albedo_.pixels[pixel] + Rgb(kAddedAlbedo);
    // One that counts for nothing lends no color.
    const auto nearest = static_cast<std::size_t>(std::max_element(around.part.begin(), around.part.end()) -
                                                  around.part.begin());
    std::array<Rgb, 4> over{};
    for (std::size_t k = 0; k < over.size(); ++k) {
      const std::size_t at = around.at[around.part[k] > 0 ? k : nearest];
      over[k] = divided(small_.pixels[at], small_albedo_.pixels[at] + Rgb(kAddedAlbedo));
    }
    bool all_tell = true;
    Rgb light;
    for (int color = 0; color < 3; ++color) light[color] = light_in(color, pixel, around, over, all_tell);
    return all_tell ? in_color_of(over, divided(light, here)) * here : light;
  }

  // all_tell: becomes false if a pixel around has too little albedo to say anything of this one.
  float light_in(int color, std::size_t pixel, const FourPixels& around, const std::array<Rgb, 4>& over,
                 bool& all_tell) const {
    const Features4 here = features_at(albedo_.pixels[pixel], normal_.pixels[pixel], color);
    Features4 slopes{}, between{};
    float value = 0;
    LightRange range, over_albedo;
    for (std::size_t k = 0; k < around.at.size(); ++k) {
      const std::size_t at = around.at[k];
      const float part = around.part[k];
      const Features4 there = features_at(small_albedo_.pixels[at], small_normal_.pixels[at], color);
      const Model& model = models_[static_cast<std::size_t>(color)][at];
      for (std::size_t i = 0; i < kFeatures; ++i)
        slopes[i] += part * model.slopes[i], between[i] += part * there[i];
      value += part * small_.pixels[at][color];
      if (!(part > 0)) continue;
      range.extend(model.least, model.most);
      const bool tells = there[0] >= kTellingAlbedo * here[0];
      if (tells) over_albedo.extend(over[k][color], over[k][color]);
      all_tell = all_tell && tells;
    }
    float wanted = value;
    for (std::size_t i = 0; i < kFeatures; ++i) wanted += slopes[i] * (here[i] - between[i]);
    // Interpolation stays where the model leads outside, or is not finite.
    range = range.widened();
    range.extend(value, value);
    const float light = std::isfinite(wanted) ? range.nearest(wanted) : value;
    // Beside a window are pixels without light: they have no albedo, and say nothing of its frame.
    return over_albedo.empty() ? light : over_albedo.widened(here[0] + kAddedAlbedo).nearest(light);
  }

  const Image &small_, &albedo_, &normal_;
  const Image small_albedo_, small_normal_;
  std::array<std::vector<Model>, 3> models_;
};

}  // namespace

Image reduced(const Image& image, int width, int height) {
  if (width > image.width || height > image.height || width < 1 || height < 1)
    throw InternalError("reduced: a picture is not made larger");
  // Which pixels of a line a new one covers, and with what part of it.
  const auto along = [](const Image& from, int to, bool of_rows) {
    const int length = of_rows ? from.height : from.width;
    if (length == to) return from;
    Image out(of_rows ? from.width : to, of_rows ? to : from.height, Rgb(0));
    const double step = static_cast<double>(length) / to;
    parallel_for(static_cast<std::size_t>(out.height), kRowsOfImage, [&](std::size_t begin, std::size_t end) {
      for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
        for (int x = 0; x < out.width; ++x) {
          const double low = (of_rows ? y : x) * step, high = low + step;
          Rgb& sum = out.at(x, y);
          for (int k = static_cast<int>(low); k < std::min(length, static_cast<int>(std::ceil(high))); ++k) {
            const double part = (std::min(high, k + 1.0) - std::max(low, static_cast<double>(k))) / step;
            sum += from.at(of_rows ? x : k, of_rows ? k : y) * static_cast<float>(std::max(0.0, part));
          }
        }
    });
    return out;
  };
  return along(along(image, width, false), height, true);
}

Image enlarged(const Image& small, const Image& albedo, const Image& normal) {
  if (albedo.width != normal.width || albedo.height != normal.height)
    throw InternalError("enlarged: features of different sizes");
  if (small.width == albedo.width && small.height == albedo.height) return small;
  return Enlarging(small, albedo, normal).picture();
}

}  // namespace lumirank::denoise
