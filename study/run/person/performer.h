#pragma once

#include <memory>
#include <optional>
#include <span>

#include "core/loop/haptic_device.h"
#include "core/loop/record_ring.h"
#include "devices/simulated/presets.h"
#include "study/plan/participant.h"
#include "study/plan/study_plan.h"
#include "study/session/apparatus.h"
#include "study/session/session.h"

namespace passung::run {

/// Somebody at this computer who takes part or only watches a simulated person, and the screens that show it. Called by
/// the thread that runs the session. What is not overridden shows, asks and watches nothing.
class Performer {
public:
    virtual ~Performer() = default;

    /// Kind of participant under which the data is stored.
    virtual plan::ParticipantKind kind() const = 0;
    /// The device for an attempt at `condition`; null: a simulated person holds one. And what it says about itself.
    virtual std::unique_ptr<loop::HapticDevice> device(const simulated::DeviceParams& /*preset*/,
                                                       const plan::Condition& /*condition*/) {
        return nullptr;
    }
    virtual DeviceDescription describe(const simulated::DeviceParams& preset) const {
        return simulated::describe(preset);
    }
    /// Get every tick, and are emptied by whoever draws or plays.
    virtual std::span<loop::ScreenRing* const> screens() { return {}; }
    /// Waits until the first picture of the attempt that was prepared last is on the participant's screen, or somebody
    /// wants something that cannot wait for it. Where nothing is shown: not at all.
    virtual void awaitPicture() {}
    /// What windows have given the participant between these times of the attempt whose loop began at `zero_ns`, on the
    /// steady clock; none where no window shows it. Its drawn_pose is "proxy" or "device", also without a picture: the
    /// database refuses another.
    virtual std::optional<session::Presentation> presented(std::int64_t /*zero_ns*/, std::int64_t /*from_ns*/,
                                                           std::int64_t /*to_ns*/) {
        return std::nullopt;
    }
    /// Source of the answers to questionnaires; may be null if the plan has none.
    virtual session::QuestionnaireSource* answers() { return nullptr; }

    /// Reader of the instructions; may be null: then they are only logged.
    virtual session::InstructionReader* reader() { return nullptr; }

    /// A session begins: `apparatus` may be halted at any time until over().
    virtual void begins(session::Apparatus& /*apparatus*/, const session::SessionSetup& /*setup*/) {}
    /// An attempt at this trial is about to begin, now its scene is built. `seed`: of the attempt.
    virtual void prepares(const plan::Condition& /*condition*/, std::int64_t /*trial_index*/, std::uint64_t /*seed*/) {}
    /// Fields and shells of that scene are built; this share of them is done. False: nobody waits for it.
    virtual bool builds(double /*share*/) { return true; }
    /// Called between two steps of the session, to read its view and to give commands.
    virtual void betweenSteps(session::Session& /*session*/) {}
    virtual void over() {}
};

}  // namespace passung::run
