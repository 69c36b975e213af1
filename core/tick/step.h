#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/tick_record.h"
#include "core/base/types.h"
#include "core/scene/assembly.h"
#include "core/tick/stage.h"
#include "core/tick/tick_frame.h"

namespace passung::tick {

struct TickModel;
struct TickState;

/// What one tick works on; dies with it.
struct TickFrame : Parts<Reading, HandSample, MappingRecord, AreaLoad, ContactRecord, HandDepth, EnergyRecord,
                         TransientsShare, WeightShare, ViscosityShare, GuidanceShare, SnapShare, InertiaShare,
                         KeepApartShare, EffectRecord, HandWrench, CommandedWrench, Report> {};

/// What one tick gives back: exact values, before they are rounded into a record.
struct TickOutput {
    Wrench F_D_B;     // to be commanded
    TickFrame frame;  // everything else
    Pose X_WG;        // proxy of the held part
    std::int32_t held =
        kNoPart;  // which part that is, in the order of the scene; kPartNotTold: the scene picks none up
    scene::StepSet steps_done = 0;  // of an assembly, as the tick began
};

/// Who is told after every stage of a tick that it has run for a hand, to measure what it costs. @pre `after` is
/// rt-safe.
struct StageWatch {
    void (*after)(void* context, const Stage& stage) noexcept;
    void* context;
};

/// One tick of the haptic loop: a plain function over values (tick_model.h, tick_state.h). Same model, state and
/// readings: same bits.
///   The hands take turns, in an order that goes round from tick to tick. Each walks its model's stages; each of these
/// sees the parts of state and frame that it declares (stage.h). While one hand's part moves all other parts rest. At
/// its end hands may pick parts up and let them go (pick.h).
/// Nothing allocates, locks or throws, and every loop has a bound. rt-safe.
/// @pre a reading and an output for each hand
void step(const TickModel& model, TickState& state, std::span<const DeviceReading> readings,
          std::span<TickOutput> outputs, const StageWatch* watch = nullptr) noexcept;
/// The same for a scene of one hand.
TickOutput step(const TickModel& model, TickState& state, const DeviceReading& reading,
                const StageWatch* watch = nullptr) noexcept;

/// The record of a tick: inputs exact, outputs as 32-bit floats. rt-safe.
TickRecord makeRecord(std::int64_t tick, const DeviceReading& reading, const TickOutput& output) noexcept;

/// The reading that a record was made from. rt-safe.
DeviceReading readingOf(const TickRecord& record) noexcept;

}  // namespace passung::tick
