#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "study/store/read/store_reader.h"
#include "tests/analysis/export/csv_reader.h"
#include "tests/support/length.h"
#include "tests/support/mesh_crossing.h"
#include "tests/ui/cli/program.h"

// Parts of another program (tests/data/parts), as a lab puts them into a study. PASSUNG_LONG=1: 143 insertions of each
// of seven pegs, 100 of the turned ones; else a few.

namespace passung::test {
namespace {

const std::filesystem::path kParts = PASSUNG_SOURCE_DIR "/tests/data/parts";

/// Binary STL in mm, corner by corner: a reader of its own.
geometry::TriangleMesh readStl(const std::string& name) {
    const std::string bytes = readText(kParts / (name + ".stl"));
    geometry::TriangleMesh mesh;
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, 4);
    for (std::uint32_t i = 0; i < count; ++i) {
        std::array<float, 9> corners{};
        std::memcpy(corners.data(), bytes.data() + 84 + 50 * i + 12, 36);
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (std::size_t k = 0; k < 9; k += 3)
            mesh.vertices.push_back(1e-3 * Vec3(corners[k], corners[k + 1], corners[k + 2]));
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

struct Fit {
    std::string peg, hole;
};

/// A study as protocols/README.md has it: each fit `repetitions` times, the peg turned about its axis.
std::string passageStudy(const std::vector<Fit>& fits, double turn_deg, int repetitions, int timeout) {
    std::string levels;
    const auto path = [](const std::string& name) { return (kParts / (name + ".stl")).string(); };
    for (const Fit& fit : fits)
        levels += fmt::format(R"(  {{ label = "{0}", set = {{ "part.peg.mesh" = "{1}", "part.block.mesh" = "{2}" }} }},
)",
                              fit.hole, path(fit.peg), path(fit.hole));
    return fmt::format(R"(passung = 1
[study]
name = "made_elsewhere"
version = "1"
seed = 11
participants = 100
[scene]
unit = "mm"
[[scene.part]]
name = "block"
mesh = "{}"
[[scene.part]]
name = "peg"
held = true
mesh = "{}"
pose = {{ position = [20, 0, 30], rotation_deg = [0, 0, {}] }}
[scene.contact]
method = "god_object"
[scene.device]
preset = "sigma7"
[scene.start_gate]
position_tolerance_mm = 3
angle_tolerance_deg = 5
hold_ms = 200
[[factor]]
name = "fit"
levels = [
{}]
[task]
type = "narrow_passage"
target = "block"
passage_length_mm = 20
passage_width_mm = 4
timeout_s = {}
[[block]]
name = "main"
order = "random"
repetitions = {}
)",
                       path(fits[0].hole), path(fits[0].peg), turn_deg, levels, timeout, repetitions);
}

struct Judged {
    int trials = 0, inserted = 0;
    std::int64_t poses = 0;
    double least_gap = 1e-3;  // [m] 0: they cross or touch
};

class MadeElsewhere : public testing::Test {
protected:
    Ended program(const std::vector<std::string>& arguments) const { return runProgram(folder_.path(), arguments); }

    /// Runs the study by one simulated person; the poses in contact, one of `every` ticks, against triangles.
    Judged run(const std::string& study, const std::vector<Fit>& fits, int every) {
        Judged judged;
        writeText(folder_ / "study.toml", study);
        const std::string db = fmt::format("study{}.db", ++runs_);
        const Ended ended = program({"run", "study.toml", "--simulated", "1", "--db", db});
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        if (ended.exit_code != 0) return judged;
        auto reader = store::StoreReader::open(folder_ / db);
        const auto attempts = reader->attempts();
        for (const store::AttemptRow& attempt : *attempts) {
            const auto fit =
                std::find_if(fits.begin(), fits.end(), [&](const Fit& each) { return attempt.condition == each.hole; });
            if (fit == fits.end()) {
                ADD_FAILURE() << attempt.condition;
                continue;
            }
            ++judged.trials;
            const auto records = reader->records(attempt.attempt_id);
            judged.inserted += attempt.outcome == "success" && isThrough(records->back()) ? 1 : 0;
            judge(*records, *fit, every, judged);
        }
        return judged;
    }

