#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "analysis/truth/accuracy_tick_tables.h"
#include "analysis/truth/accuracy_ticks.h"
#include "core/base/regular_file.h"
#include "core/scene/contact_geometry.h"
#include "devices/scripted/trajectory.h"
#include "study/run/files/builds.h"
#include "study/run/files/protocol_files.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"
#include "ui/cli/result_folder.h"

namespace passung::cli {

namespace {

constexpr std::array kTickFiles{"accuracy.svg", "accuracy.csv", "codebook.csv"};

/// Those of `all` whose names were asked for, in the order of `all`.
template <class T, class Names, class NameOf>
std::vector<T> named(const Names& all, const std::vector<std::string>& names, const NameOf& nameOf) {
    std::vector<T> chosen;
    for (const T& one : all)
        if (std::find(names.begin(), names.end(), nameOf(one)) != names.end()) chosen.push_back(one);
    return chosen;
}

truth::TickSpace tickSpaceOf(const AccuracyArguments& options) {
    using scene::ContactMethod;
    using scene::Geometry;
    truth::TickSpace space;
    space.methods = named<ContactMethod>(
        std::array{ContactMethod::Penalty, ContactMethod::GodObjectHeuristic, ContactMethod::GodObject},
        options.methods, scene::methodName);
    space.geometries = named<Geometry>(std::array{Geometry::ClosedForm, Geometry::Surface, Geometry::Field},
                                       options.geometries, scene::geometryName);
    space.modes = named<field::FieldMode>(field::kFieldModes, options.modes, field::modeName);
    for (const double tolerance : options.tolerances_um) space.tolerances.push_back(1e-6 * tolerance);
    for (const double spacing : options.spacings_mm) space.spacings.push_back(1e-3 * spacing);
    space.budgets = options.budgets;
    space.ways = options.ways;
    return space;
}

Result<Done> writeTickResults(const ResultFolder& folder, const truth::TickAccuracy& result,
                              const truth::TickPictureText& text) {
    const std::array contents{truth::tickPicture(result, text), truth::tickCsv(result), truth::tickCodebook()};
    for (std::size_t i = 0; i < kTickFiles.size(); ++i)
        if (auto done = folder.write(kTickFiles[i], contents[i]); !done) return done;
    return Done{};
}

}  // namespace

int tickAccuracy(const AccuracyArguments& options) {
    const auto source = readFile(options.field);
    if (!source) return fail(source.errors());
    const auto read = run::readSceneOnDevice(*source, options.field, options.import_limits);
    if (!read) return fail(read.errors());
    warn(options.field, read->warnings);
    if (read->scene.effects.picks())
        return fail({{.message = "must not be there: the accuracy is that of one held part",
                      .file = options.field,
                      .key = "effects.pick"}});
    const auto trajectory = scripted::Trajectory::read(options.trajectory);
    if (!trajectory) return fail(trajectory.errors());
    std::vector<Pose> path;
    for (std::int64_t i = 0; i <= trajectory->lastTick(); ++i) path.push_back(trajectory->at(i));
    const truth::TickSettings all = truth::tickSettings(read->scene, tickSpaceOf(options));
    if (all.settings.empty())
        return fail({{.message = "no setting fits: " + all.left_out.front(), .file = options.field}});
    const truth::TickPictureText text{std::filesystem::path(options.field).stem().string(),
                                      std::filesystem::path(options.trajectory).stem().string()};
    ResultFolder folder(options.out, kTickFiles);
    const auto is_ours = [&](const std::string& picture) { return truth::isTickPictureOf(picture, text); };
    if (const auto begun = folder.begin(is_ours, text.scene + " along " + text.path); !begun)
        return fail(begun.errors());
    ProgressLine progress;
    const auto builds = run::openBuilds(options.import_limits);
    const auto result = truth::measureTicks(
        read->scene, path, all.settings, {.repetitions = options.repetitions, .every = options.every},
        [&](const std::string& what, double share) { progress.show(progressBar(what, share)); }, builds.get());
    if (!result) return fail(result.errors());
    if (const auto done = writeTickResults(folder, *result, text); !done) return fail(done.errors());
    fmt::print("{}", truth::tickText(*result));
    for (const std::string& why : all.left_out) fmt::print("left out: {}\n", why);
    fmt::print("{}: accuracy.csv, accuracy.svg, codebook.csv\n", options.out);
    return 0;
}

}  // namespace passung::cli
