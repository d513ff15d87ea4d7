// Settings of the clustering of columns by rows that were read, and of the choice of representatives:
// settings that row-column sampling and methods with columns of their own for every slice share.
#pragma once

#include <cstddef>

namespace lumirank::methods {

enum class ColorMode { averaged, scalar };
enum class ZeroColumns { sample, ignore };

struct ClusterSettings {
  ColorMode color = ColorMode::averaged;
  ZeroColumns zero_columns = ZeroColumns::sample;
  double zero_share = 0.02;
  double power_share = 0.3;
  double max_contribution = 0.5;  // see matrix::ScaledColumn
};

}  // namespace lumirank::methods
