#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "tests/devices/fakes/lsl_block.h"

/// Functions with the names and results of liblsl's public C interface (1.16): times in seconds of lsl_local_clock,
/// 0 for no sample, error numbers 0, -1 (timeout), -2 (lost), -3 (argument).
///
/// A sample's time is that of its sender's clock; lsl_time_correction is what is to be added to it. Nothing waits: the
/// time is virtual, so that a timeout has passed as soon as it is asked for. lsl_set_postprocessing is kept from
/// changing times.
namespace {

using passung::fake::LslBlock;
using passung::fake::LslOutlet;
using passung::fake::LslSample;
using passung::fake::LslStream;

constexpr std::int32_t kTimeout = -1, kLost = -2, kArgument = -3;
constexpr int kString = 3;

struct Info {
    char name[passung::fake::kLslText] = "", type[passung::fake::kLslText] = "", source[passung::fake::kLslText] = "";
    int channels = 0;
    double rate_hz = 0;
    int format = 0;
    int stream = -1;  // of the block; -1 for what is to be an outlet
};

struct Inlet {
    int stream;
    std::int64_t next;
    bool opened;
};

LslBlock* block = nullptr;
char path_of_block[256] = "";

void attach() {
    const char* path = std::getenv(passung::fake::kLslVariable);
    if (path == nullptr) path = "";
    if (block != nullptr && std::strcmp(path, path_of_block) == 0) return;
    std::snprintf(path_of_block, sizeof path_of_block, "%s", path);
    block = passung::fake::findBlock<LslBlock>(passung::fake::kLslVariable);
}

void say(std::int32_t* error, std::int32_t code) {
    if (error != nullptr) *error = code;
}

Info* infoOf(int number) {
    const LslStream& stream = block->streams[static_cast<std::size_t>(number)];
    Info* info = new Info;
    std::memcpy(info->name, stream.name, sizeof info->name);
    std::memcpy(info->type, stream.type, sizeof info->type);
    std::memcpy(info->source, stream.source, sizeof info->source);
    info->channels = stream.channels;
    info->rate_hz = stream.rate_hz;
    info->format = stream.format;
    info->stream = number;
    return info;
}

/// The stream of an inlet; null and an error if it is gone.
LslStream* streamOf(const Inlet* inlet, std::int32_t* error) {
    LslStream& stream = block->streams[static_cast<std::size_t>(inlet->stream)];
    say(error, stream.lost || !stream.present ? kLost : 0);
    return stream.lost || !stream.present ? nullptr : &stream;
}

/// Opens an inlet where it was not: what was sent before is not heard.
void listen(Inlet* inlet, const LslStream& stream) {
    if (inlet->opened) return;
    inlet->opened = true;
    inlet->next = stream.sent.count();
}

std::int32_t push(LslOutlet* outlet, const double* values, const char* text, double stamp) {
    if (outlet == nullptr) return kArgument;
    LslSample sample;
    sample.stamp_s = stamp == 0.0 ? block->clock_s.load() : stamp;
    if (values != nullptr) std::copy(values, values + outlet->channels, sample.values);
    if (text != nullptr) std::snprintf(sample.text, sizeof sample.text, "%s", text);
    outlet->pushed.push(sample);
    return 0;
}

}  // namespace

#define EXPORT extern "C" __attribute__((visibility("default")))

EXPORT std::int32_t lsl_library_version() {
    attach();
    return block == nullptr ? 0 : block->library_version.load();
}

EXPORT std::int32_t lsl_protocol_version() {
    attach();
    return block == nullptr ? 0 : block->protocol_version.load();
}

EXPORT double lsl_local_clock() {
    attach();
    return block == nullptr ? 0.0 : block->clock_s.load();
}

EXPORT std::int32_t lsl_resolve_all(void** found, std::uint32_t most, double) {
    attach();
    std::int32_t count = 0;
    for (int i = 0; block != nullptr && i < passung::fake::kLslStreams; ++i) {
        const LslStream& stream = block->streams[static_cast<std::size_t>(i)];
        if (stream.present && !stream.lost && static_cast<std::uint32_t>(count) < most) found[count++] = infoOf(i);
    }
    return count;
}

EXPORT std::int32_t lsl_resolve_byprop(void** found, std::uint32_t most, const char* property, const char* value,
                                       std::int32_t, double) {
    attach();
    std::int32_t count = 0;
    for (int i = 0; block != nullptr && i < passung::fake::kLslStreams; ++i) {
        const LslStream& stream = block->streams[static_cast<std::size_t>(i)];
        const char* own = std::strcmp(property, "name") == 0        ? stream.name
                          : std::strcmp(property, "type") == 0      ? stream.type
                          : std::strcmp(property, "source_id") == 0 ? stream.source
                                                                    : nullptr;
        if (own == nullptr || std::strcmp(own, value) != 0 || !stream.present || stream.lost) continue;
        if (static_cast<std::uint32_t>(count) < most) found[count++] = infoOf(i);
    }
    return count;
}

EXPORT void* lsl_create_streaminfo(const char* name, const char* type, std::int32_t channels, double rate,
                                   std::int32_t format, const char* source) {
    if (channels < 0 || channels > static_cast<std::int32_t>(passung::fake::kLslChannels)) return nullptr;
    Info* info = new Info;
    std::snprintf(info->name, sizeof info->name, "%s", name);
    std::snprintf(info->type, sizeof info->type, "%s", type);
    std::snprintf(info->source, sizeof info->source, "%s", source);
    info->channels = channels;
    info->rate_hz = rate;
    info->format = format;
    return info;
}

