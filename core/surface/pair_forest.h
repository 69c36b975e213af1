#pragma once

#include <cstdint>
#include <vector>

#include "core/base/types.h"
#include "core/surface/approach.h"

namespace passung::surface {

/// Two clusters, one of each part. A pair that is split is covered by its two children.
struct ClusterPair {
    enum class Now : std::uint8_t { Split, Asleep, Near, Waiting };

    Vec3 n = Vec3::Zero();  // the plane that set them apart last, in the frame of the obstacle
    double key = 0.0;       // asleep: the way travelled toward planes like it up to which they cannot meet [m]
    std::uint32_t held = 0, obstacle = 0;
    std::uint32_t parent = kNoPair, child = kNoPair;
    std::uint32_t before = kNoPair, after = kNoPair;  // in the list of its bucket, or of those that wait
    std::uint16_t normals = 0;                        // asleep: the class of n
    std::uint16_t body = 0;                           // which the obstacle's cluster is of
    Now now = Now::Waiting;

    static constexpr std::uint32_t kNoPair = 0xffffffffu;
};

/// Pairs of clusters that cover all pairs of faces of a held part and of each of several bodies, each exactly once, in
/// memory reserved beforehand. For each body and class c of normals there is a way travelled S_c; pairs asleep lie in
/// buckets of that of their plane, so that a tick finds those that are due without looking at the others.
///   A pair asleep with key k is set apart by at least k - S_c along its plane: no point of the held part comes nearer
/// to a plane of the class, seen from the body, than S_c grows.
///   Memory is given out in blocks: each body is sure of half of an equal share, the rest is for whoever needs it
///   first.
class PairForest {
public:
    /// Pairs wait nowhere before restart().
    explicit PairForest(std::size_t most, std::size_t bodies = 1);

    /// Forgets all pairs of a body.
    void clear(std::size_t body) noexcept;
    /// The same; one pair of roots waits.
    void restart(std::size_t body) noexcept;

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
    double apart(std::uint32_t pair) const noexcept { return pairs_[pair].key - travelled_[listOf(pairs_[pair])]; }
    /// Lets a pair wait.
    void wait(std::uint32_t pair) noexcept;
    std::uint32_t takeWaiting(std::size_t body) noexcept;
    bool hasWaiting(std::size_t body) const noexcept { return owners_[body].waiting != ClusterPair::kNoPair; }

    /// Those asleep of a body and of a class of normals.
    static std::size_t listOf(std::size_t body, std::size_t normals) noexcept {
        return body * NormalClass::kCount + normals;
    }
    static std::size_t listOf(const ClusterPair& pair) noexcept { return listOf(pair.body, pair.normals); }
    /// Those of the list that may be nearer than `s` wait from now on, but no bucket that would make them more than
    /// `most`; at least one bucket. How many there were.
    std::size_t wake(std::size_t list, double s, std::size_t most) noexcept;
    /// All asleep of the list are set apart by no less than this [m].
    double sureOf(std::size_t list) const noexcept { return dueOf(list) - travelled_[list]; }
    /// The same before it was travelled, S_c included [m].
    double dueOf(std::size_t list) const noexcept { return static_cast<double>(next_[list]) * kBucket; }
    double travelledOf(std::size_t list) const noexcept { return travelled_[list]; }
    /// Held part and body have moved against each other: no point came nearer to any plane than this.
    void travel(std::size_t body, const PerClass& nearer) noexcept;
    std::size_t inUse() const noexcept { return in_use_; }
    std::size_t capacity() const noexcept { return pairs_.size(); }

    static constexpr double kBucket = 2e-6;  // [m]

private:
    /// What is a body's own.
    struct Owner {
        std::uint32_t waiting = ClusterPair::kNoPair, free = ClusterPair::kNoPair;
        std::uint32_t block = ClusterPair::kNoPair, blocks = 0;  // the last one given out, and how many
        std::uint32_t fresh = 0, end = 0;                        // of it: those that were never used
        std::uint32_t in_use = 0;
    };

    bool takeBlock(Owner& owner) noexcept;
    void takeOut(std::uint32_t pair) noexcept;
    void putIn(std::uint32_t& head, std::uint32_t pair) noexcept;
    std::size_t slotOf(std::size_t list, double key) const noexcept;
    std::size_t slotOf(std::size_t list, std::int64_t bucket) const noexcept {
        return list * static_cast<std::size_t>(buckets_) + static_cast<std::size_t>(bucket & (buckets_ - 1));
    }

    void mark(std::size_t slot, bool filled) noexcept;
    std::int64_t filledFrom(std::size_t list, std::int64_t from, std::int64_t end) const noexcept;

    std::vector<ClusterPair> pairs_;
    std::vector<Owner> owners_;
    std::int64_t buckets_;  // of a list, a power of two
    std::vector<std::uint32_t> heads_, counts_;
    std::vector<std::uint64_t> filled_;        // a bit a slot: some pair sleeps there
    std::vector<double> travelled_;            // S_c [m]
    std::vector<std::int64_t> next_;           // the first bucket that was not woken
    std::vector<std::uint32_t> block_before_;  // of each block: the one that was given out before, or is free after it
    std::uint32_t free_block_ = ClusterPair::kNoPair;
    std::size_t free_blocks_ = 0, share_ = 1, kept_ = 0;  // blocks: sure for each; sure and not given out yet
    std::size_t in_use_ = 0;
};

}  // namespace passung::surface
