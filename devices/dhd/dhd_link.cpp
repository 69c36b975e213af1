#include "devices/dhd/dhd_link.h"

#include <fmt/format.h>

#include <cstdlib>
#include <optional>

#include "devices/host/library_pose.h"

namespace passung::dhd {
namespace {

using unit::Exchange;

constexpr std::string_view kModel = "sigma.7";

// Places in what dhdGetStatus says.
constexpr int kForceOn = 5, kBrakesOn = 6, kForceOffCause = 14, kStatusLength = 32;

std::string versionsText(const DhdLibrary& dhd, char id) {
    const int* v = dhd.version;
    std::string text = fmt::format("SDK {}.{}.{}.{}", v[0], v[1], v[2], v[3]);
    double firmware = 0.0;
    if (dhd.getVersion != nullptr && dhd.getVersion(&firmware, id) >= 0)
        text += fmt::format(", firmware {:.2f}", firmware);
    return text;
}

/// Other models have other limits, and nothing of theirs is known here.
Error notServed(const DeviceUnit& unit) {
    return {.message = fmt::format("the device {} is no {} but {}, of whose limits nothing is known: it is not served",
                                   unit.serial, kModel, unit.model)};
}

/// Who the opened device is.
DeviceUnit unitOf(const DhdLibrary& dhd, char id) {
    unsigned short serial = 0;
    const char* name = dhd.getSystemName(id);
    DeviceUnit unit{.backend = "dhd", .model = name == nullptr ? "unknown" : name, .versions = versionsText(dhd, id)};
    if (dhd.getSerialNumber(&serial, id) >= 0) unit.serial = std::to_string(serial);
    return unit;
}

Error nothingThere() {
    return {.message =
                "Force Dimension's library sees no device: switch it on and plug it in; `lsusb -d 1451:` lists "
                "it. If it does, a udev rule is missing: put the line SUBSYSTEM==\"usb\", "
                "ATTR{idVendor}==\"1451\", MODE=\"0666\" into /etc/udev/rules.d/60-forcedimension.rules and plug "
                "it in again"};
}

}  // namespace

Result<std::vector<DeviceUnit>> look(const std::string& library) {
    const auto dhd = DhdLibrary::load(library);
    if (!dhd) return dhd.errors();
    const int count = (*dhd)->getDeviceCount();
    std::vector<DeviceUnit> units;
    std::optional<Error> other;
    for (int id = 0; id < count; ++id) {
        const auto place = static_cast<char>(id);
        if ((*dhd)->openId(place) < 0) continue;
        DeviceUnit unit = unitOf(**dhd, place);
        (*dhd)->close(place);
        if (unit.model == kModel)
            units.push_back(std::move(unit));
        else
            other = notServed(unit);
    }
    if (!units.empty()) return units;
    if (other) return *other;
    if (count <= 0) return nothingThere();
    return Error{.message =
                     fmt::format("Force Dimension's library sees {} and opens none: {}; does another program use "
                                 "it?",
                                 count == 1 ? "a device" : "devices", (*dhd)->lastError())};
}

DhdLink::DhdLink(DeviceChoice choice, DeviceDescription limits)
    : choice_(std::move(choice)), limits_(std::move(limits)) {}
DhdLink::~DhdLink() { close(); }

void DhdLink::close() noexcept {
    if (dhd_ && id_ >= 0) dhd_->close(id());
    id_ = -1;
    dhd_.reset();
}

Error DhdLink::failed(const char* call) const {
    return {.message = fmt::format("{} of Force Dimension's library failed: {}", call, dhd_->lastError())};
}

Result<DeviceUnit> DhdLink::open() {
    const auto axes = unit::Axes::parse(choice_.axes.empty() ? kDefaultAxes : choice_.axes);
    if (!axes) return axes.errors();
    axes_ = *axes;
    auto loaded = DhdLibrary::load(choice_.address);
    if (!loaded) return loaded.errors();
    dhd_ = *std::move(loaded);
    if (const auto opened = openChosen(); !opened) return opened.errors();
    DeviceUnit unit = unitOf(*dhd_, id());
    if (unit.model != kModel) return notServed(unit);
    if (const auto prepared = prepare(); !prepared) return prepared.errors();
    unit.calibration = fmt::format("axes {}; watchdog {} ms", axes_.text(), kWatchdog);
    return unit;
}

/// By its serial number where there is one: the order of IDs is that of plugging.
Result<Done> DhdLink::openChosen() {
    const int count = dhd_->getDeviceCount();
    if (count <= 0) return nothingThere();
    if (choice_.serial.empty()) {
        if (count > 1)
            return Error{.message =
                             fmt::format("Force Dimension's library sees {} devices: name one as `serial` in the "
                                         "station file; `passung doctor` lists them",
                                         count)};
        id_ = dhd_->openId(0);
        if (id_ < 0) return failed("dhdOpenID");
        return Done{};
    }
    if (dhd_->openSerial != nullptr) {
        const long serial = std::strtol(choice_.serial.c_str(), nullptr, 10);
        id_ = dhd_->openSerial(static_cast<int>(serial));
    } else {
        for (int place = 0; place < count && id_ < 0; ++place) {
            if (dhd_->openId(static_cast<char>(place)) < 0) continue;
            id_ = place;
            if (unitOf(*dhd_, id()).serial == choice_.serial) break;
            dhd_->close(id());
            id_ = -1;
        }
    }
    if (id_ >= 0 && unitOf(*dhd_, id()).serial == choice_.serial) return Done{};
    return Error{.message = fmt::format("Force Dimension's library finds no device {} among the {} that it sees: is it "
                                        "switched on? `passung doctor` lists them",
                                        choice_.serial, count)};
}

/// No force yet, and none for long without this program.
Result<Done> DhdLink::prepare() {
    if (dhd_->setWatchdog(kWatchdog, id()) < 0) return failed("dhdSetWatchdog");
    if (dhd_->setMaxForce != nullptr && dhd_->setMaxForce(limits_.max_force_N, id()) < 0)
        return failed("dhdSetMaxForce");
    if (dhd_->setMaxTorque != nullptr && dhd_->setMaxTorque(limits_.max_torque_Nm, id()) < 0)
        return failed("dhdSetMaxTorque");
    if (dhd_->setBrakes != nullptr && dhd_->setBrakes(0, id()) < 0) return failed("dhdSetBrakes");
    if (dhd_->setWrench(0, 0, 0, 0, 0, 0, 0, id()) < 0) return failed("dhdSetForceAndTorqueAndGripperForce");
    if (dhd_->enableForce(1, id()) < 0) return failed("dhdEnableForce");
    has_grip_ = dhd_->hasGripper != nullptr && dhd_->getGripperAngle != nullptr && dhd_->hasGripper(id());
    return Done{};
}

Exchange DhdLink::exchange(const Wrench& F_D_B, std::chrono::milliseconds) {
    const Vec3 f = axes_.toDevice(F_D_B.force);
    const Vec3 t = axes_.toDevice(F_D_B.torque);
    if (dhd_->setWrench(f.x(), f.y(), f.z(), t.x(), t.y(), t.z(), 0.0, id()) < 0)
        return {Exchange::Kind::Gone, {}, failed("dhdSetForceAndTorqueAndGripperForce").message};
    int status[kStatusLength] = {};
    if (dhd_->getStatus(status, id()) < 0) return {Exchange::Kind::Gone, {}, failed("dhdGetStatus").message};
    if (status[kForceOn] != 0 && status[kBrakesOn] == 0) return read();
    // Its button, its velocity limit or its watchdog. Switched on again for when it is armed again.
    if (dhd_->setBrakes != nullptr) dhd_->setBrakes(0, id());
    dhd_->enableForce(1, id());
    return {Exchange::Kind::Wrong,
            {},
            fmt::format("the device has switched its motors off (cause {} of dhdGetStatus): its force button, a speed "
                        "above its limit, or its watchdog",
                        status[kForceOffCause])};
}

Exchange DhdLink::read() {
    Vec3 p;
    double rows[3][3];
    if (dhd_->getPose(&p.x(), &p.y(), &p.z(), rows, id()) < 0)
        return {Exchange::Kind::Gone, {}, failed("dhdGetPositionAndOrientationFrame").message};
    Mat3 R;
    for (int i = 0; i < 3; ++i) R.row(i) << rows[i][0], rows[i][1], rows[i][2];
    Exchange exchange = host::saidPose(R, p, axes_);
    if (exchange.kind != Exchange::Kind::News) return exchange;
    exchange.said.buttons = dhd_->getButtonMask(id());
    if (has_grip_ && dhd_->getGripperAngle(&exchange.said.grip_rad, id()) < 0)
        return {Exchange::Kind::Gone, {}, failed("dhdGetGripperAngleRad").message};
    return exchange;
}

}  // namespace passung::dhd
