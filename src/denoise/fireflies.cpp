#include "denoise/fireflies.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "base/vec.h"

namespace lumirank::denoise {
namespace {

constexpr int kAround = 2;         // pixels
constexpr float kBrighter = 1.5f;  // than all pixels around it but one
constexpr float kCalm = 1.6f;      // these over their mean
constexpr float kUnsure = 2.5f;    // deviations
constexpr std::size_t kFireflyLines = 16;
// What a firefly loses goes to pixels so far away, each of which becomes brighter by such a part at most.
constexpr int kSpread = 16;
constexpr float kAddedAtMost = 0.05f;

// Of the pixels around one, without the brightest.
struct Around {
  float brightest = 0, mean = 0;
};
Around around(const std::vector<float>& brightness, int width, int height, int x, int y) {
  float first = 0, second = 0, sum = 0;
  int count = -1;
  for (int j = std::max(0, y - kAround); j <= std::min(height - 1, y + kAround); ++j)
    for (int i = std::max(0, x - kAround); i <= std::min(width - 1, x + kAround); ++i) {
      if (i == x && j == y) continue;
      const float b = brightness[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) +
                                 static_cast<std::size_t>(i)];
      second = std::max(second, std::min(first, b));
      first = std::max(first, b);
      sum += b, ++count;
    }
  return {second, count > 0 ? (sum - first) / static_cast<float>(count) : second};
}

// What a firefly has lost, shared out over the pixels around it in proportion to their brightness and to a
// weight that falls smoothly to 0: adds to `gains`, by what part each becomes brighter.
void share_out(float lost, const image::Image& clean, int x, int y, std::vector<float>& gains) {
  const int left = std::max(0, x - kSpread), right = std::min(clean.width - 1, x + kSpread);
  const int top = std::max(0, y - kSpread), bottom = std::min(clean.height - 1, y + kSpread);
  const auto weight = [&](int i, int j) {
    const auto d2 = static_cast<float>((i - x) * (i - x) + (j - y) * (j - y));
    return square(std::max(0.0f, 1 - d2 / static_cast<float>(kSpread * kSpread)));
  };
  float there = 0;
  for (int j = top; j <= bottom; ++j)
    for (int i = left; i <= right; ++i) there += weight(i, j) * luminance(clean.at(i, j));
  if (!(there > 0)) return;
  const float part = std::min(kAddedAtMost, lost / there);
  for (int j = top; j <= bottom; ++j)
    for (int i = left; i <= right; ++i)
      gains[static_cast<std::size_t>(j) * static_cast<std::size_t>(clean.width) +
            static_cast<std::size_t>(i)] += part * weight(i, j);
}

}  // namespace

image::Image without_fireflies(const image::Image& noisy, std::span<const float> deviation) {
  if (deviation.size() != noisy.pixels.size())
    throw InternalError("without_fireflies: pictures of different sizes");
  const int width = noisy.width, height = noisy.height;
  std::vector<float> brightness(noisy.pixels.size());
  for (std::size_t p = 0; p < brightness.size(); ++p) brightness[p] = luminance(noisy.pixels[p]);
  image::Image clean = noisy;
  std::vector<float> lost(noisy.pixels.size());
  parallel_for(static_cast<std::size_t>(height), kFireflyLines, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y)
      for (int x = 0; x < width; ++x) {
        const std::size_t p = y * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
        const Around near = around(brightness, width, height, x, static_cast<int>(y));
        if (brightness[p] > kBrighter * near.brightest && near.brightest <= kCalm * near.mean &&
            brightness[p] - near.mean < kUnsure * deviation[p])
          clean.pixels[p] *= near.mean / brightness[p], lost[p] = brightness[p] - near.mean;
      }
  });
  std::vector<float> gains(noisy.pixels.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (const float l = lost[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                               static_cast<std::size_t>(x)];
          l > 0)
        share_out(l, clean, x, y, gains);
  for (std::size_t p = 0; p < gains.size(); ++p) clean.pixels[p] *= 1 + gains[p];
  return clean;
}

}  // namespace lumirank::denoise
