#include "ui/presenter/participant.h"

#include <algorithm>

namespace passung::presenter {

namespace {

ParticipantScreen screenOf(RunState state) {
    switch (state) {
        case RunState::Idle:
        case RunState::Opening:
        case RunState::Ready:
            return ParticipantScreen::Welcome;
        case RunState::Preparing:
        case RunState::Between:
            return ParticipantScreen::Wait;
        case RunState::ToStart:
            return ParticipantScreen::ToStart;
        case RunState::Running:
            return ParticipantScreen::Task;
        case RunState::Paused:
        case RunState::Stopped:
            return ParticipantScreen::Pause;
        case RunState::Complete:
        case RunState::Incomplete:
        case RunState::Failed:
            break;
    }
    return ParticipantScreen::Thanks;
}

}  // namespace

ParticipantView participantView(const Run& run, bool feels) {
    const RunView& state = run.view();
    ParticipantView view;
    view.screen = screenOf(state.state);
    if (state.planned > 0) view.share = static_cast<double>(state.finished) / static_cast<double>(state.planned);
    const auto& scene = run.scene();
    if (!scene || view.screen == ParticipantScreen::Welcome || view.screen == ParticipantScreen::Thanks) return view;
    view.scene = true;
    view.X_WStart = scene->parts[scene->held].X_W;
    view.X_WHeld = view.X_WStart;
    view.start_mark = view.screen == ParticipantScreen::ToStart;
    if (!run.last()) return view;
    const TickRecord& record = *run.last();
    view.X_WHeld = shownPose(*scene, record);
    const bool task = view.screen == ParticipantScreen::Task;
    if (task && scene->cues.visual)
        view.cue = std::min(1.0, static_cast<double>(record.hand_depth_m) / scene->cues.full_depth);
    const Vec3 force(record.force_N[0], record.force_N[1], record.force_N[2]);
    view.arrow = task && !feels && force.norm() >= kLeastForce;
    view.arrow_from = view.X_WHeld.p;
    view.arrow_way = kArrowPerNewton * force;
    return view;
}

}  // namespace passung::presenter
