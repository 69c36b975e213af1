#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "tests/devices/fakes/dhd_block.h"

/// Functions with the names, arguments, units and results that Force Dimension's library is known to have (C calling
/// convention, forces in N and N·m, lengths in m, angles in rad; -1 on failure, with the reason in a number of its own;
/// 0 or a positive note on success). No thread of its own: all happens in that of the caller. What it does beyond that
/// is told by the block of dhd_block.h.
namespace {

using passung::fake::DhdBlock;
using passung::fake::DhdCommand;
using passung::fake::DhdDevice;
using passung::fake::DhdFault;
using passung::fake::DhdHand;

constexpr int kNoError = 0, kError = 1, kCommunication = 2, kNoDeviceFound = 5, kNotAvailable = 6, kTimeout = 7,
              kExpertModeDisabled = 9, kInvalidIndex = 15, kNullArgument = 17;

DhdBlock* block = nullptr;
int current = -1;  // what an ID of -1 means
thread_local int last_error = kNoError;

int fail(int error) {
    last_error = error;
    return -1;
}

DhdHand kept[passung::fake::kDhdDevices];  // what a frozen device goes on saying
char path_of_block[256] = "";

/// Finds the block; it may be another one than in the last test of this process.
void attach() {
    const char* path = std::getenv(passung::fake::kDhdVariable);
    if (path == nullptr) path = "";
    if (block != nullptr && std::strcmp(path, path_of_block) == 0) return;
    std::snprintf(path_of_block, sizeof path_of_block, "%s", path);
    block = passung::fake::findBlock<DhdBlock>(passung::fake::kDhdVariable);
    current = -1;
    for (DhdHand& hand : kept) hand = {};
}

int placeOf(int id) { return block->swapped ? block->present - 1 - id : id; }

/// The device of an ID; null and an error if it cannot be used. Carries out what a fault does to any call.
DhdDevice* deviceOf(char id) {
    const int number = id < 0 ? current : id;
    if (block == nullptr || number < 0) {
        fail(kNotAvailable);
        return nullptr;
    }
    if (number >= block->present) {
        fail(kInvalidIndex);
        return nullptr;
    }
    DhdDevice& device = block->devices[static_cast<std::size_t>(placeOf(number))];
    if (!device.opened) {
        fail(kNotAvailable);
        return nullptr;
    }
    const DhdFault fault = device.readings >= device.fault_at_reading ? device.fault.load() : DhdFault::None;
    if (fault == DhdFault::Crash) {
        std::signal(SIGSEGV, SIG_DFL);  // whoever watches over this process
        std::raise(SIGSEGV);
    }
    while (fault == DhdFault::Hang && !block->released) usleep(1000);
    if (!device.plugged || fault == DhdFault::Unplugged) {
        fail(kCommunication);
        return nullptr;
    }
    if (fault == DhdFault::Timeout) {
        fail(kTimeout);
        return nullptr;
    }
    return &device;
}

bool isBroken(const DhdDevice& device, DhdFault fault) {
    return device.readings >= device.fault_at_reading && device.fault == fault;
}

/// What the device says of the hand; a frozen one says what it said when it froze.
DhdHand handOf(DhdDevice& device) {
    DhdHand& last = kept[&device - block->devices.data()];
    if (!isBroken(device, DhdFault::Frozen)) last = device.hand.load();
    DhdHand hand = last;
    if (isBroken(device, DhdFault::NotANumber)) hand.position[1] = std::numeric_limits<double>::quiet_NaN();
    const double unit = block->millimetres ? 1000.0 : 1.0;
    for (double& x : hand.position) x *= unit;
    for (double& x : hand.velocity) x *= unit;
    hand.grip_gap *= unit;
    return hand;
}

/// Shortens three components to a limit. True if it did.
bool limit(double* v, double most) {
    const double norm = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (most < 0 || !(norm > most)) return false;
    for (int i = 0; i < 3; ++i) v[i] *= most / norm;
    return true;
}

int open(int id) {
    if (block == nullptr || block->present == 0) return fail(kNoDeviceFound);
    if (id < 0 || id >= block->present) return fail(kInvalidIndex);
    DhdDevice& device = block->devices[static_cast<std::size_t>(placeOf(id))];
    if (!device.plugged) return fail(kNoDeviceFound);
    device.opened = true;
    current = static_cast<unsigned char>(id);
    return id;
}

template <typename... Targets>
bool anyNull(Targets... targets) {
    return ((targets == nullptr) || ...);
}

}  // namespace

