#include "base/version.h"

namespace lumirank {

std::string program_version() { return LUMIRANK_VERSION; }

std::string program_instruction_set() {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return "AVX-512";
#elif defined(__AVX2__)
  return "AVX2";
#else
  return "no wide vectors";
#endif
}

}  // namespace lumirank
