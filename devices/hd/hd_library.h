#pragma once

#include <memory>
#include <string>

#include "core/base/result.h"
#include "devices/host/closed_library.h"

namespace passung::hd {

// Parameters, errors and capabilities by the numbers of the vendor's reference guide. Lengths in mm, forces in N,
// torques in mN·m.
enum : unsigned {
    kCurrentButtons = 0x2000,
    kCurrentTransform = 0x2052,  // 16 numbers, column by column
    kVersion = 0x2500,
    kModel = 0x2501,
    kDriver = 0x2502,
    kSerial = 0x2504,
    kMaxWorkspace = 0x2550,  // least x, y, z, most x, y, z
    kInputDegrees = 0x2553,
    kOutputDegrees = 0x2554,
    kCalibrationStyle = 0x2555,
    kUpdateRate = 0x2600,  // [Hz]
    kNominalMaxForce = 0x2603,
    kCurrentForce = 0x2700,
    kForceOutput = 0x4000,
    kMaxForceClamping = 0x4001,
    kForceRamping = 0x4002,
    kBadHandle = 0x0104,
    kWarmMotors = 0x0200,
    kLastForceError = 0x0204,  // force, impulse, velocity, ...: the output is off
    kDeviceFault = 0x0300,
    kAlreadyInitiated = 0x0301,
    kCommunicationError = 0x0302,
    kCalibrated = 0x5000,
    kCalibrationNeedsUpdate = 0x5001,
};
inline constexpr unsigned kNoDevice = 0xffff'ffff;
inline constexpr unsigned kAgain = 1, kDone = 0;  // what a callback returns

struct HdErrorInfo {
    unsigned code = 0;
    int internal_code = 0;
    unsigned device = 0;
};

/// OpenHaptics' HD interface 3, found and loaded at run time.
struct HdLibrary {
    static constexpr const char* kFileVariable = "PASSUNG_HD_LIBRARY";

    static Result<std::unique_ptr<HdLibrary>> load(const std::string& file);

    /// Takes all errors since the last call; the oldest one, from which the others come, and 0 where there is none.
    unsigned takeError();
    std::string words(unsigned error) const;
    std::string text(unsigned name) const;
    double number(unsigned name) const;
    int integer(unsigned name) const;

    unsigned (*initDevice)(const char* name) = nullptr;
    void (*disableDevice)(unsigned device) = nullptr;
    void (*makeCurrent)(unsigned device) = nullptr;
    void (*enable)(unsigned what) = nullptr;
    void (*beginFrame)(unsigned device) = nullptr;
    void (*endFrame)(unsigned device) = nullptr;
    void (*getDoubles)(unsigned name, double* values) = nullptr;
    void (*getIntegers)(unsigned name, int* values) = nullptr;
    const char* (*getString)(unsigned name) = nullptr;
    void (*setDoubles)(unsigned name, const double* values) = nullptr;
    HdErrorInfo (*getError)() = nullptr;
    const char* (*getErrorString)(unsigned code) = nullptr;
    unsigned (*checkCalibration)() = nullptr;
    void (*updateCalibration)(unsigned style) = nullptr;
    void (*setSchedulerRate)(unsigned long rate) = nullptr;
    void (*startScheduler)() = nullptr;
    void (*stopScheduler)() = nullptr;
    unsigned long (*scheduleAsynchronous)(unsigned (*callback)(void*), void* data, unsigned short priority) = nullptr;

private:
    explicit HdLibrary(std::unique_ptr<host::ClosedLibrary> file) : file_(std::move(file)) {}
    void takeFunctions();

    std::unique_ptr<host::ClosedLibrary> file_;
};

}  // namespace passung::hd
