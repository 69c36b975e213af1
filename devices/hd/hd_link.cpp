#include "devices/hd/hd_link.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "devices/host/library_pose.h"

namespace passung::hd {
namespace {

using unit::Exchange;

/// Names that the vendor's set-up gives devices, there being no list of them.
constexpr const char* kUsualNames[] = {"Default Device", "Left Device", "Right Device", "Default PHANToM"};
constexpr unsigned short kPriority = 0xffff;  // the first to be called
constexpr double kMetresPerMm = 1e-3;
constexpr double kSmallestReach = 5.0;  // [mm] of any device; in m no device reaches so far
constexpr double kRounding = 1e-6;
constexpr std::chrono::milliseconds kLook{10};  // at the servo thread,
constexpr int kStalls = 20;                     // which stands still at so many looks

/// "FILE#NAME" of a station file: the library, and a device's name in the vendor's set-up. Either may be missing.
struct LibraryPlace {
    std::string file;
    std::vector<std::string> names;
};

LibraryPlace placeOf(const std::string& address) {
    const auto mark = address.rfind('#');
    if (mark == std::string::npos) return {address, {std::begin(kUsualNames), std::end(kUsualNames)}};
    return {address.substr(0, mark), {address.substr(mark + 1)}};
}

/// Who the current device is.
DeviceUnit unitOf(const HdLibrary& hd) {
    return {.backend = "hd",
            .serial = hd.text(kSerial),
            .model = hd.text(kModel),
            .versions = fmt::format("HD {}, driver {}", hd.text(kVersion), hd.text(kDriver))};
}

Error nothingThere(const HdLibrary& hd, const std::vector<std::string>& names, unsigned error) {
    return {.message = fmt::format(
                "OpenHaptics' library opens no device of the names {}: {}; is it switched on and plugged in, has the "
                "vendor's set-up given it another name (`address = \"#NAME\"` in the station file), does another "
                "program use it, and may this user read and write its /dev/ttyACM0 or /dev/hidraw0?",
                fmt::join(names, ", "), hd.words(error))};
}

/// Those that it opens by these names, closed again. Errors: none.
Result<std::vector<DeviceUnit>> unitsOf(HdLibrary& hd, const std::vector<std::string>& names) {
    std::vector<DeviceUnit> units;
    for (const std::string& name : names) {
        const unsigned device = hd.initDevice(name.c_str());
        if (device == kNoDevice) continue;
        hd.makeCurrent(device);
        DeviceUnit unit = unitOf(hd);
        hd.disableDevice(device);
        // One device may have two names.
        if (std::ranges::find(units, unit.serial, &DeviceUnit::serial) == units.end()) units.push_back(std::move(unit));
    }
    const unsigned error = hd.takeError();
    if (units.empty()) return nothingThere(hd, names, error);
    return units;
}

}  // namespace

Result<std::vector<DeviceUnit>> look(const std::string& address) {
    const LibraryPlace place = placeOf(address);
    const auto hd = HdLibrary::load(place.file);
    if (!hd) return hd.errors();
    return unitsOf(**hd, place.names);
}

HdLink::HdLink(DeviceChoice choice, DeviceDescription limits)
    : choice_(std::move(choice)), limits_(std::move(limits)) {}
HdLink::~HdLink() { close(); }

void HdLink::close() noexcept {
    if (hd_ && scheduled_) hd_->stopScheduler();
    if (hd_ && device_ != kNoDevice) hd_->disableDevice(device_);
    scheduled_ = false;
    device_ = kNoDevice;
    hd_.reset();
}

Result<DeviceUnit> HdLink::open() {
    const auto axes = unit::Axes::parse(choice_.axes.empty() ? kDefaultAxes : choice_.axes);
    if (!axes) return axes.errors();
    axes_ = *axes;
    auto loaded = HdLibrary::load(placeOf(choice_.address).file);
    if (!loaded) return loaded.errors();
    hd_ = *std::move(loaded);
    auto unit = openChosen();
    if (!unit) return unit.errors();
    if (const auto prepared = prepare(); !prepared) return prepared.errors();
    unit->calibration = fmt::format("axes {}; {} Hz", axes_.text(), hd_->integer(kUpdateRate));
    return unit;
}

/// By its serial number: its name is the set-up's, and may be another's tomorrow.
Result<DeviceUnit> HdLink::openChosen() {
    std::string serial = choice_.serial;
    const LibraryPlace place = placeOf(choice_.address);
    if (serial.empty()) {
        const auto units = unitsOf(*hd_, place.names);
        if (!units) return units.errors();
        if (units->size() > 1)
            return Error{.message = fmt::format("OpenHaptics' library has {} devices: name one as `serial` in the "
                                                "station file; `passung doctor` lists them",
                                                units->size())};
        serial = units->front().serial;
    }
    std::string others;
    for (const std::string& name : place.names) {
        device_ = hd_->initDevice(name.c_str());
        if (device_ == kNoDevice) continue;
        hd_->makeCurrent(device_);
        DeviceUnit unit = unitOf(*hd_);
        hd_->takeError();
        if (unit.serial == serial) return unit;
        others += (others.empty() ? "" : ", ") + unit.serial;
        hd_->disableDevice(std::exchange(device_, kNoDevice));
    }
    const unsigned error = hd_->takeError();
    if (others.empty()) return nothingThere(*hd_, place.names, error);
    return Error{.message =
                     fmt::format("OpenHaptics' library has no device {}, but {}: is it switched on?", serial, others)};
}

/// No force yet. Errors: it is weaker than its kind, or counts otherwise.
Result<Done> HdLink::prepare() {
    double reach[6] = {};
    hd_->getDoubles(kMaxWorkspace, reach);
    if (!(reach[3] - reach[0] > kSmallestReach))
        return Error{.message = fmt::format("the device says that it reaches {:.3g} mm: does the library count in m?",
                                            reach[3] - reach[0])};
    const double force = hd_->number(kNominalMaxForce);
    if (!(force >= limits_.max_force_N - kRounding))
        return Error{.message = fmt::format("the device is weaker than its kind: it pushes with {:.3g} N of {:.3g} N",
                                            force, limits_.max_force_N)};
    const int measures = hd_->integer(kInputDegrees), drives = hd_->integer(kOutputDegrees);
    if (measures < 6 || drives < 3)
        return Error{.message = fmt::format("the device is weaker than its kind: it measures {} degrees of 6 and "
                                            "drives {} of 3",
                                            measures, drives)};
    hd_->enable(kMaxForceClamping);
    hd_->enable(kForceRamping);
    hd_->enable(kForceOutput);
    if (const unsigned error = hd_->takeError(); error != 0)
        return Error{.message = "OpenHaptics' library does not switch the force on: " + hd_->words(error)};
    hd_->setSchedulerRate(kRate);
    hd_->takeError();  // another rate is no failure; the calibration says which
    hd_->startScheduler();
    if (const unsigned error = hd_->takeError(); error != 0)
        return Error{.message = "OpenHaptics' library does not start its scheduler: " + hd_->words(error)};
    scheduled_ = true;
    return Done{};
}

unsigned HdLink::tick(void* self) {
    auto& link = *static_cast<HdLink*>(self);
    link.ticks_.fetch_add(1, std::memory_order_relaxed);
    if ((*link.cycle_)()) return kAgain;
    link.over_.release();
    return kDone;
}

Result<Done> HdLink::pace(const std::function<bool()>& cycle) {
    cycle_ = &cycle;
    hd_->scheduleAsynchronous(tick, this, kPriority);
    std::uint64_t seen = 0;
    for (int without = 0; !over_.try_acquire_for(kLook);) {
        const std::uint64_t ticks = ticks_.load(std::memory_order_relaxed);
        without = std::exchange(seen, ticks) == ticks ? without + 1 : 0;
        if (without < kStalls) continue;
        hd_->stopScheduler();  // waits for a call that is on its way
        scheduled_ = false;
        return Error{.message =
                         fmt::format("OpenHaptics' scheduler has not called for {} ms", kStalls * kLook.count())};
    }
    return Done{};
}

Exchange HdLink::exchange(const Wrench& F_D_B, std::chrono::milliseconds) {
    hd_->beginFrame(device_);
    if (const unsigned error = hd_->takeError(); error != 0) {
        const Vec3 none = Vec3::Zero();
        hd_->setDoubles(kCurrentForce, none.data());
        hd_->endFrame(device_);
        hd_->takeError();  // where there is no frame
        return failed(error);
    }
    Exchange said = read();
    const Vec3 force = said.kind == Exchange::Kind::News ? axes_.toDevice(F_D_B.force) : Vec3(Vec3::Zero());
    hd_->setDoubles(kCurrentForce, force.data());
    hd_->endFrame(device_);
    if (const unsigned error = hd_->takeError(); error != 0) return failed(error);
    return calibrated(std::move(said));
}

Exchange HdLink::read() {
    double transform[16];
    std::fill(std::begin(transform), std::end(transform), std::numeric_limits<double>::quiet_NaN());
    hd_->getDoubles(kCurrentTransform, transform);
    Mat3 R;
    for (int column = 0; column < 3; ++column) R.col(column) = Vec3(transform + 4 * column);
    Exchange exchange = host::saidPose(R, kMetresPerMm * Vec3(transform + 12), axes_);
    exchange.said.buttons = static_cast<std::uint32_t>(hd_->integer(kCurrentButtons));
    return exchange;
}

/// Its output is off after an error of a force; switched on again for when it is armed again.
Exchange HdLink::failed(unsigned error) {
    const std::string words = "OpenHaptics' library: " + hd_->words(error);
    if (error == kWarmMotors)
        return {Exchange::Kind::Wrong, {}, "the device's motors are too warm: let them cool, and arm again"};
    if (error > kWarmMotors && error <= kLastForceError) {
        hd_->enable(kForceOutput);
        hd_->takeError();
        return {Exchange::Kind::Wrong, {}, "the device has switched its force off; " + words};
    }
    return {Exchange::Kind::Gone, {}, words};
}

Exchange HdLink::calibrated(Exchange exchange) {
    const unsigned state = hd_->checkCalibration();
    if (state == kCalibrated || exchange.kind != Exchange::Kind::News) return exchange;
    if (state != kCalibrationNeedsUpdate)
        return {
            Exchange::Kind::Stale, {}, "the device is not calibrated: put its stylus into the inkwell and take it out"};
    hd_->updateCalibration(static_cast<unsigned>(hd_->integer(kCalibrationStyle)));
    hd_->takeError();
    return {Exchange::Kind::Stale, {}, "the device calibrates itself: move its stylus a little"};
}

}  // namespace passung::hd
