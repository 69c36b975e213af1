#pragma once

#include <atomic>
#include <deque>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "devices/mouse/pointer.h"
#include "ui/app/frame_clock.h"
#include "ui/app/performer.h"
#include "ui/app/run_study.h"
#include "ui/presenter/session_news.h"
#include "ui/sound/sound_feed.h"

namespace passung::app {

/// Who takes part in a live session.
enum class LiveHand { Mouse, Simulated };

struct LiveOptions {
    std::string database;
    LiveHand hand = LiveHand::Mouse;
    bool waits = false;                 // begins with the command Start
    FrameClock* frames = nullptr;       // of the participant's window; null: nobody measures its pictures
    sound::SoundFeed* sound = nullptr;  // what is to be heard; null: nothing
};

/// A study that runs in a thread of its own, for windows: they bring commands and take news and ticks, and never wait
/// for it. A pilot participant moves the device by mouse and keyboard, or a simulated one is watched, in real time.
/// A try-out: no questionnaires are asked.
class LiveSession final : private Performer {
public:
    LiveSession(protocol::StudyPlan plan, LiveOptions options);
    ~LiveSession() override;  // ends the session as interrupted

    /// For between two of the session's steps; Stop turns the motors off at once.
    void command(session::Command command);
    /// What has happened since the last call.
    std::vector<presenter::News> takeNews();
    /// The ticks since the last call, the oldest first, as many as fit; call until it returns 0.
    std::size_t takeTicks(std::span<loop::ScreenTick> into) { return screen_.take(into); }
    /// Where the mouse wants the held part.
    mouse::Pointer& pointer() { return pointer_; }
    /// How far the pointer may be ahead of the part [m], [rad]: as of the running attempt's device.
    double reach() const { return reach_.load(); }
    double swing() const { return swing_.load(); }

private:
    protocol::ParticipantKind kind() const override;
    std::unique_ptr<loop::HapticDevice> device(const simulated::DeviceParams& preset,
                                               const protocol::Condition& condition) override;
    DeviceDescription describe(const simulated::DeviceParams& preset) const override;
    std::span<loop::ScreenRing* const> screens() override { return screens_; }
    session::Presentation presented(std::int64_t since_ns) override;
    session::QuestionnaireSource* answers() override { return nullptr; }
    void begins(session::Apparatus& apparatus, const std::string& participant,
                std::span<const design::PlannedTrial> trials) override;
    void prepares(const protocol::Condition& condition, std::int64_t trial_index, std::uint64_t seed) override;
    bool builds(double share) override;
    void look(session::Session& session) override;
    void over() override;

    void main();
    void tell(presenter::News news);

    protocol::StudyPlan plan_;
    LiveOptions options_;
    presenter::SceneArtist artist_;
    presenter::SessionGlance told_;
    bool told_anything_ = false;
    bool cancelled_ = false;  // a build
    mouse::Pointer pointer_;
    std::atomic<double> reach_{0.0}, swing_{0.0};
    loop::ScreenRing screen_{4096};
    std::vector<loop::ScreenRing*> screens_{&screen_};
    session::Presentation shown_;  // of the running attempt: what its condition says
    std::atomic<bool> ends_{false};
    std::mutex mutex_;  // of what follows
    session::Apparatus* apparatus_ = nullptr;
    std::deque<session::Command> commands_;
    std::vector<presenter::News> news_;
    std::thread thread_;  // last: starts when everything else is there
};

}  // namespace passung::app
