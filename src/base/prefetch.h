// Asking memory for what will be read soon.
#pragma once

namespace lumirank {

inline void prefetch(const void* address) {
  __builtin_prefetch(address);
  // GCC takes a function that does nothing but prefetch for one without effect, and drops calls of it.
  asm volatile("");
}

}  // namespace lumirank
