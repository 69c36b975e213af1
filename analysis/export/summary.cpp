#include "analysis/export/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "analysis/export/cells.h"
#include "study/plan/participant.h"

namespace passung::exporter {
namespace {

struct MeanColumn {
    const char* title;
    const char* measure;
    double scale;  // from SI to the title's unit
    int decimals;
};

constexpr MeanColumn kMeans[] = {
    {"time [s]", "time_s", 1.0, 2},
    {"hand depth [mm]", "max_hand_depth_m", 1e3, 3},
    {"proxy depth [mm]", "max_proxy_depth_m", 1e3, 4},
    {"mean force [N]", "mean_force_N", 1.0, 2},
    {"peak force [N]", "peak_force_N", 1.0, 2},
};

using Line = std::vector<std::string>;

Line headerLine() {
    Line line = {"condition", "trials", "success [%]"};
    for (const MeanColumn& column : kMeans) line.emplace_back(column.title);
    return line;
}

Line conditionLine(const std::string& condition, const std::vector<const store::AttemptRow*>& attempts) {
    Line line = {condition, std::to_string(attempts.size())};
    if (attempts.empty()) {
        line.emplace_back("-");
    } else {
        const auto successes = std::count_if(attempts.begin(), attempts.end(),
                                             [](const auto* attempt) { return attempt->outcome == "success"; });
        line.push_back(
            fmt::format("{:.1f}", 100.0 * static_cast<double>(successes) / static_cast<double>(attempts.size())));
    }
    for (const MeanColumn& column : kMeans) {
        const double mean = meanOf(valuesOf(attempts, column.measure));
        line.push_back(std::isfinite(mean) ? fmt::format("{:.{}f}", mean * column.scale, column.decimals) : "-");
    }
    return line;
}

/// Columns as wide as their widest cell; the first one flush left, the others right.
std::string aligned(const std::vector<Line>& lines) {
    std::vector<std::size_t> widths(lines.front().size(), 0);
    for (const Line& line : lines) {
        for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
    }
    std::string text;
    for (const Line& line : lines) {
        text += fmt::format("{:<{}}", line[0], widths[0]);
        for (std::size_t i = 1; i < line.size(); ++i) text += fmt::format("  {:>{}}", line[i], widths[i]);
        text += '\n';
    }
    return text;
}

/// Empty without attempts of that kind under that protocol.
std::string tableOf(const StudyData& study, const std::vector<Cell>& cells, const std::string& kind,
                    const store::ProtocolRow& protocol) {
    std::set<std::string> people;
    for (const store::AttemptRow& attempt : study.attempts)
        if (attempt.kind == kind && attempt.protocol_sha256 == protocol.sha256) people.insert(attempt.participant_id);
    if (people.empty()) return {};
    std::vector<Line> lines = {headerLine()};
    for (const store::ConditionRow& condition : study.conditions) {
        if (condition.protocol_sha256 != protocol.sha256) continue;
        std::vector<const store::AttemptRow*> attempts;
        for (const Cell& cell : cells)
            if (cell.kind == kind && cell.condition == &condition)
                attempts.insert(attempts.end(), cell.attempts.begin(), cell.attempts.end());
        lines.push_back(conditionLine(condition.condition, attempts));
    }
    const std::string version =
        study.protocols.size() > 1 ? fmt::format("{} {}, ", protocol.name, protocol.version) : "";
    return fmt::format(
               "{}{} participants: {}. Means over valid main trials; time is to success, or to the end without one; "
               "depths are the trial's largest, mean force is over contact time.\n",
               version, kind, people.size()) +
           aligned(lines);
}

}  // namespace

Result<std::string> summaryTable(const store::StoreReader& reader) {
    const auto study = readStudy(reader);
    if (!study) return study.errors();
    const std::vector<Cell> cells = cellsOf(*study);
    std::string text;
    for (const std::string& kind : plan::participantKindNames())
        for (const store::ProtocolRow& protocol : study->protocols)
            if (const std::string table = tableOf(*study, cells, kind, protocol); !table.empty())
                text += (text.empty() ? "" : "\n") + table;
    return text.empty() ? std::string("no trials yet\n") : text;
}

}  // namespace passung::exporter
