#include <gtest/gtest.h>

#include "tests/devices/fakes/lsl_block.h"
#include "tests/devices/fakes/shim_library.h"

/// The shim of liblsl, called through its names as a program calls the library that it finds at run time. The
/// signatures are written here a second time, so that a slip in the shim is no slip here.
namespace passung {
namespace {

using fake::LslBlock;
using fake::LslOutlet;
using fake::LslSample;
using fake::LslStream;
using fake::SharedBlock;
using fake::ShimLibrary;

struct Lsl {
    explicit Lsl(const char* path = PASSUNG_LSL_SHIM_FILE) : library(path) {}
    ShimLibrary library;
    double (*clock)() = library.get<double()>("lsl_local_clock");
    int (*resolve)(void**, unsigned, const char*, const char*, int, double) =
        library.get<int(void**, unsigned, const char*, const char*, int, double)>("lsl_resolve_byprop");
    void (*forget)(void*) = library.get<void(void*)>("lsl_destroy_streaminfo");
    void* (*inlet)(void*, int, int, int) = library.get<void*(void*, int, int, int)>("lsl_create_inlet");
    void (*close)(void*) = library.get<void(void*)>("lsl_destroy_inlet");
    void (*open)(void*, double, int*) = library.get<void(void*, double, int*)>("lsl_open_stream");
    double (*pull)(void*, double*, int, double,
                   int*) = library.get<double(void*, double*, int, double, int*)>("lsl_pull_sample_d");
    double (*correction)(void*, double, int*) = library.get<double(void*, double, int*)>("lsl_time_correction");

