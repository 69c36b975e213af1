#include "study/measures/overlap.h"

#include <algorithm>
#include <map>

#include "study/measures/tick_facts.h"

namespace passung::measures {
namespace {

double forceSize(const TickRecord& record) {
    return Vec3(record.force_N[0], record.force_N[1], record.force_N[2]).norm();
}

/// Marks the ticks with the largest of a quantity above 0; of equal ones the earlier.
template <class Quantity>
void markLargest(std::span<const TickRecord> ticks, Quantity quantity, bool TickOverlap::*mark,
                 std::map<std::int64_t, TickOverlap>& judged) {
    std::vector<std::pair<double, std::int64_t>> found;  // the negated quantity with its tick
    for (const TickRecord& record : ticks)
        if (const double value = quantity(record); value > 0.0) found.emplace_back(-value, record.tick);
    const std::size_t count = std::min(kJudgedLargest, found.size());
    std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count), found.end());
    for (std::size_t i = 0; i < count; ++i) judged[found[i].second].*mark = true;
}

}  // namespace

std::vector<TickOverlap> ticksToJudge(std::span<const TickRecord> records, const TrialContext& context) {
    const auto begin = std::find_if(records.begin(), records.end(),
                                    [&](const TickRecord& record) { return record.tick >= context.start_tick; });
    const auto end =
        std::find_if(begin, records.end(), [&](const TickRecord& record) { return record.tick >= context.end_tick; });
    const std::span<const TickRecord> ticks(begin, end);
    std::map<std::int64_t, TickOverlap> judged;
    std::int64_t contacts = 0;
    for (const TickRecord& record : ticks)
        if (isContact(record) && contacts++ % kJudgedEvery == 0) judged[record.tick].every_20th = true;
    markLargest(
        ticks, [](const TickRecord& record) { return static_cast<double>(record.proxy_depth_m); },
        &TickOverlap::largest_depth, judged);
    markLargest(ticks, forceSize, &TickOverlap::largest_force, judged);
    std::vector<TickOverlap> result;
    for (auto& [tick, overlap] : judged) {
        overlap.tick = tick;
        result.push_back(overlap);
    }
    return result;
}

}  // namespace passung::measures
