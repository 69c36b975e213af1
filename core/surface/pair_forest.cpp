#include "core/surface/pair_forest.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace passung::surface {

namespace {

constexpr std::uint32_t kNone = ClusterPair::kNoPair;
constexpr std::int64_t kBits = 64;             // of a word
constexpr std::uint32_t kBlock = 128;          // pairs
constexpr std::int64_t kMostBuckets = 2048;    // of a list
constexpr std::int64_t kLeastBuckets = 128;    // the same, of many bodies: far pairs are looked at more often
constexpr std::int64_t kBucketsInAll = 16384;  // times the classes of normals

std::size_t blocksFor(std::size_t most, std::size_t bodies) {
    return std::max<std::size_t>((most + kBlock - 1) / kBlock, 2 * bodies);
}

std::int64_t bucketsFor(std::size_t bodies) {
    const std::uint64_t each = static_cast<std::uint64_t>(kBucketsInAll) / std::max<std::size_t>(bodies, 1);
    return std::clamp(static_cast<std::int64_t>(std::bit_floor(std::max<std::uint64_t>(each, 1))), kLeastBuckets,
                      kMostBuckets);
}

}  // namespace

PairForest::PairForest(std::size_t most, std::size_t bodies)
    : pairs_(blocksFor(most, bodies) * kBlock),
      owners_(bodies),
      buckets_(bucketsFor(bodies)),
      heads_(bodies * NormalClass::kCount * static_cast<std::size_t>(buckets_), kNone),
      counts_(heads_.size(), 0),
      filled_(heads_.size() / kBits, 0),
      travelled_(bodies * NormalClass::kCount, 0.0),
      next_(bodies * NormalClass::kCount, 0),
      block_before_(pairs_.size() / kBlock),
      free_block_(0),
      free_blocks_(block_before_.size()),
      share_(block_before_.size() / (2 * std::max<std::size_t>(bodies, 1))),
      kept_(share_ * bodies) {
    for (std::size_t i = 0; i < block_before_.size(); ++i)
        block_before_[i] = i + 1 < block_before_.size() ? static_cast<std::uint32_t>(i + 1) : kNone;
}

/// False: the others have all that is not kept for anybody.
bool PairForest::takeBlock(Owner& owner) noexcept {
    const bool sure = owner.blocks < share_;
    if (!sure && free_blocks_ <= kept_) return false;
    if (sure) --kept_;
    --free_blocks_;
    ++owner.blocks;
    const std::uint32_t block = std::exchange(free_block_, block_before_[free_block_]);
    block_before_[block] = std::exchange(owner.block, block);
    owner.fresh = block * kBlock;
    owner.end = owner.fresh + kBlock;
    return true;
}

void PairForest::clear(std::size_t body) noexcept {
    Owner& owner = owners_[body];
    const std::size_t words = NormalClass::kCount * static_cast<std::size_t>(buckets_) / kBits, first = body * words;
    for (std::size_t word = first; word < first + words; ++word)
        for (std::uint64_t bits = std::exchange(filled_[word], 0); bits != 0; bits &= bits - 1) {
            const std::size_t slot = word * kBits + static_cast<std::size_t>(std::countr_zero(bits));
            heads_[slot] = kNone;
            counts_[slot] = 0;
        }
    while (owner.block != kNone) {
        const std::uint32_t block = std::exchange(owner.block, block_before_[owner.block]);
        block_before_[block] = std::exchange(free_block_, block);
        ++free_blocks_;
        if (--owner.blocks < share_) ++kept_;
    }
    in_use_ -= owner.in_use;
    owner = {};
    const auto from = static_cast<std::ptrdiff_t>(listOf(body, 0));
    std::fill_n(next_.begin() + from, NormalClass::kCount, 0);
    std::fill_n(travelled_.begin() + from, NormalClass::kCount, 0.0);
}

void PairForest::restart(std::size_t body) noexcept {
    clear(body);
    Owner& owner = owners_[body];
    takeBlock(owner);
    const std::uint32_t root = owner.fresh++;
    pairs_[root] = {};
    pairs_[root].body = static_cast<std::uint16_t>(body);
    ++owner.in_use;
    ++in_use_;
    wait(root);
}