#define EXPORT extern "C" __attribute__((visibility("default")))

EXPORT int dhdErrorGetLast() { return last_error; }

EXPORT const char* dhdErrorGetStr(int error) {
    switch (error) {
        case kNoError:
            return "no error";
        case kCommunication:
            return "communication error";
        case kNoDeviceFound:
            return "no device found";
        case kNotAvailable:
            return "feature not available";
        case kTimeout:
            return "timeout";
        case kExpertModeDisabled:
            return "expert mode disabled";
        case kInvalidIndex:
            return "invalid index";
        case kNullArgument:
            return "null argument";
        default:
            return "undocumented error";
    }
}

EXPORT const char* dhdErrorGetLastStr() { return dhdErrorGetStr(last_error); }

EXPORT void dhdEnableSimulator(bool) {}

EXPORT int dhdGetDeviceCount() {
    attach();
    return block == nullptr ? 0 : block->present.load();
}

EXPORT int dhdGetAvailableCount() { return dhdGetDeviceCount(); }

EXPORT int dhdOpen() {
    attach();
    return open(0);
}

EXPORT int dhdOpenID(char id) {
    attach();
    return open(id);
}

EXPORT int dhdOpenSerial(int serial) {
    attach();
    for (int id = 0; block != nullptr && id < block->present; ++id) {
        if (block->devices[static_cast<std::size_t>(placeOf(id))].serial == serial) return open(id);
    }
    return fail(kNoDeviceFound);
}

EXPORT int dhdClose(char id) {
    DhdDevice* device = deviceOf(id);
    if (device == nullptr) return -1;
    device->opened = false;
    device->forces_enabled = false;
    return 0;
}

EXPORT int dhdSetDevice(char id) {
    if (block == nullptr || id < 0 || id >= block->present) return fail(kInvalidIndex);
    current = static_cast<unsigned char>(id);
    return 0;
}

EXPORT int dhdGetDeviceID() { return current; }

EXPORT int dhdGetSerialNumber(unsigned short* serial, char id) {
    DhdDevice* device = deviceOf(id);
    if (device == nullptr) return -1;
    if (serial == nullptr) return fail(kNullArgument);
    *serial = static_cast<unsigned short>(device->serial);
    return 0;
}

EXPORT int dhdGetSystemType(char id) {
    DhdDevice* device = deviceOf(id);
    return device == nullptr ? -1 : device->type.load();
}

EXPORT const char* dhdGetSystemName(char id) {
    DhdDevice* device = deviceOf(id);
    if (device == nullptr) return nullptr;
    switch (device->type) {
        case 33:
            return "omega.3";
        case 34:
            return "omega.6";
        case 35:
            return "omega.7";
        case 63:
            return "delta.3";
        case 104:
            return "sigma.7";
        default:
            return "unknown";
    }
}

EXPORT void dhdGetSDKVersion(int* major, int* minor, int* release, int* revision) {
    attach();
    int* const targets[] = {major, minor, release, revision};
    for (int i = 0; i < 4; ++i) {
        if (targets[i] != nullptr) *targets[i] = block == nullptr ? 0 : block->version[i].load();
    }
}

EXPORT int dhdGetVersion(double* version, char id) {
    if (deviceOf(id) == nullptr) return -1;
    if (version == nullptr) return fail(kNullArgument);
    *version = 2.0;
    return 0;
}

EXPORT int dhdEnableForce(unsigned char on, char id) {
    DhdDevice* device = deviceOf(id);
    if (device == nullptr) return -1;
    device->forces_enabled = on != 0;
    return 0;
}

EXPORT int dhdSetBrakes(int on, char id) {
    DhdDevice* device = deviceOf(id);
    if (device == nullptr) return -1;
    device->brakes = on != 0;
    return 0;
}

EXPORT int dhdStop(char id) { return dhdSetBrakes(1, id); }

