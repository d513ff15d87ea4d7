// Tail probabilities for the statistical tests.
#pragma once

namespace lumirank::scatter {

// P(X ≥ x) for X chi-square distributed with `degrees` degrees of freedom.
double chi_square_tail(double x, int degrees);

}  // namespace lumirank::scatter
