#include "ui/presenter/participant.h"

#include <algorithm>
#include <cmath>

namespace passung::presenter {

namespace {

// Poses that differ by less look the same.
constexpr double kApart = 0.05e-3;  // [m]
constexpr double kTurned = 2e-3;    // [rad]

/// The screen of each state.
struct ScreenOf {
    using Screen = ParticipantScreen;
    Screen operator()(const OneOf<state::Idle, state::Opening, state::Ready> auto&) const { return Screen::Welcome; }
    Screen operator()(const OneOf<state::Consenting, state::Answering> auto&) const { return Screen::Form; }
    Screen operator()(const state::ReadingPage&) const { return Screen::Page; }
    Screen operator()(const state::Resting&) const { return Screen::Rest; }
    Screen operator()(const OneOf<state::Preparing, state::AwaitingPicture, state::Between> auto&) const {
        return Screen::Wait;
    }
    Screen operator()(const state::ToStart&) const { return Screen::ToStart; }
    Screen operator()(const state::Running&) const { return Screen::Task; }
    Screen operator()(const OneOf<state::Paused, state::Stopped> auto&) const { return Screen::Pause; }
    Screen operator()(const OneOf<state::Complete, state::Incomplete, state::Failed> auto&) const {
        return Screen::Thanks;
    }
};

/// Where a ray from the middle of the part's box leaves it.
Vec3 outermost(const ShadedMesh& mesh, const Pose& X_W, const Vec3& way) {
    Vec3 middle, half;
    for (int i = 0; i < 3; ++i) {
        const double low = static_cast<double>(mesh.low_mm[static_cast<std::size_t>(i)]);
        const double high = static_cast<double>(mesh.high_mm[static_cast<std::size_t>(i)]);
        middle[i] = 0.5e-3 * (low + high);
        half[i] = 0.5e-3 * (high - low);
    }
    const Vec3 inside = X_W.q.conjugate() * way;
    double length = half.norm();
    for (int i = 0; i < 3; ++i)
        if (std::abs(inside[i]) * length > half[i]) length = half[i] / std::abs(inside[i]);
    return X_W * middle + length * way;
}

/// What there is to do in the running trial, and in which interval of a pair.
void lookIntoTrial(const Run& run, ParticipantView& view) {
    using Phase = measures::PairWatch::Phase;
    if (view.brief.timed_by != plan::TimedBy::Program) {
        const bool by_hand = view.brief.timed_by == plan::TimedBy::Experimenter;
        view.screen = by_hand ? ParticipantScreen::ByHand : ParticipantScreen::Idle;
        return;
    }
    if (view.screen != ParticipantScreen::Task) return;
    const Phase phase = run.pair() ? run.pair()->phase() : Phase::First;
    if (view.brief.kind == TrialBrief::Kind::Pair) view.interval = phase == Phase::First ? 1 : 2;
    if (phase == Phase::Question || phase == Phase::Answered) view.screen = ParticipantScreen::Question;
    if (phase == Phase::Between) view.screen = ParticipantScreen::ToStart;
}

void drawForce(ParticipantView& view, const DrawnScene& scene, const TickRecord& record) {
    const Vec3 force(record.force_N[0], record.force_N[1], record.force_N[2]);
    view.arrow = force.norm() >= kLeastForce;
    view.arrow_way = kArrowPerNewton * force;
    if (!view.arrow) return;
    const std::int32_t carried = view.hands.empty() ? kPartNotTold : view.hands.front().part;
    const std::size_t part = carried == kPartNotTold ? scene.held : static_cast<std::size_t>(carried);
    view.arrow_from = part < scene.parts.size() ? outermost(*scene.parts[part].mesh, view.X_WHeld, force.normalized())
                                                : view.X_WHeld.p;
}

/// Everything that hands pick up, and where it belongs.
void drawParts(ParticipantView& view, const DrawnScene& scene, const PartPoses& poses) {
    if (!scene.picking || poses.drawn().size() != scene.parts.size()) return;
    view.X_WParts = poses.drawn();
    view.hands = poses.hands();
    view.done = partsDone(scene, poses.done());
    if (const auto step = poses.hinted()) view.hinted = scene.picking->pick.steps[*step].part;
    view.images = stepImages(scene, poses.poses(), poses.done(), poses.hinted());
    view.steps = stepLines(*scene.picking, poses.done(), poses.hinted());
    if (view.hands.empty()) return;
    const std::int32_t carried = view.hands.front().part;
    view.X_WHeld = carried >= 0 ? view.X_WParts[static_cast<std::size_t>(carried)] : view.hands.front().X_W;
}

bool hasScene(ParticipantScreen screen) {
    return screen == ParticipantScreen::Wait || screen == ParticipantScreen::ToStart ||
           screen == ParticipantScreen::Task || screen == ParticipantScreen::Question ||
           screen == ParticipantScreen::Pause;
}

}  // namespace

ParticipantView participantView(const Run& run, bool feels) {
    const RunView& now = run.view();
    ParticipantView view;
    view.screen = std::visit(ScreenOf(), now.state);
    if (view.screen == ParticipantScreen::Pause && !now.session.awaited_device.empty())
        view.screen = ParticipantScreen::Swap;
    if (now.planned > 0) view.share = static_cast<double>(now.finished) / static_cast<double>(now.planned);
    view.brief = now.brief;
    if (const auto* resting = std::get_if<state::Resting>(&now.state)) view.rest = resting->rest;
    view.result = now.result;
    view.begun = now.is<state::Running>();
    if (view.screen == ParticipantScreen::ToStart || view.screen == ParticipantScreen::Task) lookIntoTrial(run, view);
    const auto& scene = run.scene();
    if (!scene || !hasScene(view.screen)) return view;
    const bool in_trial = view.screen == ParticipantScreen::Task || view.screen == ParticipantScreen::Question;
    const bool hidden = scene->hidden_in_trial && in_trial;
    view.scene = !hidden && (view.screen != ParticipantScreen::Wait || view.brief.timed_by == plan::TimedBy::Program);
    view.X_WStart = scene->startPose();
    view.X_WHeld = view.X_WStart;
    view.start_mark = view.screen == ParticipantScreen::ToStart;
    drawParts(view, *scene, run.poses());
    if (!run.last()) return view;
    if (!scene->picking) view.X_WHeld = shownPose(*scene, *run.last());
    view.X_WOthers.assign(run.others().begin(), run.others().end());
    if (view.screen != ParticipantScreen::Task) return view;
    if (scene->cues.visual)
        view.cue = std::min(1.0, static_cast<double>(run.last()->hand_depth_m) / scene->cues.full_depth);
    if (!feels) drawForce(view, *scene, *run.last());
    return view;
}

ParticipantView playbackView(const DrawnScene& scene, const TickRecord& record,
                             std::span<const std::optional<TickRecord>> others, const PartPoses* poses) {
    ParticipantView view;
    view.screen = (record.status & kEngaged) != 0 ? ParticipantScreen::Task : ParticipantScreen::ToStart;
    view.scene = true;
    view.X_WHeld = shownPose(scene, record);
    for (const std::optional<TickRecord>& other : others)
        view.X_WOthers.push_back(other ? std::optional(shownPoseOfOther(scene, *other)) : std::nullopt);
    const bool proxy = scene.shown == plan::ShownPose::Proxy;
    view.X_WStart = poseOf(scene, record, proxy ? plan::ShownPose::Device : plan::ShownPose::Proxy);
    view.start_mark =
        (view.X_WStart.p - view.X_WHeld.p).norm() > kApart || view.X_WStart.q.angularDistance(view.X_WHeld.q) > kTurned;
    if (scene.cues.visual) view.cue = std::min(1.0, static_cast<double>(record.hand_depth_m) / scene.cues.full_depth);
    if (poses != nullptr) drawParts(view, scene, *poses);
    if (scene.picking) view.start_mark = false;  // of which part it were the other pose changes
    drawForce(view, scene, record);
    return view;
}

}  // namespace passung::presenter
