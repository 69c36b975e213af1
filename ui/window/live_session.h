#pragma once

#include <atomic>
#include <deque>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "devices/mouse/pointer.h"
#include "study/run/files/builds.h"
#include "study/run/machine/frame_clock.h"
#include "study/run/person/performer.h"
#include "study/run/run_study.h"
#include "ui/presenter/quality_search.h"
#include "ui/presenter/session_news.h"
#include "ui/sound/sound_feed.h"
#include "ui/window/interview.h"

namespace passung::window {

/// Who moves the device in a live session.
enum class LiveHand { Mouse, Simulated };

struct LiveOptions {
    std::string database = {};
    LiveHand hand = LiveHand::Mouse;
    bool try_out = false;          // only the trials: no consent, instructions or questionnaires
    std::string participant = {};  // code; empty: the next free one of `kind`
    plan::ParticipantKind kind = plan::ParticipantKind::Pilot;  // with the mouse, where there is no code
    std::string resume = {};                                    // id of the session that goes on; empty: a new one
    std::string language = "en";                                // of a new session; one of plan::languagesOf()
    std::string experimenter = {};
    store::Station station = {};
    bool waits = false;                 // begins with the command Start
    run::FrameClock* frames = nullptr;  // of the participant's window; null: nobody measures its pictures
    sound::SoundFeed* sound = nullptr;  // what is to be heard; null: nothing
};

/// A study that runs in a thread of its own, for windows: they bring commands and answers, take news and ticks, and
/// never wait for it. A person moves the device by mouse and keyboard, or a simulated one is watched, in real time.
class LiveSession final : private run::Performer {
public:
    LiveSession(plan::StudyPlan plan, LiveOptions options);
    ~LiveSession() override;  // as end()

    /// For between two of the session's steps, from any thread. Stop turns the motors off at once, whatever all other
    /// threads do; of several in a row the session learns of the first.
    void command(session::Command command);
    /// Ends the session as interrupted and waits for it. Once.
    void end();
    /// What has happened since the last call.
    std::vector<presenter::News> takeNews();
    /// The ticks since the last call, the oldest first, as many as fit; call until it returns 0.
    std::size_t takeTicks(std::span<loop::ScreenTick> into) { return screen_.take(into); }
    /// How the participant's window draws from now on; kept with the session as a note.
    void drawsWith(const presenter::QualityFound& found);
    /// Takes what the participant answers.
    Interview& interview() { return interview_; }
    /// Where the mouse wants the held part.
    mouse::Pointer& pointer() { return pointer_; }
    /// How far the pointer may be ahead of the part [m], [rad]: as of the running attempt's device.
    double reach() const { return reach_.load(); }
    double swing() const { return swing_.load(); }

private:
    plan::ParticipantKind kind() const override;
    std::unique_ptr<loop::HapticDevice> device(const simulated::DeviceParams& preset,
                                               const plan::Condition& condition) override;
    DeviceDescription describe(const simulated::DeviceParams& preset) const override;
    std::span<loop::ScreenRing* const> screens() override { return screens_; }
    void awaitPicture() override;
    std::optional<session::Presentation> presented(std::int64_t zero_ns, std::int64_t from_ns,
                                                   std::int64_t to_ns) override;
    session::QuestionnaireSource* answers() override { return &interview_; }
    session::InstructionReader* reader() override { return &interview_; }
    void begins(session::Apparatus& apparatus, const session::SessionSetup& setup) override;
    void prepares(const plan::Condition& condition, std::int64_t trial_index, std::uint64_t seed) override;
    bool builds(double share) override;
    void betweenSteps(session::Session& session) override;
    void over() override;

    void main();
    Result<run::RunEnd> perform(const session::SessionListener& listener);
    std::optional<bool> askConsent(const plan::ConsentClause& clause, const std::string& text);
    bool takesAbort();
    void show(session::SessionView view);
    void tell(presenter::News news);
    void takePictures();
    bool isWanted();

    plan::StudyPlan plan_;
    LiveOptions options_;
    std::unique_ptr<run::Builds> builds_ = run::openBuilds();
    presenter::SceneArtist artist_{builds_.get()};
    plan::View appearance_;  // of the plan that runs, which is the stored one where a session goes on
    std::optional<session::SessionView> told_;
    bool cancelled_ = false;  // a build
    mouse::Pointer pointer_;
    std::int64_t looked_ns_ = 0;
    Interview interview_{[this](presenter::News news) { tell(std::move(news)); }};
    bool aborted_ = false;  // before the session began
    std::atomic<double> reach_{0.0}, swing_{0.0};
    loop::ScreenRing screen_{4096};
    std::vector<loop::ScreenRing*> screens_{&screen_};
    session::Presentation shown_;         // of the running attempt: what its condition says
    std::int64_t attempt_ = 0;            // its number for the pictures
    std::vector<run::Picture> pictures_;  // of it
    std::atomic<bool> ends_{false};
    std::mutex mutex_;  // of what follows
    session::Apparatus* apparatus_ = nullptr;
    std::deque<session::Command> commands_;
    std::optional<presenter::QualityFound> found_;  // to be kept
    std::vector<presenter::News> news_;
    std::thread thread_;  // last: starts when everything else is there
};

}  // namespace passung::window
