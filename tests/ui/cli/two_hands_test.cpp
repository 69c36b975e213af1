#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "analysis/truth/exact_overlap.h"
#include "study/store/read/store_reader.h"
#include "tests/analysis/export/csv_reader.h"
#include "tests/ui/cli/program.h"

// Two hands as users meet them: scenes, device paths, a study, its replay and its tables.

namespace passung::test {
namespace {

/// Two boxes of 20 mm, 0.4 mm apart, face to face along x; 1000 N/m.
const std::string kTwoBoxes = R"(unit = "mm"

[[part]]
name = "right"
held = true
shape = { kind = "box", width = 20, depth = 20, height = 20 }
pose = { position = [-10.2, 0, 0] }

[[part]]
name = "left"
held = true
hand = "other"
shape = { kind = "box", width = 20, depth = 20, height = 20 }
pose = { position = [10.2, 0, 0] }

[contact]
method = "god_object"
stiffness_N_per_m = 1000

[[hand]]
name = "other"
)";

std::string pathOf(double x_begin, double x_end) {
    std::string csv = "t_s,x_m,y_m,z_m,qw,qx,qy,qz\n";
    csv += "0," + std::to_string(x_begin) + ",0,0,1,0,0,0\n";
    csv += "0.1," + std::to_string(x_end) + ",0,0,1,0,0,0\n";
    return csv + "0.2," + std::to_string(x_end) + ",0,0,1,0,0,0\n";
}

class TwoHands : public testing::Test {
protected:
    Ended program(const std::vector<std::string>& arguments) const { return runProgram(folder_.path(), arguments); }

