// Calibration of a slice's predictions by its own tests: of all that was called visible with about the same
// probability, the share of light that turned out visible. Three nearest samples that are hidden do not make
// a probability of 0, least of all where there are few samples, or where others of the column are visible.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <span>

namespace lumirank::methods {

class Calibration {
 public:
  static constexpr std::size_t kPredictors = 3;

  // Of tests: by how many samples of a column the predictors knew, and which share of these was visible.
  static std::size_t kind_of(std::size_t samples, std::size_t visible) {
    const std::size_t size =
        std::min<std::size_t>(static_cast<std::size_t>(std::bit_width(samples / 8)), kSizes - 1);
    const std::size_t mixture = visible == 0         ? 0
                                : visible == samples ? kMixtures - 1
                                                     : 1 + (kMixtures - 2) * visible / (samples + 1);
    return size * kMixtures + mixture;
  }

  void reset() { tested_ = {}; }
  // light: what the entry would bring.
  void add(std::size_t predictor, std::size_t kind, float probability, bool visible, double light) {
    Tested& t = tested_[predictor][kind][level(probability)];
    t.light += light;
    t.visible += visible ? light : 0;
  }
  // After the last test.
  void finish() {
    for (std::size_t predictor = 0; predictor < kPredictors; ++predictor)
      for (std::size_t kind = 0; kind < tested_[predictor].size(); ++kind) {
        double all = 0;
        for (const Tested& t : tested_[predictor][kind]) all += t.light;
        const double prior = kPrior * all;
        for (std::size_t k = 0; k < kLevels; ++k) {
          const Tested& t = tested_[predictor][kind][k];
          const double own = static_cast<double>(k) / (kLevels - 1);
          worth_[predictor][kind][k] =
              static_cast<float>(all > 0 ? (t.visible + prior * own) / (t.light + prior) : own);
        }
      }
  }
  // Instead of every probability, what it was worth.
  void apply(std::size_t predictor, std::size_t kind, std::span<float> probabilities) const {
    const auto& worth = worth_[predictor][kind];
    for (float& p : probabilities) p = worth[level(p)];
  }

 private:
  // Three neighbors give four probabilities; samples by powers of two; none, few, half, many, all visible.
  static constexpr std::size_t kLevels = 4, kSizes = 8, kMixtures = 5;
  // Of a kind's light, that a level's own probability counts for: one that was hardly tested keeps it.
  static constexpr double kPrior = 0.01;
  struct Tested {
    double light = 0, visible = 0;
  };
  static std::size_t level(float p) { return static_cast<std::size_t>(p * (kLevels - 1) + 0.5f); }

  template <typename T>
  using Table = std::array<std::array<std::array<T, kLevels>, kSizes * kMixtures>, kPredictors>;
  Table<Tested> tested_{};
  Table<float> worth_{};
};

}  // namespace lumirank::methods
