#include <gtest/gtest.h>

#include <cmath>

#include "tests/analysis/export/csv_reader.h"
#include "tests/hard/case.h"
#include "tests/ui/cli/program.h"

namespace passung::test {
namespace {

constexpr double kRounding = 1e-9;  // of a path with rotations, and what a spring makes of it

TEST(HardSimulate, TheProgramGivesWhatTheHardCasesJudge) {
    // Truth: independent program (the same scene file and path through `passung simulate`, read
    // back exactly but for quaternions, whose length is made 1 once more). Among the paths: a sensor that lies, a
    // device in the loop, an open sheet.
    const TempFolder folder;
    for (const char* name : {"sheet_edge", "lying_device", "border_stiffness", "a10_cone", "mesh_flipped"}) {
        SCOPED_TRACE(name);
        hard::Case some = *hard::findCase(name);
        some.seconds = std::min(some.seconds, 1.0);
        const auto run = hard::runCase(some, model::ContactMethod::GodObjectHeuristic, 0, false);
        ASSERT_TRUE(run);
        writeText(folder / "path.csv", hard::trajectoryCsv(*run));
        const std::string out = std::string(name) + ".csv";
        const Ended ended = runProgram(
            folder.path(), {"simulate", hard::hardScenePath(some.scene), "--trajectory", "path.csv", "--out", out});
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

}  // namespace
}  // namespace passung::test
