// Least squares in four unknowns, from the sums of products of its equations.
#pragma once

#include <array>

namespace lumirank::linalg {

// w of (XᵀX + ridge·m·I) w = XᵀY, m the mean of XᵀX's diagonal. square: the upper triangle of XᵀX, row after
// row.
std::array<float, 4> solve_regularized4(const std::array<float, 10>& square,
                                        const std::array<float, 4>& right, float ridge);

}  // namespace lumirank::linalg
