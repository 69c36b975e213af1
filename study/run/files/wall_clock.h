#pragma once

#include <cstdint>

#include "study/store/write/store.h"

namespace passung::run {

/// UTC by this machine's clock, in milliseconds since 1970.
std::int64_t unixMilliseconds();

/// How this program opens a study's database for writing at this time.
store::OpenOptions openOptionsNow(std::int64_t unix_ms = unixMilliseconds());

}  // namespace passung::run
