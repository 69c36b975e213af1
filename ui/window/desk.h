#pragma once

#include <QtCore/QObject>
#include <QtCore/QTimer>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "ui/presenter/run.h"
#include "ui/window/live_session.h"
#include "ui/window/speaker.h"

namespace passung::window {

/// Between the running session and the windows: brings news and ticks to the presenter at the display's rate and tells
/// the windows to refresh. The session never waits for it.
class Desk : public QObject {
    Q_OBJECT

public:
    /// `data`: folder for the databases of try-outs.
    explicit Desk(std::string data);
    ~Desk() override;

    /// A session of the study: a new one, or one that goes on.
    void start(const plan::StudyPlan& plan, window::LiveOptions options);
    /// A run whose news and ticks the caller brings: for whoever shows one that goes on elsewhere.
    void open(const plan::StudyPlan& plan, const std::string& language);
    /// What has happened in the run since the last call, and its ticks of that time.
    void bring(const std::vector<presenter::News>& news, std::span<const loop::ScreenTick> ticks);
    /// Only the trials, into a database of its own.
    void tryOut(const plan::StudyPlan& plan, window::LiveHand hand, const std::string& language);
    void command(session::Command command);
    /// Emergency stop, from any thread, whatever the windows do meanwhile; nothing if no session runs.
    void stopNow();
    /// The participant's window shows this from now on; a running trial that nobody sees is paused.
    void setDisplay(presenter::Display display);
    /// Shows the participant's window again, whatever became of it.
    void openDisplay();
    /// Ends what runs; waits for the running step only.
    void close();

    const presenter::Run& run() const { return run_; }
    /// Where the mouse wants the held part; null: nobody moves it by mouse.
    mouse::Pointer* pointer();
    bool byMouse() const { return live_ && hand_ == window::LiveHand::Mouse; }
    /// Language that the participant is spoken to in.
    const std::string& language() const { return language_; }

    // What the participant answers, read and wants.
    void handIn(const std::string& form, session::FilledForm filled);
    void pageRead(std::int64_t page, std::int64_t read_ms);
    void goOn();

    /// How the participant's window draws from now on, for the experimenter and the data.
    void drawsWith(const presenter::QualityFound& found);
    /// The pictures of the participant's window.
    run::FrameClock& frames() { return frames_; }
    /// Where sound comes from; none: nowhere.
    std::optional<sound::SoundOutput> soundOutput() const { return sound_.output(); }

signals:
    void opened();         // another run
    void displayWanted();  // the participant's window is about to be shown again
    void happened();       // news
    void frame();          // time for a new picture
    void sceneChanged();
    void prepared(qint64 attempt);  // the windows show its scene; it begins with its first picture

private:
    void refresh();
    void take(std::span<const loop::ScreenTick> ticks);
    void show(const std::vector<presenter::News>& news, const std::optional<loop::ScreenTick>& newest);
    void end();
    void checkPictures();

    std::string data_;
    run::FrameClock frames_;
    sound::SoundFeed sound_;
    std::unique_ptr<Speaker> speaker_;  // once something is to be heard
    std::unique_ptr<window::LiveSession> live_;
    std::mutex stop_mutex_;
    window::LiveSession* stoppable_ = nullptr;  // what stopNow() stops
    window::LiveHand hand_ = window::LiveHand::Mouse;
    std::string language_ = "en";
    presenter::Run run_;
    const void* drawn_ = nullptr;  // scene that the windows know
    std::int64_t awaited_ = 0;     // the newest attempt, as the pictures count them
    QTimer timer_;
};

}  // namespace passung::window
