#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/device_unit.h"
#include "core/loop/haptic_device.h"

namespace passung::unit {

/// Something that happened to a unit, once for each time that it happened.
struct UnitNews {
    loop::DeviceState state = loop::DeviceState::Present;  // that it has come to
    std::string why;                                       // for people
    /// It was in use and is no more: what runs on it is over.
    bool isLoss() const { return state > loop::DeviceState::Ready; }
};

/// A haptic device that lives as long as the session; attempts borrow it. Absent until it is found; Present when
/// it is connected and its values are sound; Ready once it is armed as well. Whatever goes wrong then takes the motors'
/// force at once and disarms it: Lost (gone), Stale (silent), Fault (values that cannot be). It is looked for and
/// connected again by itself, and armed again by the experimenter alone. No force but while it is lent and Ready.
class Unit : public loop::HapticDevice {
public:
    /// Any thread but the loop's, as all of these.
    virtual loop::DeviceState state() const noexcept = 0;
    /// Who it is, once it was connected.
    virtual std::optional<DeviceUnit> identity() const = 0;
    /// Why it is not Present or Ready, in words that say what to do; empty: it is.
    virtual std::string trouble() const = 0;
    /// Since the last call, in time.
    virtual std::vector<UnitNews> takeNews() = 0;
    virtual void arm() = 0;

    /// An attempt begins with the handle at `X_BD_start`, for whoever has none of its own there, and ends; the next one
    /// may have begun by then. No loop runs at either.
    virtual void lend(const Pose& X_BD_start) = 0;
    virtual void giveBack() = 0;
};

/// The device of one attempt: what is read and commanded is the unit's, which gets a zero wrench when the attempt ends.
class LentUnit final : public loop::HapticDevice {
public:
    LentUnit(Unit& unit, const Pose& X_BD_start) : unit_(unit) { unit_.lend(X_BD_start); }
    ~LentUnit() override { unit_.giveBack(); }
    LentUnit(const LentUnit&) = delete;
    LentUnit& operator=(const LentUnit&) = delete;

    const DeviceDescription& description() const override { return unit_.description(); }
    DeviceReading read() noexcept override { return unit_.read(); }
    loop::DeviceStatus status() const noexcept override { return unit_.status(); }
    void command(const Wrench& F_D_B) noexcept override { unit_.command(F_D_B); }
    bool pushesHand() const override { return unit_.pushesHand(); }

private:
    Unit& unit_;
};

}  // namespace passung::unit
