#pragma once

#include <cstdint>

#include "core/base/tick_record.h"
#include "core/base/types.h"

namespace passung::tick {

/// Mean twist of a body from one good sample of its pose to the next, `periods` > 0 ticks later, about its origin,
/// world axes. rt-safe.
inline Twist twistBetween(const Pose& before, const Pose& after, std::int64_t periods) noexcept {
    const double elapsed = kTickSeconds * static_cast<double>(periods);
    return {(after.p - before.p) / elapsed, rotationVector(after.q * before.q.conjugate()) / elapsed};
}

}  // namespace passung::tick
