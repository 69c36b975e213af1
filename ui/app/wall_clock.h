#pragma once

#include <cstdint>

#include "study/store/store.h"

namespace passung::app {

/// UTC by this machine's clock, in milliseconds since 1970.
std::int64_t unixMilliseconds();

/// How this program opens a study's database for writing now.
store::OpenOptions openOptionsNow();

}  // namespace passung::app
