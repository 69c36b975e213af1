#include "tests/bench/hard_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <limits>

#include "tests/hard/case.h"

namespace passung::bench {

namespace {

Row rowOf(const hard::Case& c, const char* method, const hard::Measured& m) {
    const hard::Judgement& found = m.judgement;
    Row row{.group = kHardGroup, .method = std::string(c.name) + " " + method, .settings = c.figure, .ours = true};
    row.samples = m.us.size();
    row.figure = found.broken.empty() ? found.value : std::numeric_limits<double>::infinity();
    row.figure_mark = c.mark;
    row.figure_unit = c.unit;
    if (!found.broken.empty()) row.settings += fmt::format(" ({:.4g} {}); {}", found.value, c.unit, found.broken);
    row.settings += fmt::format("; tick p99.9 {:.0f} us, at most {} nodes, {} points, {} iterations, {} rows, {} turns",
                                m.p999_us(), m.nodes, m.points, m.iterations, m.rows, m.turns);
    if (!m.us.empty()) row.time_us = summarise(m.us);
    return row;
}

}  // namespace

Result<std::vector<Row>> hardRows(const Extent& extent) {
    std::vector<Row> rows;
    std::size_t few = 0;
    for (const hard::Case& c : hard::cases()) {
        for (const auto& [method, name] : hard::methods()) {
            if (!applies(c, method) || !extent.wanted(kHardGroup, std::string(c.name) + " " + name)) continue;
            if (extent.few_settings && (c.compute != nullptr || c.seconds * c.seeds > 1.0)) continue;
            if (extent.few_settings && few++ > 2) continue;
            const auto measured = hard::measure(c, method, hard::fullSize());
            if (!measured) return measured.errors();
            rows.push_back(rowOf(c, name, *measured));
        }
    }
    return rows;
}

Result<bool> writeHardPaths(const std::string& folder) {
    for (const hard::Case& c : hard::cases()) {
        if (c.compute != nullptr) continue;
        const auto run = hard::runCase(c, scene::ContactMethod::GodObjectHeuristic, 0, false);
        if (!run) return run.errors();
        const std::string path = folder + "/" + c.name + ".csv";
        std::ofstream out(path, std::ios::binary);
        out << hard::trajectoryCsv(*run);
        if (!out.flush()) return Errors{{.message = "cannot be written", .file = path}};
    }
    return true;
}

}  // namespace passung::bench
