#pragma once

#include "core/base/tick_record.h"

namespace passung::tick {

/// `button` from 1; 0 is never down. rt-safe.
inline bool isDown(const DeviceReading& reading, int button) noexcept {
    return button > 0 && (reading.buttons >> (button - 1) & 1u) != 0;
}

}  // namespace passung::tick
