#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/device_unit.h"
#include "core/base/result.h"
#include "core/loop/haptic_device.h"
#include "devices/unit/unit.h"
#include "study/plan/study_plan.h"
#include "study/session/apparatus.h"

namespace passung::run {

/// The real devices of this station, as its file chooses them, for as long as sessions run. What it says of a simulated
/// one is left out.
class UnitRack {
public:
    /// How long open() waits for units to be there [ms].
    static constexpr int kOpening = 5000;
    static constexpr int kArming = 1000;  // arm() likewise

    /// No units.
    UnitRack() = default;
    ~UnitRack();
    UnitRack(UnitRack&&) noexcept;
    UnitRack& operator=(UnitRack&&) noexcept;

    /// Opens all that are chosen and waits until they are there. Errors: what is missing of which, in words that a lab
    /// engineer can act on; `file` is the one that chooses.
    static Result<UnitRack> open(const std::vector<DeviceChoice>& choices, const std::string& file);

    bool empty() const { return racked_.empty(); }
    /// Why a person cannot take part in this plan on these units: what serves no hand, what is of another kind, and
    /// what is weaker than what the plan asks for, with the reason.
    Errors whyNot(const plan::StudyPlan& plan) const;
    std::vector<DeviceUnit> units() const;
    /// Of the first. @pre not empty()
    const DeviceDescription& description() const { return racked_.front().unit->description(); }

    /// The hand of a condition's scene, from 0. An attempt's device; null: no unit serves it.
    std::unique_ptr<loop::HapticDevice> lend(const plan::Condition& condition, std::size_t hand,
                                             const Pose& X_BD_start);

    /// Since the last call.
    std::vector<session::DeviceNews> takeNews();
    /// Arms all, and waits until they are ready.
    void arm();
    /// Which unit is not ready, and why; empty: all are. `or_there`: one that is to be armed yet will do.
    std::string notReady(bool or_there) const;

private:
    struct Racked {
        DeviceChoice choice;
        std::unique_ptr<unit::Unit> unit;
    };
    const Racked* serving(const plan::Condition& condition, std::size_t hand) const;

    std::vector<Racked> racked_;
    std::string file_;
};

}  // namespace passung::run
