// Adaptive column sampling and completion (Huo, Wang, Hu, Hua, Jin, "Adaptive matrix column sampling and
// completion for rendering participating media", ACM Transactions on Graphics 35(6), 2016). Rows are cut into
// slices; in each the tree of columns is refined where few drawn columns tell too little of a node, and those
// columns are known by few of their rows.
//
// Made for media, where columns are smooth functions of the rows; it runs on any matrix.
#pragma once

#include "methods/method.h"

namespace lumirank::methods {

MethodInfo column_completion_info();

}  // namespace lumirank::methods
