#include "study/store/samples/sample_codec.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>

#include "core/base/assert.h"
#include "core/base/json.h"
#include "study/store/samples/compression.h"
#include "study/store/samples/planes.h"

namespace passung::store {
namespace {

static_assert(std::endian::native == std::endian::little, "chunks are written as the machine holds them");
static_assert(std::is_standard_layout_v<TickRecord>);

struct Layout {
    std::vector<Channel> channels;
    std::size_t bytes_per_tick = 0;
    std::size_t later_columns = 0;  // at the end, that older chunks may lack

    /// How many columns `chunk` has; 0 if its size fits none of the layouts there were.
    std::size_t columnsOf(const Chunk& chunk) const {
        if (chunk.count < 1 || chunk.count > static_cast<std::int64_t>(kChunkTicks)) return 0;
        std::size_t width = bytes_per_tick;
        for (std::size_t n = channels.size(); n + later_columns >= channels.size(); width -= channels[--n].width())
            if (chunk.data.size() == static_cast<std::size_t>(chunk.count) * width) return n;
        return 0;
    }

    void add(std::string name, std::string type, std::string unit, std::string label, std::size_t offset) {
        channels.push_back({std::move(name), std::move(type), std::move(unit), std::move(label), offset});
        bytes_per_tick += channels.back().width();
    }