EXPORT void lsl_destroy_streaminfo(void* info) { delete static_cast<Info*>(info); }
EXPORT const char* lsl_get_name(void* info) { return static_cast<Info*>(info)->name; }
EXPORT const char* lsl_get_type(void* info) { return static_cast<Info*>(info)->type; }
EXPORT const char* lsl_get_source_id(void* info) { return static_cast<Info*>(info)->source; }
EXPORT std::int32_t lsl_get_channel_count(void* info) { return static_cast<Info*>(info)->channels; }
EXPORT double lsl_get_nominal_srate(void* info) { return static_cast<Info*>(info)->rate_hz; }
EXPORT std::int32_t lsl_get_channel_format(void* info) { return static_cast<Info*>(info)->format; }

EXPORT void* lsl_create_outlet(void* given, std::int32_t, std::int32_t) {
    attach();
    const Info* info = static_cast<Info*>(given);
    if (block == nullptr || info == nullptr) return nullptr;
    for (LslOutlet& outlet : block->outlets) {
        if (outlet.made) continue;
        std::memcpy(outlet.name, info->name, sizeof outlet.name);
        std::memcpy(outlet.type, info->type, sizeof outlet.type);
        std::memcpy(outlet.source, info->source, sizeof outlet.source);
        outlet.channels = info->channels;
        outlet.rate_hz = info->rate_hz;
        outlet.format = info->format;
        outlet.made = true;
        return &outlet;
    }
    return nullptr;
}

EXPORT void lsl_destroy_outlet(void* outlet) { static_cast<LslOutlet*>(outlet)->destroyed = true; }

EXPORT std::int32_t lsl_have_consumers(void*) { return block->consumers ? 1 : 0; }

EXPORT std::int32_t lsl_push_sample_d(void* outlet, const double* values) {
    return push(static_cast<LslOutlet*>(outlet), values, nullptr, 0.0);
}

EXPORT std::int32_t lsl_push_sample_dt(void* outlet, const double* values, double stamp) {
    return push(static_cast<LslOutlet*>(outlet), values, nullptr, stamp);
}

EXPORT std::int32_t lsl_push_sample_strt(void* outlet, const char** texts, double stamp) {
    return push(static_cast<LslOutlet*>(outlet), nullptr, texts[0], stamp);
}

EXPORT void* lsl_create_inlet(void* given, std::int32_t, std::int32_t, std::int32_t) {
    const Info* info = static_cast<Info*>(given);
    if (block == nullptr || info == nullptr || info->stream < 0) return nullptr;
    return new Inlet{info->stream, 0, false};
}

EXPORT void lsl_destroy_inlet(void* inlet) { delete static_cast<Inlet*>(inlet); }

EXPORT void lsl_open_stream(void* given, double, std::int32_t* error) {
    Inlet* inlet = static_cast<Inlet*>(given);
    const LslStream* stream = streamOf(inlet, error);
    if (stream != nullptr) listen(inlet, *stream);
}

EXPORT void lsl_close_stream(void* inlet) { static_cast<Inlet*>(inlet)->opened = false; }

EXPORT std::int32_t lsl_set_postprocessing(void*, std::uint32_t flags) { return flags == 0 ? 0 : kArgument; }

EXPORT double lsl_time_correction(void* inlet, double, std::int32_t* error) {
    const LslStream* stream = streamOf(static_cast<Inlet*>(inlet), error);
    if (stream == nullptr) return 0.0;
    ++block->corrections;
    return -passung::fake::aheadAt(*stream, block->clock_s);
}

EXPORT std::uint32_t lsl_samples_available(void* given) {
    const Inlet* inlet = static_cast<Inlet*>(given);
    if (!inlet->opened) return 0;
    return static_cast<std::uint32_t>(block->streams[static_cast<std::size_t>(inlet->stream)].sent.count() -
                                      inlet->next);
}

EXPORT double lsl_pull_sample_d(void* given, double* values, std::int32_t most, double, std::int32_t* error) {
    Inlet* inlet = static_cast<Inlet*>(given);
    const LslStream* stream = streamOf(inlet, error);
    if (stream == nullptr) return 0.0;
    if (most < stream->channels || stream->format == kString) {
        say(error, kArgument);
        return 0.0;
    }
    listen(inlet, *stream);
    if (inlet->next >= stream->sent.count()) {
        say(error, kTimeout);
        return 0.0;
    }
    const LslSample sample = stream->sent.row(inlet->next++);
    std::copy(sample.values, sample.values + stream->channels, values);
    return sample.stamp_s;
}

EXPORT unsigned long lsl_pull_chunk_d(void* given, double* values, double* stamps, unsigned long most_values,
                                      unsigned long most_stamps, double timeout, std::int32_t* error) {
    const Inlet* inlet = static_cast<Inlet*>(given);
    const auto channels = static_cast<unsigned long>(block->streams[static_cast<std::size_t>(inlet->stream)].channels);
    unsigned long samples = 0;
    while ((samples + 1) * channels <= most_values && samples < most_stamps) {
        const double stamp =
            lsl_pull_sample_d(given, values + samples * channels, static_cast<std::int32_t>(channels), timeout, error);
        if (stamp == 0.0) break;
        stamps[samples++] = stamp;
    }
    if (error != nullptr && *error == kTimeout) *error = 0;
    return samples * channels;
}