    TempFolder folder_;

private:
    static Pose proxyOf(const TickRecord& r) {
        const auto& p = r.proxy_position_m;
        const auto& q = r.proxy_quaternion;
        return {Quat(q[0], q[1], q[2], q[3]).normalized(), Vec3(p[0], p[1], p[2])};
    }
    /// The tip, 20 mm below the mouth and within it.
    static bool isThrough(const TickRecord& r) {
        const Vec3 p = proxyOf(r).p;
        return p.z() < -0.0199 && p.head<2>().norm() < 1e-3;
    }
    static void judge(const std::vector<TickRecord>& records, const Fit& fit, int every, Judged& judged) {
        MeshPairTruth truth(readStl(fit.peg), readStl(fit.hole));
        for (std::size_t i = 0; i < records.size(); i += static_cast<std::size_t>(every)) {
            if (!(records[i].proxy_position_m[2] < 1e-3)) continue;
            ++judged.poses;
            judged.least_gap = std::min(judged.least_gap, truth.distance(proxyOf(records[i]), judged.least_gap));
        }
    }

    int runs_ = 0;
};

TEST_F(MadeElsewhere, PegsOfFourToSixteenMillimetresGoIntoHolesWithFiftyMicrometresOfPlay) {
    // Truth: the recorded pose at the end; triangle against triangle, by formulas of the test's own.
    const std::vector<Fit> fits{{"round_4", "round_4_hole"},   {"round_8", "round_8_hole"},
                                {"round_12", "round_12_hole"}, {"round_16", "round_16_hole"},
                                {"rect_4", "rect_4_hole"},     {"rect_8", "rect_8_hole"},
                                {"rect_16", "rect_16_hole"}};
    const Judged judged = run(passageStudy(fits, 0.0, atFullLength() ? 143 : 1, 60), fits, atFullLength() ? 50 : 100);
    std::printf("[ pegs  ] inserted %d of %d, %lld poses, least gap %.2f um\n", judged.inserted, judged.trials,
                static_cast<long long>(judged.poses), 1e6 * judged.least_gap);
    EXPECT_GE(judged.inserted, 0.99 * judged.trials);
    EXPECT_GT(judged.least_gap, 0.0);
    EXPECT_GT(judged.poses, 20 * judged.trials);
}

TEST_F(MadeElsewhere, PegsThatAreTurnedAreTurnedToFit) {
    // Truth: as above.
    const std::vector<Fit> fits{{"d_8", "d_8_hole"}, {"square_8", "square_8_hole"}};
    Judged all;
    for (const double turn : {20.0, -13.0}) {
        const Judged judged = run(passageStudy(fits, turn, atFullLength() ? 50 : 1, 60), fits, 100);
        all.trials += judged.trials;
        all.inserted += judged.inserted;
        all.least_gap = std::min(all.least_gap, judged.least_gap);
    }
    std::printf("[ turned ] inserted %d of %d, least gap %.2f um\n", all.inserted, all.trials, 1e6 * all.least_gap);
    EXPECT_GE(all.inserted, 0.95 * all.trials);
    EXPECT_GT(all.least_gap, 0.0);
}

TEST_F(MadeElsewhere, PegsThatAreTooLargeAreNot) {
    // Truth: closed form: 50 um too wide.
    const std::vector<Fit> fits{{"d_8", "d_8_hole_small"}, {"square_8", "square_8_hole_small"}};
    const Judged judged = run(passageStudy(fits, 12.0, atFullLength() ? 10 : 1, atFullLength() ? 40 : 12), fits, 200);
    EXPECT_EQ(judged.inserted, 0);
    EXPECT_GT(judged.least_gap, 0.0);
}

TEST_F(MadeElsewhere, APegThatIsInTheHandFromTheStartIsLetGoWhereItBelongs) {
    // Truth: the rule of success of the assembly.
    std::string study = passageStudy({{"rect_8", "rect_8_hole"}}, 15.0, atFullLength() ? 10 : 2, 60);
    const auto cut = [&study](const std::string& from, const std::string& to, const std::string& by) {
        const std::size_t begin = study.find(from);
        study.replace(begin, study.find(to, begin) - begin, by);
    };
    cut("[scene.start_gate]", "[task]", "[scene.effects.pick]\nreach_mm = 5\n");
    cut("[task]", "[[block]]",
        "[task]\ntype = \"assembly\"\ntimeout_s = 60\n[[task.step]]\npart = \"peg\"\ninto = \"block\"\n"
        "position = [0, 0, -20]\ninsertion_mm = 20\nsymmetry = 2\n");
    cut("held = true", "\nmesh", "held = true\npickable = true");
    writeText(folder_ / "study.toml", study);
    const Ended ended = program({"run", "study.toml", "--simulated", "1", "--db", "study.db"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const auto attempts = store::StoreReader::open(folder_ / "study.db")->attempts();
    for (const store::AttemptRow& attempt : *attempts) EXPECT_EQ(attempt.outcome, "success");
}

/// What a scene of two meshes did along a path of the hand.
struct Followed {
    std::vector<Pose> hand, proxy;
    int crossings = 0, suspended = 0;
    double most_lag = 0.0;       // [m] of the proxy along z behind the hand
    double most_turn_lag = 0.0;  // [rad]
};

class MadeElsewherePair : public MadeElsewhere {
protected:
    Followed follow(const std::string& held, const std::string& fixed, const Pose& X_WStart,
                    const std::function<Pose(double)>& hand, int ticks, std::size_t every) {
        const Vec3 p = 1e3 * X_WStart.p;
        writeText(folder_ / "scene.toml",
                  fmt::format(
                      "unit = \"mm\"\n[[part]]\nname = \"fixed\"\nmesh = \"{}\"\n[[part]]\nname = \"held\"\n"
                      "held = true\nmesh = \"{}\"\npose = {{ position = [{}, {}, {}] }}\n[contact]\n"
                      "method = \"god_object\"\nstiffness_N_per_m = 2000\nrotational_stiffness_Nm_per_rad = 1\n",
                      (kParts / (fixed + ".stl")).string(), (kParts / (held + ".stl")).string(), p.x(), p.y(), p.z()));
        std::string path = "t_s,x_m,y_m,z_m,qw,qx,qy,qz\n";
        for (int i = 0; i <= ticks; ++i) {
            const Pose X = hand(1e-3 * i);
            path += fmt::format("{},{},{},{},{},{},{},{}\n", 1e-3 * i, X.p.x(), X.p.y(), X.p.z(), X.q.w(), X.q.x(),
                                X.q.y(), X.q.z());
        }
        writeText(folder_ / "path.csv", path);
        const Ended ended = program({"simulate", "scene.toml", "--trajectory", "path.csv", "--out", "out.csv"});
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        return judge(fake::readCsv(readText(folder_ / "out.csv")), readStl(held), readStl(fixed), every);
    }

private:
    /// At one of `every` ticks, and half way from the one before.
    static Followed judge(const fake::CsvFile& file, const geometry::TriangleMesh& held,
                          const geometry::TriangleMesh& fixed, std::size_t every) {
        Followed followed;
        MeshPairTruth truth(held, fixed);
        const auto pose = [&file](std::size_t row, const std::string& of) {
            const auto cell = [&](const char* name) { return std::stod(file.at(row, of + name)); };
            return Pose{Quat(cell("_qw"), cell("_qx"), cell("_qy"), cell("_qz")).normalized(),
                        Vec3(cell("_x_m"), cell("_y_m"), cell("_z_m"))};
        };
        for (std::size_t i = 0; i < file.rows.size(); ++i) {
            followed.hand.push_back(pose(i, "device"));
            const Pose X = pose(i, "proxy");
            if (i % every == 0) {
                followed.crossings += truth.distance(X, 1e-6) == 0.0 ? 1 : 0;
                if (i > 0) {
                    const Pose& before = followed.proxy.back();
                    const Pose between{before.q.slerp(0.5, X.q), 0.5 * (before.p + X.p)};
                    followed.crossings += truth.distance(between, 1e-7) == 0.0 ? 1 : 0;
                }
            }
            followed.suspended += std::stoi(file.at(i, "suspended")) != 0 ? 1 : 0;
            followed.most_lag = std::max(followed.most_lag, std::abs(X.p.z() - followed.hand.back().p.z()));
            const double turn = rotationVector(X.q * followed.hand.back().q.conjugate()).norm();
            followed.most_turn_lag = std::max(followed.most_turn_lag, turn);
            followed.proxy.push_back(X);
        }
        return followed;
    }
};

TEST_F(MadeElsewherePair, GearsMeshWithoutAToothThatJumps) {
    // Truth: triangle against triangle, at ticks and half way between. A tooth would have to cross one, or to be lifted
    // over it: the axes then are 44 mm apart.
    const Pose start{Quat::Identity(), Vec3(0.0401, 0, 0)};
    const Followed followed = follow(
        "gear", "gear_gap", start,
        [](double t) {
            const double s = std::min(t / 0.2, 1.0);  // pressed in, turned to and fro by a whole tooth, and shaken
            return Pose{rotationFromVector(
                            Vec3(0.02 * s * std::sin(9 * t), 0.02 * s * std::sin(7 * t), 0.31 * std::sin(4 * t))),
                        Vec3(0.0401 - 0.004 * s, 0.002 * s * std::sin(5 * t), 0.001 * s * std::sin(3 * t))};
        },
        atFullLength() ? 10000 : 1500, 4);
    double farthest = 0.0;
    for (const Pose& X : followed.proxy) farthest = std::max(farthest, X.p.head<2>().norm());
    std::printf("[ gears ] crossings %d of %zu ticks, suspended %d, axes up to %.2f mm apart\n", followed.crossings,
                followed.proxy.size(), followed.suspended, 1e3 * farthest);
    EXPECT_EQ(followed.crossings, 0);
    EXPECT_LT(farthest, 0.0435);
}

TEST_F(MadeElsewherePair, ABoltInItsNutCrossesNothingAndSaysHowFarItLags) {
    // Truth: triangle against triangle, as above. The hand turns along the helix, to and fro by 2 rad, and shakes.
    const Followed followed = follow(
        "bolt", "nut", {},
        [](double t) {
            const double turn = 2.0 * std::sin(1.5 * t), s = std::min(t / 0.2, 1.0);
            return Pose{rotationFromVector(Vec3(0.01 * s * std::sin(11 * t), 0.01 * s * std::sin(9 * t), 0)) *
                            rotationFromVector(Vec3(0, 0, turn)),
                        Vec3(0.0004 * s * std::sin(7 * t), 0.0004 * s * std::sin(5 * t),
                             0.002 * turn / (2.0 * std::numbers::pi) + 0.0005 * s * std::sin(13 * t))};
        },
        atFullLength() ? 4000 : 600, atFullLength() ? 5 : 60);
    std::printf(
        "[ bolt  ] crossings %d of %zu ticks, suspended %.1f %%, lags up to %.2f mm along its axis, %.0f degrees\n",
        followed.crossings, followed.proxy.size(),
        100.0 * followed.suspended / static_cast<double>(followed.proxy.size()), 1e3 * followed.most_lag,
        followed.most_turn_lag * 180.0 / std::numbers::pi);
    EXPECT_EQ(followed.crossings, 0);
    EXPECT_LT(followed.most_lag, 0.003);
}

}  // namespace
}  // namespace passung::test
