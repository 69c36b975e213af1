#include "tests/bench/hard_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "tests/hard/case.h"
#include "tests/hard/found.h"
#include "tests/support/off_file.h"

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

/// A row a figure; the first one has the ticks' times.
void addFoundRows(const hard::Found& found, const char* method, const hard::FoundMeasured& m, std::vector<Row>& rows) {
    const std::size_t first = rows.size();
    for (const hard::Figure& figure : m.figures) {
        Row row{.group = kHardGroup,
                .method = fmt::format("found {} {}: {}", found.name, method, figure.name),
                .settings = figure.was.empty() ? "not found before" : "was " + figure.was,
                .ours = true,
                .samples = m.us.size()};
        if (std::isfinite(figure.mark)) {
            row.figure = figure.value;
            row.figure_mark = figure.mark;
            row.figure_unit = figure.unit;
        } else {
            row.settings += fmt::format("; {:.4g} {}, without a mark", figure.value, figure.unit);
        }
        rows.push_back(row);
    }
    if (!m.us.empty() && rows.size() > first) rows[first].time_us = summarise(m.us);
}

Result<Done> addFound(const Extent& extent, std::vector<Row>& rows) {
    for (const hard::Found& found : hard::foundCases()) {
        if (extent.few_settings && found.name != std::string("pin")) continue;
        for (const auto& [method, name] : hard::methods()) {
            if (!((found.methods >> static_cast<int>(method)) & 1u)) continue;
            if (!extent.wanted(kHardGroup, fmt::format("found {} {}", found.name, name))) continue;
            const auto measured = hard::measureFound(found, method, hard::fullSize(), hard::fullSize() ? 5 : 3);
            if (!measured) return measured.errors();
            addFoundRows(found, name, *measured, rows);
        }
    }
    return Done{};
}

Result<Done> writeText(const std::string& path, const std::string& text) {
    std::ofstream out(path, std::ios::binary);
    out << text;
    if (!out.flush()) return Errors{{.message = "cannot be written", .file = path}};
    return Done{};
}

/// A case of meshes as a scene file beside its meshes.
Result<Done> writeMeshScene(const std::string& folder, const std::string& name, const hard::FoundScene& scene) {
    test::writeOff(folder + "/" + name + "_held.off", scene.held);
    test::writeOff(folder + "/" + name + "_obstacle.off", scene.obstacle);
    const Vec3 p = scene.hand(0.0).p;
    const scene::ContactSpec& contact = scene.spec.contact;
    return writeText(
        folder + "/" + name + ".toml",
        fmt::format("unit = \"m\"\n\n[[part]]\nname = \"held\"\nheld = true\nmesh = \"{0}_held.off\"\n"
                    "pose = {{ position = [{1}, {2}, {3}] }}\n\n[[part]]\nname = \"obstacle\"\n"
                    "mesh = \"{0}_obstacle.off\"\n\n[contact]\nmethod = \"god_object\"\nstiffness_N_per_m = {4}\n"
                    "rotational_stiffness_Nm_per_rad = {5}\ndamping_Ns_per_m = {6}\n",
                    name, p.x(), p.y(), p.z(), contact.stiffness, contact.rotational_stiffness, contact.damping));
}

Result<Done> writeFoundPaths(const std::string& folder) {
    for (const hard::Found& found : hard::foundCases()) {
        if (found.make == nullptr) continue;
        const auto scene = found.make(0);
        if (!scene) return scene.errors();
        hard::Run run;
        for (std::int64_t i = 0; static_cast<double>(i) < found.seconds / kTickSeconds; ++i)
            run.readings.push_back(hard::driveOf(*scene)(i, nullptr));
        const std::string name = std::string("found_") + found.name;
        if (const auto done = writeText(folder + "/" + name + ".csv", hard::trajectoryCsv(run)); !done) return done;
        if (scene->held.triangles.empty()) continue;
        if (const auto done = writeMeshScene(folder, name, *scene); !done) return done;
    }
    return Done{};
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
    if (const auto done = addFound(extent, rows); !done) return done.errors();
    return rows;
}

Result<bool> writeHardPaths(const std::string& folder) {
    for (const hard::Case& c : hard::cases()) {
        if (c.compute != nullptr) continue;
        const auto run = hard::runCase(c, scene::ContactMethod::GodObjectHeuristic, 0, false);
        if (!run) return run.errors();
        const auto done = writeText(folder + "/" + c.name + ".csv", hard::trajectoryCsv(*run));
        if (!done) return done.errors();
    }
    if (const auto done = writeFoundPaths(folder); !done) return done.errors();
    return true;
}

}  // namespace passung::bench
