#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "analysis/truth/accuracy_picture.h"
#include "analysis/truth/accuracy_sweep.h"
#include "analysis/truth/accuracy_tables.h"
#include "study/run/files/builds.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"
#include "ui/cli/part_argument.h"
#include "ui/cli/pose_table.h"
#include "ui/cli/result_folder.h"

namespace passung::cli {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostPrinted = 20;  // disagreements
// The picture first, for it tells whose results these are: so does what an interrupted run leaves.
constexpr std::array kFiles{"accuracy.svg", "accuracy.csv", "poses.csv", "codebook.csv"};

truth::AccuracySpace spaceOf(const AccuracyArguments& options, double length) {
    truth::AccuracySpace space;
    space.modes.clear();
    for (const field::FieldMode mode : field::kFieldModes)
        if (options.modes.empty() ||
            std::find(options.modes.begin(), options.modes.end(), field::modeName(mode)) != options.modes.end())
            space.modes.push_back(mode);
    if (!options.tolerances_um.empty()) space.tolerances.clear();
    for (const double tolerance : options.tolerances_um) space.tolerances.push_back(1e-6 * tolerance);
    for (const double spacing : options.spacings_mm) space.spacings.push_back(1e-3 * spacing);
    if (space.spacings.empty()) space.spacings = truth::defaultSpacings(length);
    if (!options.budgets.empty()) space.budgets = options.budgets;
    space.repetitions = options.repetitions;
    return space;
}

std::string nameOf(const std::string& path) { return fs::path(path).stem().string(); }

Result<Done> writeAll(const AccuracyArguments& options, const ResultFolder& folder, const truth::AccuracyResult& result,
                      const std::vector<truth::JudgedPose>& poses) {
    truth::PictureText text{nameOf(options.field), nameOf(options.shell), poses.size(), 0};
    for (const auto& pose : poses) text.contacts += pose.truth.inContact() ? 1 : 0;
    const std::array contents{truth::accuracyPicture(result.rows, text), truth::accuracyCsv(result.rows),
                              truth::posesCsv(poses), truth::accuracyCodebook()};
    for (std::size_t i = 0; i < kFiles.size(); ++i)
        if (auto done = folder.write(kFiles[i], contents[i]); !done) return done;
    return Done{};
}

/// Prints what contradicts the truth; the exit code.
int printDisagreements(const truth::AccuracyResult& result) {
    fmt::print(
        "{} answers compared with FCL and the true depth: {} outside their stated bound; for {} the bound leaves "
        "open whether the surfaces meet.\n",
        result.compared, result.disagreements.size(), result.undecided);
    for (std::size_t i = 0; i < std::min(kMostPrinted, result.disagreements.size()); ++i) {
        const truth::Disagreement& d = result.disagreements[i];
        const Vec3& p = d.X_FS.p;
        const Quat& q = d.X_FS.q;
        fmt::print(stderr, "error: {}\n  setting: {}\n  pose x_m,y_m,z_m,qw,qx,qy,qz: {},{},{},{},{},{},{}\n", d.what,
                   truth::settingText(d.setting), p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z());
    }
    return result.disagreements.empty() ? 0 : 1;
}

}  // namespace

int accuracy(const AccuracyArguments& options) {
    if (!options.trajectory.empty()) return tickAccuracy(options);
    if (options.shell.empty()) return studyAccuracy(options);
    const auto field = partArgument(options.field, options.field_unit.empty() ? options.unit : options.field_unit);
    if (!field) return fail(field.errors());
    const auto shell = partArgument(options.shell, options.shell_unit.empty() ? options.unit : options.shell_unit);
    if (!shell) return fail(shell.errors());
    std::vector<Pose> given;
    if (!options.poses.empty()) {
        NumberTable table;
        auto poses = readPoses(options.poses, table);
        if (!poses) return fail(poses.errors());
        if (poses->empty()) return fail({{.message = "has no pose", .file = options.poses}});
        given = std::move(*poses);
    }
    ResultFolder folder(options.out, kFiles);
    const truth::PictureText pair{nameOf(options.field), nameOf(options.shell)};
    const auto is_ours = [&](const std::string& picture) { return truth::isPictureOf(picture, pair); };
    if (const auto begun = folder.begin(is_ours, pair.shell + " against " + pair.field); !begun)
        return fail(begun.errors());

    ProgressLine progress;
    progress.show("reading the parts");
    const auto builds = run::openBuilds(options.import_limits);
    const auto truth = truth::PairTruth::build(*field, *shell, builds.get());
    if (!truth) return fail(truth.errors());
    const auto poses_report = [&](double share) {
        progress.show(progressBar("finding poses and what is true there", share));
    };
    const auto poses = given.empty() ? truth::contactPath(*truth, options.paths, options.seed, poses_report)
                                     : truth::judgePoses(*truth, given, poses_report);
    if (poses.empty()) return fail({{.message = "no path of SHELL meets it", .file = options.field}});
    const auto shaken = truth::shakenPoses(*truth, poses, options.fcl_poses, options.seed, [&](double share) {
        progress.show(progressBar("asking FCL about further poses", share));
    });
    const auto result = truth::sweepAccuracy(
        *field, *shell, spaceOf(options, truth->length()), poses, shaken, truth->lever(),
        [&](const std::string& what, double share) { progress.show(progressBar(what, share)); }, builds.get());
    if (!result) return fail(result.errors());
    if (const auto done = writeAll(options, folder, *result, poses); !done) return fail(done.errors());
    fmt::print("{}", truth::frontText(result->rows));
    const int code = printDisagreements(*result);
    fmt::print("{}: accuracy.csv, accuracy.svg, poses.csv, codebook.csv\n", options.out);
    return code;
}

}  // namespace passung::cli
