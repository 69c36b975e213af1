#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "tests/bench/contact_rows.h"
#include "tests/bench/convergence_rows.h"
#include "tests/bench/force_rows.h"
#include "tests/bench/hard_rows.h"
#include "tests/bench/many_part_rows.h"
#include "tests/bench/marks.h"
#include "tests/bench/million_rows.h"
#include "tests/bench/part_rows.h"
#include "tests/bench/pieces_rows.h"
#include "tests/bench/sampling_rows.h"
#include "tests/bench/true_poses.h"

using namespace passung;
using namespace passung::bench;

namespace {

struct Options {
    std::string out, filter, make_poses, data = PASSUNG_BENCH_DATA, protocol = PASSUNG_BENCH_PROTOCOL;
    std::string hard_paths;
    bool check = false, quick = false;
    std::size_t poses = 500;
    std::uint64_t seed = 1;
};

int fail(const Errors& errors) {
    for (const Error& error : errors) fmt::print(stderr, "{}\n", toString(error));
    return 1;
}

/// True if what we say about ourselves can be believed: errors are numbers, and every error bound stated holds.
bool trustworthy(const std::vector<Row>& rows) {
    bool fine = true;
    for (const Row& row : rows) {
        if (!row.ours) continue;
        const auto complain = [&](const std::string& what) {
            fmt::print(stderr, "error: {}: {}: {}: {}\n", row.group, row.method, row.settings, what);
            fine = false;
        };
        const bool times_only = row.group == kMillionGroup || row.group == kPiecesGroup || row.group == kHardGroup ||
                                row.group == kForceGroup || row.group == kPartsGroup;
        if (!std::isfinite(row.distance_error_um.max) && !times_only) complain("an error is not a number");
        if (row.bound_broken > 0.0) complain(fmt::format("{} answers are outside their own bound", row.bound_broken));
    }
    return fine;
}

/// Minutes of measuring are not to be lost: can this file be written? It is not touched.
Result<Done> checkWritable(const std::string& out) {
    const std::filesystem::path file(out);
    std::error_code unknown;
    if (std::filesystem::is_directory(file, unknown)) return Error{.message = "is a folder", .file = out};
    const bool there = std::filesystem::exists(file, unknown);
    const auto folder = file.has_parent_path() ? file.parent_path() / "" : std::filesystem::path("./");
    if (access(there ? file.c_str() : folder.c_str(), W_OK) == 0) return Done{};
    return Error{.message = std::string("cannot be written: ") + std::strerror(errno), .file = out};
}

Error nothingMatches(const std::string& filter) {
    std::string message = "no row's group and method contain this text; groups:";
    const char* between = " ";
    for (const char* group : {kPressedGroup, kApartGroup, kMillionGroup, kSamplingGroup, kBuildGroup, kBoreGroup,
                              kDefectGroup, kConvergenceGroup, kHardGroup, kPiecesGroup, kForceGroup, kPartsGroup}) {
        message += between + fmt::format("'{}'", group);
        between = ", ";
    }
    return {.message = message, .key = "--filter", .value = filter};
}

int run(const Options& options) {
    if (!options.out.empty())
        if (const auto writable = checkWritable(options.out); !writable) return fail(writable.errors());
    Extent extent;
    extent.few_settings = options.quick;
    extent.repetitions = options.quick ? 1 : 5;
    extent.wanted = [&](const std::string& group, const std::string& method) {
        return options.filter.empty() || (group + " " + method).find(options.filter) != std::string::npos;
    };
    auto bunny = loadBunny(options.data + "/bunny.off");
    if (!bunny) return fail(bunny.errors());

    if (!options.make_poses.empty()) {
        const auto written = writeTruePoses(makeContactScene(*bunny, options.poses, options.seed), options.make_poses);
        return written ? 0 : fail(written.errors());
    }

    if (!options.hard_paths.empty()) {
        const auto written = writeHardPaths(options.hard_paths);
        return written ? 0 : fail(written.errors());
    }

    const auto scene = readTruePoses(*bunny, options.data + "/bunny_torus_poses.csv", options.poses);
    if (!scene) return fail(scene.errors());
    std::vector<Row> rows;
    using Group = std::function<Result<std::vector<Row>>()>;
    const std::vector<Group> groups{[&] { return contactRows(*scene, extent); },
                                    [&] { return millionRows(*scene, extent); },
                                    [&] { return samplingRows(*bunny, extent); },
                                    [&] { return partRows(*bunny, extent); },
                                    [&] { return convergenceRows(extent); },
                                    [&] { return hardRows(extent); },
                                    [&] { return piecesRows(*scene, extent); },
                                    [&] { return forceRows(options.protocol, extent); },
                                    [&] { return manyPartRows(options.protocol, extent); }};
    for (const Group& group : groups) {
        const auto measured = group();
        if (!measured) return fail(measured.errors());
        fmt::print("{}", table(*measured));
        std::fflush(stdout);
        rows.insert(rows.end(), measured->begin(), measured->end());
    }
    if (rows.empty() && !options.filter.empty()) return fail({nothingMatches(options.filter)});
    if (!options.out.empty()) {
        std::ofstream out(options.out);
        out << csvHeader();
        for (const Row& row : rows) out << csvLine(row);
        if (!out.flush()) return fail({{.message = "cannot be written", .file = options.out}});
    }
    bool fine = trustworthy(rows);
    if (options.check) {
        std::vector<Mark> marks = judge(rows);
        // What was left out on purpose is not missed.
        if (!options.filter.empty()) std::erase_if(marks, [](const Mark& mark) { return std::isnan(mark.value); });
        fmt::print("{}", describe(marks));
        fine = allMet(marks) && fine;
    }
    return fine ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Contact queries of Passung beside FCL, ODE, Bullet and OpenVDB: time and error on the same poses."};
    Options options;
    app.add_option("--out", options.out, "CSV file for all rows");
    app.add_option("--filter", options.filter, "only rows whose group and method contain this text");
    auto* check = app.add_flag("--check", options.check, "compare with the marks; exit 1 if one is missed");
    app.add_option("--poses", options.poses, "poses of each kind")->check(CLI::Range(1, 100'000));
    app.add_option("--make-poses", options.make_poses, "only find poses and their truth, into this file (minutes)");
    app.add_option("--hard-paths", options.hard_paths,
                   "only write the device paths of the hard cases into this folder, for passung simulate");
    app.add_option("--seed", options.seed, "of the poses that are made");
    app.add_option("--data", options.data, "folder of bunny.off and bunny_torus_poses.csv");
    app.add_option("--protocol", options.protocol, "study of the kind peg_in_hole whose forces are measured");
    app.add_flag("--quick", options.quick, "few settings, one repetition: to see that it works")->excludes(check);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    return run(options);
}
