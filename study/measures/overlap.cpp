#include "study/measures/overlap.h"

#include <algorithm>
#include <map>

#include "study/measures/tick_of_hands.h"

namespace passung::measures {
namespace {

/// Marks the ticks with the largest of a quantity above 0; of equal ones the earlier.
void markLargest(std::span<const TickRecord> ticks, std::span<const TickOfHands> together,
                 double TickOfHands::*quantity, bool TickOverlap::*mark, std::map<std::int64_t, TickOverlap>& judged) {
    std::vector<std::pair<double, std::int64_t>> found;  // the negated quantity with its tick
    for (std::size_t i = 0; i < ticks.size(); ++i)
        if (const double value = together[i].*quantity; value > 0.0) found.emplace_back(-value, ticks[i].tick);
    const std::size_t count = std::min(kJudgedLargest, found.size());
    std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count), found.end());
    for (std::size_t i = 0; i < count; ++i) judged[found[i].second].*mark = true;
}

}  // namespace

std::vector<TickOverlap> ticksToJudge(std::span<const TickRecord> records, const TrialContext& context,
                                      std::span<const std::span<const TickRecord>> hands) {
    const auto begin = std::find_if(records.begin(), records.end(),
                                    [&](const TickRecord& record) { return record.tick >= context.start_tick; });
    const auto end =
        std::find_if(begin, records.end(), [&](const TickRecord& record) { return record.tick >= context.end_tick; });
    const std::span<const TickRecord> ticks(begin, end);
    const std::vector<TickOfHands> together = togetherAt(ticks, hands);
    std::map<std::int64_t, TickOverlap> judged;
    std::int64_t contacts = 0;
    for (std::size_t i = 0; i < ticks.size(); ++i)
        if (together[i].contact && contacts++ % kJudgedEvery == 0) judged[ticks[i].tick].every_20th = true;
    markLargest(ticks, together, &TickOfHands::depth, &TickOverlap::largest_depth, judged);
    markLargest(ticks, together, &TickOfHands::force, &TickOverlap::largest_force, judged);
    std::vector<TickOverlap> result;
    for (auto& [tick, overlap] : judged) {
        overlap.tick = tick;
        result.push_back(overlap);
    }
    return result;
}

}  // namespace passung::measures
