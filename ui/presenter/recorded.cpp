#include "ui/presenter/recorded.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "analysis/export/cells.h"

namespace passung::presenter {

Result<Recorded> readRecorded(const store::StoreReader& reader) {
    auto data = exporter::readStudy(reader);
    if (!data) return data.errors();
    Recorded recorded{*std::move(data), {}, {}, reader.damages().size()};
    const auto& attempts = recorded.data.attempts;
    for (const store::MeasureRow& row : recorded.data.measures)
        if (std::any_of(attempts.begin(), attempts.end(),
                        [&](const auto& a) { return a.measures.contains(row.measure); }))
            recorded.measures.push_back({row.measure, row.label, row.unit});
    for (const char* kind : {"real", "pilot", "simulated"})
        if (std::any_of(attempts.begin(), attempts.end(), [&](const auto& a) { return a.kind == kind; }))
            recorded.kinds.emplace_back(kind);
    return recorded;
}

std::size_t firstMeasure(const Recorded& recorded) {
    const auto varies = [&](const ShownMeasure& measure) {
        std::set<double> values;
        for (const store::AttemptRow& attempt : recorded.data.attempts)
            if (const auto found = attempt.measures.find(measure.name);
                found != attempt.measures.end() && std::isfinite(found->second))
                values.insert(found->second);
        return values.size() > 1;
    };
    const auto& all = recorded.measures;
    const auto time = std::find_if(all.begin(), all.end(), [](const auto& m) { return m.name == "time_s"; });
    if (time != all.end() && varies(*time)) return static_cast<std::size_t>(time - all.begin());
    const auto first = std::find_if(all.begin(), all.end(), varies);
    return first == all.end() ? 0 : static_cast<std::size_t>(first - all.begin());
}

std::vector<const store::AttemptRow*> attemptsOf(const Recorded& recorded, const std::string& session_id) {
    std::vector<const store::AttemptRow*> found;
    for (const store::AttemptRow& attempt : recorded.data.attempts)
        if (attempt.session_id == session_id) found.push_back(&attempt);
    std::stable_sort(found.begin(), found.end(), [](const auto* a, const auto* b) {
        return std::pair(a->trial_index, a->attempt_no) < std::pair(b->trial_index, b->attempt_no);
    });
    return found;
}

FiveNumbers fiveNumbers(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const auto quantile = [&values](double share) {
        const double place = share * static_cast<double>(values.size() - 1);
        const auto below = static_cast<std::size_t>(std::floor(place));
        const std::size_t above = std::min(below + 1, values.size() - 1);
        return values[below] + (place - std::floor(place)) * (values[above] - values[below]);
    };
    return {values.front(), quantile(0.25), quantile(0.5), quantile(0.75), values.back()};
}

std::vector<ConditionSummary> lookAt(const Recorded& recorded, const std::string& measure, const std::string& kind) {
    const auto cells = exporter::cellsOf(recorded.data);
    std::vector<ConditionSummary> summaries;
    for (const store::ConditionRow& row : recorded.data.conditions) {
        ConditionSummary summary;
        summary.condition = row.condition;
        bool met = false;
        std::set<std::string> people;
        for (const exporter::Cell& cell : cells) {
            if (cell.condition != &row || cell.kind != kind) continue;
            met = true;
            const auto values = exporter::valuesOf(cell.attempts, measure);
            if (!values.empty()) people.insert(cell.participant_id);
            summary.values.insert(summary.values.end(), values.begin(), values.end());
        }
        if (!met) continue;
        summary.participants = people.size();
        if (recorded.data.protocols.size() > 1)
            for (const store::ProtocolRow& protocol : recorded.data.protocols)
                if (protocol.sha256 == row.protocol_sha256) summary.version = protocol.version;
        if (!summary.values.empty()) summary.numbers = fiveNumbers(summary.values);
        summaries.push_back(std::move(summary));
    }
    return summaries;
}

}  // namespace passung::presenter
