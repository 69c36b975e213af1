#include "core/surface/pair_forest.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace passung::surface {

namespace {

constexpr std::uint32_t kNone = ClusterPair::kNoPair;
constexpr std::int64_t kBits = 64;  // of a word

}  // namespace

PairForest::PairForest(std::size_t most)
    : pairs_(std::max<std::size_t>(most, 1)),
      heads_(NormalClass::kCount * kBuckets, kNone),
      counts_(NormalClass::kCount * kBuckets, 0),
      filled_(NormalClass::kCount * kBuckets / kBits, 0) {
    restart();
}

void PairForest::restart() noexcept {
    for (std::size_t i = 0; i < fresh_; ++i)
        if (pairs_[i].now == ClusterPair::Now::Asleep) {
            const std::size_t slot = slotOf(pairs_[i].normals, pairs_[i].key);
            heads_[slot] = kNone;
            counts_[slot] = 0;
            mark(slot, false);
        }
    waiting_ = free_ = kNone;
    next_.fill(0);
    travelled_.fill(0.0);
    pairs_[0] = {};
    fresh_ = in_use_ = 1;
    wait(0);
}

std::uint32_t PairForest::trySplit(std::uint32_t parent) noexcept {
    std::uint32_t child = free_;
    if (child != kNone) {
        free_ = pairs_[child].after;
    } else if (fresh_ + 2 <= pairs_.size()) {
        child = static_cast<std::uint32_t>(fresh_);
        fresh_ += 2;
    } else {
        return kNone;
    }
    in_use_ += 2;
    ClusterPair& split = pairs_[parent];
    split.now = ClusterPair::Now::Split;
    split.child = child;
    for (const std::uint32_t i : {child, child + 1}) {
        pairs_[i] = {};
        pairs_[i].n = split.n;
        pairs_[i].held = split.held;
        pairs_[i].obstacle = split.obstacle;
        pairs_[i].parent = parent;
    }
    return child;
}

void PairForest::merge(std::uint32_t parent) noexcept {
    const std::uint32_t child = pairs_[parent].child;
    takeOut(child);
    takeOut(child + 1);
    pairs_[child].after = free_;
    free_ = child;
    pairs_[parent].child = kNone;
    in_use_ -= 2;
}

std::size_t PairForest::slotOf(std::size_t normals, double key) const noexcept {
    const double bucket = std::floor(key / kBucket);
    const std::int64_t last = next_[normals] + kBuckets - 1;
    return slotOf(normals, bucket < static_cast<double>(last) ? static_cast<std::int64_t>(bucket) : last);
}

void PairForest::putIn(std::uint32_t& head, std::uint32_t pair) noexcept {
    pairs_[pair].before = kNone;
    pairs_[pair].after = head;
    if (head != kNone) pairs_[head].before = pair;
    head = pair;
}

void PairForest::sleep(std::uint32_t pair, const Vec3& n, double s) noexcept {
    const std::size_t normals = NormalClass::of(n);
    // Too far for the ring: it is woken early and looked at again.
    const double key =
        std::min(travelled_[normals] + s, (static_cast<double>(next_[normals] + kBuckets) - 0.5) * kBucket);
    ClusterPair& asleep = pairs_[pair];
    asleep.now = ClusterPair::Now::Asleep;
    asleep.n = n;
    asleep.normals = static_cast<std::uint16_t>(normals);
    asleep.key = key;
    const std::size_t slot = slotOf(normals, key);
    putIn(heads_[slot], pair);
    ++counts_[slot];
    mark(slot, true);
}

void PairForest::wait(std::uint32_t pair) noexcept {
    pairs_[pair].now = ClusterPair::Now::Waiting;
    putIn(waiting_, pair);
}

std::uint32_t PairForest::takeWaiting() noexcept {
    const std::uint32_t pair = waiting_;
    if (pair == kNone) return pair;
    waiting_ = pairs_[pair].after;
    if (waiting_ != kNone) pairs_[waiting_].before = kNone;
    return pair;
}

void PairForest::takeOut(std::uint32_t pair) noexcept {
    ClusterPair& gone = pairs_[pair];
    const bool asleep = gone.now == ClusterPair::Now::Asleep;
    const std::size_t slot = asleep ? slotOf(gone.normals, gone.key) : 0;
    std::uint32_t& head = asleep ? heads_[slot] : waiting_;
    if (gone.before != kNone)
        pairs_[gone.before].after = gone.after;
    else
        head = gone.after;
    if (gone.after != kNone) pairs_[gone.after].before = gone.before;
    if (asleep && --counts_[slot] == 0) mark(slot, false);
}

void PairForest::mark(std::size_t slot, bool filled) noexcept {
    const std::uint64_t bit = std::uint64_t{1} << (slot % kBits);
    if (filled)
        filled_[slot / kBits] |= bit;
    else
        filled_[slot / kBits] &= ~bit;
}

/// The first bucket before `end` in which some pair sleeps; `end` if there is none.
std::int64_t PairForest::filledFrom(std::size_t normals, std::int64_t from, std::int64_t end) const noexcept {
    const std::int64_t last = std::min(end, from + kBuckets);
    for (std::int64_t at = from; at < last;) {
        const std::size_t slot = slotOf(normals, at);
        const std::int64_t bit = at % kBits;
        const std::uint64_t word = filled_[slot / kBits] >> bit;
        if (word != 0) return std::min(end, at + std::countr_zero(word));
        at += kBits - bit;
    }
    return end;
}

void PairForest::travel(const PerClass& nearer) noexcept {
    for (std::size_t c = 0; c < NormalClass::kCount; ++c) travelled_[c] += nearer[c];
}

std::size_t PairForest::wake(std::size_t normals, double s, std::size_t most) noexcept {
    const auto end = static_cast<std::int64_t>(std::floor((travelled_[normals] + s) / kBucket)) + 1;
    std::size_t woken = 0;
    std::int64_t& next = next_[normals];
    for (bool first = true; next < end; ++next, first = false) {
        if (!first) next = filledFrom(normals, next, end);
        if (next == end) break;
        const std::size_t slot = slotOf(normals, next);
        if (!first && woken + counts_[slot] > most) break;
        woken += counts_[slot];
        counts_[slot] = 0;
        mark(slot, false);
        std::uint32_t last = heads_[slot];
        if (last == kNone) continue;
        for (std::uint32_t pair = last; pair != kNone; pair = pairs_[pair].after) {
            pairs_[pair].now = ClusterPair::Now::Waiting;
            last = pair;
        }
        pairs_[last].after = waiting_;
        if (waiting_ != kNone) pairs_[waiting_].before = last;
        waiting_ = std::exchange(heads_[slot], kNone);
    }
    return woken;
}

}  // namespace passung::surface
