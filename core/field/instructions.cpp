#include "core/field/instructions.h"

namespace passung::field {

namespace {

Instructions detect() {
#if defined(__x86_64__)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
        return Instructions::V4;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
        __builtin_cpu_supports("bmi2"))
        return Instructions::V3;
#endif
    return Instructions::Baseline;
}

}  // namespace

Instructions bestInstructions() noexcept {
    static const Instructions best = detect();  // at first use: other files' constants may ask before this one's exist
    return best;
}

}  // namespace passung::field
