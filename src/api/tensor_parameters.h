// The parameters of tensor clustering by their names: what `--set` takes, and what reports and lists have.
#pragma once

#include <string>

#include "lumirank/info.h"

namespace lumirank::api {

inline constexpr const char* kTensorClustering = "tensor-clustering";

// Beside those of methods::all_methods(): it makes the frames of a shot (AnimateSettings::tensor).
MethodDescription describe_tensor_clustering();

}  // namespace lumirank::api