    /// `axes` columns of one array, e.g. proxy_x_m, proxy_y_m, proxy_z_m.
    void addAxes(const std::string& stem, std::string_view axes, const std::string& suffix, const std::string& type,
                 const std::string& unit, const std::string& label, std::size_t offset) {
        for (const char c : axes) {
            const std::string axis(1, c);
            add(stem + axis + suffix, type, unit, label + ", " + axis, offset);
            offset += channels.back().width();
        }
    }
};

Layout makeTickLayout() {
    Layout layout;
    layout.addAxes("device_", "xyz", "_m", "float64", "m", "Raw position of the handle, device base frame",
                   offsetof(TickRecord, device_position_m));
    layout.addAxes("device_q", "wxyz", "", "float64", "1", "Raw orientation of the handle, device base frame",
                   offsetof(TickRecord, device_quaternion));
    layout.add("input_flags", "uint32", "1", "Bit 0: fresh reading; bits 8-31: buttons 0-23",
               offsetof(TickRecord, input_flags));
    layout.add("periods", "uint32", "1",
               "Haptic periods of 1 ms since the previous tick: 1, more after missed cycles; tick 0: 1",
               offsetof(TickRecord, periods));
    layout.addAxes("hand_", "xyz", "_m", "float32", "m", "Held part where the device asks it to be, scene frame",
                   offsetof(TickRecord, hand_position_m));
    layout.addAxes("hand_q", "wxyz", "", "float32", "1", "Orientation asked by the device, scene frame",
                   offsetof(TickRecord, hand_quaternion));
    layout.addAxes("proxy_", "xyz", "_m", "float32", "m", "Held part's proxy, scene frame (penalty: as hand)",
                   offsetof(TickRecord, proxy_position_m));
    layout.addAxes("proxy_q", "wxyz", "", "float32", "1", "Orientation of the proxy, scene frame",
                   offsetof(TickRecord, proxy_quaternion));
    layout.addAxes("force_", "xyz", "_N", "float32", "N", "Force on the hand after the output stage, scene axes",
                   offsetof(TickRecord, force_N));
    layout.addAxes("torque_", "xyz", "_Nm", "float32", "N·m",
                   "Torque on the hand about the held part's origin, scene axes", offsetof(TickRecord, torque_Nm));
    layout.add("hand_depth_m", "float32", "m",
               "Depth of the held part's deepest sample point (contact.spacing_mm apart) at the hand's pose; what lies "
               "between two points may be deeper",
               offsetof(TickRecord, hand_depth_m));
    layout.add(
        "proxy_depth_m", "float32", "m",
        "Depth of the held part's deepest sample point (contact.spacing_mm apart) at the proxy's pose; what lies "
        "between two points may be deeper",
        offsetof(TickRecord, proxy_depth_m));
    layout.add(
        "energy_J", "float32", "J",
        "Energy that the controller has taken in through the handle since the trial's first tick; below 0: it gave",
        offsetof(TickRecord, energy_J));
    layout.add("quality", "float32", "1", "Area fraction of the point shell that was proven or evaluated",
               offsetof(TickRecord, quality));
    layout.add("status", "uint32", "1", "Status bits of the tick; 0 = nothing to report", offsetof(TickRecord, status));
    layout.add("contacts", "uint32", "1", "Points inside an obstacle at the proxy", offsetof(TickRecord, contacts));
    layout.add("iterations", "uint32", "1", "Sub-steps of the proxy", offsetof(TickRecord, iterations));
    layout.add("nodes_visited", "uint32", "1", "Nodes that the queries visited", offsetof(TickRecord, nodes_visited));
    // The last: chunks of databases from before each end here, and its values are then not known.
    layout.add("hand_energy_J", "float32", "J",
               "Energy that the simulated hand has put into the handle since the trial's first tick; not a number of "
               "real hands",
               offsetof(TickRecord, hand_energy_J));
    layout.add("proxy_gap_m", "float32", "m",
               "Proven least gap between the held part at the proxy's pose and the obstacles; not a number where the "
               "contact's geometry proves none (field)",
               offsetof(TickRecord, proxy_gap_m));
    layout.later_columns = 2;
    return layout;
}

Layout makeTimingLayout() {
    Layout layout;
    layout.add("duration_ns", "int64", "ns", "Computing time of the tick by the wall clock",
               offsetof(TickRecord, duration_ns));
    // The last: as above; 0 is then not measured.
    layout.add("processor_ns", "int64", "ns", "Computing time of the tick that its thread spent on a processor",
               offsetof(TickRecord, processor_ns));
    layout.later_columns = 1;
    return layout;
}

Layout makeNavigationLayout() {
    Layout layout;
    layout.add("navigation_clutched", "uint32", "1", "1 while the clutch is held, else 0",
               offsetof(TickRecord, navigation_clutched));
    layout.add("navigation_scale", "float32", "1", "Metres in the scene per metre of the device in this tick",
               offsetof(TickRecord, navigation_scale));
    layout.addAxes("navigation_", "xyz", "_m", "float32", "m",
                   "Offset that is added to where the registration and navigation_scale have the handle, scene axes",
                   offsetof(TickRecord, navigation_offset_m));
    layout.addAxes("navigation_q", "wxyz", "", "float32", "1",
                   "Turn of the held part in the handle, before the registration's own",
                   offsetof(TickRecord, navigation_quaternion));
    return layout;
}

Layout makeBodiesLayout() {
    Layout layout;
    layout.add(
        "held_part", "int32", "1",
        "Part in the hand in this tick, its place in the scene from 0; -1: none. The part is where the proxy is; "
        "let go it stays where it was in the hand's last tick",
        offsetof(TickRecord, held));
    layout.add("steps_done", "int64", "1",
               "Steps of the assembly that were done as the tick began: bit 0 the first step",
               offsetof(TickRecord, steps_done));
    return layout;
}

Layout makeEffectsLayout() {
    struct Named {
        const char *key, *what;
    };
    constexpr std::array kNamed{Named{"transients", "the vibration after impacts"},
                                Named{"weight", "the held part's weight"},
                                Named{"viscosity", "the viscosity"},
                                Named{"guidance", "the guide"},
                                Named{"snap", "the snap into its place"},
                                Named{"inertia", "the held part's inertia"},
                                Named{"keep_apart", "keeping apart from parts in other hands"}};
    static_assert(kNamed.size() == kWrenchEffects);
    Layout layout;
    layout.add("effects", "uint32", "1",
               "Effects that the scene has: bit 0 transients, bit 1 weight, bit 2 viscosity, bit 3 guidance, "
               "bit 4 snap, bit 5 inertia, bit 6 keep_apart",
               offsetof(TickRecord, effects));
    layout.add("guided", "float32", "1",
               "Share of its way that the guide has gone, 0 to 1; not a number without a guide",
               offsetof(TickRecord, guided));
    for (std::size_t i = 0; i < kWrenchEffects; ++i) {
        const auto& [key, what] = kNamed[i];
        const std::size_t at = offsetof(TickRecord, effect_wrench) + i * sizeof(TickRecord::effect_wrench[0]);
        layout.addAxes(std::string(key) + "_force_", "xyz", "_N", "float32", "N",
                       std::string("Force that ") + what + " adds, before the device's delay and limits, scene axes",
                       at);
        layout.addAxes(std::string(key) + "_torque_", "xyz", "_Nm", "float32", "N·m",
                       std::string("Torque that ") + what + " adds, about the held part's origin, likewise",
                       at + 3 * sizeof(float));
    }
    layout.later_columns = 18;  // snap; inertia and keep_apart
    return layout;
}

const Layout& tickLayout() {
    static const Layout layout = makeTickLayout();
    return layout;
}

const Layout& timingLayout() {
    static const Layout layout = makeTimingLayout();
    return layout;
}

const Layout& extraLayout(Extra extra) {
    static const std::array layouts{makeNavigationLayout(), makeBodiesLayout(), makeEffectsLayout()};
    return layouts[static_cast<std::size_t>(extra)];
}

Chunk encode(const Layout& layout, std::span<const TickRecord> records) {
    PASSUNG_ASSERT(!records.empty() && consecutiveTicks(records) == records.size());
    Chunk chunk;
    chunk.first_tick = records.front().tick;
    chunk.count = static_cast<std::int64_t>(records.size());
    chunk.data.resize(layout.bytes_per_tick * records.size());
    std::byte* out = chunk.data.data();
    for (const Channel& channel : layout.channels) {
        const std::size_t width = channel.width();
        for (const TickRecord& record : records) {
            std::memcpy(out, reinterpret_cast<const std::byte*>(&record) + channel.offset, width);
            out += width;
        }
    }
    chunk.crc32 = crc32(chunk.data);
    return chunk;
}

constexpr std::string_view kPlanes = "columns-v2", kDifferences = "columns-v3";
constexpr std::size_t kSizeBytes = 4;  // before the deflated bytes: how many they become, little-endian

std::vector<std::size_t> widthsOf(const Layout& layout, std::size_t columns) {
    std::vector<std::size_t> widths;
    for (const Channel& channel : std::span(layout.channels).first(columns)) widths.push_back(channel.width());
    return widths;
}

Chunk pack(const Layout& layout, const Chunk& chunk) {
    const auto widths = widthsOf(layout, layout.columnsOf(chunk));
    const auto planes = toDifferencePlanes(chunk.data, widths, static_cast<std::size_t>(chunk.count));
    Chunk packed{chunk.first_tick, chunk.count, 0, deflated(planes)};
    std::array<std::byte, kSizeBytes> size;
    for (std::size_t i = 0; i < kSizeBytes; ++i) size[i] = static_cast<std::byte>(planes.size() >> (8 * i) & 0xff);
    packed.data.insert(packed.data.begin(), size.begin(), size.end());
    packed.crc32 = crc32(packed.data);
    return packed;
}

Error chunkError(const Chunk& chunk, const char* what) {
    return {.message = "chunk of samples from tick " + std::to_string(chunk.first_tick) + ": " + what};
}

/// The columns of planes of as many columns as make that many bytes; nothing if no number of them does.
std::optional<std::vector<std::byte>> columnsFrom(const Layout& layout, std::span<const std::byte> bytes,
                                                  std::size_t rows, bool differences) {
    for (std::size_t n = layout.channels.size(); n + layout.later_columns >= layout.channels.size(); --n) {
        const auto widths = widthsOf(layout, n);
        const std::size_t size = std::accumulate(widths.begin(), widths.end(), std::size_t{0}) * rows;
        if (differences && bytes.size() == n + size) return fromDifferencePlanes(bytes, widths, rows);
        if (!differences && bytes.size() == size) return fromPlanes(bytes, widths, rows);
    }
    return std::nullopt;
}

Result<Chunk> unpack(const Layout& layout, const Chunk& stored, std::string_view encoding) {
    const bool differences = encoding.starts_with(kDifferences);
    if (!differences && !encoding.starts_with(kPlanes)) return stored;
    if (crc32(stored.data) != stored.crc32) return chunkError(stored, "checksum does not match, the data is damaged");
    const auto misfit = chunkError(stored, "its size does not fit its number of ticks");
    if (stored.data.size() < kSizeBytes || stored.count < 1 || stored.count > static_cast<std::int64_t>(kChunkTicks))
        return misfit;
    std::size_t size = 0;
    for (std::size_t i = 0; i < kSizeBytes; ++i) size |= std::to_integer<std::size_t>(stored.data[i]) << (8 * i);
    if (size > kChunkTicks * layout.bytes_per_tick + layout.channels.size()) return misfit;
    const auto bytes = inflated(std::span(stored.data).subspan(kSizeBytes), size);
    if (bytes.size() != size) return misfit;
    auto columns = columnsFrom(layout, bytes, static_cast<std::size_t>(stored.count), differences);
    if (!columns) return misfit;
    Chunk chunk{stored.first_tick, stored.count, 0, *std::move(columns)};
    chunk.crc32 = crc32(chunk.data);
    return chunk;
}

Result<Done> check(const Layout& layout, const Chunk& chunk) {
    if (layout.columnsOf(chunk) == 0) return chunkError(chunk, "its size does not fit its number of ticks");
    if (crc32(chunk.data) != chunk.crc32) return chunkError(chunk, "checksum does not match, the data is damaged");
    return Done{};
}

void decode(const Layout& layout, const Chunk& chunk, std::span<TickRecord> records, std::size_t skip_rows) {
    const auto rows = static_cast<std::size_t>(chunk.count);
    const std::byte* column = chunk.data.data();
    for (const Channel& channel : std::span(layout.channels).first(layout.columnsOf(chunk))) {
        const std::size_t width = channel.width();
        for (std::size_t row = 0; row < records.size(); ++row) {
            std::memcpy(reinterpret_cast<std::byte*>(&records[row]) + channel.offset,
                        column + (skip_rows + row) * width, width);
        }
        column += rows * width;
    }
}

}  // namespace

namespace {

constexpr std::string_view kOtherHand = "tick_hand_";
constexpr std::array<std::string_view, kExtras.size()> kExtraNames{"navigation", "bodies", "effects"};

/// Fills what `chunk` holds of `records` (ascending ticks).
Result<Done> decodeBeside(const Layout& layout, const Chunk& chunk, std::span<TickRecord> records) {
    if (const auto sound = check(layout, chunk); !sound) return sound.errors();
    for (TickRecord& record : records) {
        const std::int64_t row = record.tick - chunk.first_tick;
        if (row < 0 || row >= chunk.count) continue;
        decode(layout, chunk, std::span(&record, 1), static_cast<std::size_t>(row));
    }
    return Done{};
}

}  // namespace

std::string tickStreamName(std::size_t hand) {
    return hand == 0 ? "tick" : std::string(kOtherHand) + std::to_string(hand + 1);
}

bool isTickStream(std::string_view name) { return name == "tick" || name.starts_with(kOtherHand); }

const std::vector<Channel>& tickChannels() { return tickLayout().channels; }
const std::vector<Channel>& timingChannels() { return timingLayout().channels; }
const std::vector<Channel>& extraChannels(Extra extra) { return extraLayout(extra).channels; }

std::string extraStreamName(Extra extra, std::size_t hand) {
    return std::string(kExtraNames[static_cast<std::size_t>(extra)]) +
           (hand == 0 ? "" : "_hand_" + std::to_string(hand + 1));
}

std::optional<Extra> extraNamed(std::string_view stream) {
    for (const Extra extra : kExtras)
        if (stream.starts_with(kExtraNames[static_cast<std::size_t>(extra)])) return extra;
    return std::nullopt;
}

bool haveExtra(Extra extra, std::span<const TickRecord> records) {
    return std::any_of(records.begin(), records.end(), [extra](const TickRecord& record) {
        switch (extra) {
            case Extra::Navigation:
                return !std::isnan(record.navigation_scale);
            case Extra::Bodies:
                return record.held != kPartNotTold;
            case Extra::Effects:
                return record.effects != 0;
        }
        return false;
    });
}

std::string encodingText() {
    return "columns-v3: one blob holds n consecutive ticks, tick number of row i = first_tick + i. Time since the "
           "attempt's tick 0 = 0.001 s * sum of the column periods over the ticks after it (in virtual time: 0.001 s * "
           "tick); that of the chunk's first tick is t0_ns less the attempt's start_ns. The blob is a length (4 bytes, "
           "little-endian), then as many bytes as a zlib stream: first one byte for each column of channels_json, its "
           "order; then the columns in that order, each as planes: the lowest byte of all n words, then the next of "
           "all, and so on. A word w stands for the difference (w >> 1) xor -(w & 1). Sums of a column's differences "
           "from the first on, modulo 2^32 or 2^64, taken as often as its order says, are the bits of its n values, "
           "little-endian. crc32 = CRC-32 (zlib) of the blob.";
}

std::string channelsJson(const std::vector<Channel>& channels) {
    std::vector<std::string> items;
    for (const Channel& channel : channels)
        items.push_back(JsonObject()
                            .text("name", channel.name)
                            .text("type", channel.type)
                            .text("unit", channel.unit)
                            .text("label", channel.label)
                            .str());
    return jsonList(items);
}

Chunk encodeTicks(std::span<const TickRecord> records) { return encode(tickLayout(), records); }
Chunk encodeTiming(std::span<const TickRecord> records) { return encode(timingLayout(), records); }
Chunk encodeExtra(Extra extra, std::span<const TickRecord> records) { return encode(extraLayout(extra), records); }

Chunk packTicks(const Chunk& chunk) { return pack(tickLayout(), chunk); }
Chunk packTiming(const Chunk& chunk) { return pack(timingLayout(), chunk); }
Chunk packExtra(Extra extra, const Chunk& chunk) { return pack(extraLayout(extra), chunk); }
Result<Chunk> unpackTicks(const Chunk& stored, std::string_view encoding) {
    return unpack(tickLayout(), stored, encoding);
}
Result<Chunk> unpackTiming(const Chunk& stored, std::string_view encoding) {
    return unpack(timingLayout(), stored, encoding);
}
Result<Chunk> unpackExtra(Extra extra, const Chunk& stored, std::string_view encoding) {
    return unpack(extraLayout(extra), stored, encoding);
}

Result<Done> decodeTicks(const Chunk& chunk, std::vector<TickRecord>& records) {
    if (const auto sound = check(tickLayout(), chunk); !sound) return sound.errors();
    const std::size_t first = records.size();
    records.resize(first + static_cast<std::size_t>(chunk.count));
    const std::span<TickRecord> added = std::span(records).subspan(first);
    for (std::size_t row = 0; row < added.size(); ++row) {
        added[row].tick = chunk.first_tick + static_cast<std::int64_t>(row);
    }
    decode(tickLayout(), chunk, added, 0);
    return Done{};
}

Result<Done> decodeTiming(const Chunk& chunk, std::span<TickRecord> records) {
    return decodeBeside(timingLayout(), chunk, records);
}
Result<Done> decodeExtra(Extra extra, const Chunk& chunk, std::span<TickRecord> records) {
    return decodeBeside(extraLayout(extra), chunk, records);
}

std::size_t consecutiveTicks(std::span<const TickRecord> records) {
    std::size_t n = std::min<std::size_t>(records.size(), 1);
    while (n < records.size() && n < kChunkTicks && records[n].tick == records[n - 1].tick + 1) ++n;
    return n;
}

}  // namespace passung::store
