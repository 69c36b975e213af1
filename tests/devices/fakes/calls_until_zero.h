#pragma once

#include <cstdint>
#include <optional>

#include "tests/devices/fakes/shared_block.h"

namespace passung::fake {

/// Which call after the first `from` of them is the first that is zero for good: 1 is the next one, 0 says that there
/// was zero already and no call since. Nothing where the last call of all is not zero: what it has commanded stands.
/// `is_zero` takes the number of a call, from 0.
template <typename IsZero>
std::optional<std::int64_t> callsUntilZero(std::int64_t count, std::int64_t from, IsZero is_zero) {
    if (count > 0 && !is_zero(count - 1)) return std::nullopt;
    if (count <= from) return 0;
    std::int64_t last_not_zero = count - 1;
    while (last_not_zero >= from && is_zero(last_not_zero)) --last_not_zero;
    return last_not_zero + 2 - from;
}

/// The same for the commands that a shim keeps.
template <typename Command>
std::optional<std::int64_t> callsUntilZero(const SharedRing<Command>& commands, std::int64_t from) {
    return callsUntilZero(commands.count(), from, [&](std::int64_t number) {
        const Command command = commands.row(number);
        for (const double component : command.felt) {
            if (component != 0.0) return false;  // NaN is not zero
        }
        return true;
    });
}

}  // namespace passung::fake
