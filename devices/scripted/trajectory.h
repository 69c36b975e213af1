#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/types.h"

namespace passung::scripted {

/// A recorded or synthetic path of the held part, from a CSV file with the columns t_s,x_m,y_m,z_m,qw,qx,qy,qz; a
/// further one, buttons, says which buttons of the handle are down: a number, bit 0 the first button.
class Trajectory {
public:
    /// Errors: unreadable, not numbers, times that do not rise, a first row that is not finite, a quaternion of another
    /// length than 1 (± 1e-3), buttons that are no whole number from 0 to 2^24 - 1. Rows with nan are allowed: a broken
    /// sensor.
    static Result<Trajectory> read(const std::string& path);

    /// Whole milliseconds up to the last row: ticks 0 … lastTick() make the run.
    std::int64_t lastTick() const;

    /// The pose at `tick` milliseconds: a row's own at its time, linear and slerp between rows, nan between two rows of
    /// which one is nan, the first row before its time.
    Pose at(std::int64_t tick) const;
    /// The buttons that are down then: those of the last row up to `tick`; none where the file does not say.
    std::uint32_t buttonsAt(std::int64_t tick) const;

private:
    struct Row {
        double t;  // [s]
        Pose pose;
        std::uint32_t buttons;
    };
    /// The row after `tick`, or the end.
    std::vector<Row>::const_iterator after(std::int64_t tick) const;
    std::vector<Row> rows_;
};

}  // namespace passung::scripted
