#include <time.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <thread>

#include "tests/devices/fakes/virtuose_block.h"

/// Functions with the names and units of Haption's VirtuoseAPI 4.04, in an archive, as the public kit for Linux is: m,
/// quaternion x, y, z, w, N, N·m, s, 32-bit numbers; 0 on success, -1 on failure with a number that
/// virtGetErrorCode gives. virtSetPeriodicFunction and virtStartLoop call back in a thread of their own.
///
/// Our readings: a force in another mode than impedance is an error; the force factor multiplies what is asked.
namespace {

using passung::fake::VirtuoseBlock;
using passung::fake::VirtuoseCommand;
using passung::fake::VirtuoseFault;
using passung::fake::VirtuoseHand;
using Context = void*;
using Periodic = void (*)(Context, void*);

constexpr int kCommunicationFailure = 2, kInvalidContext = 3, kIncorrectValue = 9, kWrongMode = 17, kAlreadyCalled = 22;
constexpr int kImpedance = 3;

VirtuoseBlock* block = nullptr;
char path_of_block[256] = "";
VirtuoseHand kept;
int last_error = 0;
Periodic periodic = nullptr;
void* periodic_data = nullptr;
std::thread loop;
std::atomic<bool> loops = false;

int fail(int error) {
    last_error = error;
    return -1;
}

void attach() {
    const char* path = std::getenv(passung::fake::kVirtuoseVariable);
    if (path == nullptr) path = "";
    if (block != nullptr && std::strcmp(path, path_of_block) == 0) return;
    std::snprintf(path_of_block, sizeof path_of_block, "%s", path);
    block = passung::fake::findBlock<VirtuoseBlock>(passung::fake::kVirtuoseVariable);
    kept = {};
}

/// Is the context ours, and the device there? An error otherwise.
bool serves(Context context) {
    if (block == nullptr || context != block || !block->opened) {
        fail(kInvalidContext);
        return false;
    }
    if (block->fault == VirtuoseFault::Crash) {
        std::signal(SIGSEGV, SIG_DFL);  // whoever watches over this process
        std::raise(SIGSEGV);
    }
    if (!block->plugged || block->fault == VirtuoseFault::Unplugged) {
        fail(kCommunicationFailure);
        return false;
    }
    return true;
}

VirtuoseHand hand() {
    if (block->fault != VirtuoseFault::Frozen) kept = block->hand.load();
    VirtuoseHand now = kept;
    if (block->fault == VirtuoseFault::NotANumber) now.position[1] = std::numeric_limits<double>::quiet_NaN();
    return now;
}

void limit(double* v, double most) {
    const double norm = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (most < 0 || !(norm > most)) return;
    for (int i = 0; i < 3; ++i) v[i] *= most / norm;
}

int position(Context context, float* target) {
    if (!serves(context)) return -1;
    const VirtuoseHand now = hand();
    for (int i = 0; i < 3; ++i) target[i] = static_cast<float>(now.position[i]);
    for (int i = 0; i < 4; ++i) target[3 + i] = static_cast<float>(now.xyzw[i]);
    return 0;
}

int speed(Context context, float* target) {
    if (!serves(context)) return -1;
    const VirtuoseHand now = hand();
    for (int i = 0; i < 6; ++i) target[i] = static_cast<float>(now.speed[i]);
    return 0;
}

int frame(Context context, const float* values) {
    if (!serves(context)) return -1;
    for (int i = 0; i < 7; ++i) {
        if (values[i] != (i == 6 ? 1.0f : 0.0f)) block->foreign_frame = true;
    }
    return 0;
}

void run() {
    while (loops) {
        if (block->stepped) {
            if (!passung::fake::taken(block->go)) continue;
        } else {
            const timespec period{0, static_cast<long>(1e9 * block->period_s)};
            nanosleep(&period, nullptr);
        }
        ++block->ticks;
        periodic(block, periodic_data);
        if (block->stepped) sem_post(&block->done);
    }
}

}  // namespace