    TempFolder folder_;
};

TEST_F(TwoHands, SimulateTakesAPathAndGivesATableForEachHand) {
    // Truth: closed form. Pressed together by d, two equal springs give way by d/2 each; each hand feels K d/2.
    writeText(folder_ / "scene.toml", kTwoBoxes);
    writeText(folder_ / "a.csv", pathOf(-0.0102, -0.0072));
    writeText(folder_ / "b.csv", pathOf(0.0102, 0.0092));
    const Ended ended = program({"simulate", "scene.toml", "--trajectory", "a.csv", "--trajectory", "b.csv", "--out",
                                 "a_out.csv", "--out", "b_out.csv"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const fake::CsvFile a = fake::readCsv(readText(folder_ / "a_out.csv"));
    const fake::CsvFile b = fake::readCsv(readText(folder_ / "b_out.csv"));
    ASSERT_EQ(a.rows.size(), 201u);
    ASSERT_EQ(b.rows.size(), 201u);
    const double d = 0.004 - 0.0004;
    const auto last = [](const fake::CsvFile& csv, const char* column) { return std::stod(csv.at(200, column)); };
    EXPECT_NEAR(last(a, "force_x_N"), -1000.0 * d / 2, 1e-3);
    EXPECT_NEAR(last(b, "force_x_N"), 1000.0 * d / 2, 1e-3);
    EXPECT_NEAR(last(a, "proxy_x_m"), -0.0072 - d / 2, 1e-6);
    EXPECT_NEAR(last(b, "proxy_x_m"), 0.0092 + d / 2, 1e-6);
    EXPECT_EQ(std::stod(a.at(0, "force_x_N")), 0.0);
}

TEST_F(TwoHands, SimulateRefusesWhatDoesNotFitTheHands) {
    // Truth: the rule of the command, one line with what is wrong.
    writeText(folder_ / "scene.toml", kTwoBoxes);
    writeText(folder_ / "a.csv", pathOf(-0.0102, -0.0072));
    const Ended one = program({"simulate", "scene.toml", "--trajectory", "a.csv", "--out", "a_out.csv"});
    EXPECT_EQ(one.exit_code, 1);
    EXPECT_NE(one.err.find("--trajectory: 1 files: must be given once for each hand of the scene, which has 2"),
              std::string::npos)
        << one.err;
    const Ended outs =
        program({"simulate", "scene.toml", "--trajectory", "a.csv", "--trajectory", "a.csv", "--out", "a_out.csv"});
    EXPECT_EQ(outs.exit_code, 1);
    EXPECT_NE(outs.err.find("--out: 1 files: must be given as often as --trajectory"), std::string::npos) << outs.err;
    const Ended same = program({"simulate", "scene.toml", "--trajectory", "a.csv", "--trajectory", "a.csv", "--out",
                                "a_out.csv", "--out", "a_out.csv"});
    EXPECT_EQ(same.exit_code, 1) << same.err;
    const Ended alike = program({"simulate", "scene.toml", "--trajectory", "a.csv", "--trajectory", "a.csv", "--out",
                                 "a_out.csv", "--out", "./a_out.csv"});
    EXPECT_EQ(alike.exit_code, 1) << alike.err;
    const Ended nowhere = program({"simulate", "scene.toml", "--trajectory", "a.csv", "--trajectory", "a.csv", "--out",
                                   "a_out.csv", "--out", "no/such/folder/b_out.csv"});
    EXPECT_EQ(nowhere.exit_code, 1) << nowhere.err;
    const Ended measured = program({"accuracy", "scene.toml", "--trajectory", "a.csv", "--out", "acc.csv"});
    EXPECT_EQ(measured.exit_code, 1) << measured.err;
    EXPECT_NE(measured.err.find("has more than one hand"), std::string::npos) << measured.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a_out.csv"));
}

Pose poseOf(const std::array<float, 3>& p, const std::array<float, 4>& q) {
    return {Quat(q[0], q[1], q[2], q[3]).normalized(), Vec3(p[0], p[1], p[2])};
}

Pose proxyOf(const TickRecord& record) { return poseOf(record.proxy_position_m, record.proxy_quaternion); }

/// The shipped study with one repetition, run by one simulated participant.
class TwoHandStudy : public TwoHands {
protected:
    void SetUp() override {
        std::string text = readText(PASSUNG_SOURCE_DIR "/protocols/two_hands/study.toml");
        const std::string repetitions = "repetitions = 2";
        text.replace(text.find(repetitions), repetitions.size(), "repetitions = 1");
        writeText(folder_ / "study.toml", text);
        run_ = program({"run", "study.toml", "--simulated", "1", "--db", "study.db"});
    }

    Ended run_;
};

TEST_F(TwoHandStudy, RunsReplaysAndExports) {
    // Truth: invariants of a session: every trial ended by its own rules, all bits again from the inputs of both hands;
    // from outside: no overlap of what was shown above 0.1 um and float rounding by exact geometry at each judged tick,
    // both parts where they were; the plate did move and was pushed as hard as the peg.
    ASSERT_EQ(run_.exit_code, 0) << run_.err;
    auto reader = store::StoreReader::open(folder_ / "study.db");
    ASSERT_TRUE(reader);
    const auto attempts = reader->attempts();
    ASSERT_TRUE(attempts);
    ASSERT_EQ(attempts->size(), 5u);
    std::size_t inserted = 0, pressed = 0;
    double moved = 0.0;
    for (const auto& attempt : *attempts) {
        inserted += attempt.outcome == "success";
        const auto peg = reader->records(attempt.attempt_id, 0), plate = reader->records(attempt.attempt_id, 1);
        ASSERT_TRUE(peg && plate);
        ASSERT_EQ(peg->size(), plate->size());
        const double bore = attempt.presented_condition.starts_with("0.5") ? 0.021 : 0.0202;
        const truth::OverlapBody peg_body(shape::Peg{0.02, 0.05, 0.0005}, 5e-7);
        const truth::OverlapBody plate_body(shape::BorePlate{0.06, 0.06, 0.03, bore, 0.025, 0.0005}, 5e-7);
        for (std::size_t i = 0; i < peg->size(); ++i) {
            const TickRecord &a = (*peg)[i], &b = (*plate)[i];
            ASSERT_EQ(a.tick, b.tick);
            moved = std::max(moved, proxyOf(b).p.norm());
            if ((a.status & kEngaged) == 0 || (b.status & kEngaged) == 0 || a.contacts == 0) continue;
            const Vec3 on_peg(a.force_N[0], a.force_N[1], a.force_N[2]),
                on_plate(b.force_N[0], b.force_N[1], b.force_N[2]);
            if (on_peg.norm() > 1.0 && (a.status & (kForceLimited | kRateLimited)) == 0) {
                ++pressed;
                // The damper and a hand that is not at rest are in it too: action and reaction within a fifth.
                EXPECT_LT((on_peg + on_plate).norm(), 0.2 * on_peg.norm() + 0.3) << i;
            }
            if (i % 100 != 0) continue;
            const truth::Overlap found =
                truth::overlapOf(peg_body, proxyOf(a), plate_body, proxyOf(b), {.ignore = 1e-7});
            EXPECT_LT(found.depth, 0.3e-6) << "tick " << a.tick;
        }
    }
    EXPECT_EQ(inserted, attempts->size());
    EXPECT_GT(pressed, 100u);
    EXPECT_GT(moved, 1e-4);

    const Ended replay = program({"replay", "study.db"});
    EXPECT_EQ(replay.exit_code, 0) << replay.out << replay.err;
    const Ended verify = program({"verify", "study.db"});
    EXPECT_EQ(verify.exit_code, 0) << verify.out << verify.err;

    const Ended exported = program({"export", "study.db", "--out", "tables"});
    ASSERT_EQ(exported.exit_code, 0) << exported.err;
    // Each hand's rows are one scene's, and tell whose they are.
    const fake::CsvFile energies = fake::readCsv(readText(folder_ / "tables/contact_energy.csv"));
    ASSERT_EQ(energies.rows.size(), 4 * attempts->size());
    for (std::size_t i = 0; i < energies.rows.size(); ++i) {
        EXPECT_EQ(energies.at(i, "scene"), "1");
        EXPECT_EQ(energies.at(i, "hand"), i % 4 < 2 ? "NA" : "left");
        const std::string obstacle = i % 2 == 1 ? "NA" : i % 4 == 0 ? "plate" : "peg";
        EXPECT_EQ(energies.at(i, "obstacle"), obstacle);
    }
    std::size_t of_first = 0, of_second = 0;
    for (const auto& file : std::filesystem::directory_iterator(folder_ / "tables/samples"))
        ++(file.path().string().ends_with("_left.csv.gz") ? of_second : of_first);
    EXPECT_EQ(of_first, attempts->size());
    EXPECT_EQ(of_second, attempts->size());
}

}  // namespace
}  // namespace passung::test
