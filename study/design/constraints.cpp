#include "study/design/constraints.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

namespace passung::design {
namespace {

std::vector<std::size_t> joined(const Pools& pools) {
    std::vector<std::size_t> order;
    for (const auto& pool : pools) order.insert(order.end(), pool.begin(), pool.end());
    return order;
}

/// Whether the item at `place` fits those before it.
bool fits(const std::vector<std::size_t>& order, std::size_t place, const ItemRule& rule) {
    const Constraint& c = rule.constraint;
    const std::size_t own = rule.class_of[order[place]];
    const auto classAt = [&](std::size_t i) { return rule.class_of[order[i]]; };
    switch (c.rule) {
        case Rule::MaxRun: {
            if (place < c.count) return true;
            for (std::size_t back = 1; back <= c.count; ++back)
                if (classAt(place - back) != own) return true;
            return false;
        }
        case Rule::MinDistance:
            for (std::size_t back = 1; back < c.count && back <= place; ++back)
                if (classAt(place - back) == own) return false;
            return true;
        case Rule::FirstNot:
            return place > 0 || own != c.chosen;
        case Rule::PositionWindow:
            return own != c.chosen || (place + 1 >= c.from && place + 1 <= c.to);
    }
    return true;
}

bool fitsAll(const std::vector<std::size_t>& order, std::size_t place, const std::vector<ItemRule>& rules) {
    return std::all_of(rules.begin(), rules.end(), [&](const ItemRule& rule) { return fits(order, place, rule); });
}

/// One order and the pools' borders in it.
struct Sequence {
    explicit Sequence(const Pools& pools) : order(joined(pools)) {
        std::size_t first = 0;
        for (const auto& pool : pools) {
            begins.insert(begins.end(), pool.size(), first);
            first += pool.size();
            ends.insert(ends.end(), pool.size(), first);
        }
    }

    Pools pools() const {
        Pools all;
        for (std::size_t i = 0; i < order.size(); ++i) {
            if (begins[i] == i) all.emplace_back();
            all.back().push_back(order[i]);
        }
        return all;
    }

    std::vector<std::size_t> order;
    std::vector<std::size_t> begins, ends;  // of the pool of each place
};

void shufflePools(Pools& pools, Random& random) {
    for (auto& pool : pools) shuffle(pool, random);
}

/// Goes through the places and repairs; false after kMaxRepairs failed repairs.
bool repair(Sequence& s, const std::vector<ItemRule>& rules, Random& random) {
    int failed = 0;
    std::vector<std::size_t> later;
    for (std::size_t place = 0; place < s.order.size(); ++place) {
        if (fitsAll(s.order, place, rules)) continue;
        later.clear();
        for (std::size_t other = place + 1; other < s.ends[place]; ++other) {
            std::swap(s.order[place], s.order[other]);
            if (fitsAll(s.order, place, rules)) later.push_back(other);
            std::swap(s.order[place], s.order[other]);
        }
        if (!later.empty()) {
            std::swap(s.order[place], s.order[later[random.below(later.size())]]);
            continue;
        }
        if (++failed > kMaxRepairs) return false;
        const std::size_t first = s.begins[place];
        std::swap(s.order[place], s.order[first + random.below(s.ends[place] - first)]);
        place = first - 1;  // wraps to the pool's first place with the loop's step
    }
    return true;
}

/// Depth first over the places; among the items of a place equal ones are tried once.
class BackTracking {
public:
    BackTracking(Sequence& sequence, const std::vector<ItemRule>& rules) : s_(sequence), rules_(rules) {}