EXPORT int dhdSetGravityCompensation(int, char id) { return deviceOf(id) == nullptr ? -1 : 0; }

EXPORT int dhdGetStatus(int* status, char id) {
    DhdDevice* device = deviceOf(id);
    if (device == nullptr) return -1;
    if (status == nullptr) return fail(kNullArgument);
    std::fill(status, status + 16, 0);
    status[0] = status[1] = status[2] = status[3] = 1;  // power, connected, started, reset
    status[5] = device->forces_enabled && !device->brakes;
    status[6] = device->brakes;
    status[14] = device->force_off_cause;
    return 0;
}

EXPORT bool dhdIsLeftHanded(char id) {
    DhdDevice* device = deviceOf(id);
    return device != nullptr && device->left_handed;
}

EXPORT bool dhdHasWrist(char id) {
    DhdDevice* device = deviceOf(id);
    return device != nullptr && device->type != 33 && device->type != 63;
}

EXPORT bool dhdHasActiveWrist(char id) {
    DhdDevice* device = deviceOf(id);
    return device != nullptr && device->type >= 104;
}

EXPORT bool dhdHasGripper(char id) {
    DhdDevice* device = deviceOf(id);
    return device != nullptr && (device->type >= 104 || device->type == 35);
}

EXPORT bool dhdHasActiveGripper(char id) { return dhdHasGripper(id); }

EXPORT int dhdGetPositionAndOrientationFrame(double* px, double* py, double* pz, double matrix[3][3], char id) {
    DhdDevice* device = deviceOf(id);
    if (device == nullptr) return -1;
    if (anyNull(px, py, pz) || matrix == nullptr) return fail(kNullArgument);
    const DhdHand hand = handOf(*device);
    *px = hand.position[0];
    *py = hand.position[1];
    *pz = hand.position[2];
    for (int i = 0; i < 9; ++i) matrix[i / 3][i % 3] = hand.frame[i];
    ++device->readings;
    return block->call_result == 2 ? 0 : block->call_result.load();
}

EXPORT int dhdGetPosition(double* px, double* py, double* pz, char id) {
    double matrix[3][3];
    return dhdGetPositionAndOrientationFrame(px, py, pz, matrix, id);
}

EXPORT int dhdGetOrientationFrame(double matrix[3][3], char id) {
    double x, y, z;
    return dhdGetPositionAndOrientationFrame(&x, &y, &z, matrix, id);
}

EXPORT int dhdGetLinearVelocity(double* vx, double* vy, double* vz, char id) {
    DhdDevice* device = deviceOf(id);
    if (device == nullptr) return -1;
    if (anyNull(vx, vy, vz)) return fail(kNullArgument);
    const DhdHand hand = handOf(*device);
    *vx = hand.velocity[0];
    *vy = hand.velocity[1];
    *vz = hand.velocity[2];
    return 0;
}

EXPORT int dhdGetAngularVelocityRad(double* wx, double* wy, double* wz, char id) {
    DhdDevice* device = deviceOf(id);
    if (device == nullptr) return -1;
    if (anyNull(wx, wy, wz)) return fail(kNullArgument);
    const DhdHand hand = handOf(*device);
    *wx = hand.spin[0];
    *wy = hand.spin[1];
    *wz = hand.spin[2];
    return 0;
}

EXPORT int dhdGetGripperAngleRad(double* angle, char id) {
    DhdDevice* device = deviceOf(id);
    if (device == nullptr) return -1;
    if (angle == nullptr) return fail(kNullArgument);
    if (!dhdHasGripper(id)) return fail(kNotAvailable);
    *angle = handOf(*device).grip_angle;
    return 0;
}

EXPORT int dhdGetGripperGap(double* gap, char id) {
    DhdDevice* device = deviceOf(id);
    if (device == nullptr) return -1;
    if (gap == nullptr) return fail(kNullArgument);
    if (!dhdHasGripper(id)) return fail(kNotAvailable);
    *gap = handOf(*device).grip_gap;
    return 0;
}

EXPORT unsigned dhdGetButtonMask(char id) {
    DhdDevice* device = deviceOf(id);
    return device == nullptr ? 0u : static_cast<unsigned>(handOf(*device).buttons);
}

