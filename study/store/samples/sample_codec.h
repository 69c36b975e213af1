#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/base/tick_record.h"

namespace passung::store {

/// Ticks per chunk at most; a gap in the ticks begins a new chunk earlier.
inline constexpr std::size_t kChunkTicks = 1000;

/// One column of a stream: what a reader in another language has to know.
struct Channel {
    std::string name;  // unit as suffix where there is one
    std::string type;  // "float64", "float32", "uint32", "int32", "int64"; little-endian
    std::string unit;  // "1" if it has none
    std::string label;
    std::size_t offset = 0;  // of the value in a TickRecord

    std::size_t width() const { return type == "float64" || type == "int64" ? 8 : 4; }  // [bytes]
};

/// Hands whose ticks an attempt may have.
inline constexpr std::size_t kMostTickStreams = 4;
/// Name of the stream of a hand's ticks: "tick" of the first, "tick_hand_2" and so on of others. `hand`: from 0.
std::string tickStreamName(std::size_t hand);
/// Tells whether a stream of this name has ticks of a hand.
bool isTickStream(std::string_view name);

/// Columns of the streams of ticks, in the order of the blob.
const std::vector<Channel>& tickChannels();
/// Columns of the stream "tick_timing": measured computing times, only where a real clock ran.
const std::vector<Channel>& timingChannels();

/// Streams that a hand has beside its ticks, only of attempts whose scene calls for them: "navigation"
/// (core/tick/navigation.h), "bodies" (core/tick/pick.h) and "effects" (core/tick/effect_sum.h).
enum class Extra { Navigation, Bodies, Effects };
inline constexpr std::array kExtras{Extra::Navigation, Extra::Bodies, Extra::Effects};
const std::vector<Channel>& extraChannels(Extra extra);
/// Name of such a stream of a hand: "navigation" of the first, "navigation_hand_2" and so on of others.
std::string extraStreamName(Extra extra, std::size_t hand);
/// Which of them a stream of this name is, if any.
std::optional<Extra> extraNamed(std::string_view stream);
/// Tells whether the scene of any of these ticks called for it.
bool haveExtra(Extra extra, std::span<const TickRecord> records);

/// How a chunk's blob is laid out, in words that suffice to write a reader.
std::string encodingText();
/// `[{"name":…,"type":…,"unit":…,"label":…}, …]`
std::string channelsJson(const std::vector<Channel>& channels);

/// Consecutive ticks as one blob; the tick numbers are first_tick + row and not in the blob.
struct Chunk {
    std::int64_t first_tick = 0;
    std::int64_t count = 0;
    std::uint32_t crc32 = 0;  // over `data`
    std::vector<std::byte> data;
};

/// Encodes ticks without gaps. @pre records are consecutive, 1 … kChunkTicks of them.
Chunk encodeTicks(std::span<const TickRecord> records);
Chunk encodeTiming(std::span<const TickRecord> records);
Chunk encodeExtra(Extra extra, std::span<const TickRecord> records);

/// The chunk as it is stored: its differences in planes (planes.h) and deflated, with a checksum of that.
Chunk packTicks(const Chunk& chunk);
Chunk packTiming(const Chunk& chunk);
Chunk packExtra(Extra extra, const Chunk& chunk);

/// Undoes pack*(). `encoding` is that of its stream: those of columns-v2 are planes of the values,
/// from before that stored as they are. Fails on a wrong checksum and on bytes that are no such chunk.
Result<Chunk> unpackTicks(const Chunk& stored, std::string_view encoding);
Result<Chunk> unpackTiming(const Chunk& stored, std::string_view encoding);
Result<Chunk> unpackExtra(Extra extra, const Chunk& stored, std::string_view encoding);

/// Appends the chunk's ticks. Fails on a wrong checksum or size, and then appends nothing.
Result<Done> decodeTicks(const Chunk& chunk, std::vector<TickRecord>& records);
/// Fills duration_ns and processor_ns of those of `records` (ascending ticks) that the chunk holds.
Result<Done> decodeTiming(const Chunk& chunk, std::span<TickRecord> records);
/// Likewise what is told in such a stream.
Result<Done> decodeExtra(Extra extra, const Chunk& chunk, std::span<TickRecord> records);

/// Length of the first run of consecutive ticks, at most kChunkTicks.
std::size_t consecutiveTicks(std::span<const TickRecord> records);

}  // namespace passung::store
