#include <gtest/gtest.h>

#include <cmath>

#include "tests/analysis/export/csv_reader.h"
#include "tests/hard/case.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

namespace passung::test {
namespace {

constexpr double kRounding = 1e-9;  // of a path with rotations, and what a spring makes of it

/// Writes the scene file of a hard case, with contact of fields as the cases have it, beside the meshes that it names.
std::string writeOnFields(const TempFolder& folder, const std::string& scene) {
    const std::filesystem::path path = hard::hardScenePath(scene);
    for (const auto& file : std::filesystem::directory_iterator(path.parent_path()))
        if (file.path().extension() == ".off")
            std::filesystem::copy_file(file, folder / file.path().filename().string(),
                                       std::filesystem::copy_options::overwrite_existing);
    writeText(folder / "scene.toml", onFields(readText(path.string())));
    return "scene.toml";
}

TEST(HardSimulate, TheProgramGivesWhatTheHardCasesJudge) {
    // Truth: invariant. The same scene file and path through `passung simulate`, read back exactly but for quaternions,
    // whose length is made 1 once more. Among the paths: a sensor that lies, a device in the loop, an open sheet.
    const TempFolder folder;
    for (const char* name : {"sheet_edge", "lying_device", "border_stiffness", "a10_cone", "mesh_flipped"}) {
        SCOPED_TRACE(name);
        hard::Case some = *hard::findCase(name);
        some.seconds = std::min(some.seconds, 1.0);
        const auto run = hard::runCase(some, scene::ContactMethod::GodObjectHeuristic, 0, false);
        ASSERT_TRUE(run);
        writeText(folder / "path.csv", hard::trajectoryCsv(*run));
        const std::string out = std::string(name) + ".csv";
        const Ended ended = runProgram(
            folder.path(), {"simulate", writeOnFields(folder, some.scene), "--trajectory", "path.csv", "--out", out});
        ASSERT_EQ(ended.exit_code, 0) << ended.err;
        const fake::CsvFile t = fake::readCsv(readText(folder / out));
        ASSERT_EQ(t.rows.size(), run->ticks.size());
        int different = 0;
        for (std::size_t i = 0; i < t.rows.size(); ++i) {
            const hard::Tick& tick = run->ticks[i];
            const auto differs = [&](const char* column, double value) {
                different += std::abs(std::stod(t.at(i, column)) - value) <= kRounding ? 0 : 1;
            };
            differs("proxy_x_m", tick.proxy.p.x());
            differs("proxy_z_m", tick.proxy.p.z());
            differs("proxy_qw", tick.proxy.q.w());
            differs("force_z_N", tick.sent.force.z());
            differs("torque_x_Nm", tick.sent.torque.x());
            differs("iterations", tick.iterations);
        }
        EXPECT_EQ(different, 0);
    }
}

TEST(HardSimulate, ThePressOfABallIsTheSpringOfItsDepth) {
    // Truth: closed form. A ball of 20 mm rests 1 mm too low over a table at z = 0: its proxy lies on the table within
    // the tolerance of 20 um, and the spring of 1000 N/m pushes with 1 N up and with nothing aside.
    const TempFolder folder;
    const hard::Case some = *hard::findCase("a13_cycle");
    const auto run = hard::runCase(some, scene::ContactMethod::GodObjectHeuristic, 0, false);
    ASSERT_TRUE(run);
    writeText(folder / "path.csv", hard::trajectoryCsv(*run));
    const Ended ended = runProgram(
        folder.path(), {"simulate", writeOnFields(folder, some.scene), "--trajectory", "path.csv", "--out", "out.csv"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const fake::CsvFile t = fake::readCsv(readText(folder / "out.csv"));
    int pressed = 0;
    for (std::size_t i = 1; i < t.rows.size(); ++i) {
        const auto number = [&](const char* column) { return std::stod(t.at(i, column)); };
        if (std::abs(number("device_z_m") - 9e-3) > 1e-12) continue;
        ++pressed;
        EXPECT_NEAR(number("proxy_z_m"), 10e-3, 20e-6);
        EXPECT_NEAR(number("force_z_N"), 1.0, 0.02);
        EXPECT_NEAR(number("force_x_N"), 0.0, 1e-9);
    }
    EXPECT_GE(pressed, 20);
}

}  // namespace
}  // namespace passung::test
