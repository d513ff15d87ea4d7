// Rendering a list of scaled columns, in blocks: between them come progress, previews, the deadline and
// cancellation.
#pragma once

#include <functional>
#include <span>

#include "methods/common/run_clock.h"
#include "methods/method.h"

namespace lumirank::methods {

struct PassControl {
  const RunOptions& options;
  const RunClock& timer;  // since the method was called
  double deadline = 0;    // seconds of `timer` after which no block is begun; 0: none
  // Called between blocks, at first often, then after each quarter more. May be empty.
  std::function<void(std::span<const Rgb> sums, std::size_t done)> on_block;
};

struct PassResult {
  std::size_t done = 0;  // columns rendered: the first `done` of the list
  bool cancelled = false;
  bool out_of_time = false;
  double seconds = 0;
};

// sums += Σ scaled columns, in the order of the list. Stops early, at a block's end, when cancelled or out of
// time.
PassResult render_columns(const matrix::LightingMatrix& matrix, std::span<const matrix::ScaledColumn> columns,
                          const PassControl& control, std::span<Rgb> sums);

// The estimate as a combination of columns: combination ← (1 − share)·combination + share·gain·columns.
void mix_in(std::vector<matrix::ScaledColumn>& combination, std::span<const matrix::ScaledColumn> columns,
            float gain, float share);

// out = a·sums; parallel.
std::vector<Rgb> scaled_sums(std::span<const Rgb> sums, float a);
// ‖a − b‖₂ / ‖b‖₂ over all rows and channels, in double precision; 0 if both are zero.
double relative_difference(std::span<const Rgb> a, std::span<const Rgb> b);
// Σ|a − b| / Σ|b|, likewise.
double relative_l1_difference(std::span<const Rgb> a, std::span<const Rgb> b);

}  // namespace lumirank::methods
