// Power sampling: columns drawn in proportion to their lights' power, without reading any row (the
// baseline PS of 2007, section 5).
//
// Unbiased: column j is drawn with probability p_j = power_j / Σ power and scaled by 1/(c·p_j), so the
// expected sum is Σ_j φ_j. Columns of zero power are zero by the matrix's contract and never drawn; if no
// powers are known all columns are equally likely. Ours: the draws are stratified along the running sum of
// powers (choice `independent` for the plain form), and with a time or error target rounds of doubling size
// are added until it is met.
#pragma once

#include "methods/method.h"

namespace lumirank::methods {

MethodInfo power_sampling_info();

}  // namespace lumirank::methods
