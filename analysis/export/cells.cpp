#include "analysis/export/cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

#include "study/measures/measures.h"
#include "study/protocol/trial_types.h"

namespace passung::exporter {
namespace {

constexpr const char* kTime = "time_s";
constexpr const char* kFinished = "finished";

using store::AttemptRow;

/// Where a cell stands in the order of cells: participant, protocol, session, block, condition.
using CellKey = std::tuple<std::string, std::size_t, std::int64_t, std::int64_t, std::size_t>;

/// What of the study cells are made of, looked up by name.
class CellMaker {
public:
    explicit CellMaker(const StudyData& study) : study_(study), counted_(countedSessions(study)) {
        for (std::size_t i = 0; i < study.protocols.size(); ++i) protocols_[study.protocols[i].sha256] = i;
        for (std::size_t i = 0; i < study.conditions.size(); ++i)
            conditions_[{study.conditions[i].protocol_sha256, study.conditions[i].condition}] = i;
        for (const store::ParticipantRow& person : study.participants) people_[person.participant_id] = &person;
        for (const store::PlannedCellRow& planned : study.planned) {
            const auto condition = conditions_.find({planned.protocol_sha256, planned.condition});
            if (condition == conditions_.end()) continue;
            shorten(planned.protocol_sha256, planned.block, study.conditions[condition->second].timeout_s);
            if (counted_.count(planned.session_id) == 0) continue;
            Cell& cell = at(planned.participant_id, planned.protocol_sha256, planned.session_ordinal,
                            planned.block_index, planned.block, condition->second);
            if (const auto person = people_.find(planned.participant_id); person != people_.end()) {
                cell.kind = person->second->kind;
                cell.group = groupOf(study, planned.participant_id);
            }
        }
        for (const AttemptRow& attempt : study.attempts) add(attempt);
    }

    std::vector<Cell> cells() {
        std::vector<Cell> list;
        for (auto& [key, cell] : cells_) {
            const auto block = horizons_.find({cell.protocol_sha256, cell.block});
            if (block != horizons_.end()) cell.horizon_s = block->second;
            list.push_back(std::move(cell));
        }
        return list;
    }

private:
    Cell& at(const std::string& participant, const std::string& protocol, std::int64_t session, std::int64_t index,
             const std::string& block, std::size_t condition) {
        const auto place = protocols_.find(protocol);
        const std::size_t number = place == protocols_.end() ? protocols_.size() : place->second;
        Cell& cell = cells_[CellKey{participant, number, session, index, condition}];
        cell.participant_id = participant;
        cell.protocol_sha256 = protocol;
        cell.session_ordinal = session;
        cell.block_index = index;
        cell.block = block;
        cell.condition = &study_.conditions[condition];
        return cell;
    }

    void add(const AttemptRow& attempt) {
        const auto condition = conditions_.find({attempt.protocol_sha256, attempt.condition});
        if (attempt.phase != "main" || counted_.count(attempt.session_id) == 0 || condition == conditions_.end())
            return;
        Cell& cell = at(attempt.participant_id, attempt.protocol_sha256, attempt.session_ordinal, attempt.block_index,
                        attempt.block, condition->second);
        cell.kind = attempt.kind;
        cell.group = attempt.group;
        if (!countsInMeans(study_, attempt)) return;
        cell.attempts.push_back(&attempt);
        if (const auto time = attempt.measures.find(kTime); time != attempt.measures.end())
            lengthen(attempt.protocol_sha256, attempt.block, time->second);
    }

    void shorten(const std::string& protocol, const std::string& block, const std::optional<double>& timeout_s) {
        if (!timeout_s) return;
        const auto [known, fresh] = horizons_.try_emplace({protocol, block}, *timeout_s);
        known->second = std::min(known->second, *timeout_s);
        told_.insert({protocol, block});
    }

    void lengthen(const std::string& protocol, const std::string& block, double time_s) {
        if (told_.count({protocol, block}) != 0) return;
        const auto [known, fresh] = horizons_.try_emplace({protocol, block}, time_s);
        known->second = std::max(known->second, time_s);
    }

    using Named = std::pair<std::string, std::string>;  // protocol, name in it

    const StudyData& study_;
    std::set<std::string> counted_;
    std::map<std::string, std::size_t> protocols_;
    std::map<Named, std::size_t> conditions_;
    std::map<std::string, const store::ParticipantRow*> people_;
    std::map<Named, double> horizons_;  // by block
    std::set<Named> told_;              // blocks with time-outs
    std::map<CellKey, Cell> cells_;
};

}  // namespace

std::vector<Cell> cellsOf(const StudyData& study) { return CellMaker(study).cells(); }

bool canHave(const store::ConditionRow& condition, const std::string& measure) {
    const bool secondary = measure.starts_with("secondary_");
    if (secondary && condition.stimulus == "none") return false;
    if (condition.timed_by != "program" && !measures::isKnownUnwatched(measure)) return false;
    const auto types = protocol::typesWith(measure);
    return types.empty() || condition.task_type.empty() ||
           std::any_of(types.begin(), types.end(),
                       [&](const protocol::TrialType* type) { return type->name == condition.task_type; });
}

bool isCensored(const std::string& measure) { return measure == kTime; }

std::vector<double> valuesOf(const std::vector<const AttemptRow*>& attempts, const std::string& measure) {
    std::vector<double> values;
    for (const AttemptRow* attempt : attempts) {
        if (const auto found = attempt->measures.find(measure); found != attempt->measures.end()) {
            values.push_back(found->second);
        }
    }
    return values;
}

double valueOf(const Cell& cell, const std::string& measure) {
    if (!isCensored(measure)) return meanOf(valuesOf(cell.attempts, measure));
    std::vector<CensoredTime> times;
    for (const AttemptRow* attempt : cell.attempts) {
        const auto time = attempt->measures.find(kTime);
        if (time == attempt->measures.end()) continue;
        const auto finished = attempt->measures.find(kFinished);
        times.push_back({time->second,
                         finished == attempt->measures.end() ? attempt->outcome == "success" : finished->second > 0.5});
    }
    if (!cell.horizon_s) return std::numeric_limits<double>::quiet_NaN();
    return restrictedMean(std::move(times), *cell.horizon_s);
}

double meanOf(const std::vector<double>& values) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double medianOf(std::vector<double> values) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2.0;
}

double restrictedMean(std::vector<CensoredTime> times, double horizon_s) {
    if (times.empty()) return std::numeric_limits<double>::quiet_NaN();
    // What finishes at a time is over before what is censored there.
    std::sort(times.begin(), times.end(), [](const CensoredTime& a, const CensoredTime& b) {
        return a.time_s != b.time_s ? a.time_s < b.time_s : a.finished && !b.finished;
    });
    double share = 1.0, area = 0.0, last = 0.0;
    for (std::size_t i = 0; i < times.size() && times[i].time_s < horizon_s; ++i) {
        area += share * (times[i].time_s - last);
        last = times[i].time_s;
        if (times[i].finished) share *= 1.0 - 1.0 / static_cast<double>(times.size() - i);
    }
    return area + share * (horizon_s - last);
}

}  // namespace passung::exporter
