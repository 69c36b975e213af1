#pragma once

#include <cstdio>
#include <cstdlib>

/// Our own mistakes only, never input. On unless NDEBUG (Release) is set.
#ifdef NDEBUG
#define PASSUNG_ASSERT(condition) static_cast<void>(0)
#else
#define PASSUNG_ASSERT(condition) \
    ((condition)                  \
         ? static_cast<void>(0)   \
         : (std::fprintf(stderr, "%s:%d: assertion failed: %s\n", __FILE__, __LINE__, #condition), std::abort()))
#endif