extern "C" {

int virtAPIVersion(int* major, int* minor) {
    attach();
    *major = block == nullptr ? 0 : block->version[0].load();
    *minor = block == nullptr ? 0 : block->version[1].load();
    return 0;
}

Context virtOpen(const char* name) {
    attach();
    if (block == nullptr || !block->plugged || std::strchr(name, '#') == nullptr) {  // host#port
        fail(kCommunicationFailure);
        return nullptr;
    }
    block->opened = true;
    last_error = 0;
    return block;
}

int virtClose(Context context) {
    if (block == nullptr || context != block) return fail(kInvalidContext);
    block->opened = false;
    block->power = false;
    return 0;
}

int virtGetErrorCode(Context) { return last_error; }

char* virtGetErrorMessage(int code) {
    static char text[32];
    std::snprintf(text, sizeof text, "error %d", code);
    return text;
}

int virtGetDeviceID(Context context, int* type, int* serial) {
    if (!serves(context)) return -1;
    *type = block->type;
    *serial = block->serial;
    return 0;
}

int virtSetCommandType(Context context, int type) {
    if (!serves(context)) return -1;
    block->command_type = type;
    return 0;
}

int virtSetIndexingMode(Context context, int) { return serves(context) ? 0 : -1; }

int virtSetForceFactor(Context context, float factor) {
    if (!serves(context)) return -1;
    if (!(factor > 0)) return fail(kIncorrectValue);
    block->force_factor = static_cast<double>(factor);
    return 0;
}

int virtSetSpeedFactor(Context context, float factor) {
    if (!serves(context)) return -1;
    return factor > 0 ? 0 : fail(kIncorrectValue);
}

int virtSetTimeStep(Context context, float step) {
    if (!serves(context)) return -1;
    return step > 0 ? 0 : fail(kIncorrectValue);
}

int virtSetBaseFrame(Context context, float* values) { return frame(context, values); }
int virtSetObservationFrame(Context context, float* values) { return frame(context, values); }

int virtSetPowerOn(Context context, int on) {
    if (!serves(context)) return -1;
    block->power = on != 0;
    return 0;
}

int virtGetPowerOn(Context context, int* on) {
    if (!serves(context)) return -1;
    *on = block->power;
    return 0;
}

int virtSetTimeoutValue(Context context, float seconds) {
    if (!serves(context)) return -1;
    block->timeout_s = static_cast<double>(seconds);
    return 0;
}

int virtSaturateTorque(Context context, float force, float moment) {
    if (!serves(context)) return -1;
    block->max_force = static_cast<double>(force);
    block->max_torque = static_cast<double>(moment);
    return 0;
}

int virtGetPosition(Context context, float* target) { return position(context, target); }
int virtGetPhysicalPosition(Context context, float* target) { return position(context, target); }
int virtGetAvatarPosition(Context context, float* target) { return position(context, target); }
int virtGetSpeed(Context context, float* target) { return speed(context, target); }
int virtGetPhysicalSpeed(Context context, float* target) { return speed(context, target); }

int virtGetButton(Context context, int number, int* state) {
    if (!serves(context)) return -1;
    *state = static_cast<int>(static_cast<unsigned>(hand().buttons) >> number & 1u);
    return 0;
}

int virtGetDeadMan(Context context, int* on) {
    if (!serves(context)) return -1;
    *on = hand().dead_man != 0;
    return 0;
}

int virtGetEmergencyStop(Context context, int* on) {
    if (!serves(context)) return -1;
    *on = block->emergency_stop;
    return 0;
}

int virtGetAlarm(Context context, unsigned* alarm) {
    if (!serves(context)) return -1;
    *alarm = block->alarm;
    return 0;
}

int virtSetForce(Context context, float* force) {
    if (!serves(context)) return -1;
    if (block->command_type != kImpedance) return fail(kWrongMode);
    VirtuoseCommand command;
    command.tick = static_cast<double>(block->ticks);
    bool finite = true;
    for (int i = 0; i < 6; ++i) {
        command.asked[i] = static_cast<double>(force[i]);
        command.felt[i] = command.asked[i] * block->force_factor;
        finite = finite && std::isfinite(force[i]);
    }
    if (!finite) ++block->non_finite;
    limit(command.felt, block->max_force);
    limit(command.felt + 3, block->max_torque);
    const bool acts = block->power && !block->emergency_stop && hand().dead_man != 0;
    if (!acts) std::fill(command.felt, command.felt + 6, 0.0);
    block->commands.push(command);
    return 0;
}

int virtSetPeriodicFunction(Context context, Periodic function, float* period, void* data) {
    if (!serves(context)) return -1;
    periodic = function;
    periodic_data = data;
    block->period_s = static_cast<double>(*period);
    return 0;
}

int virtStartLoop(Context context) {
    if (!serves(context)) return -1;
    if (periodic == nullptr || loops) return fail(kAlreadyCalled);
    loops = true;
    loop = std::thread(run);
    return 0;
}

int virtStopLoop(Context context) {
    if (block == nullptr || context != block || !loops) return fail(kInvalidContext);
    loops = false;
    loop.join();
    return 0;
}

}  // extern "C"
