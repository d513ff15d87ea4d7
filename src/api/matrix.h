// Implementation of the public matrix. Inside this room only.
#pragma once

#include "lumirank/matrix.h"
#include "pipeline/prepared.h"

namespace lumirank {

struct Matrix::Impl {
  pipeline::SharedPrepared prepared;  // keeps the matrix alive
};

// As the inner rooms have it.
std::vector<matrix::ScaledColumn> to_scaled(std::span<const WeightedColumn> columns);

}  // namespace lumirank
