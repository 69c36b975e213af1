#include "study/run/units/unit_rack.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "core/base/json.h"
#include "devices/backends/backends.h"
#include "study/run/files/known_names.h"
#include "study/run/machine/stability_report.h"

namespace passung::run {
namespace {

using loop::DeviceState;

constexpr std::chrono::milliseconds kLook{5};

std::string nameOfHand(const plan::Condition& condition, std::size_t hand) {
    return hand == 0 ? kFirstHand : condition.scene.hand(hand).name;
}

const std::string& kindOfHand(const plan::Condition& condition, std::size_t hand) {
    return hand == 0 ? condition.device : condition.other_devices.at(hand - 1);
}

/// What the condition asks of the device in that hand.
DeviceDescription neededKind(const plan::Condition& condition, std::size_t hand) {
    const std::string& kind = kindOfHand(condition, hand);
    const DeviceDescription* known = deviceNamed(kind, knownDevices());
    DeviceDescription needed = known != nullptr ? *known : DeviceDescription{};
    if (kind != kAnyKind || !condition.needs) return needed;
    needed.sensed_degrees = condition.needs->degrees;
    needed.actuated_degrees = condition.needs->torque > 0.0 ? 6 : condition.needs->force > 0.0 ? 3 : 0;
    needed.max_force_N = condition.needs->force;
    needed.max_torque_Nm = condition.needs->torque;
    return needed;
}

bool isThere(DeviceState state) { return state != DeviceState::Absent && state != DeviceState::Lost; }

/// Calls `done` until it is true or the time is over.
template <class Done>
void waitUntil(int milliseconds, Done done) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(milliseconds);
    while (!done() && std::chrono::steady_clock::now() < until) std::this_thread::sleep_for(kLook);
}

std::string nameOf(const DeviceChoice& choice) {
    return fmt::format("{} ({}{}{})", choice.hand, choice.backend, choice.serial.empty() ? "" : " ", choice.serial);
}

}  // namespace

UnitRack::~UnitRack() = default;
UnitRack::UnitRack(UnitRack&&) noexcept = default;
UnitRack& UnitRack::operator=(UnitRack&&) noexcept = default;

Result<UnitRack> UnitRack::open(const std::vector<DeviceChoice>& choices, const std::string& file) {
    UnitRack rack;
    rack.file_ = file;
    Errors errors;
    for (const DeviceChoice& choice : choices) {
        if (choice.backend == kSimulatedBackend) continue;
        auto unit = backends::open(choice);
        if (unit) {
            rack.racked_.push_back({choice, *std::move(unit)});
            continue;
        }
        for (Error error : unit.errors()) {
            error.file = file;
            error.key = "station.device." + choice.hand + "." + error.key;
            errors.push_back(std::move(error));
        }
    }
    if (!errors.empty()) return errors;
    waitUntil(kOpening, [&rack] { return rack.notReady(true).empty(); });
    for (const Racked& racked : rack.racked_)
        if (!isThere(racked.unit->state()))
            errors.push_back({.message = racked.unit->trouble(),
                              .file = file,
                              .key = "station.device." + racked.choice.hand,
                              .value = racked.choice.backend});
    if (!errors.empty()) return errors;
    return rack;
}

const UnitRack::Racked* UnitRack::serving(const plan::Condition& condition, std::size_t hand) const {
    const auto found = std::find_if(racked_.begin(), racked_.end(), [&](const Racked& racked) {
        return racked.choice.hand == nameOfHand(condition, hand);
    });
    return found == racked_.end() ? nullptr : &*found;
}

Errors UnitRack::whyNot(const plan::StudyPlan& plan) const {
    Errors why;
    const auto refuse = [&](const plan::Condition& condition, std::size_t hand, std::string message) {
        Error error{.message = std::move(message),
                    .file = file_,
                    .key = "station.device." + nameOfHand(condition, hand),
                    .value = kindOfHand(condition, hand)};
        if (std::none_of(why.begin(), why.end(),
                         [&](const Error& told) { return told.message == error.message && told.key == error.key; }))
            why.push_back(std::move(error));
    };
    for (const plan::Condition& condition : plan.conditions) {
        for (std::size_t hand = 0; hand < condition.scene.handCount(); ++hand) {
            const Racked* racked = serving(condition, hand);
            const std::string& kind = kindOfHand(condition, hand);
            if (racked == nullptr) {
                refuse(condition, hand, "no unit of the station serves this hand");
                continue;
            }
            if (kind != kAnyKind && kind != racked->choice.kind) {
                refuse(condition, hand, "the station's unit serves " + racked->choice.kind);
                continue;
            }
            for (const std::string& weakness :
                 backends::whyWeaker(racked->unit->description(), neededKind(condition, hand)))
                refuse(condition, hand, "the unit is weaker than that: it " + weakness);
            const bool pushes = kind == kAnyKind && condition.needs && condition.needs->force > 0.0;
            if (pushes && !racked->unit->pushesHand())
                refuse(condition, hand, "the unit has no motors: it shows a force as an arrow, at most");
        }
    }
    return why;
}

std::vector<DeviceUnit> UnitRack::units() const {
    std::vector<DeviceUnit> units;
    for (const Racked& racked : racked_)
        if (const auto unit = racked.unit->identity()) units.push_back(*unit);
    return units;
}

std::unique_ptr<loop::HapticDevice> UnitRack::lend(const plan::Condition& condition, std::size_t hand,
                                                   const Pose& X_BD_start) {
    const Racked* racked = serving(condition, hand);
    if (racked == nullptr) return nullptr;
    return std::make_unique<unit::LentUnit>(*racked->unit, X_BD_start);
}

std::vector<session::DeviceNews> UnitRack::takeNews() {
    std::vector<session::DeviceNews> all;
    for (const Racked& racked : racked_) {
        for (const unit::UnitNews& news : racked.unit->takeNews()) {
            JsonObject payload;
            payload.text("hand", racked.choice.hand).text("backend", racked.choice.backend);
            if (const auto unit = racked.unit->identity()) payload.text("serial", unit->serial);
            if (!news.why.empty()) payload.text("reason", news.why);
            all.push_back({fmt::format("device_{}", loop::stateName(news.state)), payload.str(),
                           news.isLoss() ? fmt::format("{}: {}", nameOf(racked.choice), news.why) : std::string()});
        }
    }
    return all;
}

void UnitRack::arm() {
    for (const Racked& racked : racked_) racked.unit->arm();
    waitUntil(kArming, [this] { return notReady(false).empty(); });
}

std::string UnitRack::notReady(bool or_there) const {
    for (const Racked& racked : racked_) {
        const DeviceState state = racked.unit->state();
        if (state == DeviceState::Ready || (or_there && isThere(state))) continue;
        const std::string why = racked.unit->trouble();
        return fmt::format("{} is {}{}{}", nameOf(racked.choice), loop::stateName(state), why.empty() ? "" : ": ", why);
    }
    return {};
}

}  // namespace passung::run
