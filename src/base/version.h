// The program's version, as reports and pages state it.
#pragma once

#include <string>

namespace lumirank {

// "0.1.0"
std::string program_version();
// See lumirank.h.
std::string program_instruction_set();

}  // namespace lumirank
