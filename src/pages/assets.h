// The style sheet and the script of the compare page.
#pragma once

namespace lumirank::pages {

extern const char* const kCompareStyle;
extern const char* const kCompareScript;

}  // namespace lumirank::pages
