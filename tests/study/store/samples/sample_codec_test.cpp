#include "study/store/samples/sample_codec.h"

#include <gtest/gtest.h>

#include <array>

#include <cmath>
#include <fstream>
#include <limits>

#include "study/store/samples/compression.h"
#include "study/store/samples/planes.h"
#include "tests/study/store/fake_study.h"

namespace passung::store {
namespace {

TEST(SampleCodec, GivesBackEveryStoredBit) {
    // Truth: invariant (decoding inverts encoding)
    for (const std::size_t count : {1u, 2u, 999u, 1000u}) {
        std::vector<TickRecord> records = fake::makeRecords(count, count, 5'000'000'000);
        records[0].device_position_m = {std::nan("7"), -0.0, std::numeric_limits<double>::infinity()};
        records[0].force_N = {std::nanf("7"), -0.0f, std::numeric_limits<float>::denorm_min()};
        std::vector<TickRecord> back;
        ASSERT_TRUE(decodeTicks(encodeTicks(records), back));
        EXPECT_TRUE(fake::sameStoredBits(records, back)) << count;
    }
}

TEST(SampleCodec, KeepsMeasuredDurationsOutOfTheTicksAndInTheirOwnStream) {
    // Truth: invariant
    const std::vector<TickRecord> records = fake::makeRecords(1, 50);
    std::vector<TickRecord> back;
    ASSERT_TRUE(decodeTicks(encodeTicks(records), back));
    for (const TickRecord& record : back) {
        EXPECT_EQ(record.duration_ns, 0);
        EXPECT_EQ(record.processor_ns, 0);
    }
    ASSERT_TRUE(decodeTiming(encodeTiming(records), back));
    for (std::size_t i = 0; i < records.size(); ++i) {
        EXPECT_EQ(back[i].duration_ns, records[i].duration_ns);
        EXPECT_EQ(back[i].processor_ns, records[i].processor_ns);
    }
}

TEST(SampleCodec, ReadsTimesFromBeforeTheProcessorsWasMeasured) {
    // Truth: invariant: the wall clock's as they were, the processor's not measured.
    const auto records = fake::makeRecords(1, 50);
    Chunk old = encodeTiming(records);
    old.data.resize(old.data.size() / 2);
    old.crc32 = crc32(old.data);
    const auto unpacked = unpackTiming(packTiming(old), encodingText());
    ASSERT_TRUE(unpacked);
    std::vector<TickRecord> back;
    ASSERT_TRUE(decodeTicks(encodeTicks(records), back));
    ASSERT_TRUE(decodeTiming(*unpacked, back));
    for (std::size_t i = 0; i < records.size(); ++i) {
        EXPECT_EQ(back[i].duration_ns, records[i].duration_ns);
        EXPECT_EQ(back[i].processor_ns, 0);
    }
}

TEST(SampleCodec, ReadsEffectsFromBeforeOthersCame) {
    // Truth: invariant: the effects that there were as they were, of those that came later nothing.
    const auto records = fake::withEffects(1, fake::makeRecords(1, 50));
    for (const WrenchEffect first_later : {WrenchEffect::Snap, WrenchEffect::Inertia}) {
        const auto known = static_cast<std::size_t>(first_later);
        Chunk old = encodeExtra(Extra::Effects, records);
        old.data.resize(old.data.size() - 6 * sizeof(float) * (kWrenchEffects - known) * records.size());
        old.crc32 = crc32(old.data);
        const auto unpacked = unpackExtra(Extra::Effects, packExtra(Extra::Effects, old), encodingText());
        ASSERT_TRUE(unpacked);
        std::vector<TickRecord> back;
        ASSERT_TRUE(decodeTicks(encodeTicks(records), back));
        ASSERT_TRUE(decodeExtra(Extra::Effects, *unpacked, back));
        for (std::size_t i = 0; i < records.size(); ++i) {
            EXPECT_EQ(back[i].effects, records[i].effects);
            EXPECT_EQ(back[i].guided, records[i].guided);
            for (std::size_t e = 0; e < kWrenchEffects; ++e)
                EXPECT_EQ(back[i].effect_wrench[e], e < known ? records[i].effect_wrench[e] : (std::array<float, 6>{}));
        }
    }
}

TEST(SampleCodec, KeepsWhatFewScenesHaveOutOfTheTicksAndInStreamsOfItsOwn) {
    // Truth: invariant: decoding inverts encoding, by tick; ticks of other scenes have nothing to keep.
    const auto plain = fake::makeRecords(1, 50);
    const std::array of_extra{fake::withNavigation(2, plain), fake::withBodies(2, plain), fake::withEffects(2, plain)};
    static_assert(of_extra.size() == kExtras.size());
    for (const Extra extra : kExtras) {
        const auto& records = of_extra[static_cast<std::size_t>(extra)];
        EXPECT_FALSE(haveExtra(extra, plain));
        EXPECT_TRUE(haveExtra(extra, records));
        std::vector<TickRecord> back;
        ASSERT_TRUE(decodeTicks(encodeTicks(records), back));
        EXPECT_TRUE(fake::sameStoredBits(plain, back));
        const auto unpacked = unpackExtra(extra, packExtra(extra, encodeExtra(extra, records)), encodingText());
        ASSERT_TRUE(unpacked);
        ASSERT_TRUE(decodeExtra(extra, *unpacked, back));
        EXPECT_TRUE(fake::sameStoredBits(records, back));
        for (const std::size_t hand : {0u, 3u}) {
            EXPECT_EQ(extraNamed(extraStreamName(extra, hand)), extra);
            EXPECT_FALSE(isTickStream(extraStreamName(extra, hand)));
        }
    }
    EXPECT_EQ(extraStreamName(Extra::Navigation, 1), "navigation_hand_2");
    EXPECT_EQ(extraStreamName(Extra::Bodies, 0), "bodies");
    EXPECT_EQ(extraStreamName(Extra::Effects, 2), "effects_hand_3");
    EXPECT_FALSE(extraNamed("tick_timing") || extraNamed("tick_hand_2"));
}

TEST(SampleCodec, FindsEveryFlippedBit) {
    // Truth: invariant (a CRC-32 finds every single-bit error)
    const Chunk sound = encodeTicks(fake::makeRecords(2, 3));
    for (std::size_t byte = 0; byte < sound.data.size(); ++byte) {
        for (int bit = 0; bit < 8; ++bit) {
            Chunk damaged = sound;
            damaged.data[byte] ^= static_cast<std::byte>(1 << bit);
            std::vector<TickRecord> back;
            ASSERT_FALSE(decodeTicks(damaged, back)) << byte << " " << bit;
            ASSERT_TRUE(back.empty());
        }
    }
}

TEST(SampleCodec, RefusesAChunkWhoseSizeDoesNotFit) {
    // Truth: invariant
    const Chunk sound = encodeTicks(fake::makeRecords(2, 3));
    std::vector<TickRecord> back;
    Chunk longer = sound;
    longer.count = 4;
    EXPECT_FALSE(decodeTicks(longer, back));
    longer.count = -1;
    EXPECT_FALSE(decodeTicks(longer, back));
    Chunk shorter = sound;
    shorter.data.resize(shorter.data.size() - 1);
    EXPECT_FALSE(decodeTicks(shorter, back));
    EXPECT_TRUE(back.empty());
}

TEST(SampleCodec, LayoutIsWhatItsDescriptionSays) {
    // Truth: invariant (a reader written from encodingText() and the channels alone finds the values)
    const std::vector<TickRecord> records = fake::makeRecords(3, 10);
    const Chunk chunk = encodeTicks(records);
    std::size_t offset = 0;
    int checked = 0;
    for (const Channel& channel : tickChannels()) {
        const std::size_t width = channel.type == "float64" || channel.type == "int64" ? 8 : 4;
        const std::byte* row7 = chunk.data.data() + offset + 7 * width;
        const auto holds = [&](const auto& expected) {
            ++checked;
            return sizeof expected == width && std::memcmp(row7, &expected, width) == 0;
        };
        const TickRecord& r = records[7];
        if (channel.name == "device_z_m") {
            EXPECT_TRUE(holds(r.device_position_m[2]));
        }
        if (channel.name == "device_qw") {
            EXPECT_TRUE(holds(r.device_quaternion[0]));
        }
        if (channel.name == "input_flags") {
            EXPECT_TRUE(holds(r.input_flags));
        }
        if (channel.name == "periods") {
            EXPECT_TRUE(holds(r.periods));
        }
        if (channel.name == "proxy_y_m") {
            EXPECT_TRUE(holds(r.proxy_position_m[1]));
        }
        if (channel.name == "force_x_N") {
            EXPECT_TRUE(holds(r.force_N[0]));
        }
        if (channel.name == "torque_z_Nm") {
            EXPECT_TRUE(holds(r.torque_Nm[2]));
        }
        if (channel.name == "proxy_depth_m") {
            EXPECT_TRUE(holds(r.proxy_depth_m));
        }
        if (channel.name == "nodes_visited") {
            EXPECT_TRUE(holds(r.nodes_visited));
        }
        if (channel.name == "energy_J") {
            EXPECT_TRUE(holds(r.energy_J));
        }
        if (channel.name == "hand_energy_J") {
            EXPECT_TRUE(holds(r.hand_energy_J));
        }
        if (channel.name == "proxy_gap_m") {
            EXPECT_TRUE(holds(r.proxy_gap_m));
        }
        offset += 10 * width;
    }
    EXPECT_EQ(offset, chunk.data.size());
    EXPECT_EQ(checked, 12);
}

TEST(SampleCodec, PackedChunksComeBackAndNeighboursThatDifferLittleTakeLittle) {
    // Truth: invariant; and closed form: 1000 ticks of which only the last bits of one column change are constant
    // planes but for one, which deflate turns into next to nothing.
    const Chunk noise = encodeTicks(fake::makeRecords(5, 700));
    const auto back = unpackTicks(packTicks(noise), encodingText());
    ASSERT_TRUE(back);
    EXPECT_EQ(back->data, noise.data);
    std::vector<TickRecord> still(1000, fake::makeRecords(6, 1).front());
    for (std::size_t i = 0; i < still.size(); ++i) {
        still[i].tick = static_cast<std::int64_t>(i);
        still[i].force_N[0] = 1.0f + 1e-6f * static_cast<float>(i % 8);
    }
    const Chunk raw = encodeTicks(still);
    const Chunk packed = packTicks(raw);
    EXPECT_LT(packed.data.size() * 50, raw.data.size());
    EXPECT_EQ(unpackTicks(packed, encodingText())->data, raw.data);
    const Chunk timing = encodeTiming(still);
    EXPECT_EQ(unpackTiming(packTiming(timing), encodingText())->data, timing.data);
    EXPECT_EQ(unpackTicks(raw, "columns-v1: as it is")->data, raw.data) << "files from before";
}

std::vector<std::byte> bytesOfHex(const std::string& hex) {
    std::vector<std::byte> bytes;
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
        bytes.push_back(static_cast<std::byte>(std::stoi(hex.substr(i, 2), nullptr, 16)));
    return bytes;
}

TEST(SampleCodec, ReadsAChunkOfAFileFromBeforeDifferencesWereStored) {
    // Truth: independent program (Python 3.11, zlib and struct, by what the stream's own encoding said of columns-v2)
    // on a chunk that the program of revision 23 wrote; the columns as it read them.
    std::ifstream file(PASSUNG_SOURCE_DIR "/tests/data/samples/columns_v2.txt");
    Chunk stored;
    std::string blob, columns;
    file >> stored.first_tick >> stored.count >> stored.crc32 >> blob >> columns;
    stored.data = bytesOfHex(blob);
    ASSERT_GT(stored.data.size(), 500u);
    const auto read = unpackTicks(stored, "columns-v2: one blob holds n consecutive ticks ...");
    ASSERT_TRUE(read);
    EXPECT_EQ(read->data, bytesOfHex(columns));
    EXPECT_FALSE(unpackTicks(stored, encodingText())) << "no planes of differences";
}

TEST(SampleCodec, DifferencesAreTakenAsOftenAsLeavesLeast) {
    // Truth: closed form: of a constant once, of a line twice, of a parabola three times nothing but the beginning is
    // left, folded so that 0, -1, 1, -2 are 0, 1, 2, 3; of alternating bits none are taken.
    const std::size_t rows = 6;
    const auto columnOf = [&](auto value) {
        std::vector<std::byte> bytes;
        for (std::uint32_t i = 0; i < rows; ++i) {
            const std::uint32_t word = value(i);
            for (int b = 0; b < 4; ++b) bytes.push_back(static_cast<std::byte>(word >> (8 * b) & 0xff));
        }
        return bytes;
    };
    const std::array<std::size_t, 1> width{4};
    struct Case {
        std::vector<std::byte> column;
        int order;
        std::vector<int> first_plane;  // lowest bytes
    };
    for (const Case& c : {Case{columnOf([](std::uint32_t) { return 7u; }), 1, {14, 0, 0, 0, 0, 0}},
                          Case{columnOf([](std::uint32_t i) { return 0u - 3u * i; }), 2, {0, 5, 0, 0, 0, 0}},
                          Case{columnOf([](std::uint32_t i) { return i * i; }), 3, {0, 2, 2, 0, 0, 0}},
                          Case{columnOf([](std::uint32_t i) { return i % 2; }), 0, {0, 2, 0, 2, 0, 2}}}) {
        const auto planes = toDifferencePlanes(c.column, width, rows);
        ASSERT_EQ(planes.size(), 1 + c.column.size());
        EXPECT_EQ(std::to_integer<int>(planes[0]), c.order);
        for (std::size_t row = 0; row < rows; ++row)
            EXPECT_EQ(std::to_integer<int>(planes[1 + row]), c.first_plane[row]) << c.order << " " << row;
        for (std::size_t i = 1 + rows; i < planes.size(); ++i) EXPECT_EQ(planes[i], std::byte{0});
        EXPECT_EQ(fromDifferencePlanes(planes, width, rows), c.column);
    }
}

TEST(SampleCodec, APackedChunkWithAnyFlippedBitOrWrongLengthIsRefused) {
    // Truth: invariant, also where the checksum hides it
    const Chunk sound = packTicks(encodeTicks(fake::makeRecords(7, 3)));
    ASSERT_TRUE(unpackTicks(sound, encodingText()));
    for (std::size_t byte = 0; byte < sound.data.size(); ++byte) {
        Chunk damaged = sound;
        damaged.data[byte] ^= std::byte{4};
        EXPECT_FALSE(unpackTicks(damaged, encodingText())) << byte;
    }
    for (const std::size_t size : {0u, 3u, 4u, 20u, static_cast<unsigned>(sound.data.size()) - 1}) {
        Chunk cut = sound;
        cut.data.resize(size);
        cut.crc32 = crc32(cut.data);
        EXPECT_FALSE(unpackTicks(cut, encodingText())) << size;
    }
    Chunk counted = sound;
    counted.count = 4;
    EXPECT_FALSE(unpackTicks(counted, encodingText()));
}

TEST(SampleCodec, ReadsChunksFromBeforeTheHandsEnergyAndTheGapWereRecorded) {
    // Truth: invariant: all other columns as they were, the hand's energy and the gap not known.
    auto records = fake::makeRecords(3, 10);
    Chunk old = encodeTicks(records);
    old.data.resize(old.data.size() - 10 * sizeof(float));  // the gap, the last column
    old.crc32 = crc32(old.data);
    std::vector<TickRecord> back;
    ASSERT_TRUE(decodeTicks(old, back));
    ASSERT_EQ(back.size(), records.size());
    for (std::size_t i = 0; i < records.size(); ++i) {
        EXPECT_TRUE(std::isnan(back[i].proxy_gap_m));
        back[i].proxy_gap_m = records[i].proxy_gap_m;
    }
    EXPECT_TRUE(fake::sameStoredBits(records, back));
    old.data.resize(old.data.size() - 10 * sizeof(float));  // the hand's energy
    old.crc32 = crc32(old.data);
    back.clear();
    ASSERT_TRUE(decodeTicks(old, back));
    for (std::size_t i = 0; i < records.size(); ++i) {
        EXPECT_TRUE(std::isnan(back[i].hand_energy_J));
        back[i].hand_energy_J = records[i].hand_energy_J;
        back[i].proxy_gap_m = records[i].proxy_gap_m;
    }
    EXPECT_TRUE(fake::sameStoredBits(records, back));
    old.data.resize(old.data.size() - 10 * sizeof(float));  // one more is damage
    old.crc32 = crc32(old.data);
    EXPECT_FALSE(decodeTicks(old, back));
}

TEST(SampleCodec, AChunkEndsAtAGapAndAtItsLargestSize) {
    // Truth: closed form
    std::vector<TickRecord> records = fake::makeRecords(4, 10);
    for (std::size_t i = 6; i < 10; ++i) records[i].tick += 1;
    EXPECT_EQ(consecutiveTicks(records), 6u);
    EXPECT_EQ(consecutiveTicks(fake::makeRecords(4, 2500)), kChunkTicks);
    EXPECT_EQ(consecutiveTicks({}), 0u);
}

}  // namespace
}  // namespace passung::store
