// Visibility of the shared library's symbols.
#pragma once

#if defined(__GNUC__)
#define LUMIRANK_API __attribute__((visibility("default")))
#else
#define LUMIRANK_API
#endif
