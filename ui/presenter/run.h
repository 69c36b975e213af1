#pragma once

#include <array>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include "study/measures/pair_watch.h"
#include "ui/presenter/quality_search.h"
#include "ui/presenter/session_news.h"
#include "ui/presenter/trace.h"

namespace passung::presenter {

/// What goes on, as the largest line on the experimenter's screen says it.
enum class RunState {
    Idle,        // no session
    Opening,     // database and study
    Preparing,   // the next trial's scene is built
    ToStart,     // the hand is on its way to the start pose
    Running,     // the trial
    Between,     // trials
    Consenting,  // the participant decides on a clause of consent
    Reading,     // the participant reads instructions
    Answering,   // the participant fills a questionnaire
    Resting,
    Ready,  // waits for Start
    Paused,
    Stopped,  // paused by an emergency stop: motors are off
    Complete,
    Incomplete,  // ended before the last trial
    Failed,
};

enum class RowState { Waiting, Next, Running, Success, Timeout, Failure, Aborted, Skipped, Invalid };

struct TrialRow {
    std::int64_t number = 0;  // from 1
    std::string block, phase, condition;
    RowState state = RowState::Waiting;
    int attempts = 0;  // that ended
    std::optional<double> time_s;
    std::string remark;  // why it does not count
};

/// Why a command cannot be given now.
using Why = session::WhyNot;

/// What the participant's window is able to show.
enum class Display {
    Shown,
    Closed,  // the window was
    Lost,    // the graphics system draws no picture any more
};

/// How the loop has kept its rate over the last second.
struct LoopView {
    double rate_hz = 0.0;     // ticks that happened
    double typical_us = 0.0;  // computing time of a tick, median
    double longest_us = 0.0;
    std::int64_t missed = 0;  // cycles since the attempt began
    bool known = false;
};

/// The pictures of the participant's window over the last second.
struct PicturesView {
    double per_s = 0.0;   // that showed a newer tick
    double age_ms = 0.0;  // of what is on the screen now
    bool known = false;
};

/// What came of a trial, for the participant.
struct TrialResult {
    bool success = false;
    std::optional<double> time_s;  // if that is told as well
};

struct RunView {
    RunState state = RunState::Idle;
    std::string study, participant;
    std::size_t planned = 0, finished = 0;
    std::int64_t number = 0;  // of the running or next trial, from 1; 0: none
    std::string condition;
    bool by_hand = false;  // the experimenter times the running trial
    session::SessionView session = session::viewWithoutSession();
    double trial_s = 0.0;  // since the go
    std::vector<TrialRow> rows;
    std::int64_t rows_changed = 0;  // counts up whenever a row does
    LoopView loop;
    PicturesView pictures;
    std::optional<QualityFound> quality;  // with which the participant's window draws; none: not found yet
    bool awaits_picture = false;          // the prepared trial begins with its first one
    double force_N = 0.0, depth_mm = 0.0;
    std::optional<CommandAnswered> answered;  // the last command
    std::vector<std::string> warnings;        // of this run, in sentences
    std::string failure;                      // why the session failed
    Display display = Display::Shown;
    std::optional<double> built;  // of the scene that is being built: the share that is done
    bool sound = false;           // the trial has something to be heard

    Why why(session::CommandKind kind) const { return session.permission(kind).why; }
    bool may(session::CommandKind kind) const { return why(kind) == Why::Possible; }
    bool isRunning() const { return state > RunState::Idle && state < RunState::Complete; }
};

/// What an experimenter sees of a run and may do to it. Knows no thread and no window: news and records are brought to
/// it.
class Run {
public:
    /// A run of this study is being opened.
    void open(const plan::StudyPlan& plan);
    void take(const News& news);
    void take(std::span<const TickRecord> records);
    /// The display has got a picture that shows this tick [ns], both on one clock.
    void see(std::int64_t began_ns, std::int64_t presented_ns);
    void checkPictures(std::int64_t now_ns);
    void drawsWith(const QualityFound& found) { view_.quality = found; }
    void awaitsPicture(bool awaits) { view_.awaits_picture = awaits; }
    /// What the participant's window shows from now on. The command that the session then needs, if any.
    std::optional<session::Command> setDisplay(Display display);

    const RunView& view() const { return view_; }
    const Trace& force() const { return force_; }
    const Trace& depth() const { return depth_; }
    const std::shared_ptr<const DrawnScene>& scene() const { return scene_; }
    /// The newest tick of the running attempt.
    const std::optional<TickRecord>& last() const { return last_; }
    /// What the participant is asked or reads now; null: nothing.
    const std::shared_ptr<const FormRequest>& form() const { return form_; }
    const std::optional<PageDue>& page() const { return page_; }
    const TrialBrief& brief() const { return brief_; }
    /// How the participant's window draws.
    const plan::View& appearance() const { return appearance_; }
    /// Of a pair: where it is; nothing before its first interval.
    const std::optional<measures::PairWatch>& pair() const { return pair_; }
    /// What the participant may know of the trial that ended last; nothing once the next one begins.
    const std::optional<TrialResult>& result() const { return result_; }

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
    void ask(std::shared_ptr<const FormRequest> form, std::optional<PageDue> page);
    RunState between() const;
    void startClock();

    RunView view_;
    std::shared_ptr<const FormRequest> form_;
    std::optional<PageDue> page_;
    TrialBrief brief_;
    plan::View appearance_;
    std::optional<measures::PairWatch> pair_;
    std::optional<TrialResult> result_;
    std::vector<std::string> conditions_;  // names
    std::shared_ptr<const DrawnScene> scene_;
    std::optional<TickRecord> last_;
    Trace force_, depth_;
    double time_ = 0.0;      // in the attempt [s]
    double started_ = -1.0;  // when the trial began; negative: not yet
    std::array<float, 1000> durations_us_{};
    std::array<std::uint32_t, 1000> periods_{};
    std::size_t ticks_ = 0;                  // of the attempt
    std::deque<std::int64_t> presented_ns_;  // of the last second
    std::int64_t on_screen_ns_ = 0;          // when the tick began that is on the screen; 0: none is
};

}  // namespace passung::presenter
