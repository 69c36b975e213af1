#include <signal.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tests/devices/fakes/hd_block.h"

/// Functions with the names, types and units of OpenHaptics' HD interface: mm, mm/s, N, mN·m, N/mm; transforms of 16
/// doubles, column by column. The scheduler has a thread of its own, which calls the callbacks; a frame keeps the hand
/// as it was at its beginning and commands at its end. Errors go to a stack, the newest first out.
///
/// Our readings: state that is asked for outside a frame is an error and writes nothing; a frame in which no force is
/// set commands none; what was commanded stands until the next frame. A force above the device's limit without
/// HD_MAX_FORCE_CLAMPING is an error and switches the output off.
namespace {

using passung::fake::HdBlock;
using passung::fake::HdCommand;
using passung::fake::HdDevice;
using passung::fake::HdFault;
using passung::fake::HdHand;

using HDenum = unsigned;
using HHD = unsigned;
using HDCallback = unsigned (*)(void*);

struct HDErrorInfo {
    unsigned code;
    int internal_code;
    HHD device;
};

constexpr unsigned kSuccess = 0, kInvalidEnum = 0x100, kInvalidValue = 0x101, kInvalidOperation = 0x102,
                   kInvalidInputType = 0x103, kBadHandle = 0x104, kWarmMotors = 0x200, kExceededMaxForce = 0x201,
                   kDeviceFault = 0x300, kAlreadyInitiated = 0x301, kCommunication = 0x302, kIllegalBegin = 0x400,
                   kIllegalEnd = 0x401, kFrameError = 0x402;
constexpr HHD kInvalidHandle = 0xFFFFFFFF;

struct Frame {
    bool open = false;
    HdHand hand;
    double force[3] = {};
    double torque[3] = {};
};

struct Task {
    HDCallback callback;
    void* data;
    unsigned short priority;
    unsigned long handle;
};

HdBlock* block = nullptr;
char path_of_block[256] = "";
HHD current = kInvalidHandle;
Frame frames[passung::fake::kHdDevices];
HdHand kept[passung::fake::kHdDevices];
std::vector<HDErrorInfo> errors;
std::mutex errors_mutex;
std::vector<Task> tasks;
std::recursive_mutex tasks_mutex;
unsigned long next_handle = 1;
std::thread* scheduler = nullptr;
std::atomic<bool> scheduled = false;

void attach() {
    const char* path = std::getenv(passung::fake::kHdVariable);
    if (path == nullptr) path = "";
    if (block != nullptr && std::strcmp(path, path_of_block) == 0) return;
    std::snprintf(path_of_block, sizeof path_of_block, "%s", path);
    block = passung::fake::findBlock<HdBlock>(passung::fake::kHdVariable);
    current = kInvalidHandle;
    for (Frame& frame : frames) frame = {};
    for (HdHand& hand : kept) hand = {};
    errors.clear();
}

void fail(unsigned code) {
    const std::lock_guard lock(errors_mutex);
    errors.push_back({code, static_cast<int>(code), current});
    if (block == nullptr) return;
    block->last_error = code;
    ++block->errors;
}

/// The device of a handle; null and an error if there is none.
HdDevice* deviceOf(HHD handle) {
    if (block == nullptr || handle >= static_cast<HHD>(block->present) || !block->devices[handle].opened) {
        fail(kBadHandle);
        return nullptr;
    }
    return &block->devices[handle];
}

HdFault faultOf(const HdDevice& device) {
    return block->ticks >= device.fault_at_tick ? device.fault.load() : HdFault::None;
}

Frame* openFrame() {
    if (deviceOf(current) == nullptr) return nullptr;
    if (frames[current].open) return &frames[current];
    fail(kFrameError);
    return nullptr;
}

void tick() {
    ++block->ticks;
    if (block->stalled) return;
    const std::lock_guard lock(tasks_mutex);
    const std::vector<Task> now = tasks;
    for (const Task& task : now) {
        ++block->calls;
        if (task.callback(task.data) != 0) continue;  // HD_CALLBACK_CONTINUE
        std::erase_if(tasks, [&](const Task& other) { return other.handle == task.handle; });
    }
}

void schedule() {
    while (scheduled) {
        if (block->stepped) {
            if (!passung::fake::taken(block->go)) continue;
            tick();
            sem_post(&block->done);
        } else {
            const timespec period{0, 1000000000L / block->granted_rate};
            nanosleep(&period, nullptr);
            tick();
        }
    }
}

double length(const double* v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

/// Applies a limit to three components. False if they exceed it and are not to be shortened.
bool limit(double* v, double most, bool clamping) {
    const double norm = length(v);
    if (!(norm > most)) return true;
    if (!clamping) return false;
    for (int i = 0; i < 3; ++i) v[i] *= most / norm;
    return true;
}

/// The numbers of a parameter; how many there are, 0 and an error if it has none.
int numbersOf(HDenum name, double* numbers) {
    HdDevice* device = deviceOf(current);
    if (device == nullptr) return 0;
    const double unit = block->metres ? 1.0 : 1000.0;
    switch (name) {   // what needs no frame
        case 0x2600:  // HD_UPDATE_RATE
        case 0x2601:  // HD_INSTANTANEOUS_UPDATE_RATE
            numbers[0] = block->granted_rate;
            return 1;
        case 0x2602:  // HD_NOMINAL_MAX_STIFFNESS [N/mm]
            numbers[0] = 0.7;
            return 1;
        case 0x2603:  // HD_NOMINAL_MAX_FORCE
            numbers[0] = device->max_force;
            return 1;
        case 0x2604:  // HD_NOMINAL_MAX_CONTINUOUS_FORCE
            numbers[0] = 0.88;
            return 1;
        case 0x2609:  // HD_NOMINAL_MAX_DAMPING [N s/mm]
            numbers[0] = 0.005;
            return 1;
        case 0x2622:  // HD_NOMINAL_MAX_TORQUE_FORCE [mN·m]
            numbers[0] = device->max_torque;
            return 1;
        case 0x2550:    // HD_MAX_WORKSPACE_DIMENSIONS
        case 0x2551: {  // HD_USABLE_WORKSPACE_DIMENSIONS: least x y z, most x y z
            const double half[3] = {0.080, 0.060, 0.035};
            for (int i = 0; i < 3; ++i) {
                numbers[i] = -half[i] * unit;
                numbers[i + 3] = half[i] * unit;
            }
            return 6;
        }
        default:
            break;
    }
    Frame* frame = nullptr;
    switch (name) {
        case 0x2050:
        case 0x2051:
        case 0x2052:
        case 0x2053:
        case 0x2150:
        case 0x2700:
        case 0x2701:
            frame = openFrame();
            break;
        default:
            fail(kInvalidEnum);
            return 0;
    }
    if (frame == nullptr) return 0;
    const HdHand& hand = frame->hand;
    switch (name) {
        case 0x2050:  // HD_CURRENT_POSITION
            for (int i = 0; i < 3; ++i) numbers[i] = hand.position[i] * unit;
            return 3;
        case 0x2051:  // HD_CURRENT_VELOCITY
            for (int i = 0; i < 3; ++i) numbers[i] = hand.velocity[i] * unit;
            return 3;
        case 0x2052:  // HD_CURRENT_TRANSFORM
            for (int row = 0; row < 3; ++row) {
                for (int column = 0; column < 3; ++column) numbers[4 * column + row] = hand.frame[3 * row + column];
                numbers[12 + row] = hand.position[row] * unit;
                numbers[4 * row + 3] = 0.0;
            }
            numbers[15] = 1.0;
            return 16;
        case 0x2053:  // HD_CURRENT_ANGULAR_VELOCITY
            std::copy(hand.spin, hand.spin + 3, numbers);
            return 3;
        case 0x2150:  // HD_CURRENT_GIMBAL_ANGLES
            std::copy(hand.gimbal, hand.gimbal + 3, numbers);
            return 3;
        case 0x2700:
            std::copy(frame->force, frame->force + 3, numbers);
            return 3;
        default:
            std::copy(frame->torque, frame->torque + 3, numbers);
            return 3;
    }
}

template <typename Number>
void give(HDenum name, Number* target) {
    double numbers[16] = {};
    const int count = numbersOf(name, numbers);
    for (int i = 0; i < count; ++i) target[i] = static_cast<Number>(numbers[i]);
}

void switchOn(HDenum what, bool on) {
    HdDevice* device = deviceOf(current);
    if (device == nullptr) return;
    switch (what) {
        case 0x4000:
            device->force_output = on;
            break;
        case 0x4001:
            device->clamping = on;
            break;
        case 0x4002:
            device->ramping = on;
            break;
        case 0x2606:
        case 0x2607:
        case 0x4003:
        case 0x4004:
            break;
        default:
            fail(kInvalidEnum);
    }
}

}  // namespace

#define EXPORT extern "C" __attribute__((visibility("default")))

EXPORT HHD hdInitDevice(const char* name) {
    attach();
    if (block == nullptr) {
        fail(kDeviceFault);
        return kInvalidHandle;
    }
    const char* const names[] = {"Default Device", "Left Device"};
    for (HHD place = 0; place < static_cast<HHD>(block->present); ++place) {
        if (name != nullptr && std::strcmp(name, names[place]) != 0) continue;
        const HHD handle = block->swapped ? static_cast<HHD>(block->present) - 1 - place : place;
        HdDevice& device = block->devices[handle];
        if (device.opened && (device.owner == getpid() || kill(device.owner, 0) == 0)) {
            fail(kAlreadyInitiated);
            return kInvalidHandle;
        }
        if (!device.plugged || faultOf(device) == HdFault::Unplugged) break;
        device.opened = true;
        device.owner = getpid();
        current = handle;
        return handle;
    }
    fail(kDeviceFault);
    return kInvalidHandle;
}

EXPORT void hdDisableDevice(HHD handle) {
    HdDevice* device = deviceOf(handle);
    if (device == nullptr) return;
    device->opened = false;
    device->force_output = false;
    frames[handle] = {};
}

EXPORT void hdMakeCurrentDevice(HHD handle) {
    if (deviceOf(handle) != nullptr) current = handle;
}

EXPORT HHD hdGetCurrentDevice() { return current; }

EXPORT void hdBeginFrame(HHD handle) {
    HdDevice* device = deviceOf(handle);
    if (device == nullptr) return;
    current = handle;
    Frame& frame = frames[handle];
    if (frame.open) return fail(kIllegalBegin);
    const HdFault fault = faultOf(*device);
    if (fault == HdFault::Crash) {
        signal(SIGSEGV, SIG_DFL);  // whoever watches over this process
        raise(SIGSEGV);
    }
    if (!device->plugged || fault == HdFault::Unplugged) return fail(kCommunication);
    if (fault == HdFault::WarmMotors) fail(kWarmMotors);
    if (fault != HdFault::Frozen) kept[handle] = device->hand.load();
    frame = {};
    frame.open = true;
    frame.hand = kept[handle];
    if (fault == HdFault::NotANumber) frame.hand.position[1] = std::numeric_limits<double>::quiet_NaN();
    ++device->frames;
}

EXPORT void hdEndFrame(HHD handle) {
    HdDevice* device = deviceOf(handle);
    if (device == nullptr) return;
    Frame& frame = frames[handle];
    if (!frame.open) return fail(kIllegalEnd);
    frame.open = false;
    HdCommand command;
    command.tick = static_cast<double>(block->ticks);
    bool finite = true;
    for (int i = 0; i < 3; ++i) {
        command.asked[i] = command.felt[i] = frame.force[i];
        command.asked[i + 3] = frame.torque[i];
        command.felt[i + 3] = frame.torque[i] * (block->newtonmetres ? 1.0 : 1e-3);
        finite = finite && std::isfinite(frame.force[i]) && std::isfinite(frame.torque[i]);
    }
    if (!finite) ++device->non_finite;
    const bool fits = limit(command.felt, device->max_force, device->clamping) &&
                      limit(command.felt + 3, 1e-3 * device->max_torque, device->clamping);
    if (!fits) {
        fail(kExceededMaxForce);
        device->force_output = false;
    }
    if (!device->force_output) std::fill(command.felt, command.felt + 6, 0.0);
    if (device->output_degrees < 6) std::fill(command.felt + 3, command.felt + 6, 0.0);
    device->commands.push(command);
}

EXPORT void hdGetDoublev(HDenum name, double* target) { give(name, target); }

EXPORT void hdGetFloatv(HDenum name, float* target) { give(name, target); }

EXPORT void hdGetIntegerv(HDenum name, int* target) {
    HdDevice* device = deviceOf(current);
    if (device == nullptr) return;
    switch (name) {
        case 0x2000: {  // HD_CURRENT_BUTTONS
            const Frame* frame = openFrame();
            if (frame != nullptr) *target = static_cast<int>(frame->hand.buttons);
            break;
        }
        case 0x2553:
            *target = 6;
            break;  // HD_INPUT_DOF
        case 0x2554:
            *target = device->output_degrees;
            break;  // HD_OUTPUT_DOF
        case 0x2555:
            *target = 2;
            break;  // HD_CALIBRATION_STYLE: by itself
        case 0x2600:
        case 0x2601:
            give(name, target);
            break;
        default:
            fail(kInvalidEnum);
    }
}

EXPORT void hdGetBooleanv(HDenum name, unsigned char* target) {
    if (name == 0x2001 || name == 0x2002) {  // safety and inkwell switches
        *target = 0;
    } else {
        fail(kInvalidInputType);
    }
}

EXPORT const char* hdGetString(HDenum name) {
    static std::string serial;
    const HdDevice* device = deviceOf(current);
    if (device == nullptr) return "";
    switch (name) {
        case 0x2500:
            return "3.4.0";  // HD_VERSION
        case 0x2501:
            return device->output_degrees == 6 ? "Premium 6DOF" : "Touch";
        case 0x2502:
            return "1.0";
        case 0x2503:
            return "shim";
        case 0x2504:
            serial = std::to_string(device->serial);
            return serial.c_str();
        default:
            fail(kInvalidEnum);
            return "";
    }
}

EXPORT void hdSetDoublev(HDenum name, const double* values) {
    if (name == 0x2606 || name == 0x2607 || name == 0x2608) return;  // limits and ramp of the software
    if (name != 0x2700 && name != 0x2701 && name != 0x2704) return fail(kInvalidEnum);
    Frame* frame = openFrame();
    if (frame == nullptr) return;
    std::copy(values, values + 3, name == 0x2700 ? frame->force : frame->torque);
}

EXPORT void hdSetFloatv(HDenum name, const float* values) {
    const double numbers[3] = {values[0], values[1], values[2]};
    hdSetDoublev(name, numbers);
}

EXPORT void hdEnable(HDenum what) { switchOn(what, true); }

EXPORT void hdDisable(HDenum what) { switchOn(what, false); }

EXPORT unsigned char hdIsEnabled(HDenum what) {
    const HdDevice* device = deviceOf(current);
    if (device == nullptr) return 0;
    if (what == 0x4000) return device->force_output;
    if (what == 0x4001) return device->clamping;
    return what == 0x4002 && device->ramping;
}

EXPORT HDErrorInfo hdGetError() {
    const std::lock_guard lock(errors_mutex);
    if (errors.empty()) return {kSuccess, 0, kInvalidHandle};
    const HDErrorInfo error = errors.back();
    errors.pop_back();
    return error;
}

EXPORT const char* hdGetErrorString(unsigned code) {
    switch (code) {
        case kSuccess:
            return "no error";
        case kDeviceFault:
            return "device fault";
        case kCommunication:
            return "communication error";
        case kExceededMaxForce:
            return "maximum force exceeded";
        default:
            return "another error";
    }
}

EXPORT unsigned hdCheckCalibration() {
    const HdDevice* device = deviceOf(current);
    return device == nullptr ? 0x5001u : device->calibration.load();
}

EXPORT void hdUpdateCalibration(HDenum) {
    HdDevice* device = deviceOf(current);
    if (device != nullptr) device->calibration = 0x5000;
}

EXPORT void hdStartScheduler() {
    if (block == nullptr || scheduled) return fail(kInvalidOperation);
    scheduled = true;
    scheduler = new std::thread(schedule);
}

EXPORT void hdStopScheduler() {
    if (!scheduled) return fail(kInvalidOperation);
    scheduled = false;
    scheduler->join();
    delete scheduler;
    scheduler = nullptr;
    const std::lock_guard lock(tasks_mutex);
    tasks.clear();
}

EXPORT void hdSetSchedulerRate(unsigned long rate) {
    if (block == nullptr || rate != static_cast<unsigned long>(block->granted_rate)) fail(kInvalidValue);
}

EXPORT double hdGetSchedulerTimeStamp() { return 0.0; }

EXPORT unsigned long hdScheduleAsynchronous(HDCallback callback, void* data, unsigned short priority) {
    const std::lock_guard lock(tasks_mutex);
    const auto before = std::find_if(tasks.begin(), tasks.end(), [&](const Task& t) { return t.priority < priority; });
    tasks.insert(before, {callback, data, priority, next_handle});
    return next_handle++;
}

EXPORT void hdScheduleSynchronous(HDCallback callback, void* data, unsigned short) {
    // Between two ticks, in the caller's thread while the scheduler's waits: as far apart as the caller can see.
    const std::lock_guard lock(tasks_mutex);
    while (callback(data) != 0) {
    }
}

EXPORT unsigned char hdUnschedule(unsigned long handle) {
    const std::lock_guard lock(tasks_mutex);
    const auto gone = std::erase_if(tasks, [&](const Task& task) { return task.handle == handle; });
    if (gone == 0) fail(kInvalidValue);
    return gone != 0;
}
