#include "core/surface/pair_forest.h"

#include <algorithm>
#include <cmath>

namespace passung::surface {

namespace {

constexpr std::uint32_t kNone = ClusterPair::kNoPair;

}  // namespace

PairForest::PairForest(std::size_t most)
    : pairs_(std::max<std::size_t>(most, 1)), heads_(kBuckets, kNone), counts_(kBuckets, 0) {
    restart();
}

void PairForest::restart() noexcept {
    std::fill(heads_.begin(), heads_.end(), kNone);
    std::fill(counts_.begin(), counts_.end(), 0u);
    waiting_ = free_ = kNone;
    next_ = 0;
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

std::size_t PairForest::slotOf(double key) const noexcept {
    const double bucket = std::floor(key / kBucket);
    const std::int64_t last = next_ + kBuckets - 1;
    const std::int64_t at = bucket < static_cast<double>(last) ? static_cast<std::int64_t>(bucket) : last;
    return static_cast<std::size_t>(at % kBuckets);
}

void PairForest::putIn(std::uint32_t& head, std::uint32_t pair) noexcept {
    pairs_[pair].before = kNone;
    pairs_[pair].after = head;
    if (head != kNone) pairs_[head].before = pair;
    head = pair;
}

void PairForest::sleep(std::uint32_t pair, double key) noexcept {
    // Too far for the ring: it is woken early and looked at again.
    key = std::min(key, (static_cast<double>(next_ + kBuckets) - 0.5) * kBucket);
    pairs_[pair].now = ClusterPair::Now::Asleep;
    pairs_[pair].key = key;
    const std::size_t slot = slotOf(key);
    putIn(heads_[slot], pair);
    ++counts_[slot];
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
    const std::size_t slot = asleep ? slotOf(gone.key) : 0;
    std::uint32_t& head = asleep ? heads_[slot] : waiting_;
    if (gone.before != kNone)
        pairs_[gone.before].after = gone.after;
    else
        head = gone.after;
    if (gone.after != kNone) pairs_[gone.after].before = gone.before;
    if (asleep) --counts_[slot];
}

double PairForest::wake(double way, std::size_t most) noexcept {
    const auto end = static_cast<std::int64_t>(std::floor(way / kBucket)) + 1;
    std::size_t woken = 0;
    for (bool first = true; next_ < end; ++next_, first = false) {
        const auto slot = static_cast<std::size_t>(next_ % kBuckets);
        if (!first && woken + counts_[slot] > most) break;
        woken += counts_[slot];
        while (heads_[slot] != kNone) {
            const std::uint32_t pair = heads_[slot];
            takeOut(pair);
            wait(pair);
        }
    }
    return due();
}

}  // namespace passung::surface
