#include "ui/window/live_session.h"

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <thread>

#include "study/protocol/protocol_reader.h"
#include "study/run/files/known_names.h"
#include "study/store/schema/sqlite.h"
#include "tests/support/temp_folder.h"
#include "tests/ui/window/asking_study.h"
#include "tests/ui/window/four_trials.h"

// The threads of a live session without windows and without Qt, so that ThreadSanitizer sees all of them: the session's
// with its loop and its writer, and those that windows bring: items, drawing, sound, and a listener that stops.

namespace passung::window {
namespace {

using session::CommandKind;

/// Draws what the items stand for while their thread waits, as a scene graph with a thread of its own does.
class Drawing {
public:
    explicit Drawing(run::FrameClock& clock) : clock_(clock) {}
    ~Drawing() { ends_.store(true); }

    /// The items' thread: moves them.
    void items(const std::function<void(run::FrameClock&)>& move) {
        const std::lock_guard lock(items_);
        move(clock_);
    }

private:
    void draw() {
        while (!ends_.load()) {
            {
                const std::lock_guard lock(items_);
                clock_.take();
            }
            clock_.present(run::steadyNanoseconds());
            std::this_thread::yield();
        }
    }

    run::FrameClock& clock_;
    std::mutex items_;
    std::atomic<bool> ends_{false};
    std::jthread thread_{[this] { draw(); }};  // last: starts when everything else is there
};

/// Plays as an output does, which calls from a thread of its own.
class Playing {
public:
    explicit Playing(sound::SoundFeed& feed) : feed_(feed) { feed.setOutput(sound::SoundOutput{"a test", 1.0}); }
    ~Playing() { ends_.store(true); }

private:
    void play() {
        std::vector<float> samples(480);
        while (!ends_.load()) {
            feed_.fill(samples);
            std::this_thread::yield();
        }
    }

    sound::SoundFeed& feed_;
    std::atomic<bool> ends_{false};
    std::jthread thread_{[this] { play(); }};  // last: starts when everything else is there
};

/// What the windows do, in the test's thread.
class Desk {
public:
    Desk(LiveSession& live, Drawing& drawing) : live_(live), drawing_(drawing) {}

    /// Until it is so, or the run is over; the test's limit of time finds what hangs.
    void waitFor(const std::function<bool()>& so) {
        while (!so() && !over) {
            while (const std::size_t count = live_.takeTicks(ticks_)) show(std::span(ticks_).first(count));
            for (const presenter::News& news : live_.takeNews())
                std::visit([this](const auto& told) { take(told); }, news);
            std::this_thread::yield();
        }
    }
    void command(CommandKind kind, std::string text = {}) {
        live_.command({.kind = kind, .text = std::move(text), .source = "window", .now = true});
    }

    session::SessionView view;
    std::int64_t decided = 0, read = 0, answered = 0;  // clauses, pages, items
    std::int64_t shown = 0;                            // ticks of the running attempt
    int attempts = 0;
    bool in_order = true;  // ticks of an attempt
    std::optional<presenter::RunOver> over;

private:
    void take(const presenter::FormDue& due) {
        const presenter::FormRequest& form = *due.form;
        session::FilledForm filled;
        filled.answered_by = "participant";
        if (form.consent)
            filled.answers = {{.answer = {.number = 1.0, .text = {}}, .response_ms = {}}};
        else
            for (const questionnaire::Answer& answer : form.definition.golden.front().answers)
                filled.answers.push_back({.answer = answer, .response_ms = {}});
        (form.consent ? decided : answered) += static_cast<std::int64_t>(filled.answers.size());
        live_.interview().handIn(form.id, std::move(filled));
    }
    void take(const presenter::PageDue& due) {
        ++read;
        live_.interview().pageRead(due.number, 10);
        live_.interview().goOn();
    }
    void take(const presenter::AttemptPrepared& prepared) {
        ++attempts;
        shown = 0;
        last_ = -1;
        drawing_.items([&](run::FrameClock& clock) { clock.prepared(prepared.shown_as); });
    }
    void take(const session::SessionEvent& event) {
        if (const auto* now = std::get_if<session::SessionView>(&event)) view = *now;
    }
    void take(const presenter::RunOver& told) { over = told; }
    void take(const auto&) {}

