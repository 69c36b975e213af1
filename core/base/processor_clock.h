#pragma once

#include <cstdint>

namespace passung {

/// That the calling thread has spent on a processor since it began [ns]: what other programs take from it does not
/// count. Slower to read than the wall clock, about 0.3 µs. rt-safe.
std::int64_t threadProcessorNanoseconds() noexcept;

}  // namespace passung
