#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <type_traits>

namespace passung::host {

/// Memory that a study's process and a device host share: one page that the study writes and the host only sees, and
/// one the other way round, so that a vendor's library cannot spoil what the study says. What stands in one page is
/// plain numbers and texts, checked before it is used: the other side may be of another version, or may have died in
/// the middle of a word.

/// A value that one side writes and the other reads whole or not at all; neither ever waits for the other.
template <class Value>
class Seqlocked {
    static_assert(std::is_trivially_copyable_v<Value> && sizeof(Value) % sizeof(std::uint64_t) == 0);
    static constexpr std::size_t kWords = sizeof(Value) / sizeof(std::uint64_t);
    static constexpr int kTries = 16;
    using Words = std::array<std::uint64_t, kWords>;

public:
    void store(const Value& value) noexcept {
        const Words words = std::bit_cast<Words>(value);
        const auto version = version_.load(std::memory_order_relaxed) | 1;
        version_.store(version);
        for (std::size_t i = 0; i < kWords; ++i) words_[i].store(words[i]);
        version_.store(version + 1);
    }

    /// Nothing where the writer is in the middle of it, or has died there.
    std::optional<Value> load() const noexcept {
        for (int i = 0; i < kTries; ++i) {
            const auto before = version_.load();
            if (before % 2 != 0) continue;
            Words words;
            for (std::size_t k = 0; k < kWords; ++k) words[k] = words_[k].load();
            if (version_.load() == before) return std::bit_cast<Value>(words);
        }
        return std::nullopt;
    }

private:
    static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
    std::atomic<std::uint64_t> version_{0};
    std::array<std::atomic<std::uint64_t>, kWords> words_{};
};

template <std::size_t kLength>
struct PlainText {
    char letters[kLength] = {};

    void put(std::string_view text) noexcept {
        const std::size_t length = std::min(text.size(), kLength - 1);
        std::memcpy(letters, text.data(), length);
        std::memset(letters + length, 0, kLength - length);
    }
    std::string_view view() const noexcept { return {letters, strnlen(letters, kLength)}; }
};

/// What a page begins with: its kind, and the format of both.
struct PageHead {
    static constexpr std::uint32_t kFormat = 1;  // raised with every change of a page

    std::uint64_t magic = 0;
    std::uint32_t format = 0;
    std::uint32_t bytes = 0;

    template <class Page>
    static PageHead of() noexcept {
        return {Page::kMagic, kFormat, sizeof(Page)};
    }
    bool operator==(const PageHead&) const = default;
};

/// The newest command, written with every exchange: its stamp is the study's heartbeat.
struct StudyCommand {
    double force[3] = {}, torque[3] = {};  // on the hand, in the base's frame [N], [N·m]
    std::int64_t at = 0;                   // [ns] on the steady clock, which all programs of a machine share
    std::uint64_t number = 0;
    std::uint64_t withheld_seen = 0;  // HostReport::withheld that the study knows of
};

/// The newest report.
struct HostReport {
    std::uint64_t number = 0;
    std::uint64_t answers = 0;                                  // number of the command that it replies to
    std::uint64_t kind = 0;                                     // unit::Exchange::Kind
    std::uint64_t withheld = 0;                                 // how often the force was taken until the study knows
    std::uint64_t gaps = 0;                                     // heartbeats that were missing and came back
    double position[3] = {}, quaternion[4] = {}, grip_rad = 0;  // [m]; x, y, z, w; NaN: no grip
    std::uint64_t buttons = 0;
    PlainText<256> why;
};

/// What the host is to do.
struct HostTask {
    std::uint32_t looks_only = 0;  // tells the units, opens none
    std::uint32_t heartbeat_ms = 0;
    std::uint32_t actuated_degrees = 0;
    double max_force_N = 0, max_torque_Nm = 0;
    PlainText<64> serial, axes;
    PlainText<1024> library;
};

/// The task stands before the host is started.
struct StudyPage {
    static constexpr std::uint64_t kMagic = 0x5041'5353'5354'5544;

    PageHead head;
    HostTask task;
    Seqlocked<StudyCommand> now;
};

struct UnitTexts {
    PlainText<64> serial, model;
    PlainText<256> versions, calibration;
};

/// What the host has done.
struct HostPage {
    static constexpr std::uint64_t kMagic = 0x5041'5353'484f'5354;
    static constexpr std::uint32_t kMostUnits = 8;
    enum Stage : std::uint32_t { Starting, Failed, Running };  // Running: `units` are there to read

    PageHead head;
    std::atomic<std::uint32_t> stage{Starting};
    std::uint32_t unit_count = 0;
    std::array<UnitTexts, kMostUnits> units;
    PlainText<2048> failure;
    Seqlocked<HostReport> now;
};

inline constexpr std::size_t kPageBytes = 8192;  // of either: a whole number of pages of this machine
static_assert(sizeof(StudyPage) <= kPageBytes && sizeof(HostPage) <= kPageBytes);

inline constexpr int kMemoryDescriptor = 3, kBellDescriptor = 4;  // that the host begins with

}  // namespace passung::host
