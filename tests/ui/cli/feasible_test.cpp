#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "analysis/truth/mesh_oracle.h"
#include "core/shape/shape.h"
#include "study/feasible/path_problems.h"
#include "study/run/files/protocol_files.h"
#include "tests/analysis/export/csv_reader.h"
#include "tests/ui/cli/program.h"

// `passung feasible` as people use it, and its paths by an independent program.

namespace passung::test {
namespace {

constexpr const char* kData = PASSUNG_SOURCE_DIR "/tests/data/feasible/";
constexpr double kDense = 1e-4;  // between poses that FCL judges no point goes farther [m]
constexpr double kChord = 1e-6;  // of the triangles that it judges [m]

std::string pageStudy() {
    const std::string page = readText(PASSUNG_SOURCE_DIR "/protocols/ASSEMBLY.md"), fence = "```toml\n";
    const std::size_t begin = page.find(fence) + fence.size();
    return page.substr(begin, page.find("```", begin) - begin);
}

struct Placed {
    shape::Shape shape;
    Pose X;
};

/// What a step's object has under this key, as text; empty: no such step or key.
std::string valueIn(const std::string& json, const std::string& step, const std::string& key) {
    const std::size_t begin = json.find("{\"step\":\"" + step + "\""), end = json.find("search_s", begin);
    const std::string word = "\"" + key + "\":";
    const std::size_t at = json.find(word, begin);
    if (begin == std::string::npos || at == std::string::npos || at > end) return {};
    const std::size_t from = at + word.size();
    return json.substr(from, json.find_first_of(json[from] == '"' ? "\"" : ",}", from + 1) - from);
}
double numberIn(const std::string& json, const std::string& step, const std::string& key) {
    const std::string text = valueIn(json, step, key);
    return text.empty() ? -1.0 : std::stod(text);
}

/// A box with its centre at the origin [mm].
std::string boxOff(double width, double depth, double height) {
    std::string text = "OFF\n8 12 0\n";
    for (int i = 0; i < 8; ++i)
        text += std::to_string((i & 1 ? 0.5 : -0.5) * width) + " " + std::to_string((i & 2 ? 0.5 : -0.5) * depth) +
                " " + std::to_string((i & 4 ? 0.5 : -0.5) * height) + "\n";
    return text +
           "3 0 2 1\n3 1 2 3\n3 4 5 6\n3 5 7 6\n3 0 1 4\n3 1 5 4\n3 2 6 3\n3 3 6 7\n3 0 4 2\n3 2 4 6\n3 1 3 5\n3 3 7 "
           "5\n";
}

void replace(std::string& text, const std::string& what, const std::string& by) {
    ASSERT_NE(text.find(what), std::string::npos) << what;
    text.replace(text.find(what), what.size(), by);
}

class Feasible : public testing::Test {
protected:
    Ended search(const std::string& protocol, const std::string& seconds = "20",
                 const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words{"feasible", protocol, "--seconds", seconds, "--out", "out"};
        words.insert(words.end(), more.begin(), more.end());
        return runProgram(folder_.path(), words);
    }
    /// Waypoints of each part's step, in the order of the file.
    std::map<std::string, std::vector<Pose>> paths() const {
        const fake::CsvFile file = fake::readCsv(readText(folder_ / "out/paths_1.csv"));
        std::map<std::string, std::vector<Pose>> paths;
        for (std::size_t i = 0; i < file.rows.size(); ++i) {
            const auto number = [&](const char* name) { return std::stod(file.at(i, name)); };
            paths[file.at(i, "step")].push_back({Quat(number("qw"), number("qx"), number("qy"), number("qz")),
                                                 Vec3(number("x_m"), number("y_m"), number("z_m"))});
        }
        return paths;
    }

