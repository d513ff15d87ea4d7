// What statistical tests of this room allow to chance.
#pragma once

namespace lumirank::transport {

inline constexpr double kAlpha = 1e-4;  // false alarms per test

}  // namespace lumirank::transport
