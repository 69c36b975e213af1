#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <semaphore>
#include <thread>

#include "core/loop/mailbox.h"
#include "devices/unit/heartbeat_watch.h"
#include "devices/unit/link.h"
#include "devices/unit/rate_handle.h"
#include "devices/unit/unit.h"

namespace passung::unit {

/// How a backend's units are to be treated.
struct LinkedParams {
    DeviceDescription description;  // limits of the unit: nothing above them leaves
    bool gives_speeds = false;      // velocity control: the handle is ours (RateHandle)
    bool pushes = true;
    int clutch = 0;                               // button, from 1, that lets go of a RateHandle; 0: none
    std::chrono::milliseconds heartbeat{5};       // that a wrench holds without the next
    std::chrono::milliseconds reading_stands{5};  // without the next
    std::chrono::milliseconds stale_after{50};    // without a word, while it is lent
    std::chrono::milliseconds frozen_after{200};  // the same values to the last bit, while it pushes, or else is lent
    std::chrono::milliseconds first_retry{100};   // of looking for it; doubled up to kLastRetry
};

/// A unit behind a link, which has a thread of its own; the loop reads from a mailbox and commands into another, so
/// that neither read() nor command() ever waits, whatever the link does. A wrench holds for a heartbeat and then counts
/// as zero: a loop that hangs pushes nobody, and one that goes on gets its force back by a ramp.
/// The loop and the unit have clocks of their own, so that now and then no reading comes between two ticks, or more of
/// them: the newest is held for a tick, as the input guard does, and then taken again as long as it is young. An older
/// one is not fresh, and the guard lets go within two ticks.
class LinkedUnit final : public Unit {
public:
    static constexpr std::chrono::milliseconds kLastRetry{2000};
    static constexpr std::chrono::milliseconds kKeepAlive{10};  // between two exchanges while no loop runs

    LinkedUnit(std::unique_ptr<Link> link, LinkedParams params);
    ~LinkedUnit() override;

    const DeviceDescription& description() const override { return params_.description; }
    DeviceReading read() noexcept override;
    void command(const Wrench& F_D_B) noexcept override;
    loop::DeviceStatus status() const noexcept override { return status_; }
    bool pushesHand() const override { return params_.pushes; }

    loop::DeviceState state() const noexcept override { return state_.load(std::memory_order_acquire); }
    std::optional<DeviceUnit> identity() const override;
    std::string trouble() const override;
    std::vector<UnitNews> takeNews() override;
    void arm() override;
    void lend(const Pose& X_BD_start) override;
    void giveBack() override;

private:
    using Nanoseconds = std::int64_t;  // on the steady clock

    struct Stamped {  // from the thread to the loop
        Said said;
        Nanoseconds at = 0;
        std::int64_t number = 0;
    };
    struct Commanded {  // from the loop to the thread
        Wrench F_D_B;
        Nanoseconds at = 0;
        std::uint64_t number = 0;
    };
    /// What the thread remembers of what was said, to judge what comes.
    struct Judged {
        std::int64_t count = 0;
        Said last;
        Nanoseconds at = 0;           // of the last
        Nanoseconds differed_at = 0;  // when it was another than the one before, or need not have been
    };

    void main();
    void serve();
    void isSound();
    bool awaitCommand();
    Wrench wrenchNow() noexcept;
    bool mayStandStill(const Wrench& given) const noexcept;
    bool judge(const Said& said, const Wrench& given);
    std::string flaw(const Said& said, Nanoseconds now) const;
    void become(loop::DeviceState state, const std::string& why);
    void lose(loop::DeviceState state, const std::string& why);
    void remark(const std::string& what);
    bool isLent() const noexcept { return loans_.load() > 0; }
    bool isReady() const noexcept { return state() == loop::DeviceState::Ready; }

    const LinkedParams params_;
    std::unique_ptr<Link> link_;

    // Shared by all.
    std::atomic<loop::DeviceState> state_{loop::DeviceState::Absent};
    std::atomic<bool> stop_{false}, armed_{false};
    std::atomic<int> loans_{0};  // two for the moment in which an attempt follows another
    loop::Mailbox<Stamped> said_{Stamped{}};
    loop::Mailbox<Commanded> commanded_{Commanded{}};
    std::counting_semaphore<> command_came_{0};

    // The loop's.
    loop::DeviceStatus status_;
    std::int64_t number_read_ = 0;
    bool was_fresh_ = false;
    std::uint64_t number_commanded_ = 0;
    RateHandle handle_;
    Wrench last_commanded_;

    // The thread's.
    Judged judged_;
    HeartbeatWatch beats_;

    // Of the thread and of whoever looks after the unit.
    mutable std::mutex mutex_;
    std::condition_variable woken_;
    std::optional<DeviceUnit> identity_;
    std::string trouble_;
    std::vector<UnitNews> news_;

    std::thread thread_;  // last: begins when all else is there
};

}  // namespace passung::unit
