#include "base/version.h"

namespace lumirank {

std::string program_version() { return LUMIRANK_VERSION; }

}  // namespace lumirank