EXPORT int dhdGetButton(int index, char id) {
    DhdDevice* device = deviceOf(id);
    if (device == nullptr) return -1;
    if (index < 0 || index >= 16) return fail(kInvalidIndex);
    return static_cast<int>(static_cast<unsigned>(handOf(*device).buttons) >> index & 1u);
}

EXPORT int dhdSetForceAndTorqueAndGripperForce(double fx, double fy, double fz, double tx, double ty, double tz,
                                               double fg, char id) {
    DhdDevice* device = deviceOf(id);
    if (device == nullptr) return -1;
    DhdCommand command;
    command.call = static_cast<double>(device->commands.count() + 1);
    const double asked[7] = {fx, fy, fz, tx, ty, tz, fg};
    bool finite = true;
    for (int i = 0; i < 7; ++i) {
        command.asked[i] = asked[i];
        finite = finite && std::isfinite(asked[i]);
        command.felt[i] = asked[i] * (block->millinewtonmetres && i >= 3 && i < 6 ? 1e-3 : 1.0);
    }
    if (!finite) ++device->non_finite;
    bool saturated = limit(command.felt, device->max_force);
    saturated = limit(command.felt + 3, device->max_torque) || saturated;
    if (!device->forces_enabled || device->brakes) std::fill(command.felt, command.felt + 7, 0.0);
    device->commands.push(command);
    return saturated ? 2 : block->call_result.load();
}

EXPORT int dhdSetForceAndTorque(double fx, double fy, double fz, double tx, double ty, double tz, char id) {
    return dhdSetForceAndTorqueAndGripperForce(fx, fy, fz, tx, ty, tz, 0.0, id);
}

EXPORT int dhdSetForce(double fx, double fy, double fz, char id) {
    return dhdSetForceAndTorqueAndGripperForce(fx, fy, fz, 0.0, 0.0, 0.0, 0.0, id);
}

EXPORT int dhdSetMaxForce(double most, char id) {
    DhdDevice* device = deviceOf(id);
    if (device == nullptr) return -1;
    device->max_force = most;
    return 0;
}

EXPORT int dhdSetMaxTorque(double most, char id) {
    DhdDevice* device = deviceOf(id);
    if (device == nullptr) return -1;
    device->max_torque = most;
    return 0;
}

EXPORT int dhdSetWatchdog(unsigned char milliseconds, char id) {
    DhdDevice* device = deviceOf(id);
    if (device == nullptr) return -1;
    device->watchdog_ms = milliseconds;
    return 0;
}

EXPORT int dhdEnableExpertMode() {
    attach();
    if (block == nullptr) return fail(kError);
    block->expert = true;
    return 0;
}

EXPORT int dhdDisableExpertMode() {
    if (block == nullptr) return fail(kError);
    block->expert = false;
    return 0;
}

EXPORT int dhdSetVelocityThreshold(unsigned, char id) {
    if (deviceOf(id) == nullptr) return -1;
    return block->expert ? 0 : fail(kExpertModeDisabled);
}

EXPORT int dhdSetTimeGuard(int, char id) {
    if (deviceOf(id) == nullptr) return -1;
    return block->expert ? 0 : fail(kExpertModeDisabled);
}

EXPORT int dhdSetVibration(double frequency, double amplitude, int, char id) {
    DhdDevice* device = deviceOf(id);
    if (device == nullptr) return -1;
    device->vibration_hz = frequency;
    device->vibration_amplitude = amplitude;
    return 0;
}

EXPORT double dhdGetComFreq(char id) { return deviceOf(id) == nullptr ? 0.0 : 4.0; }  // [kHz]

EXPORT double dhdGetTime() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

EXPORT int drdOpenID(char id) { return dhdOpenID(id); }

EXPORT int drdClose(char id) { return dhdClose(id); }

EXPORT bool drdIsInitialized(char id) { return deviceOf(id) != nullptr; }

EXPORT int drdAutoInit(char id) { return deviceOf(id) == nullptr ? -1 : 0; }

EXPORT int drdStop(bool, char id) { return deviceOf(id) == nullptr ? -1 : 0; }