    bool place(std::size_t next) {
        if (next == s_.order.size()) return true;
        std::vector<std::size_t> tried;
        for (std::size_t other = next; other < s_.ends[next]; ++other) {
            const std::size_t item = s_.order[other];
            if (std::find(tried.begin(), tried.end(), item) != tried.end()) continue;
            tried.push_back(item);
            if (++nodes_ > kMaxNodes) return false;
            std::swap(s_.order[next], s_.order[other]);
            if (fitsAll(s_.order, next, rules_) && place(next + 1)) return true;
            std::swap(s_.order[next], s_.order[other]);
        }
        return false;
    }

private:
    Sequence& s_;
    const std::vector<ItemRule>& rules_;
    long nodes_ = 0;
};

/// Trials of the class that has most, and how many classes have so many.
std::pair<std::size_t, std::size_t> mostFrequent(const std::vector<std::size_t>& order, const ItemRule& rule) {
    std::map<std::size_t, std::size_t> counts;
    for (const std::size_t item : order) ++counts[rule.class_of[item]];
    std::size_t most = 0, classes = 0;
    for (const auto& [own, count] : counts) {
        if (count > most) classes = 0;
        most = std::max(most, count);
        classes += count == most ? 1 : 0;
    }
    return {most, classes};
}

}  // namespace

std::optional<std::string> infeasible(const Pools& pools, const ItemRule& rule) {
    const auto order = joined(pools);
    const Constraint& c = rule.constraint;
    const std::size_t n = order.size();
    const auto [most, classes] = mostFrequent(order, rule);
    const auto isChosen = [&](std::size_t item) { return rule.class_of[item] == c.chosen; };
    switch (c.rule) {
        case Rule::MaxRun:
            if (most <= c.count * (n - most + 1)) return std::nullopt;
            return fmt::format(
                "cannot be kept: {} of {} trials are alike, and runs of at most {} with another trial between them "
                "hold {}",
                most, n, c.count, c.count * (n - most + 1));
        case Rule::MinDistance:
            if (most == 0 || (most - 1) * c.count + classes <= n) return std::nullopt;
            return fmt::format("cannot be kept: {} trials alike, {} apart, need {} trials; there are {}", most, c.count,
                               (most - 1) * c.count + classes, n);
        case Rule::FirstNot:
            if (pools.empty() || pools[0].empty() || !std::all_of(pools[0].begin(), pools[0].end(), isChosen))
                return std::nullopt;
            return "cannot be kept: every trial that can come first has this level";
        case Rule::PositionWindow: {
            std::size_t first = 0;
            for (const auto& pool : pools) {
                const std::size_t last = first + pool.size();
                const std::size_t low = std::max(first, c.from - 1), high = std::min(last, c.to);
                const auto wanted = static_cast<std::size_t>(std::count_if(pool.begin(), pool.end(), isChosen));
                if (wanted > (high > low ? high - low : 0))
                    return fmt::format(
                        "cannot be kept: trials {} to {} of the block have {} of this level, and {} of "
                        "them may have it",
                        first + 1, last, wanted, high > low ? high - low : 0);
                first = last;
            }
            return std::nullopt;
        }
    }
    return std::nullopt;
}

bool keepsTo(const Pools& pools, const std::vector<ItemRule>& rules) {
    const auto order = joined(pools);
    for (std::size_t place = 0; place < order.size(); ++place)
        if (!fitsAll(order, place, rules)) return false;
    return true;
}

std::optional<ConstrainedOrder> constrainedOrder(Pools pools, const std::vector<ItemRule>& rules, Random& random) {
    for (int restarts = 0; restarts <= kMaxRestarts; ++restarts) {
        shufflePools(pools, random);
        Sequence sequence(pools);
        if (repair(sequence, rules, random)) return ConstrainedOrder{sequence.pools(), restarts, false};
    }
    shufflePools(pools, random);
    Sequence sequence(pools);
    if (sequence.order.size() > kMaxExact || !BackTracking(sequence, rules).place(0)) return std::nullopt;
    return ConstrainedOrder{sequence.pools(), kMaxRestarts + 1, true};
}

double acceptedShare(Pools pools, const std::vector<ItemRule>& rules, Random& random, int draws) {
    int accepted = 0;
    for (int i = 0; i < draws; ++i) {
        shufflePools(pools, random);
        accepted += keepsTo(pools, rules) ? 1 : 0;
    }
    return static_cast<double>(accepted) / draws;
}

}  // namespace passung::design
