// Small matrices of three kinds, and what methods that cut the light tree must do on them.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "matrix/synthetic.h"
#include "methods/common/column_pass.h"
#include "methods/parameters.h"

namespace lumirank::methods::test {

inline std::vector<matrix::DenseMatrix> cut_matrices() {
  std::vector<matrix::DenseMatrix> m;
  m.push_back(matrix::low_rank_matrix({120, 300, 1}, 6, 3));
  m.push_back(matrix::sparse_matrix({120, 300, 2}, 0.3));
  m.push_back(matrix::recess_matrix({120, 300, 3}));
  return m;
}

// With sizes[0] < sizes[1] < sizes[2] nodes of a cut at most, the last of which are enough for every light.
inline void expect_error_falls_to_nothing(const std::string& method, SettingsMap settings,
                                          const std::string& max_nodes,
                                          const std::array<const char*, 3>& sizes) {
  for (const matrix::DenseMatrix& m : cut_matrices()) {
    std::vector<double> errors;
    for (const char* nodes : sizes) {
      settings[max_nodes] = nodes;
      const Estimate e = find_method(method).make(settings)->run(m, {});
      errors.push_back(relative_difference(e.sums, m.exact_sums()));
      EXPECT_LE(e.trace.numbers.at("columns_max"), std::stod(nodes));
    }
    EXPECT_GT(errors[0], errors[1]);
    EXPECT_GT(errors[1], errors[2]);
    EXPECT_LT(errors[2], 1e-6);  // sums of 300 floats in another order
  }
}

}  // namespace lumirank::methods::test
