#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>

#include "core/base/types.h"
#include "core/loop/mailbox.h"

namespace passung::mouse {

/// The vector in its direction, at most `longest` long.
Vec3 shortened(const Vec3& v, double longest) noexcept;

/// Pose at which somebody with mouse and keyboard wants the held part, and what keys act as the handle's buttons.
/// Windows move it, a device follows it.
class Pointer {
public:
    /// The held part shall be here. Any thread but the loop's.
    void place(const Pose& X_W);
    /// Moves the wish by so much, world axes [m], turned about its own origin by a rotation vector in world axes [rad].
    /// Any thread but the loop's.
    void move(const Vec3& way, const Vec3& turn);
    /// Keys are held: from now on pass() moves it at this speed [m/s] and spin [rad/s], world axes, until they are told
    /// anew; for kHeld at most, so that it stops where nobody is left to say that a key was released. Any thread but
    /// the loop's.
    void drive(const Vec3& speed, const Vec3& spin);
    static constexpr double kHeld = 1.0;  // [s]
    /// So much time has passed [s]: however it is cut into pieces, the way is the same. Any thread but the loop's.
    void pass(double seconds);
    /// Pulls it back to at most `reach` [m] and `swing` [rad] away from `X_W`, where the part is: what the hand cannot
    /// follow is not saved up. Any thread but the loop's.
    void keepNear(const Pose& X_W, double reach, double swing);
    /// Bit per button. Any thread.
    void press(std::uint32_t buttons) noexcept { buttons_.store(buttons, std::memory_order_relaxed); }

    /// The loop's thread only; rt-safe.
    const Pose& latest() noexcept { return box_.latest(); }
    std::uint32_t buttons() const noexcept { return buttons_.load(std::memory_order_relaxed); }

private:
    std::mutex mutex_;  // of those who move it
    Pose X_W_;
    Vec3 speed_ = Vec3::Zero(), spin_ = Vec3::Zero();
    double held_ = 0.0;  // for which they hold yet [s]
    loop::Mailbox<Pose> box_{Pose{}};
    std::atomic<std::uint32_t> buttons_{0};
};

}  // namespace passung::mouse