    void show(std::span<const loop::ScreenTick> ticks) {
        for (const loop::ScreenTick& tick : ticks) {
            in_order = in_order && tick.record.tick > last_;
            last_ = tick.record.tick;
            ++shown;
        }
        drawing_.items([&](run::FrameClock& clock) { clock.show(ticks.back()); });
        live_.pointer().move(Vec3(0.0, 0.0, 1e-5), Vec3::Zero());
        live_.pointer().drive(Vec3(1e-3, 0.0, 0.0), Vec3::Zero());
        live_.pointer().keepNear({}, 2.0 * live_.reach(), 2.0 * live_.swing());
        live_.drawsWith({});
    }

    LiveSession& live_;
    Drawing& drawing_;
    std::vector<loop::ScreenTick> ticks_{256};
    std::int64_t last_ = -1;
};

/// Every trial is heard, and a machine that misses cycles and pictures invalidates nothing.
const std::string kMore = std::string("\n[feedback]\ncues = [\"audio\"]\nmasking_noise = true\n") + test::kOnAnyMachine;

std::int64_t countIn(const std::string& file, const std::string& from) {
    return store::Database(file, store::OpenMode::ReadOnly).integer("SELECT count(*) FROM " + from);
}

TEST(LiveSession, ItsThreadsMeetWithoutARaceAndNothingIsLost) {
    // Truth: invariant: whatever was handed in or commanded before the end is in the data, ticks are shown in order,
    // and ThreadSanitizer, in its build, sees no access that another thread's may meet.
    const test::TempFolder folder;
    const std::string file = test::writeAskingStudy(folder / "asking", kMore);
    const auto plan = protocol::readProtocol(file, run::knownDevices(), run::knownMeasures());
    ASSERT_TRUE(plan) << plan.errors().front().message;
    run::FrameClock clock;
    sound::SoundFeed feed;
    Drawing drawing(clock);
    const Playing playing(feed);
    const LiveOptions options{.database = folder / "study.db", .waits = true, .frames = &clock, .sound = &feed};
    constexpr int kNotes = 40;
    {
        LiveSession live(*plan, options);
        Desk desk(live, drawing);
        desk.waitFor([&] { return desk.view.state == session::SessionState::Ready; });
        ASSERT_FALSE(desk.over.has_value()) << desk.over->errors.front().message;
        desk.command(CommandKind::Start);
        desk.waitFor([&] { return desk.attempts == 1 && desk.shown > 200; });
        const std::jthread listener([&live] {
            for (int i = 0; i < kNotes; ++i)
                live.command({.kind = CommandKind::Note, .text = std::to_string(i), .source = "listener"});
            live.command({.kind = CommandKind::Stop, .text = "smoke", .source = "listener"});
        });
        desk.waitFor([&] { return desk.view.stopped; });
        desk.command(CommandKind::Continue);
        desk.waitFor([&] { return desk.attempts == 2 && desk.shown > 200; });
        desk.command(CommandKind::Abort, "enough");
        desk.waitFor([] { return false; });
        live.end();
        ASSERT_TRUE(desk.over.has_value());
        EXPECT_TRUE(desk.over->errors.empty()) << desk.over->errors.front().message;
        EXPECT_FALSE(desk.over->complete);
        EXPECT_TRUE(desk.in_order);
        EXPECT_EQ(desk.decided, static_cast<std::int64_t>(plan->consent.size()));
        EXPECT_EQ(desk.read, 1) << "the page at the end is of a session that ends by itself";
        EXPECT_EQ(countIn(options.database, "consent WHERE decision = 'yes'"), desk.decided);
        EXPECT_EQ(countIn(options.database, "item_response"), desk.answered);
    }
    EXPECT_EQ(countIn(options.database, "note WHERE author = 'listener'"), kNotes);
    EXPECT_EQ(countIn(options.database, "attempt"), 2);
    EXPECT_EQ(countIn(options.database, "attempt WHERE outcome = 'aborted'"), 2);
    EXPECT_EQ(countIn(options.database, "presentation WHERE frames > 0 AND sound = 'played'"), 2);
}

}  // namespace
}  // namespace passung::window