    /// An inlet of the stream with that type, opened.
    void* hear(const char* type) const {
        void* info = nullptr;
        if (resolve(&info, 1, "type", type, 1, 1.0) != 1) return nullptr;
        void* const result = inlet(info, 360, 0, 1);
        forget(info);
        int error = 0;
        open(result, 1.0, &error);
        return error == 0 ? result : nullptr;
    }
};

/// Sends a sample at our time, stamped by the sender's clock.
void send(const LslBlock& block, LslStream& stream, double value) {
    LslSample sample;
    sample.stamp_s = block.clock_s + aheadAt(stream, block.clock_s);
    for (int i = 0; i < stream.channels; ++i) sample.values[i] = value + i;
    stream.sent.push(sample);
}

TEST(LslShim, HasTheNamesOfTheLibraryAndItsVariantLacksOne) {
    // Truth: liblsl's public C interface, by name.
    const ShimLibrary library(PASSUNG_LSL_SHIM_FILE);
    const ShimLibrary incomplete(PASSUNG_LSL_SHIM_INCOMPLETE_FILE);
    for (const char* name :
         {"lsl_library_version",    "lsl_protocol_version",  "lsl_local_clock",        "lsl_resolve_all",
          "lsl_resolve_byprop",     "lsl_create_streaminfo", "lsl_destroy_streaminfo", "lsl_get_name",
          "lsl_get_type",           "lsl_get_source_id",     "lsl_get_channel_count",  "lsl_get_nominal_srate",
          "lsl_get_channel_format", "lsl_create_outlet",     "lsl_destroy_outlet",     "lsl_have_consumers",
          "lsl_push_sample_d",      "lsl_push_sample_dt",    "lsl_push_sample_strt",   "lsl_create_inlet",
          "lsl_destroy_inlet",      "lsl_open_stream",       "lsl_close_stream",       "lsl_set_postprocessing",
          "lsl_time_correction",    "lsl_samples_available", "lsl_pull_sample_d",      "lsl_pull_chunk_d"}) {
        EXPECT_TRUE(library.has(name)) << name;
        EXPECT_EQ(incomplete.has(name), std::string(name) != "lsl_time_correction") << name;
    }
}

TEST(LslShim, FindsNothingWithoutABlockOrAStream) {
    // Truth: invariant.
    const Lsl lsl;
    void* info = nullptr;
    EXPECT_EQ(lsl.resolve(&info, 1, "type", "EMG", 1, 1.0), 0);
    SharedBlock<LslBlock> block(fake::kLslVariable);
    EXPECT_EQ(lsl.resolve(&info, 1, "type", "EMG", 1, 1.0), 0);
    offer(block->streams[0], "forearm", "EMG", 2, 1000.0);
    EXPECT_EQ(lsl.resolve(&info, 1, "type", "Gaze", 1, 1.0), 0);
    ASSERT_EQ(lsl.resolve(&info, 1, "name", "forearm", 1, 1.0), 1);
    EXPECT_EQ(lsl.library.get<int(void*)>("lsl_get_channel_count")(info), 2);
    EXPECT_EQ(lsl.library.get<double(void*)>("lsl_get_nominal_srate")(info), 1000.0);
    EXPECT_STREQ(lsl.library.get<const char*(void*)>("lsl_get_type")(info), "EMG");
    lsl.forget(info);
    EXPECT_EQ(lsl.library.get<int()>("lsl_library_version")(), 116);
}

TEST(LslShim, BringsSamplesWithTheirSendersTimeAndTheCorrectionToOurs) {
    // Truth: closed form: the sender's clock is 5 s ahead and gains 50 ppm; stamp plus correction is our time to the
    // double's last places. A thousand seconds without a new correction are 50 ms.
    SharedBlock<LslBlock> block(fake::kLslVariable);
    LslStream& stream = block->streams[1];
    offer(stream, "forearm", "EMG", 2, 1000.0);
    stream.offset_s = 5.0;
    stream.drift = 50e-6;
    send(*block, stream, 1.0);  // before anybody listens
    const Lsl lsl;
    void* const inlet = lsl.hear("EMG");
    ASSERT_NE(inlet, nullptr);
    double values[2] = {}, first = 0.0;
    int error = 0;
    EXPECT_EQ(lsl.pull(inlet, values, 2, 0.0, &error), 0.0);
    EXPECT_EQ(error, -1);
    for (const double time : {200.0, 700.0, 1200.0}) {
        block->clock_s = time;
        EXPECT_EQ(lsl.clock(), time);
        send(*block, stream, time);
        const double stamp = lsl.pull(inlet, values, 2, 0.0, &error);
        EXPECT_EQ(error, 0);
        EXPECT_EQ(values[0], time);
        EXPECT_EQ(values[1], time + 1.0);
        const double correction = lsl.correction(inlet, 1.0, &error);
        EXPECT_NEAR(stamp + correction, time, 1e-12 * time);
        if (first == 0.0) first = correction;
        EXPECT_NEAR(stamp + first - time, 50e-6 * (time - 200.0), 1e-9);
    }
    EXPECT_EQ(block->corrections, 3);
    lsl.close(inlet);
}

TEST(LslShim, GivesChunksInTheirOrder) {
    // Truth: invariant.
    SharedBlock<LslBlock> block(fake::kLslVariable);
    LslStream& stream = block->streams[0];
    offer(stream, "plate", "Force", 3, 500.0);
    const Lsl lsl;
    void* const inlet = lsl.hear("Force");
    ASSERT_NE(inlet, nullptr);
    for (int i = 0; i < 5; ++i) send(*block, stream, 10.0 * i);
    EXPECT_EQ(lsl.library.get<unsigned(void*)>("lsl_samples_available")(inlet), 5u);
    const auto chunk =
        lsl.library.get<unsigned long(void*, double*, double*, unsigned long, unsigned long, double, int*)>(
            "lsl_pull_chunk_d");
    double values[12] = {}, stamps[8] = {};
    int error = 0;
    EXPECT_EQ(chunk(inlet, values, stamps, 12, 8, 0.0, &error), 12u);
    EXPECT_EQ(values[9], 30.0);
    EXPECT_EQ(values[11], 32.0);
    EXPECT_EQ(stamps[3], 100.0);
    EXPECT_EQ(chunk(inlet, values, stamps, 12, 8, 0.0, &error), 3u);
    EXPECT_EQ(values[0], 40.0);
    EXPECT_EQ(chunk(inlet, values, stamps, 12, 8, 0.0, &error), 0u);
    EXPECT_EQ(error, 0);
    EXPECT_EQ(lsl.pull(inlet, values, 2, 0.0, &error), 0.0) << "too few places";
    EXPECT_EQ(error, -3);
    lsl.close(inlet);
}

TEST(LslShim, SaysThatAStreamIsLostAndFindsItAgain) {
    // Truth: liblsl's public C interface: -2.
    SharedBlock<LslBlock> block(fake::kLslVariable);
    LslStream& stream = block->streams[0];
    offer(stream, "eye", "Gaze", 1, 0.0);
    const Lsl lsl;
    void* const inlet = lsl.hear("Gaze");
    ASSERT_NE(inlet, nullptr);
    stream.lost = true;
    double value = 0.0;
    int error = 0;
    EXPECT_EQ(lsl.pull(inlet, &value, 1, 0.0, &error), 0.0);
    EXPECT_EQ(error, -2);
    lsl.correction(inlet, 0.0, &error);
    EXPECT_EQ(error, -2);
    EXPECT_EQ(lsl.hear("Gaze"), nullptr);
    stream.lost = false;
    send(*block, stream, 7.0);
    EXPECT_EQ(lsl.pull(inlet, &value, 1, 0.0, &error), 100.0);
    EXPECT_EQ(value, 7.0);
    lsl.close(inlet);
}

TEST(LslShim, KeepsWhatIsPushed) {
    // Truth: liblsl's public C interface: a time of zero is now.
    SharedBlock<LslBlock> block(fake::kLslVariable);
    const Lsl lsl;
    const auto describe =
        lsl.library.get<void*(const char*, const char*, int, double, int, const char*)>("lsl_create_streaminfo");
    const auto make = lsl.library.get<void*(void*, int, int)>("lsl_create_outlet");
    void* info = describe("Passung ticks", "Haptics", 3, 1000.0, 2, "passung-1");
    void* const ticks = make(info, 0, 360);
    lsl.forget(info);
    info = describe("Passung events", "Markers", 1, 0.0, 3, "passung-2");
    void* const events = make(info, 0, 360);
    lsl.forget(info);
    ASSERT_NE(ticks, nullptr);
    const double values[3] = {1.0, 2.0, 3.0};
    EXPECT_EQ(lsl.library.get<int(void*, const double*)>("lsl_push_sample_d")(ticks, values), 0);
    EXPECT_EQ(lsl.library.get<int(void*, const double*, double)>("lsl_push_sample_dt")(ticks, values, 99.5), 0);
    const char* text = "trial 3 begins";
    EXPECT_EQ(lsl.library.get<int(void*, const char**, double)>("lsl_push_sample_strt")(events, &text, 0.0), 0);
    const LslOutlet& kept = block->outlets[0];
    EXPECT_STREQ(kept.name, "Passung ticks");
    EXPECT_EQ(kept.channels, 3);
    ASSERT_EQ(kept.pushed.count(), 2);
    EXPECT_EQ(kept.pushed.row(0).stamp_s, 100.0);
    EXPECT_EQ(kept.pushed.row(1).stamp_s, 99.5);
    EXPECT_EQ(kept.pushed.row(1).values[2], 3.0);
    EXPECT_STREQ(block->outlets[1].pushed.last().text, "trial 3 begins");
    EXPECT_EQ(block->outlets[1].format, 3);
    lsl.library.get<void(void*)>("lsl_destroy_outlet")(ticks);
    EXPECT_TRUE(kept.destroyed);
}

}  // namespace
}  // namespace passung
