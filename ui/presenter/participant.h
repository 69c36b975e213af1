#pragma once

#include <optional>
#include <span>
#include <vector>

#include "ui/presenter/part_poses.h"
#include "ui/presenter/run.h"
#include "ui/presenter/step_view.h"

namespace passung::presenter {

/// What the participant is to do now.
enum class ParticipantScreen {
    Welcome,
    Form,     // consent or a questionnaire
    Page,     // of instructions
    Wait,     // for the next trial
    ToStart,  // the hand takes the start pose
    Task,
    Question,  // of a pair: which interval?
    ByHand,    // real parts: the experimenter times the trial
    Idle,      // nothing is handled: the trial lasts its time
    Rest,
    Swap,  // another device comes into use
    Pause,
    Thanks,
};

/// What the participant sees; nothing of it tells more than the condition lets them know.
struct ParticipantView {
    ParticipantScreen screen = ParticipantScreen::Welcome;
    bool scene = false;  // is drawn
    Pose X_WHeld;        // where the held part is drawn
    // Likewise the parts in other hands, in the order of these; none: where it starts.
    std::vector<std::optional<Pose>> X_WOthers;
    // Of a scene whose parts are picked up: where all parts are drawn, and the hands; else none.
    std::vector<Pose> X_WParts;
    std::vector<DrawnHand> hands;
    std::vector<bool> done;                  // parts of steps that are done and lock
    std::optional<std::size_t> hinted = {};  // the part that a hint says to take
    std::vector<StepImage> images;           // pale, where parts belong next
    std::vector<StepLine> steps;
    bool start_mark = false;
    Pose X_WStart;
    double cue = 0.0;                                          // visual collision cue, 0 … 1
    bool arrow = false;                                        // of the force, for who cannot feel it
    Vec3 arrow_from = Vec3::Zero(), arrow_way = Vec3::Zero();  // world [m]
    double share = 0.0;                                        // of the session's trials that are over
    TrialBrief brief;                                          // of the running or last trial
    int interval = 0;                                          // of a pair, 1 or 2; 0: none
    bool begun = false;                                        // ByHand: the clock runs
    std::optional<session::RestView> rest;
    std::optional<TrialResult> result;  // of the last trial
};

/// Length of the arrow per force [m/N].
inline constexpr double kArrowPerNewton = 4e-3;
/// Below that no arrow is drawn [N].
inline constexpr double kLeastForce = 0.15;

/// `feels`: the participant's device renders the force; else it is drawn.
ParticipantView participantView(const Run& run, bool feels);

/// A recorded tick: what the participant saw, with the force as an arrow whoever felt it, and as a ghost in the start
/// mark's place the held part's other pose if it is another:
/// the hand's where the proxy was drawn, the proxy's where the hand was. `others`: the same tick of the other hands.
/// `poses`: where parts that are picked up then are; null: none are.
ParticipantView playbackView(const DrawnScene& scene, const TickRecord& record,
                             std::span<const std::optional<TickRecord>> others = {}, const PartPoses* poses = nullptr);

}  // namespace passung::presenter
