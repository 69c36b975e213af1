#include "devices/dhd/dhd_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>

namespace passung::dhd {
namespace {

/// The library that drives devices has all names of the one that only reads and pushes.
constexpr const char* kUsualFiles[] = {"libdhd.so.3", "libdhd.so", "libdrd.so.3", "libdrd.so"};

/// Whose file is named; empty: nobody has named one.
std::string namedFile(const std::string& file) {
    if (!file.empty()) return file;
    const char* variable = std::getenv(DhdLibrary::kFileVariable);
    return variable == nullptr ? std::string() : variable;
}

std::string advice() {
    return fmt::format(
        "install the Force Dimension SDK 3 of forcedimension.com, and write the path of its libdhd.so as "
        "`address` into the station file, or into {}",
        DhdLibrary::kFileVariable);
}

}  // namespace

Result<std::unique_ptr<DhdLibrary>> DhdLibrary::load(const std::string& file) {
    std::unique_ptr<DhdLibrary> loaded(new DhdLibrary);
    const std::string named = namedFile(file);
    std::string tried, why, path = named;
    if (!named.empty()) {
        loaded->library_ = dlopen(named.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (loaded->library_ == nullptr) {
            const char* reason = dlerror();
            return Error{.message = fmt::format("Force Dimension's library does not load from {}: {}; {}", named,
                                                reason == nullptr ? "no reason" : reason, advice())};
        }
    }
    for (const char* usual : kUsualFiles) {
        if (loaded->library_ != nullptr) break;
        loaded->library_ = dlopen(usual, RTLD_NOW | RTLD_LOCAL);
        if (loaded->library_ != nullptr)
            path = usual;
        else
            tried += (tried.empty() ? "" : ", ") + std::string(usual);
    }
    if (loaded->library_ == nullptr)
        return Error{.message = fmt::format("Force Dimension's library is not found: looked for {} where the system's "
                                            "loader looks (LD_LIBRARY_PATH, /etc/ld.so.conf, /usr/lib); {}",
                                            tried, advice())};
    if (const std::string missing = loaded->missingName(); !missing.empty())
        return Error{.message =
                         fmt::format("Force Dimension's library {} has no function {}: it is older than 3.17, or "
                                     "another library; {}",
                                     path, missing, advice())};
    int* v = loaded->version;
    loaded->getSdkVersion(&v[0], &v[1], &v[2], &v[3]);
    if (v[0] != 3)
        return Error{.message = fmt::format("Force Dimension's library {} is of version {}.{}, and not 3; {}", path,
                                            v[0], v[1], advice())};
    return loaded;
}

/// Takes all names; the first that has to be there and is not.
std::string DhdLibrary::missingName() {
    std::string missing;
    const auto take = [this](auto& function, const char* name) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library_, name));
        return function != nullptr;
    };
    const auto need = [&](auto& function, const char* name) {
        if (!take(function, name) && missing.empty()) missing = name;
    };
    need(getDeviceCount, "dhdGetDeviceCount");
    need(openId, "dhdOpenID");
    need(close, "dhdClose");
    need(getSerialNumber, "dhdGetSerialNumber");
    need(getSystemName, "dhdGetSystemName");
    need(getSdkVersion, "dhdGetSDKVersion");
    need(getStatus, "dhdGetStatus");
    need(enableForce, "dhdEnableForce");
    need(setWatchdog, "dhdSetWatchdog");
    need(getPose, "dhdGetPositionAndOrientationFrame");
    need(getButtonMask, "dhdGetButtonMask");
    need(setWrench, "dhdSetForceAndTorqueAndGripperForce");
    need(errorGetLastStr, "dhdErrorGetLastStr");
    take(openSerial, "dhdOpenSerial");
    take(setBrakes, "dhdSetBrakes");
    take(setMaxForce, "dhdSetMaxForce");
    take(setMaxTorque, "dhdSetMaxTorque");
    take(getVersion, "dhdGetVersion");
    take(hasGripper, "dhdHasGripper");
    take(getGripperAngle, "dhdGetGripperAngleRad");
    return missing;
}

DhdLibrary::~DhdLibrary() {
    if (library_ != nullptr) dlclose(library_);
}

std::string DhdLibrary::lastError() const {
    const char* text = errorGetLastStr();
    return text == nullptr ? "no reason given" : text;
}

}  // namespace passung::dhd
