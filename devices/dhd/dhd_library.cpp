#include "devices/dhd/dhd_library.h"

#include <fmt/format.h>

namespace passung::dhd {
namespace {

/// The library that drives devices has all names of the one that only reads and pushes.
constexpr const char* kUsualFiles[] = {"libdhd.so.3", "libdhd.so", "libdrd.so.3", "libdrd.so"};
constexpr host::LibraryWords kWords{
    "Force Dimension's library", DhdLibrary::kFileVariable, kUsualFiles, "3.17",
    "install the Force Dimension SDK 3 of forcedimension.com, and write the path of its "
    "libdhd.so"};

}  // namespace

Result<std::unique_ptr<DhdLibrary>> DhdLibrary::load(const std::string& file) {
    auto opened = host::ClosedLibrary::load(file, kWords);
    if (!opened) return opened.errors();
    std::unique_ptr<DhdLibrary> loaded(new DhdLibrary(*std::move(opened)));
    loaded->takeFunctions();
    if (const auto complete = loaded->file_->complete(); !complete) return complete.errors();
    int* v = loaded->version;
    loaded->getSdkVersion(&v[0], &v[1], &v[2], &v[3]);
    if (v[0] != 3)
        return Error{.message = fmt::format("Force Dimension's library {} is of version {}.{}, and not 3; {}",
                                            loaded->file_->path(), v[0], v[1], loaded->file_->advice())};
    return loaded;
}

void DhdLibrary::takeFunctions() {
    file_->need(getDeviceCount, "dhdGetDeviceCount");
    file_->need(openId, "dhdOpenID");
    file_->need(close, "dhdClose");
    file_->need(getSerialNumber, "dhdGetSerialNumber");
    file_->need(getSystemName, "dhdGetSystemName");
    file_->need(getSdkVersion, "dhdGetSDKVersion");
    file_->need(getStatus, "dhdGetStatus");
    file_->need(enableForce, "dhdEnableForce");
    file_->need(setWatchdog, "dhdSetWatchdog");
    file_->need(getPose, "dhdGetPositionAndOrientationFrame");
    file_->need(getButtonMask, "dhdGetButtonMask");
    file_->need(setWrench, "dhdSetForceAndTorqueAndGripperForce");
    file_->need(errorGetLastStr, "dhdErrorGetLastStr");
    file_->take(openSerial, "dhdOpenSerial");
    file_->take(setBrakes, "dhdSetBrakes");
    file_->take(setMaxForce, "dhdSetMaxForce");
    file_->take(setMaxTorque, "dhdSetMaxTorque");
    file_->take(getVersion, "dhdGetVersion");
    file_->take(hasGripper, "dhdHasGripper");
    file_->take(getGripperAngle, "dhdGetGripperAngleRad");
}

std::string DhdLibrary::lastError() const {
    const char* text = errorGetLastStr();
    return text == nullptr ? "no reason given" : text;
}

}  // namespace passung::dhd
