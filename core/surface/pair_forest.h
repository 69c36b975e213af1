#pragma once

#include <cstdint>
#include <vector>

#include "core/base/types.h"

namespace passung::surface {

/// Two clusters, one of each part. A pair that is split is covered by its two children.
struct ClusterPair {
    enum class Now : std::uint8_t { Split, Asleep, Near, Waiting };

    Vec3 n = Vec3::Zero();  // the plane that set them apart last, world
    double key = 0.0;       // asleep: the travelled way up to which they cannot meet [m]
    std::uint32_t held = 0, obstacle = 0;
    std::uint32_t parent = kNoPair, child = kNoPair;
    std::uint32_t before = kNoPair, after = kNoPair;  // in the list of its bucket, or of those that wait
    Now now = Now::Waiting;

    static constexpr std::uint32_t kNoPair = 0xffffffffu;
};

/// Pairs of clusters that cover all pairs of faces, each exactly once, in memory reserved beforehand: those asleep lie
/// in buckets of the travelled way S, so that a tick finds those that are due without looking at the others.
///   A pair asleep with key k is set apart by at least k - S. No point of the held part goes farther than S grows.
class PairForest {
public:
    explicit PairForest(std::size_t most);

    /// Forgets all; one pair of roots waits.
    void restart() noexcept;

    ClusterPair& operator[](std::uint32_t i) noexcept { return pairs_[i]; }
    const ClusterPair& operator[](std::uint32_t i) const noexcept { return pairs_[i]; }

    /// The first of two children, which wait nowhere yet; kNoPair: no room.
    std::uint32_t trySplit(std::uint32_t parent) noexcept;
    /// The children of a pair, both asleep and not split, are forgotten. The pair itself is in no list.
    void merge(std::uint32_t parent) noexcept;

    /// Puts a pair to sleep. @pre key > due(): it would never wake.
    void sleep(std::uint32_t pair, double key) noexcept;
    /// Lets a pair wait.
    void wait(std::uint32_t pair) noexcept;
    std::uint32_t takeWaiting() noexcept;
    bool hasWaiting() const noexcept { return waiting_ != ClusterPair::kNoPair; }

    /// Those whose key may be less than `way` wait from now on, but no bucket that would make them more than `most`;
    /// at least one bucket. How far that went: keys of all asleep are no less [m].
    double wake(double way, std::size_t most) noexcept;
    /// Keys of all asleep are no less than this [m].
    double due() const noexcept { return static_cast<double>(next_) * kBucket; }
    std::size_t inUse() const noexcept { return in_use_; }
    std::size_t capacity() const noexcept { return pairs_.size(); }

    static constexpr double kBucket = 2e-6;  // [m]

private:
    void takeOut(std::uint32_t pair) noexcept;
    void putIn(std::uint32_t& head, std::uint32_t pair) noexcept;
    std::size_t slotOf(double key) const noexcept;

    static constexpr std::int64_t kBuckets = 8192;
    std::vector<ClusterPair> pairs_;
    std::vector<std::uint32_t> heads_, counts_;
    std::uint32_t waiting_ = ClusterPair::kNoPair, free_ = ClusterPair::kNoPair;
    std::size_t fresh_ = 0;  // those from here on were never used
    std::size_t in_use_ = 0;
    std::int64_t next_ = 0;  // the first bucket that was not woken
};

}  // namespace passung::surface
