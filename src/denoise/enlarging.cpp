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
  const Image small_albedo = reduced(albedo, small.width, small.height),
              small_normal = reduced(normal, small.width, small.height);
  Image large(albedo.width, albedo.height);
  const auto width = static_cast<std::size_t>(small.width);
  for (int color = 0; color < 3; ++color) {
    const std::vector<Model> models = fitted(small, small_albedo, small_normal, color);
    parallel_for(
        static_cast<std::size_t>(large.height), kRowsOfImage, [&](std::size_t begin, std::size_t end) {
          for (std::size_t y = begin; y < end; ++y) {
            const Place row = place(y, large.height, small.height);
            for (int x = 0; x < large.width; ++x) {
              const Place column = place(static_cast<std::size_t>(x), large.width, small.width);
              const std::size_t at[] = {row.first * width + column.first, row.first * width + column.second,
                                        row.second * width + column.first,
                                        row.second * width + column.second};
              const float part[] = {(1 - row.part) * (1 - column.part), (1 - row.part) * column.part,
                                    row.part * (1 - column.part), row.part * column.part};
              const auto pixel = static_cast<std::size_t>(large.width) * y + static_cast<std::size_t>(x);
              const Features4 here = features_at(albedo.pixels[pixel], normal.pixels[pixel], color);
              Features4 slopes{}, between{};
              float value = 0;
              LightRange around, over_albedo;
              for (std::size_t k = 0; k < 4; ++k) {
                const Features4 there =
                    features_at(small_albedo.pixels[at[k]], small_normal.pixels[at[k]], color);
                const Model& model = models[at[k]];
                for (std::size_t i = 0; i < kFeatures; ++i)
                  slopes[i] += part[k] * model.slopes[i], between[i] += part[k] * there[i];
                const float light = small.pixels[at[k]][color];
                value += part[k] * light;
                if (!(part[k] > 0)) continue;
                around.extend(model.least, model.most);
                const float over = light / (there[0] + kAddedAlbedo);
                if (there[0] >= kTellingAlbedo * here[0]) over_albedo.extend(over, over);
              }
              float wanted = value;
              for (std::size_t i = 0; i < kFeatures; ++i) wanted += slopes[i] * (here[i] - between[i]);
              // Interpolation stays where the model leads outside, or is not finite.
              around = around.widened();
              around.extend(value, value);
              float& out = large.pixels[pixel][color];
              out = std::isfinite(wanted) ? around.nearest(wanted) : value;
              // Beside a window are pixels without light: they have no albedo, and say nothing of its frame.
              if (!over_albedo.empty()) out = over_albedo.widened(here[0] + kAddedAlbedo).nearest(out);
            }
          }
        });
  }
  return large;
}

}  // namespace lumirank::denoise
