#pragma once

#include <array>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "study/measures/pair_watch.h"
#include "ui/presenter/part_poses.h"
#include "ui/presenter/run_view.h"
#include "ui/presenter/trace.h"

namespace passung::presenter {

/// What an experimenter sees of a run and may do to it. Knows no thread and no window: news and records are brought to
/// it.
class Run {
public:
    /// A run of this study is being opened.
    void open(const plan::StudyPlan& plan);
    void take(const News& news);
    void take(std::span<const TickRecord> records);
    /// Where the other hands' parts are drawn in the newest of these.
    void place(std::vector<Pose> X_WOthers) { X_WOthers_ = std::move(X_WOthers); }
    /// Where parts that are picked up are, from what a screen learns of these ticks.
    void follow(std::span<const loop::ScreenTick> ticks);
    /// The display has got a picture that shows this tick [ns], both on one clock.
    void see(std::int64_t began_ns, std::int64_t presented_ns);
    void checkPictures(std::int64_t now_ns);
    void drawsWith(const QualityFound& found) { view_.quality = found; }
    /// `shown`: the participant's window has shown the first picture of the attempt that is prepared. True if that
    /// changes the state.
    bool checkFirstPicture(bool shown);
    /// What the participant's window shows from now on. The command that the session then needs, if any.
    std::optional<session::Command> setDisplay(Display display);

    const RunView& view() const { return view_; }
    const Trace& force() const { return force_; }
    const Trace& depth() const { return depth_; }
    const std::shared_ptr<const DrawnScene>& scene() const { return scene_; }
    /// The newest tick of the running attempt.
    const std::optional<TickRecord>& last() const { return last_; }
    /// Where the other hands' parts are drawn in that tick; more than the scene has hands may be there.
    const std::vector<Pose>& others() const { return X_WOthers_; }
    /// Where all parts of a scene are whose parts are picked up.
    const PartPoses& poses() const { return poses_; }
    /// How the participant's window draws.
    const plan::View& appearance() const { return appearance_; }
    /// Of a pair: where it is; nothing before its first interval.
    const std::optional<measures::PairWatch>& pair() const { return pair_; }

private:
    void begin(const SessionBegun& begun);
    void prepare(const AttemptPrepared& prepared);
    void show(const session::SessionView& session);
    void hear(const session::SessionEvent& event);
    void end(const session::AttemptEnded& ended);
    void answer(const CommandAnswered& answered);
    void finish(const RunOver& over);
    void watch(const TickRecord& record);
    void judgeLoop();
    void ask(FormOrPage asked);
    RunState between() const;
    void startClock();

    RunView view_;
    plan::View appearance_;
    std::optional<measures::PairWatch> pair_;
    std::vector<std::string> conditions_;  // names
    std::shared_ptr<const DrawnScene> scene_;
    std::optional<TickRecord> last_;
    std::vector<Pose> X_WOthers_;
    PartPoses poses_;
    Trace force_, depth_;
    double time_ = 0.0;              // in the attempt [s]
    std::optional<double> started_;  // when the trial began; none: not yet
    std::array<float, LoopView::kTicksPerSecond> durations_us_{};
    std::array<std::uint32_t, LoopView::kTicksPerSecond> periods_{};
    std::size_t ticks_ = 0;                  // of the attempt
    std::int64_t missed_ = 0;                // cycles of it
    std::deque<std::int64_t> presented_ns_;  // of the last second
    std::int64_t on_screen_ns_ = 0;          // when the tick began that is on the screen; 0: none is
};

}  // namespace passung::presenter