std::uint32_t PairForest::trySplit(std::uint32_t parent) noexcept {
    Owner& owner = owners_[pairs_[parent].body];
    std::uint32_t child = owner.free;
    if (child != kNone) {
        owner.free = pairs_[child].after;
    } else if (owner.fresh + 2 <= owner.end || takeBlock(owner)) {
        child = owner.fresh;
        owner.fresh += 2;
    } else {
        return kNone;
    }
    in_use_ += 2;
    owner.in_use += 2;
    ClusterPair& split = pairs_[parent];
    split.now = ClusterPair::Now::Split;
    split.child = child;
    for (const std::uint32_t i : {child, child + 1}) {
        pairs_[i] = {};
        pairs_[i].n = split.n;
        pairs_[i].held = split.held;
        pairs_[i].obstacle = split.obstacle;
        pairs_[i].body = split.body;
        pairs_[i].parent = parent;
    }
    return child;
}

void PairForest::merge(std::uint32_t parent) noexcept {
    Owner& owner = owners_[pairs_[parent].body];
    const std::uint32_t child = pairs_[parent].child;
    takeOut(child);
    takeOut(child + 1);
    pairs_[child].after = owner.free;
    owner.free = child;
    pairs_[parent].child = kNone;
    in_use_ -= 2;
    owner.in_use -= 2;
}

std::size_t PairForest::slotOf(std::size_t list, double key) const noexcept {
    const double bucket = std::floor(key / kBucket);
    const std::int64_t last = next_[list] + buckets_ - 1;
    return slotOf(list, bucket < static_cast<double>(last) ? static_cast<std::int64_t>(bucket) : last);
}

void PairForest::putIn(std::uint32_t& head, std::uint32_t pair) noexcept {
    pairs_[pair].before = kNone;
    pairs_[pair].after = head;
    if (head != kNone) pairs_[head].before = pair;
    head = pair;
}

void PairForest::sleep(std::uint32_t pair, const Vec3& n, double s) noexcept {
    ClusterPair& asleep = pairs_[pair];
    asleep.normals = static_cast<std::uint16_t>(NormalClass::of(n));
    const std::size_t list = listOf(asleep);
    // Too far for the ring: it is woken early and looked at again.
    const double key = std::min(travelled_[list] + s, (static_cast<double>(next_[list] + buckets_) - 0.5) * kBucket);
    asleep.now = ClusterPair::Now::Asleep;
    asleep.n = n;
    asleep.key = key;
    const std::size_t slot = slotOf(list, key);
    putIn(heads_[slot], pair);
    ++counts_[slot];
    mark(slot, true);
}

void PairForest::wait(std::uint32_t pair) noexcept {
    pairs_[pair].now = ClusterPair::Now::Waiting;
    putIn(owners_[pairs_[pair].body].waiting, pair);
}

std::uint32_t PairForest::takeWaiting(std::size_t body) noexcept {
    std::uint32_t& waiting = owners_[body].waiting;
    const std::uint32_t pair = waiting;
    if (pair == kNone) return pair;
    waiting = pairs_[pair].after;
    if (waiting != kNone) pairs_[waiting].before = kNone;
    return pair;
}

void PairForest::takeOut(std::uint32_t pair) noexcept {
    ClusterPair& gone = pairs_[pair];
    const bool asleep = gone.now == ClusterPair::Now::Asleep;
    const std::size_t slot = asleep ? slotOf(listOf(gone), gone.key) : 0;
    std::uint32_t& head = asleep ? heads_[slot] : owners_[gone.body].waiting;
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
std::int64_t PairForest::filledFrom(std::size_t list, std::int64_t from, std::int64_t end) const noexcept {
    const std::int64_t last = std::min(end, from + buckets_);
    for (std::int64_t at = from; at < last;) {
        const std::size_t slot = slotOf(list, at);
        const std::int64_t bit = at % kBits;
        const std::uint64_t word = filled_[slot / kBits] >> bit;
        if (word != 0) return std::min(end, at + std::countr_zero(word));
        at += kBits - bit;
    }
    return end;
}

void PairForest::travel(std::size_t body, const PerClass& nearer) noexcept {
    double* travelled = travelled_.data() + listOf(body, 0);
    for (std::size_t c = 0; c < NormalClass::kCount; ++c) travelled[c] += nearer[c];
}

std::size_t PairForest::wake(std::size_t list, double s, std::size_t most) noexcept {
    const auto end = static_cast<std::int64_t>(std::floor((travelled_[list] + s) / kBucket)) + 1;
    std::size_t woken = 0;
    std::int64_t& next = next_[list];
    std::uint32_t& waiting = owners_[list / NormalClass::kCount].waiting;
    for (bool first = true; next < end; ++next, first = false) {
        if (!first) next = filledFrom(list, next, end);
        if (next == end) break;
        const std::size_t slot = slotOf(list, next);
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
        pairs_[last].after = waiting;
        if (waiting != kNone) pairs_[waiting].before = last;
        waiting = std::exchange(heads_[slot], kNone);
    }
    return woken;
}

}  // namespace passung::surface
