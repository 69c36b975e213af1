#pragma once

#include <cstdint>
#include <vector>

#include "core/base/types.h"
#include "core/surface/approach.h"

namespace passung::surface {

/// Two clusters, one of each part. A pair that is split is covered by its two children.
struct ClusterPair {
    enum class Now : std::uint8_t { Split, Asleep, Near, Waiting };

    Vec3 n = Vec3::Zero();  // the plane that set them apart last, world
    double key = 0.0;       // asleep: the way travelled toward planes like it up to which they cannot meet [m]
    std::uint32_t held = 0, obstacle = 0;
    std::uint32_t parent = kNoPair, child = kNoPair;
    std::uint32_t before = kNoPair, after = kNoPair;  // in the list of its bucket, or of those that wait
    std::uint16_t normals = 0;                        // asleep: the class of n
    Now now = Now::Waiting;

    static constexpr std::uint32_t kNoPair = 0xffffffffu;
};

/// Pairs of clusters that cover all pairs of faces, each exactly once, in memory reserved beforehand. For each class c
/// of normals there is a way travelled S_c; pairs asleep lie in buckets of that of their plane, so that a tick finds
/// those that are due without looking at the others.
///   A pair asleep with key k is set apart by at least k - S_c along its plane: no point of the held part comes nearer
/// to a plane of the class than S_c grows.
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

    /// Puts a pair to sleep that a plane with unit normal `n` sets apart by `s`. @pre s > sureOf() of the class: it
    /// would never wake.
    void sleep(std::uint32_t pair, const Vec3& n, double s) noexcept;
    /// What sets a sleeping pair apart at least [m].
    double apart(std::uint32_t pair) const noexcept { return pairs_[pair].key - travelled_[pairs_[pair].normals]; }
    /// Lets a pair wait.
    void wait(std::uint32_t pair) noexcept;
    std::uint32_t takeWaiting() noexcept;
    bool hasWaiting() const noexcept { return waiting_ != ClusterPair::kNoPair; }

    /// Those of the class that may be nearer than `s` wait from now on, but no bucket that would make them more than
    /// `most`; at least one bucket. How many there were.
    std::size_t wake(std::size_t normals, double s, std::size_t most) noexcept;
    /// All asleep of the class are set apart by no less than this [m].
    double sureOf(std::size_t normals) const noexcept { return dueOf(normals) - travelled_[normals]; }
    /// The same before it was travelled, S_c included [m].
    double dueOf(std::size_t normals) const noexcept { return static_cast<double>(next_[normals]) * kBucket; }
    double travelledOf(std::size_t normals) const noexcept { return travelled_[normals]; }
    /// The held part has moved, and came no nearer to any plane than this.
    void travel(const PerClass& nearer) noexcept;
    std::size_t inUse() const noexcept { return in_use_; }
    std::size_t capacity() const noexcept { return pairs_.size(); }

    static constexpr double kBucket = 2e-6;  // [m]

private:
    void takeOut(std::uint32_t pair) noexcept;
    void putIn(std::uint32_t& head, std::uint32_t pair) noexcept;
    std::size_t slotOf(std::size_t normals, double key) const noexcept;
    std::size_t slotOf(std::size_t normals, std::int64_t bucket) const noexcept {
        return normals * static_cast<std::size_t>(kBuckets) + static_cast<std::size_t>(bucket % kBuckets);
    }

    void mark(std::size_t slot, bool filled) noexcept;
    std::int64_t filledFrom(std::size_t normals, std::int64_t from, std::int64_t end) const noexcept;

    static constexpr std::int64_t kBuckets = 2048;  // of a class
    std::vector<ClusterPair> pairs_;
    std::vector<std::uint32_t> heads_, counts_;
    std::vector<std::uint64_t> filled_;                     // a bit a slot: some pair sleeps there
    PerClass travelled_{};                                  // S_c [m]
    std::array<std::int64_t, NormalClass::kCount> next_{};  // the first bucket that was not woken
    std::uint32_t waiting_ = ClusterPair::kNoPair, free_ = ClusterPair::kNoPair;
    std::size_t fresh_ = 0;  // those from here on were never used
    std::size_t in_use_ = 0;
};

}  // namespace passung::surface
