// How far an image is from a reference. Formulas in docs/command-line.md.
#pragma once

#include "image/image.h"

namespace lumirank::image {

struct ErrorMetrics {
  double relative_l1 = 0;  // Σ|I-R| / ΣR
  double relative_l2 = 0;  // ‖I-R‖₂ / ‖R‖₂
  double rmse = 0;
  double relmse = 0;  // mean of (I-R)²/(R² + 0.01²·mean(R)²)
  double bias = 0;    // Σ(I-R) / ΣR
};

// Throws InputError if sizes differ or either image has NaN or infinite pixels (the message says how many).
ErrorMetrics compare(const Image& image, const Image& reference);

// |I-R| relative to the reference's mean, in false color (dark blue 0 … yellow `full` and more).
Image false_color_error(const Image& image, const Image& reference, float full = 0.5f);

}  // namespace lumirank::image
