#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>

#include "tests/devices/fakes/shared_block.h"

namespace passung::fake {

constexpr const char* kLslVariable = "PASSUNG_LSL_SHIM";
constexpr int kLslStreams = 3;
constexpr int kLslOutlets = 3;
constexpr std::size_t kLslChannels = 16;
constexpr std::size_t kLslText = 64;

/// A sample on its way, with the time of the sender's clock.
struct LslSample {
    double stamp_s = 0;
    double values[kLslChannels] = {};
    char text[kLslText] = {};  // of a stream of strings
};

/// A stream that another program sends. Its clock is ours plus `offset_s`, which grows by `drift` a second.
struct LslStream {
    char name[kLslText] = "", type[kLslText] = "", source[kLslText] = "";
    int channels = 1;
    double rate_hz = 0;  // 0: irregular
    int format = 2;      // 2: doubles, 3: strings
    std::atomic<bool> present = false;
    std::atomic<bool> lost = false;
    std::atomic<double> offset_s = 0, drift = 0;
    SharedRing<LslSample> sent;
};

/// A stream that the program under test sends.
struct LslOutlet {
    std::atomic<bool> made = false, destroyed = false;
    char name[kLslText] = "", type[kLslText] = "", source[kLslText] = "";
    int channels = 0;
    double rate_hz = 0;
    int format = 0;
    SharedRing<LslSample> pushed;
};

/// Time is virtual: `clock_s` is lsl_local_clock.
struct LslBlock {
    std::array<LslStream, kLslStreams> streams;
    std::array<LslOutlet, kLslOutlets> outlets;
    std::atomic<double> clock_s = 100;
    std::atomic<int> library_version = 116, protocol_version = 110;
    std::atomic<bool> consumers = true;
    std::atomic<std::int64_t> corrections = 0;  // calls of lsl_time_correction
};

/// A stream appears.
inline void offer(LslStream& stream, const char* name, const char* type, int channels, double rate_hz) {
    std::strncpy(stream.name, name, kLslText - 1);
    std::strncpy(stream.type, type, kLslText - 1);
    std::strncpy(stream.source, name, kLslText - 1);
    stream.channels = channels;
    stream.rate_hz = rate_hz;
    stream.present = true;
}

/// What the stream's clock adds to ours at that time of ours.
inline double aheadAt(const LslStream& stream, double clock_s) {
    return stream.offset_s + stream.drift * (clock_s - 100.0);
}

}  // namespace passung::fake