    TempFolder folder_;
};

/// Poses of the path at which FCL finds the surfaces crossing; `judged` counts all.
int crossings(const shape::Shape& moving, const std::vector<Pose>& path, const std::vector<Placed>& standing,
              int& judged, double chord = kChord) {
    const auto mesh = shape::tessellate(moving, chord);
    double reach = 0.0;
    for (const Vec3& v : mesh.vertices) reach = std::max(reach, v.norm());
    int crossed = 0;
    for (const Placed& other : standing) {
        const truth::MeshOracle oracle(shape::tessellate(other.shape, chord), mesh);
        for (std::size_t i = 1; i < path.size(); ++i) {
            const Pose &a = path[i - 1], &b = path[i];
            const double way = (b.p - a.p).norm() + reach * a.q.angularDistance(b.q);
            const int steps = std::max(1, static_cast<int>(std::ceil(way / kDense)));
            for (int step = 0; step <= steps; ++step) {
                const double share = static_cast<double>(step) / steps;
                const Pose X{a.q.slerp(share, b.q), a.p + share * (b.p - a.p)};
                const auto meets = oracle.surfacesIntersect(other.X.inverse() * X);
                ++judged;
                crossed += !meets || *meets;
            }
        }
    }
    return crossed;
}

Pose at(double x, double y, double z) { return {Quat::Identity(), 1e-3 * Vec3(x, y, z)}; }

const shape::Shape kPin = shape::Peg{0.010, 0.040, 0.0005};
const shape::Shape kBlock = shape::Box{0.020, 0.020, 0.010}, kLid = shape::Box{0.030, 0.010, 0.008};
shape::Shape baseWith(double bore) { return shape::BorePlate{0.080, 0.060, 0.020, bore, 0.015, 0.0005}; }

TEST_F(Feasible, PathsOfThePagesStudyCrossNothing) {
    // Truth: independent program: FCL (collide) on triangles within 1 µm, at poses 0.1 mm apart; goals from the page.
    writeText(folder_ / "study.toml", pageStudy());
    const Ended ended = search("study.toml");
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    auto found = paths();
    const Placed base{baseWith(0.0104), {}};
    int judged = 0, crossed = 0;
    crossed += crossings(kPin, found["pin"], {base, {kBlock, at(-60, 30, 10)}, {kLid, at(-60, -30, 10)}}, judged);
    crossed += crossings(kBlock, found["block"], {base, {kPin, at(0, 0, -14.5)}, {kLid, at(-60, -30, 10)}}, judged);
    crossed += crossings(kLid, found["lid"], {base, {kPin, at(0, 0, -14.5)}, {kBlock, at(-25, 15, 5.5)}}, judged);
    EXPECT_EQ(crossed, 0);
    std::printf("FCL judged %d poses of paths: %d cross\n", judged, crossed);
    EXPECT_GT(judged, 3000);
    EXPECT_NEAR((found["pin"].back().p - Vec3(0, 0, -0.0145)).norm(), 0.0, 1e-12);
    EXPECT_NEAR((found["pin"].front().p - Vec3(0.060, 0.040, 0)).norm(), 0.0, 1e-12);
    // Closed form: the bore leaves 0.2 mm all round, and no path can have more at its goal.
    EXPECT_NE(ended.out.find("200.0"), std::string::npos) << ended.out;
}

TEST_F(Feasible, APathFromAGoalThatLeansCrossesNothing) {
    // Truth: as above; the pin has 50 µm of play all round and starts its way out beside the axis and askew.
    const Ended ended = search(std::string(kData) + "leaning.toml");
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    int judged = 0;
    EXPECT_EQ(crossings(kPin, paths()["pin"], {{baseWith(0.0101), {}}}, judged), 0);
    EXPECT_GT(judged, 500);
}

TEST_F(Feasible, AKeyIsTurnedIntoItsKeyway) {
    // Truth: as above. The pin starts 120 degrees off.
    const Ended ended = search(std::string(kData) + "keyed.toml");
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    int judged = 0;
    const shape::Shape pin = shape::KeyedPeg{0.010, 0.040, 0.003, 0.0015, 0.0005},
                       base = shape::KeyedBorePlate{0.080, 0.060, 0.020, 0.0102, 0.0032, 0.0016, 0.015, 0.0005};
    EXPECT_EQ(crossings(pin, paths()["pin"], {{base, {}}}, judged), 0);
}

TEST_F(Feasible, PathsOfTheShippedGearboxCrossNothing) {
    // Truth: independent program: FCL as above, on triangles within 5 µm, which is a twentieth of the least clearance.
    const std::string study = PASSUNG_SOURCE_DIR "/protocols/gearbox_assembly/study.toml";
    const Ended ended = search(study);
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const auto plan = run::readProtocol(study);
    ASSERT_TRUE(plan);
    const scene::SceneSpec& scene = plan->conditions.front().scene;
    const auto shapeOf = [&](std::size_t part) { return std::get<shape::Shape>(scene.parts[part].geometry); };
    auto found = paths();
    int judged = 0;
    for (const feasible::PathProblem& problem : feasible::problemsOf(plan->conditions.front())) {
        std::vector<Placed> standing;
        for (const feasible::StandingPart& other : problem.standing)
            standing.push_back({shapeOf(other.part), other.X_WP});
        EXPECT_EQ(crossings(shapeOf(problem.part), found[problem.name], standing, judged, 5e-6), 0) << problem.name;
    }
    std::printf("FCL judged %d poses of the gearbox's paths\n", judged);
    EXPECT_GT(judged, 50000);
}

TEST_F(Feasible, ABoreThatIsTooSmallIsRefusedWithTheOverlapAsProof) {
    // Truth: closed form: half of 10 mm less half of 9.9 mm are 50 µm.
    const Ended ended = search(std::string(kData) + "hole_too_small.toml");
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_NE(ended.err.find("step pin"), std::string::npos) << ended.err;
    EXPECT_NE(ended.err.find("the goal itself overlaps base by 50 µm (proof)"), std::string::npos) << ended.err;
    EXPECT_EQ(linesOf(ended.err).size(), 1u) << ended.err;
}

TEST_F(Feasible, AKeyThatIsTurnedByNinetyDegreesIsRefused) {
    // Truth: closed form: the key's corners are 6.5 mm from the axis, the bore's wall is at 5.1 mm.
    const Ended ended = search(std::string(kData) + "key_turned.toml");
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_NE(ended.err.find("step pin"), std::string::npos) << ended.err;
    EXPECT_NE(ended.err.find("(proof)"), std::string::npos) << ended.err;
}

TEST_F(Feasible, APartInAClosedBoxIsToldWithoutProof) {
    // Truth: topology: walls all round, without a gap.
    const Ended ended = search(std::string(kData) + "caught.toml", "3");
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_NE(ended.err.find("step lid"), std::string::npos) << ended.err;
    EXPECT_NE(ended.err.find("no path found within 3 s (no proof)"), std::string::npos) << ended.err;
}

TEST_F(Feasible, JsonSaysWhatTheWrittenPathsSay) {
    // Truth: sums over the waypoints of paths_1.csv; closed form: the bore leaves 0.2 mm all round, and the block, here
    // a mesh, ends 0.5 mm above the base. Only what is found from triangles comes with a proof.
    std::string text = pageStudy();
    replace(text, "shape = { kind = \"box\", width = 20, depth = 20, height = 10 }", "mesh = \"block.off\"");
    replace(text, "part = \"pin\"\n", "part = \"pin\"\nname = \"pin in\"\n");
    writeText(folder_ / "block.off", boxOff(20, 20, 10));
    writeText(folder_ / "study.toml", text);
    const Ended ended = search("study.toml", "20", {"--json"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_EQ(ended.out.find("{\"geometries\":["), 0u) << ended.out;
    EXPECT_EQ(valueIn(ended.out, "pin in", "part"), "\"pin");
    EXPECT_NEAR(numberIn(ended.out, "block", "clearance_m"), 0.0005, 2e-6) << ended.out;
    EXPECT_EQ(valueIn(ended.out, "block", "nearest"), "\"base") << ended.out;
    const double proven = numberIn(ended.out, "block", "proven_clearance_m");
    EXPECT_GT(proven, 0.0) << ended.out;
    EXPECT_LE(proven, 0.0005 + 2e-6);
    const auto found = paths();
    ASSERT_EQ(found.size(), 3u);
    for (const auto& [step, path] : found) {
        double length = 0.0, turn = 0.0;
        for (std::size_t i = 1; i < path.size(); ++i) {
            length += (path[i].p - path[i - 1].p).norm();
            turn += path[i - 1].q.angularDistance(path[i].q);
        }
        EXPECT_NEAR(numberIn(ended.out, step, "length_m"), length, 1e-9) << step;
        EXPECT_NEAR(numberIn(ended.out, step, "turn_rad"), turn, 1e-7) << step;
        EXPECT_EQ(valueIn(ended.out, step, "found"), "true");
    }
}

TEST_F(Feasible, JsonSaysWhyThereIsNoPath) {
    // Truth: closed form: half of 10 mm less half of 9.9 mm are 50 µm; topology: walls all round.
    const Ended ended = search(std::string(kData) + "hole_too_small.toml", "20", {"--json"});
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_EQ(valueIn(ended.out, "pin", "found"), "false") << ended.out;
    EXPECT_EQ(valueIn(ended.out, "pin", "is_proof"), "true");
    EXPECT_EQ(valueIn(ended.out, "pin", "why"), "\"the goal itself overlaps base by 50 µm (proof)");
    EXPECT_EQ(valueIn(ended.out, "pin", "length_m"), "");
    const Ended caught = search(std::string(kData) + "caught.toml", "1", {"--json"});
    EXPECT_EQ(caught.exit_code, 1);
    EXPECT_EQ(valueIn(caught.out, "lid", "is_proof"), "false") << caught.out;
    const Ended none = search(PASSUNG_SOURCE_DIR "/protocols/narrow_passage/study.toml", "1", {"--json"});
    EXPECT_EQ(none.exit_code, 0) << none.err;
    EXPECT_EQ(none.out, "{\"geometries\":[]}\n");
}

TEST_F(Feasible, ATaskWithoutAGoalBetweenPartsHasNothingToSearch) {
    // Truth: the shipped study's type is narrow_passage.
    const Ended ended = search(PASSUNG_SOURCE_DIR "/protocols/narrow_passage/study.toml");
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_NE(ended.out.find("there is nothing to search"), std::string::npos) << ended.out;
}

}  // namespace
}  // namespace passung::test
