#include "devices/unit/linked_unit.h"

#include <pthread.h>
#include <sched.h>
#include <time.h>

#include <algorithm>
#include <utility>

#include "devices/unit/wrench_gate.h"

namespace passung::unit {
namespace {

using loop::DeviceState;
using std::chrono::milliseconds;

constexpr int kPriority = 75;      // below the loop's
constexpr double kFarthest = 1e3;  // [m] from its base
constexpr auto kAlways = std::chrono::nanoseconds::max();

std::int64_t now() noexcept {
    timespec t{};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

constexpr std::int64_t in(milliseconds time) noexcept { return std::chrono::nanoseconds(time).count(); }

bool same(const Said& a, const Said& b) {
    return a.X_BD.p == b.X_BD.p && a.X_BD.q.coeffs() == b.X_BD.q.coeffs() && a.V_D_B.v == b.V_D_B.v &&
           a.V_D_B.w == b.V_D_B.w;
}

bool isZero(const Wrench& F) { return F.force.isZero(0.0) && F.torque.isZero(0.0); }

}  // namespace

LinkedUnit::LinkedUnit(std::unique_ptr<Link> link, LinkedParams params)
    : params_(std::move(params)), link_(std::move(link)), beats_(params_.heartbeat, kAlways) {
    status_.state = DeviceState::Absent;
    thread_ = std::thread([this] { main(); });
}

LinkedUnit::~LinkedUnit() {
    {
        const std::lock_guard lock(mutex_);
        stop_.store(true);
    }
    woken_.notify_all();
    command_came_.release();
    thread_.join();
}

DeviceReading LinkedUnit::read() noexcept {
    const Stamped& newest = said_.latest();
    const DeviceState state = this->state();
    status_.state = state;
    status_.age_s = newest.number == 0 ? 0.0 : 1e-9 * static_cast<double>(now() - newest.at);
    status_.grip_rad = newest.said.grip_rad;
    DeviceReading reading;
    reading.buttons = newest.said.buttons;
    if (params_.gives_speeds) {
        reading.fresh = state == DeviceState::Ready;
        const bool clutched = params_.clutch > 0 && (reading.buttons >> (params_.clutch - 1) & 1u) != 0;
        if (reading.fresh && !clutched)
            handle_.advance(newest.said.V_D_B, last_commanded_, params_.description.workspace_radius_m);
        reading.X_BD = handle_.X_BD;
    } else {
        const bool is_new = newest.number != std::exchange(number_read_, newest.number);
        const bool stands = !was_fresh_ && newest.number > 0 && now() - newest.at <= in(params_.reading_stands);
        reading.fresh = was_fresh_ = state == DeviceState::Ready && (is_new || stands);
        reading.X_BD = newest.said.X_BD;
    }
    return reading;
}

void LinkedUnit::command(const Wrench& F_D_B) noexcept {
    last_commanded_ = passed(F_D_B, params_.description, isReady());
    status_.commanded = last_commanded_.force == F_D_B.force && last_commanded_.torque == F_D_B.torque;
    commanded_.put({last_commanded_, now(), ++number_commanded_});
    command_came_.release();
}

std::optional<DeviceUnit> LinkedUnit::identity() const {
    const std::lock_guard lock(mutex_);
    return identity_;
}

std::string LinkedUnit::trouble() const {
    const std::lock_guard lock(mutex_);
    return trouble_;
}

std::vector<UnitNews> LinkedUnit::takeNews() {
    const std::lock_guard lock(mutex_);
    return std::exchange(news_, {});
}

void LinkedUnit::arm() { armed_.store(true); }

void LinkedUnit::lend(const Pose& X_BD_start) {
    handle_.X_BD = X_BD_start;
    last_commanded_ = {};
    loans_.fetch_add(1);
}

void LinkedUnit::giveBack() {
    if (loans_.fetch_sub(1) == 1) command({});
}

void LinkedUnit::main() {
    sched_param priority{};
    priority.sched_priority = kPriority;
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);  // goes on without it, like the loop
    milliseconds retry = params_.first_retry;
    while (!stop_.load()) {
        Result<DeviceUnit> opened = link_->open();
        if (opened) {
            retry = params_.first_retry;
            {
                const std::lock_guard lock(mutex_);
                identity_ = *std::move(opened);
            }
            judged_ = {};
            serve();
        } else {
            const std::lock_guard lock(mutex_);
            trouble_ = opened.errors().front().message;
        }
        link_->close();
        std::unique_lock lock(mutex_);
        woken_.wait_for(lock, retry, [this] { return stop_.load(); });
        retry = std::min(2 * retry, kLastRetry);
    }
}

/// Until the unit is gone.
void LinkedUnit::serve() {
    std::int64_t heard_at = now();
    while (!stop_.load()) {
        const bool looped = awaitCommand();
        if (stop_.load()) return;
        const Wrench given = wrenchNow();
        const Exchange exchange = link_->exchange(given, looped ? params_.heartbeat : kKeepAlive);
        switch (exchange.kind) {
            case Exchange::Kind::Gone:
                return lose(DeviceState::Lost, exchange.why);
            case Exchange::Kind::Stale:
                lose(DeviceState::Stale, exchange.why);
                break;
            case Exchange::Kind::Wrong:
                lose(DeviceState::Fault, exchange.why);
                break;
            case Exchange::Kind::News:
                heard_at = now();
                if (judge(exchange.said, given)) isSound();
                if (!exchange.why.empty()) remark(exchange.why);
                break;
            case Exchange::Kind::Silence:
                if (params_.gives_speeds) {
                    if (judged_.count > 0) isSound();  // at rest it has nothing to say
                } else if (isReady() && now() - heard_at > in(params_.stale_after))
                    lose(DeviceState::Stale,
                         "nothing has come from the device for " + std::to_string(params_.stale_after.count()) + " ms");
                break;
        }
    }
    // The last that it gets.
    link_->exchange({}, kKeepAlive);
}

/// What it said last can be.
void LinkedUnit::isSound() {
    if (isReady()) return;
    if (armed_.load())
        become(DeviceState::Ready, {});
    else if (state() == DeviceState::Absent || state() == DeviceState::Lost)
        become(DeviceState::Present, {});
}

/// Waits for the loop's next command, for a while; true if one came.
bool LinkedUnit::awaitCommand() {
    if (!command_came_.try_acquire_for(isLent() ? params_.heartbeat : kKeepAlive)) return false;
    while (command_came_.try_acquire()) {  // of several the newest is in the mailbox
    }
    return true;
}

/// What may reach the unit now.
Wrench LinkedUnit::wrenchNow() noexcept {
    const Commanded& newest = commanded_.latest();
    link_->stamp(newest.at);
    const double share = beats_.share({newest.number, newest.at, !isZero(newest.F_D_B), 0}, now());
    if (!isLent()) return {};
    const Wrench F = {share * newest.F_D_B.force, share * newest.F_D_B.torque};
    return passed(F, params_.description, isReady());
}

/// Its values may be the same to the last bit: nothing pushes it, nor, where nothing ever does, does anybody use it.
bool LinkedUnit::mayStandStill(const Wrench& given) const noexcept {
    if (params_.gives_speeds) return true;
    return params_.pushes ? isZero(given) : !isLent();
}

/// Takes what was said, or tells what is wrong with it.
bool LinkedUnit::judge(const Said& said, const Wrench& given) {
    const std::int64_t time = now();
    if (const std::string wrong = flaw(said, time); !wrong.empty()) {
        judged_ = {};  // what comes next is judged by itself
        lose(DeviceState::Fault, wrong);
        return false;
    }
    if (judged_.count == 0 || mayStandStill(given) || !same(said, judged_.last)) judged_.differed_at = time;
    judged_.last = said;
    judged_.at = time;
    ++judged_.count;
    if (isReady() && time - judged_.differed_at > in(params_.frozen_after)) {
        lose(DeviceState::Fault, "its values have not changed by a bit for " +
                                     std::to_string(params_.frozen_after.count()) + " ms, although it " +
                                     (params_.pushes ? "pushes" : "is in use") + ": they stand still");
        return false;
    }
    said_.put({said, time, judged_.count});
    return true;
}

/// Why this cannot be; empty: it can.
std::string LinkedUnit::flaw(const Said& said, std::int64_t time) const {
    const bool finite = isFinite(said.X_BD) && said.V_D_B.v.allFinite() && said.V_D_B.w.allFinite();
    if (!finite) return "a value is no finite number";
    if (params_.gives_speeds) return {};
    if (!isRigid(said.X_BD)) return "its orientation is no rotation";
    if (said.X_BD.p.cwiseAbs().maxCoeff() > kFarthest) return "its position is beyond any device's reach";
    if (judged_.count == 0) return {};
    const double seconds = std::max(kTickSeconds, 1e-9 * static_cast<double>(time - judged_.at));
    const DeviceDescription& limits = params_.description;
    if ((said.X_BD.p - judged_.last.X_BD.p).norm() > limits.max_speed_m_per_s * seconds)
        return "its position has jumped farther than it can move";
    if (rotationVector(said.X_BD.q * judged_.last.X_BD.q.conjugate()).norm() > limits.max_spin_rad_per_s * seconds)
        return "its orientation has jumped farther than it can turn";
    return {};
}

void LinkedUnit::become(DeviceState state, const std::string& why) {
    const std::lock_guard lock(mutex_);
    state_.store(state, std::memory_order_release);
    trouble_ = why;
    news_.push_back({state, why});
}

/// It cannot be used any more. Told once: what follows from it until it is armed again is no news.
void LinkedUnit::lose(DeviceState state, const std::string& why) {
    const bool was_armed = armed_.exchange(false);
    if (was_armed) return become(state, why);
    const std::lock_guard lock(mutex_);
    if (state == DeviceState::Lost && this->state() != DeviceState::Absent) state_.store(DeviceState::Lost);
    trouble_ = why;
}

/// Something to be told that changes no state. Of a unit that cannot be used the loss alone is news.
void LinkedUnit::remark(const std::string& what) {
    const std::lock_guard lock(mutex_);
    if (const UnitNews news{state(), what}; !news.isLoss()) news_.push_back(news);
}

}  // namespace passung::unit
