#include "devices/host/serve_link.h"

#include <poll.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <cstdio>

#include "devices/host/paced_link.h"
#include "devices/host/shared_pages.h"
#include "devices/unit/heartbeat_watch.h"
#include "devices/unit/wrench_gate.h"

namespace passung::host {
namespace {

using unit::Exchange;

constexpr int kPriority = 74;                       // below the unit's thread in the study
constexpr std::chrono::milliseconds kRecovers{50};  // a study without a heartbeat
// A library that hangs for so long [s] ends this program, also where no study is there any more to do it.
constexpr unsigned kOpens = 10, kHangs = 2;

std::int64_t now() noexcept {
    timespec t{};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

struct Pages {
    const StudyPage* study = nullptr;
    HostPage* host = nullptr;
};

/// Both pages; null where this program was not started by a study of its own version.
Pages sharedPages() {
    void* asked = mmap(nullptr, kPageBytes, PROT_READ, MAP_SHARED, kMemoryDescriptor, 0);
    void* told = mmap(nullptr, kPageBytes, PROT_READ | PROT_WRITE, MAP_SHARED, kMemoryDescriptor, kPageBytes);
    if (asked == MAP_FAILED || told == MAP_FAILED) return {};
    Pages pages{static_cast<const StudyPage*>(asked), static_cast<HostPage*>(told)};
    pages.host->head = PageHead::of<HostPage>();  // that the study sees which version this is, if no more
    if (!(pages.study->head == PageHead::of<StudyPage>())) return {};
    return pages;
}

void tell(HostPage& page, const std::vector<DeviceUnit>& units) {
    page.unit_count = 0;
    for (const DeviceUnit& unit : units) {
        if (page.unit_count == HostPage::kMostUnits) break;
        UnitTexts& texts = page.units[page.unit_count++];
        texts.serial.put(unit.serial);
        texts.model.put(unit.model);
        texts.versions.put(unit.versions);
        texts.calibration.put(unit.calibration);
    }
    page.stage.store(HostPage::Running);
}

int fail(HostPage& page, const Errors& errors) {
    page.failure.put(errors.front().message);
    page.stage.store(HostPage::Failed);
    return 1;
}

void ring() noexcept {
    const char stroke = 1;
    send(kBellDescriptor, &stroke, 1, MSG_NOSIGNAL | MSG_DONTWAIT);  // who does not listen has heard enough
}

/// Waits for a command; false: the study has gone.
bool awaitBell(std::chrono::milliseconds longest) {
    pollfd bell{kBellDescriptor, POLLIN, 0};
    if (poll(&bell, 1, static_cast<int>(longest.count())) <= 0) return true;
    char strokes[64];
    const ssize_t count = recv(kBellDescriptor, strokes, sizeof strokes, MSG_DONTWAIT);
    return count != 0 && (bell.revents & (POLLHUP | POLLERR)) == 0;
}

HostReport reportOf(const Exchange& exchange, const StudyCommand& command, const unit::HeartbeatWatch& watch) {
    HostReport report;
    report.answers = command.number;
    report.kind = static_cast<std::uint64_t>(exchange.kind);
    report.withheld = watch.withheld();
    report.gaps = watch.gaps();
    const Pose& X_BD = exchange.said.X_BD;
    for (int i = 0; i < 3; ++i) report.position[i] = X_BD.p[i];
    for (int i = 0; i < 4; ++i) report.quaternion[i] = X_BD.q.coeffs()[i];
    report.grip_rad = exchange.said.grip_rad;
    report.buttons = exchange.said.buttons;
    report.why.put(exchange.why);
    return report;
}

Wrench wrenchOf(const StudyCommand& command) {
    Wrench F;
    for (int i = 0; i < 3; ++i) {
        F.force[i] = command.force[i];
        F.torque[i] = command.torque[i];
    }
    return F;
}

/// The device's cycles, by whosever thread: a command in, a report out.
class Serving {
public:
    Serving(unit::Link& link, const DeviceDescription& limits, const Pages& pages)
        : link_(link),
          limits_(limits),
          pages_(pages),
          watch_(std::chrono::milliseconds(pages.study->task.heartbeat_ms), kRecovers) {}

    /// One of them, which begins with a command, or after `patience`; false: it was the last, and gave no force.
    bool cycle(std::chrono::milliseconds patience) {
        alarm(kHangs);
        if (awaitBell(patience) && exchange()) return true;
        link_.exchange({}, kPatience);
        return false;
    }

    void tell(const Exchange& exchange) {
        HostReport report = reportOf(exchange, command_, watch_);
        report.number = ++number_;
        pages_.host->now.store(report);
        ring();
    }

private:
    bool exchange() {
        if (const auto newest = pages_.study->now.load()) command_ = *newest;
        Wrench F = wrenchOf(command_);
        const bool pushes = !F.force.isZero(0.0) || !F.torque.isZero(0.0);
        const double share = watch_.share({command_.number, command_.at, pushes, command_.withheld_seen}, now());
        F.force *= share;
        F.torque *= share;
        const Exchange said = link_.exchange(unit::passed(F, limits_, share > 0.0), kPatience);
        // What it said cannot be used: no force until the study knows.
        if (said.kind != Exchange::Kind::News) watch_.withhold();
        tell(said);
        return said.kind != Exchange::Kind::Gone;
    }

    unit::Link& link_;
    const DeviceDescription& limits_;
    const Pages& pages_;
    unit::HeartbeatWatch watch_;
    StudyCommand command_;
    std::uint64_t number_ = 0;
};

void serve(unit::Link& link, const DeviceDescription& limits, const Pages& pages) {
    Serving serving(link, limits, pages);
    alarm(kHangs);
    if (auto* paced = dynamic_cast<PacedLink*>(&link)) {
        const auto paced_to_the_end = paced->pace([&] { return serving.cycle(std::chrono::milliseconds(0)); });
        if (!paced_to_the_end) serving.tell({Exchange::Kind::Gone, {}, paced_to_the_end.errors().front().message});
        return;
    }
    while (serving.cycle(kPatience)) {
    }
}

}  // namespace

int serveLibrary(const HostedLibrary& library) {
    const Pages pages = sharedPages();
    if (pages.host == nullptr) return 2;
    sched_param priority{};
    priority.sched_priority = kPriority;
    sched_setscheduler(0, SCHED_FIFO, &priority);  // goes on without it, like the loop
    alarm(kOpens);
    const HostTask& task = pages.study->task;
    const std::string file(task.library.view());
    if (task.looks_only != 0) {
        const auto units = library.look(file);
        if (!units) return fail(*pages.host, units.errors());
        tell(*pages.host, *units);
        return 0;
    }
    DeviceDescription limits;
    limits.actuated_degrees = static_cast<int>(task.actuated_degrees);
    limits.max_force_N = task.max_force_N;
    limits.max_torque_Nm = task.max_torque_Nm;
    DeviceChoice choice;
    choice.serial = task.serial.view();
    choice.address = file;
    choice.axes = task.axes.view();
    const auto link = library.link(choice, limits);
    const auto opened = link->open();
    if (!opened) {
        link->close();
        return fail(*pages.host, opened.errors());
    }
    tell(*pages.host, {*opened});
    serve(*link, limits, pages);
    link->close();
    return 0;
}

}  // namespace passung::host
