#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/tick_record.h"
#include "core/scene/assembly.h"
#include "core/tick/hand_model.h"
#include "core/tick/step.h"

namespace passung::tick {

struct TickModel;
struct TickState;

/// Picking parts up, carrying them and letting them go: a rule of the tick alone, so that a replay finds it again.
///
/// When. At the end of a tick, after all hands have had their turn, in the order of their turns; what changes holds
/// from the next tick on. The button counts in ticks with a usable sample. A hand closes when it goes down, and opens
/// when it goes up, or with `on_press` when it goes down again. A hand that begins with a part holds it until it opens.
///
/// Closing. Of all pickable parts that are not locked and that nobody holds, or one other hand that may pick parts up,
/// the one whose surface is nearest to the hand's point o_D, the origin of what the registration puts into the handle,
/// within `reach`; a point inside a part is at distance 0, of equal ones the first of the scene is taken. With X_WD the
/// hand's frame, X_WP the part's pose:
///   X_DP = X_WD⁻¹ X_WP   the grip, until the hand opens: the part is asked to be at X_WD X_DP,
///   c = X_WP⁻¹ o_D       the point of the part that the coupling's springs hold (motion/metric.h, grip.h).
/// So nothing moves and no spring is stretched when the hand closes. A hand that finds nothing has closed on nothing.
///
/// In two hands (god objects only). The hand that closed first goes on to move the part: by both springs, each where
/// its hand holds it (motion::Pull), and the second one follows it (followed_part.h). When the first opens the
/// second goes on alone, and when the second does the first: nothing is laid down. So parts are handed over. A device
/// that is believed to be elsewhere (input_guard.h) gets another grip at the same part, whose other hand it does not
/// tear it from.
///
/// Opening. The part stays where its proxy is, which overlaps nothing, each number rounded to the nearest single
/// precision: as a record has the proxy's pose, so that it tells where the part is left. It rests there, for others
/// too, until somebody closes on it; with `locks` for good. The hand's wrench ends with what its spring held, at once,
/// and with what an output delay still had of it.
///
/// Assemblies (scene/assembly.h). A step is done when its part rests, let go within the tolerances of its goal, and all
/// steps before it are done: at the end of the tick in which the last of these came true. A part that is let go there
/// too early waits. Done, a step that locks keeps its part; of another one the part may be taken out again, which takes
/// the step back. The undo button of a hand that may pick parts up takes back the step that was done last, when it goes
/// down: its part is free again and waits to be handled.
///
/// Cost. Nothing where the scene names no pick: no call, no memory. Else, when a hand closes, a look at the box of
/// every pickable part and at the faces of those near; in other ticks a comparison for each hand. What a part takes of
/// memory (PartState) is its own, whoever holds it; it waits where nobody does.
struct Hold {
    std::size_t body = kNoBody;     // that the hand holds
    std::size_t let_go = kNoBody;   // that it let go at the end of the tick before
    bool down = false;              // the button, in the last tick with a good new sample
    bool seen = false;              // there was one
    bool undo_down = false;         // as `down`, the undo button
    std::size_t partner = kNoHand;  // that holds the same part
    bool follows = false;           // the partner moves it
    static constexpr std::size_t kNoHand = ~std::size_t{0};
};

/// How far an assembly is.
struct AssemblyState {
    scene::StepSet done = 0;
    scene::StepSet laid = 0;                                 // the part was let go, and neither taken nor undone since
    std::array<std::uint8_t, scene::kMostSteps> sequence{};  // in which the done ones were done
    std::size_t count = 0;                                   // of these
};

/// The end of a tick. rt-safe. @pre model.picks()
void pickAndLetGo(const TickModel& model, TickState& state, std::span<const DeviceReading> readings,
                  std::span<const TickOutput> outputs) noexcept;

}  // namespace passung::tick
