#include "devices/host/hosted_unit.h"

#include <utility>

#include "devices/host/host_process.h"
#include "devices/unit/axes.h"
#include "devices/unit/linked_unit.h"

namespace passung::host {
namespace {

using std::chrono::milliseconds;
using unit::Exchange;

constexpr milliseconds kOpening{4000};  // of a vendor's library and its device

DeviceUnit unitOf(const UnitTexts& texts, const DeviceChoice& choice) {
    return {.hand = choice.hand,
            .kind = choice.kind,
            .backend = choice.backend,
            .serial = std::string(texts.serial.view()),
            .model = std::string(texts.model.view()),
            .versions = std::string(texts.versions.view()),
            .calibration = std::string(texts.calibration.view())};
}

HostTask taskFor(const DeviceChoice& choice, const DeviceDescription& limits) {
    HostTask task;
    task.heartbeat_ms = static_cast<std::uint32_t>(choice.heartbeat_ms);
    task.actuated_degrees = static_cast<std::uint32_t>(limits.actuated_degrees);
    task.max_force_N = limits.max_force_N;
    task.max_torque_Nm = limits.max_torque_Nm;
    task.serial.put(choice.serial);
    task.axes.put(choice.axes);
    task.library.put(choice.address);
    return task;
}

Exchange exchangeOf(const HostReport& report) {
    constexpr auto kLast = static_cast<std::uint64_t>(Exchange::Kind::Gone);
    if (report.kind > kLast) return {Exchange::Kind::Wrong, {}, "what the device host says makes no sense"};
    Exchange exchange{static_cast<Exchange::Kind>(report.kind), {}, std::string(report.why.view())};
    for (int i = 0; i < 3; ++i) exchange.said.X_BD.p[i] = report.position[i];
    for (int i = 0; i < 4; ++i) exchange.said.X_BD.q.coeffs()[i] = report.quaternion[i];
    exchange.said.grip_rad = report.grip_rad;
    exchange.said.buttons = static_cast<std::uint32_t>(report.buttons);
    return exchange;
}

std::int64_t stampOfNow() {
    return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

HostedLink::HostedLink(DeviceChoice choice, DeviceDescription limits)
    : choice_(std::move(choice)), limits_(std::move(limits)) {}
HostedLink::~HostedLink() = default;

void HostedLink::close() noexcept { process_.reset(); }

Result<DeviceUnit> HostedLink::open() {
    auto started = HostProcess::start(choice_.backend, taskFor(choice_, limits_));
    if (!started) return started.errors();
    process_ = *std::move(started);
    if (const auto running = process_->awaitRunning(kOpening); !running) return running.errors();
    commands_ = reports_ = withheld_ = gaps_ = 0;
    heard_at_ = std::chrono::steady_clock::now();
    DeviceUnit unit = unitOf(process_->told().units.front(), choice_);
    unit.calibration += "; heartbeat " + std::to_string(choice_.heartbeat_ms) + " ms";
    return unit;
}

Exchange HostedLink::exchange(const Wrench& F_D_B, milliseconds longest) {
    StudyCommand command;
    for (int i = 0; i < 3; ++i) {
        command.force[i] = F_D_B.force[i];
        command.torque[i] = F_D_B.torque[i];
    }
    command.at = std::exchange(made_at_, std::nullopt).value_or(stampOfNow());
    command.number = ++commands_;
    command.withheld_seen = withheld_;
    process_->give(command);
    const auto report = process_->awaitReport(commands_, longest);
    if (process_->hasGone() &&
        !(report && report->number != reports_ && exchangeOf(*report).kind == Exchange::Kind::Gone))
        return {Exchange::Kind::Gone, {}, process_->ending()};
    const auto now = std::chrono::steady_clock::now();
    if (!report || report->number == reports_) {
        if (now - heard_at_ < kHangs) return {};
        return {Exchange::Kind::Gone, {}, "the device host hangs in the vendor's library"};
    }
    heard_at_ = now;
    return taken(*report);
}

/// A new report, and what it tells of force that was withheld.
Exchange HostedLink::taken(const HostReport& report) {
    reports_ = report.number;
    Exchange exchange = exchangeOf(report);
    const bool withheld = std::exchange(withheld_, report.withheld) != report.withheld;
    if (exchange.kind != Exchange::Kind::News) return exchange;
    if (withheld) {
        exchange.kind = Exchange::Kind::Stale;
        exchange.why =
            "the device's force was taken away: this program, or the device, did not answer for longer than "
            "the heartbeat and 50 ms";
    } else if (std::exchange(gaps_, report.gaps) != report.gaps) {
        exchange.why = "this program's heartbeat was missing for a moment; the force was taken away and ramped back";
    }
    return exchange;
}

Result<std::unique_ptr<unit::Unit>> openHosted(const DeviceChoice& choice, const DeviceDescription& description) {
    if (!choice.axes.empty()) {
        const auto axes = unit::Axes::parse(choice.axes);
        if (!axes) return axes.errors();
        if (axes->mirrors())
            return Error{.message = "must not mirror: forces and turns of a device are those of a right-handed frame",
                         .key = "axes",
                         .value = choice.axes};
    }
    unit::LinkedParams params;
    params.description = description;
    params.heartbeat = milliseconds(choice.heartbeat_ms);
    return std::unique_ptr<unit::Unit>(
        std::make_unique<unit::LinkedUnit>(std::make_unique<HostedLink>(choice, description), std::move(params)));
}

Result<std::vector<DeviceUnit>> lookHosted(const std::string& backend, const std::string& library) {
    const DeviceChoice choice{.backend = backend, .address = library};
    HostTask task = taskFor(choice, {});
    task.looks_only = 1;
    const auto started = HostProcess::start(backend, task);
    if (!started) return started.errors();
    if (const auto running = (*started)->awaitRunning(kOpening); !running) return running.errors();
    const HostPage& told = (*started)->told();
    std::vector<DeviceUnit> units;
    for (std::uint32_t i = 0; i < std::min(told.unit_count, HostPage::kMostUnits); ++i)
        units.push_back(unitOf(told.units[i], choice));
    return units;
}

}  // namespace passung::host
