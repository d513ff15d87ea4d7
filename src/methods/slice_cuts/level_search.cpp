#include "methods/slice_cuts/level_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "base/parallel.h"
#include "base/random.h"
#include "methods/common/exact_rows.h"
#include "methods/slice_cuts/slice_rows.h"

namespace lumirank::methods {

using matrix::Index;

namespace {

constexpr double kTarget = 0.03;
constexpr std::size_t kMinSlices = 3, kMaxSlices = 12, kPixelsPerSlice = 5, kMaxTrials = 16;

// From coarse to fine.
constexpr std::array<double, kCutLevels> kAlpha{0.05, 0.02, 0.01, 0.005, 0.002, 0.001, 0.0005};

struct Trial {
  SliceLevel level;
  double error = 0, cost = 0;
};

class LevelSearch {
 public:
  LevelSearch(const matrix::LightingMatrix& matrix, const Slices& slices, const RunOptions& options,
              const LevelTrials& trials)
      : slices_(slices), options_(options), trials_(trials), known_(matrix), sums_(matrix.rows()) {
    const std::size_t count =
        std::min(slices.count(), std::clamp(slices.count() / 16, kMinSlices, kMaxSlices));
    std::vector<Rgb> values(matrix.columns());
    Rng rng(options.seed, Stage::method, 0x4155544f);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t begin = k * slices.count() / count, end = (k + 1) * slices.count() / count;
      chosen_.push_back(begin + rng.next_below(end - begin));
      // Whole pixels, since receivers of one share a visibility and their errors cancel.
      SliceRows rows;
      rows.build(matrix.row_features(), slices.slice(chosen_.back()));
      const std::size_t pixels = std::min(kPixelsPerSlice, rows.size());
      for (std::size_t p = 0; p < pixels; ++p) {
        const std::size_t first = p * rows.size() / pixels, last = (p + 1) * rows.size() / pixels;
        const std::size_t row = first + rng.next_below(last - first);
        for (std::uint32_t r = rows.begin(row); r < rows.end(row); ++r)
          known_.read({rows.receivers()[r], 1}, values);
        pixel_end_.push_back(known_.size());
      }
    }
  }

  LevelChoice run() {
    LevelChoice choice;
    choice.rows = known_.size();
    choice.target =
        options_.target_error > 0
            ? target_for_sampling(options_.target_error, known_.lights().value, known_.clamping().value)
            : kTarget;
    const Trial first = trial({});
    best_ = first;
    if (first.error > choice.target)
      refine(first, choice.target);
    else
      coarsen(first, choice.target);
    choice.level = best_.level;
    choice.error = best_.error;
    choice.trials = tried_.size();
    return choice;
  }

 private:
  Trial trial(SliceLevel level) {
    if (const auto found = tried_.find(level); found != tried_.end()) return found->second;
    std::vector<double> costs(chosen_.size());
    parallel_for(chosen_.size(), 1,
                 [&](std::size_t k, std::size_t) { costs[k] = trials_.render(level, chosen_[k], sums_); });
    Trial t{level, error(), 0};
    for (const double c : costs) t.cost += c;
    spent_ += t.cost;
    tried_[level] = t;
    return t;
  }
  // Relative L1 over the known pixels.
  double error() const {
    double off = 0, whole = 0;
    std::size_t k = 0;
    for (const std::size_t end : pixel_end_) {
      Rgb estimated(0), exact(0);
      for (; k < end; ++k) {
        const ExactRow& known = known_.rows()[k];
        const auto weight = static_cast<float>(known.share);
        estimated += sums_[known.from.row] * weight;
        exact += known.sum * weight;
      }
      for (int c = 0; c < 3; ++c) {
        off += static_cast<double>(std::abs(estimated[c] - exact[c]));
        whole += static_cast<double>(exact[c]);
      }
    }
    return whole > 0 ? off / whole : 0;
  }
  // The search shall not cost more than the picture at the level it has come to.
  bool affordable(const Trial& at) const {
    return spent_ * static_cast<double>(chosen_.size()) < at.cost * static_cast<double>(slices_.count());
  }
  bool may_try() const { return tried_.size() < kMaxTrials && !options_.sinks.cancelled(); }

  // The neighbors in one direction of both ladders.
  std::vector<Trial> neighbors(SliceLevel at, bool finer) {
    std::vector<Trial> found;
    const auto step = [&](std::size_t k, std::size_t size) -> std::optional<std::size_t> {
      if (finer) return k + 1 < size ? std::optional(k + 1) : std::nullopt;
      return k > 0 ? std::optional(k - 1) : std::nullopt;
    };
    if (const auto c = step(at.cut, kCutLevels); c && may_try()) found.push_back(trial({*c, at.visibility}));
    if (const auto v = step(at.visibility, kVisibilityLevels); trials_.predicts && v && may_try())
      found.push_back(trial({at.cut, *v}));
    return found;
  }

  // Steps to where the error falls most for what it costs more.
  void refine(Trial at, double target) {
    while (at.error > target && affordable(at)) {
      const auto options = neighbors(at.level, true);
      if (options.empty()) return;
      const auto gain = [&](const Trial& t) {
        return (at.error - t.error) / std::max(t.cost - at.cost, 1.0);
      };
      at = *std::max_element(options.begin(), options.end(),
                             [&](const Trial& a, const Trial& b) { return gain(a) < gain(b); });
      if (at.error < best_.error) best_ = at;
    }
  }
  // Steps to the cheapest that still meets the target.
  void coarsen(Trial at, double target) {
    while (affordable(at)) {
      std::optional<Trial> next;
      for (const Trial& t : neighbors(at.level, false))
        if (t.error <= target && t.cost < at.cost && (!next || t.cost < next->cost)) next = t;
      if (!next) return;
      best_ = at = *next;
    }
  }

  const Slices& slices_;
  const RunOptions& options_;
  const LevelTrials& trials_;
  ExactRows known_;
  std::vector<Rgb> sums_;
  std::vector<std::size_t> chosen_;
  std::vector<std::size_t> pixel_end_;  // of the known rows, by pixel
  double spent_ = 0;
  std::map<SliceLevel, Trial> tried_;
  Trial best_;
};

}  // namespace

void set_cut_level(std::size_t level, SliceCutSettings& settings) {
  settings.alpha = kAlpha[level];
  settings.initial_columns =
      std::clamp(static_cast<std::size_t>(2.5 / settings.alpha), std::size_t{50}, std::size_t{1000});
  settings.max_columns = std::max(settings.max_columns, 4 * settings.initial_columns);
}

void write_cut_level(const SliceCutSettings& settings, Trace& trace) {
  trace.numbers["automatic.alpha"] = settings.alpha;
  trace.numbers["automatic.initial_columns"] = static_cast<double>(settings.initial_columns);
}

LevelChoice choose_level(const matrix::LightingMatrix& matrix, const Slices& slices,
                         const RunOptions& options, const LevelTrials& trials) {
  if (slices.count() == 0 || matrix.columns() == 0 || options.sinks.cancelled()) return {};
  return LevelSearch(matrix, slices, options, trials).run();
}

}  // namespace lumirank::methods
