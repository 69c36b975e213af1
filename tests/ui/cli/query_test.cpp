#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <numbers>

#include "core/base/number_table.h"
#include "core/base/types.h"
#include "tests/analysis/export/csv_reader.h"
#include "tests/ui/cli/program.h"

namespace passung::test {
namespace {

constexpr double kBall = 0.010;         // radius [m]
const Vec3 kHalf(0.020, 0.015, 0.010);  // half edges of the box [m]
constexpr double kStiffness = 1e9;      // of the reported wrench [N/m³]

const std::vector<std::string> kColumns = {"x_m",
                                           "y_m",
                                           "z_m",
                                           "qw",
                                           "qx",
                                           "qy",
                                           "qz",
                                           "signed_distance_m",
                                           "field_error_bound_m",
                                           "error_bound_m",
                                           "quality",
                                           "status",
                                           "closest_x_m",
                                           "closest_y_m",
                                           "closest_z_m",
                                           "normal_x",
                                           "normal_y",
                                           "normal_z",
                                           "force_x_N",
                                           "force_y_N",
                                           "force_z_N",
                                           "torque_x_Nm",
                                           "torque_y_Nm",
                                           "torque_z_Nm",
                                           "contacts",
                                           "nodes_visited",
                                           "points_tested",
                                           "query_us"};

const std::string kBoxPart =
    "[[part]]\nname = \"box\"\nshape = { kind = \"box\", width = 40, depth = 30, height = 20 }\n";
const std::string kBallPart = "[[part]]\nname = \"ball\"\nshape = { kind = \"sphere\", diameter = 20 }\n";

/// The stated bound next to contact: what the points, 1 mm apart, and the field's cells let slip at most. Farther away
/// the field is coarser and vouches for a share of the distance only.
constexpr double kBoundAtContact = 1.7e-3, kBoundShare = 0.35;
double largestBound(double distance) { return kBoundAtContact + kBoundShare * std::max(0.0, distance); }

/// Signed distance of a box with the half edges kHalf about the origin: the closed form.
double boxDistance(const Vec3& p) {
    const Vec3 q = p.cwiseAbs() - kHalf;
    return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

class Query : public testing::Test {
protected:
    void SetUp() override {
        writeText(folder_ / "box.toml", kBoxPart);
        writeText(folder_ / "ball.toml", kBallPart);
    }

    void writePoses(const std::vector<Vec3>& places, const Quat& q = Quat::Identity()) {
        std::string text = "x_m,y_m,z_m,qw,qx,qy,qz\n";
        for (const Vec3& p : places) {
            for (const double v : {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()}) {
                std::array<char, 32> digits;
                std::snprintf(digits.data(), digits.size(), "%.17g,", v);
                text += digits.data();
            }
            text.back() = '\n';
        }
        writeText(folder_ / "poses.csv", text);
    }

    fake::CsvFile query(const std::string& field, const std::string& shell, std::vector<std::string> options = {}) {
        std::vector<std::string> arguments = {"query", field, shell, "--poses", "poses.csv", "--out", "r.csv"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const Ended ended = runProgram(folder_.path(), arguments);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        EXPECT_EQ(ended.out + ended.err, "");
        EXPECT_FALSE(std::filesystem::exists(folder_ / "r.csv.part"));
        fake::CsvFile result = fake::readCsv(readText(folder_ / "r.csv"));
        EXPECT_EQ(result.header, kColumns);
        return result;
    }

    static double number(const fake::CsvFile& csv, std::size_t row, const std::string& column) {
        return std::stod(csv.at(row, column));
    }
    static Vec3 vector(const fake::CsvFile& csv, std::size_t row, const std::string& stem, const std::string& unit) {
        return {number(csv, row, stem + "_x" + unit), number(csv, row, stem + "_y" + unit),
                number(csv, row, stem + "_z" + unit)};
    }

    TempFolder folder_;
};

TEST_F(Query, ListsThePatchesOfContactOfEveryPose) {
    // Truth: closed form. The ball apart from the box; 1 mm deep in its top: one patch, whose area 2πRh is off by no
    // more than its border, 2π √(2Rh - h²), times what lies between points 0.5 mm apart.
    writePoses({Vec3(0, 0, 0.03), Vec3(0.003, 0.002, kHalf.z() + kBall - 1e-3)});
    query("box.toml", "ball.toml", {"--spacing-mm", "0.5", "--patches", "p.json"});
    const std::string json = readText(folder_ / "p.json");
    const auto first = json.find("\"row\":1"), second = json.find("\"row\":2");
    ASSERT_NE(first, std::string::npos) << json;
    ASSERT_NE(second, std::string::npos) << json;
    EXPECT_NE(json.find("\"patches_found\":0", first), std::string::npos);
    EXPECT_NE(json.find("\"patches_found\":1", second), std::string::npos);
    const auto value = [&](const std::string& name) {
        const std::string key = "\"" + name + "\":";
        const auto at = json.find(key, second);
        return at == std::string::npos ? -1.0 : std::stod(json.substr(at + key.size()));
    };
    constexpr double h = 1e-3;
    EXPECT_NEAR(value("depth_m"), h, 20e-6);
    EXPECT_NEAR(value("area_m2"), 2 * std::numbers::pi * kBall * h,
                2 * std::numbers::pi * std::sqrt(2 * kBall * h - h * h) * 0.36e-3);
    const Ended same = runProgram(folder_.path(), {"query", "box.toml", "ball.toml", "--poses", "poses.csv", "--out",
                                                   "r.csv", "--patches", "r.csv"});
    EXPECT_EQ(same.exit_code, 1);
    std::filesystem::remove(folder_ / "r.csv");
    const Ended both = runProgram(folder_.path(), {"query", "box.toml", "ball.toml", "--poses", "poses.csv", "--out",
                                                   "r.csv", "--patches", "q.json", "--two-way"});
    EXPECT_EQ(both.exit_code, 1);
    EXPECT_EQ(linesOf(both.err).size(), 1u) << both.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "r.csv") || std::filesystem::exists(folder_ / "q.json"));
}

TEST_F(Query, WritesThroughLinksAndRefusesWhatIsNoFile) {
    // Truth: invariant (a link stays a link, a pipe a pipe; a rename would put a file in their place).
    namespace fs = std::filesystem;
    writePoses({Vec3(0, 0, 0.03)});
    fs::create_directory(folder_ / "far");
    fs::create_symlink("far/back.csv", folder_ / "there.csv");
    fs::create_symlink("../result.csv", folder_ / "far/back.csv");
    ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    fs::create_symlink("pipe", folder_ / "to_pipe");
    fs::create_symlink("circle", folder_ / "circle");
    const auto into = [&](const std::string& out) {
        return runProgram(folder_.path(), {"query", "box.toml", "ball.toml", "--poses", "poses.csv", "--out", out});
    };
    for (int i = 0; i < 2; ++i) {  // the link leads nowhere at first
        const Ended good = into("there.csv");
        EXPECT_EQ(good.exit_code, 0) << good.err;
        EXPECT_TRUE(fs::is_symlink(folder_ / "there.csv"));
        EXPECT_TRUE(fs::is_symlink(folder_ / "far/back.csv"));
        EXPECT_EQ(linesOf(readText(folder_ / "result.csv")).size(), 2u);
        writeText(folder_ / "result.csv", "old");
    }
    for (const char* out : {"pipe", "to_pipe", "circle", "far"}) {
        const Ended bad = into(out);
        EXPECT_EQ(bad.exit_code, 1) << out;
        EXPECT_EQ(bad.err, std::string(out) +
                               ": error: is no regular file (a folder, a pipe or a device): name a "
                               "file\n");
        EXPECT_FALSE(fs::exists(folder_ / (std::string(out) + ".part")));
    }
    EXPECT_TRUE(fs::is_fifo(folder_ / "pipe"));
    EXPECT_TRUE(fs::is_symlink(folder_ / "to_pipe"));
    EXPECT_TRUE(fs::is_symlink(folder_ / "circle"));
}

TEST_F(Query, SaysWhereTheBoundMissesTheTolerance) {
    // Truth: invariant (the status and the bound beside it). No step is left to refine with after one node.
    writePoses({Vec3(0.001, 0.002, 0.0201), Vec3(0.05, 0.003, 0.001)});
    std::size_t missed = 0;
    for (const std::string budget : {"1", "1000000"}) {
        const fake::CsvFile r = query("box.toml", "ball.toml", {"--tolerance-um", "5", "--budget-nodes", budget});
        for (const std::size_t row : {0u, 1u}) {
            const bool above = number(r, row, "error_bound_m") > 5e-6;
            EXPECT_EQ(r.at(row, "status").find("bound_not_reached") != std::string::npos, above) << budget;
            missed += above ? 1 : 0;
        }
    }
    EXPECT_GT(missed, 0u);
    EXPECT_LT(missed, 4u);
}

TEST_F(Query, KeepsFurtherColumnsAndNamesTheLineOfABadPose) {
    // Truth: closed form (the text itself): "the input columns, then" the results.
    writeText(folder_ / "poses.csv",
              "x_m,y_m,z_m,qw,qx,qy,qz,label,weight\n0.05,0,0,1,0,0,0,\"far, right\",0.10\n\n0,0,0.045,1,0,0,0,,7\n");
    const std::vector<std::string> command = {"query",     "box.toml", "ball.toml", "--poses",
                                              "poses.csv", "--out",    "r.csv"};
    ASSERT_EQ(runProgram(folder_.path(), command).exit_code, 0);
    const fake::CsvFile r = fake::readCsv(readText(folder_ / "r.csv"));
    ASSERT_EQ(r.rows.size(), 2u);
    EXPECT_EQ(std::vector<std::string>(r.header.begin() + 7, r.header.begin() + 10),
              (std::vector<std::string>{"label", "weight", "signed_distance_m"}));
    EXPECT_EQ(r.at(0, "label"), "far, right");
    EXPECT_EQ(r.at(0, "weight"), "0.10");
    EXPECT_EQ(r.at(1, "label"), "");
    EXPECT_NEAR(std::stod(r.at(1, "signed_distance_m")), 0.025, largestBound(0.025));

    writeText(folder_ / "poses.csv", "x_m,y_m,z_m,qw,qx,qy,qz\n0,0,0,1,0,0,0\n\n\n0,0,0,2,0,0,0\n");
    const Ended bad = runProgram(folder_.path(), command);
    EXPECT_EQ(bad.exit_code, 1);
    EXPECT_TRUE(bad.err.starts_with("poses.csv:5:1: error: ")) << bad.err;
    writeText(folder_ / "poses.csv", "x_m,y_m,z_m,qw,qx,qy,qz,status\n0,0,0,1,0,0,0,ok\n");
    const Ended twice = runProgram(folder_.path(), command);
    EXPECT_EQ(twice.exit_code, 1);
    EXPECT_TRUE(twice.err.starts_with("poses.csv:1:1: error: status: ")) << twice.err;
}

/// Beside, above and at an edge of the box; touching; inside by up to 2 mm. The ball's deepest point is where the field
/// falls straight, so that the pair's distance is the centre's less the radius.
const std::vector<Vec3> kPlaces = {{0.050, 0.003, 0.001},    {0.001, 0.002, 0.045},  {0.040, 0.035, 0.002},
                                   {0.033, 0.027, 0.022},    {0.002, 0.001, 0.0201}, {0.003, -0.002, 0.0185},
                                   {-0.0285, 0.004, -0.001}, {0.002, -0.023, 0.001}};

TEST_F(Query, DistanceOfBallAndBoxIsTheClosedFormWithinTheStatedBound) {
    // Truth: closed form (distance of a box from the ball's centre, less its radius)
    const Quat turned(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
    writePoses(kPlaces, turned);
    for (const std::string mode : {"layered", "surface_point", "linear", "trilinear", "cubic"}) {
        const fake::CsvFile r = query("box.toml", "ball.toml", {"--mode", mode});
        ASSERT_EQ(r.rows.size(), kPlaces.size());
        for (std::size_t i = 0; i < kPlaces.size(); ++i) {
            SCOPED_TRACE(mode + ", pose " + std::to_string(i));
            const double truth = boxDistance(kPlaces[i]) - kBall;
            const double bound = number(r, i, "error_bound_m");
            EXPECT_NEAR(number(r, i, "signed_distance_m"), truth, bound);
            EXPECT_LT(bound, largestBound(truth));
            EXPECT_GE(number(r, i, "field_error_bound_m"), 0.0);
            EXPECT_EQ(number(r, i, "quality"), 1.0);
            EXPECT_EQ(r.at(i, "status"), "ok");
            EXPECT_EQ(number(r, i, "x_m"), kPlaces[i].x());
            EXPECT_EQ(number(r, i, "qy"), turned.y());
            EXPECT_GE(number(r, i, "points_tested"), 1.0);
            EXPECT_GE(number(r, i, "query_us"), 0.0);
            EXPECT_EQ(number(r, i, "contacts") > 0, truth < -0.2e-3);

            const Vec3 closest = vector(r, i, "closest", "_m");
            EXPECT_NEAR((closest - kPlaces[i]).norm(), kBall, 2e-5) << "the closest point lies on the ball";
            EXPECT_NEAR(boxDistance(closest), number(r, i, "signed_distance_m"), number(r, i, "field_error_bound_m"));
            const Vec3 normal = vector(r, i, "normal", "");
            EXPECT_NEAR(normal.norm(), 1.0, 1e-9);
            // The field's direction next to contact is that of fine cells. Farther away cells are 10 mm wide, and half
            // a cell over the 11 mm to the corner of pose 3 lets it err by up to 0.45 rad.
            EXPECT_GT(normal.dot(kPlaces[i] - closest), (truth < 1e-3 ? 0.99 : std::cos(0.45)) * kBall)
                << "out of the box, towards the ball's centre";
        }
    }
}

TEST_F(Query, DistanceOfTwoBallsIsTheClosedFormWithinTheStatedBound) {
    // Truth: closed form (the surface point of one ball that is nearest to the other's centre)
    const std::vector<Vec3> places = {{0.03, 0.01, 0.02}, {0.0, 0.0199, 0.0}, {0.01, 0.01, 0.012}, {0.004, 0.0, 0.001}};
    writePoses(places);
    const fake::CsvFile r = query("ball.toml", "ball.toml", {"--spacing-mm", "0.5", "--tolerance-um", "50"});
    for (std::size_t i = 0; i < places.size(); ++i) {
        SCOPED_TRACE(i);
        const double bound = number(r, i, "error_bound_m"), truth = std::abs(places[i].norm() - kBall) - kBall;
        EXPECT_NEAR(number(r, i, "signed_distance_m"), truth, bound);
        EXPECT_LT(bound, largestBound(truth));
    }
}

TEST_F(Query, WrenchOfADippedBallIsTheWeightOfTheCap) {
    // Truth: closed form (through the ball's centre. The ball's points in the box: κ × volume of the spherical cap. The
    // box's points in the ball: κ ∫ (r - distance from the centre) dA over the disc that the face cuts out.)
    const double depth = 2e-3, off = kBall - depth;
    const double cap = std::numbers::pi * depth * depth * (3.0 * kBall - depth) / 3.0;
    const auto cube = [](double x) { return x * x * x; };
    const double disc =
        std::numbers::pi * (kBall * (kBall * kBall - off * off) - 2.0 / 3.0 * (cube(kBall) - cube(off)));
    writePoses({{0.002, -0.001, kHalf.z() + kBall - depth}});
    for (const bool two_way : {false, true}) {
        std::vector<std::string> options = {"--spacing-mm", "0.5"};
        if (two_way) options.push_back("--two-way");
        const fake::CsvFile r = query("box.toml", "ball.toml", options);
        const Vec3 force = vector(r, 0, "force", "_N"), torque = vector(r, 0, "torque", "_Nm");
        const double truth = kStiffness * (two_way ? 0.5 * (cap + disc) : cap);
        EXPECT_NEAR(force.z(), truth, 0.01 * truth) << two_way;
        EXPECT_LT(force.head<2>().norm(), 0.01 * force.z());
        EXPECT_LT(torque.norm(), 0.01 * force.z() * kBall);
        EXPECT_NEAR(number(r, 0, "signed_distance_m"), -depth, number(r, 0, "error_bound_m"));
    }
}

TEST_F(Query, BeyondTheProximityOnlyTheLowerBoundIsSaid) {
    // Truth: closed form (5 mm is below the true distance of the first pose and above that of the second)
    writePoses({{0.0, 0.0, 0.045}, {0.0, 0.0, 0.022}});
    const fake::CsvFile r = query("box.toml", "ball.toml", {"--proximity-mm", "5"});
    EXPECT_EQ(number(r, 0, "signed_distance_m"), 0.005);
    EXPECT_EQ(r.at(0, "status"), "beyond_proximity");
    for (const char* column : {"closest_x_m", "closest_y_m", "closest_z_m", "normal_x", "normal_y", "normal_z"}) {
        EXPECT_EQ(r.at(0, column), "nan");
        EXPECT_NE(r.at(1, column), "nan");
    }
    EXPECT_EQ(r.at(1, "status"), "ok");
    EXPECT_NEAR(number(r, 1, "signed_distance_m"), 0.002, number(r, 1, "error_bound_m"));
    const fake::CsvFile unlimited = query("box.toml", "ball.toml");
    EXPECT_NEAR(number(unlimited, 0, "signed_distance_m"), 0.025, number(unlimited, 0, "error_bound_m"));
    EXPECT_EQ(number(unlimited, 1, "signed_distance_m"), number(r, 1, "signed_distance_m"));
}

TEST_F(Query, ABudgetEndsTheSearchAndAQualityWins) {
    // Truth: invariant (what is not proven is said; the asked share is reached)
    writePoses({{0.003, -0.002, 0.0185}});
    const fake::CsvFile full = query("box.toml", "ball.toml");
    const fake::CsvFile budget = query("box.toml", "ball.toml", {"--budget-nodes", "3"});
    EXPECT_EQ(budget.at(0, "status"), "budget_reached+bound_not_reached");
    EXPECT_LT(number(budget, 0, "quality"), 1.0);
    EXPECT_GE(number(budget, 0, "quality"), 0.0);
    EXPECT_LE(number(budget, 0, "nodes_visited"), 3.0 + 16.0) << "the children of the node at hand are finished";
    EXPECT_GT(number(full, 0, "nodes_visited"), 3.0 + 16.0);
    EXPECT_NEAR(number(budget, 0, "signed_distance_m"), -0.0015, number(budget, 0, "error_bound_m"));
    EXPECT_GT(number(budget, 0, "error_bound_m"), number(full, 0, "error_bound_m"));
    const fake::CsvFile both = query("box.toml", "ball.toml", {"--budget-nodes", "3", "--quality", "1"});
    EXPECT_EQ(both.at(0, "status"), "quality_overruled_budget");
    EXPECT_EQ(number(both, 0, "quality"), 1.0);
    EXPECT_EQ(number(both, 0, "signed_distance_m"), number(full, 0, "signed_distance_m"));
}

TEST_F(Query, UnitsOfOptionsAndFilesMeanTheSameParts) {
    // Truth: closed form (the same two parts, written in millimetres, metres and centimetres)
    const std::string box_m =
        "[[part]]\nname = \"box\"\nshape = { kind = \"box\", width = 0.04, depth = 0.03, height = 0.02 }\n";
    writeText(folder_ / "box_m.toml", box_m);
    writeText(folder_ / "box_says_m.toml", "unit = \"m\"\n" + box_m);
    writeText(folder_ / "ball_cm.toml",
              "[[part]]\nname = \"ball\"\nunit = \"cm\"\nshape = { kind = \"sphere\", diameter = 2 }\n");
    writeText(folder_ / "ball_m.toml", "[[part]]\nname = \"ball\"\nshape = { kind = \"sphere\", diameter = 0.02 }\n");
    writePoses({kPlaces[3], kPlaces[5]});
    const std::vector<std::vector<std::string>> same = {
        {"box_m.toml", "ball_m.toml", "--unit", "m"},
        {"box_m.toml", "ball.toml", "--field-unit", "m"},
        {"box.toml", "ball_m.toml", "--shell-unit", "m"},
        {"box_m.toml", "ball.toml", "--unit", "m", "--shell-unit", "mm"},
        {"box_says_m.toml", "ball_cm.toml"},
        {"box_says_m.toml", "ball_cm.toml", "--unit", "in"},
    };
    for (const auto& arguments : same) {
        const fake::CsvFile r = query(arguments[0], arguments[1], {arguments.begin() + 2, arguments.end()});
        for (const std::size_t row : {0u, 1u}) {
            const double truth = boxDistance(kPlaces[row == 0 ? 3 : 5]) - kBall;
            EXPECT_NEAR(number(r, row, "signed_distance_m"), truth, number(r, row, "error_bound_m")) << arguments[0];
            EXPECT_LT(number(r, row, "error_bound_m"), largestBound(truth));
        }
    }
}

TEST_F(Query, AMeshFileIsAPartToo) {
    // Truth: closed form (a cube of 20 mm as an OFF file in centimetres; the ball 3 mm above its top)
    writeText(folder_ / "cube.off",
              "OFF\n8 12 0\n-1 -1 -1\n1 -1 -1\n1 1 -1\n-1 1 -1\n-1 -1 1\n1 -1 1\n1 1 1\n-1 1 1\n"
              "3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n"
              "3 3 4 7\n");
    writePoses({{0.001, 0.002, 0.023}});
    const fake::CsvFile r = query("cube.off", "ball.toml", {"--field-unit", "cm"});
    EXPECT_NEAR(number(r, 0, "signed_distance_m"), 0.003, number(r, 0, "error_bound_m"));
    EXPECT_LT(number(r, 0, "error_bound_m"), largestBound(0.003));
}

TEST_F(Query, TheSameQueryGivesTheSameNumbers) {
    // Truth: invariant (nothing but the measured time differs)
    writePoses(kPlaces);
    const fake::CsvFile first = query("box.toml", "ball.toml", {"--two-way"});
    fake::CsvFile again = query("box.toml", "ball.toml", {"--two-way"});
    for (std::size_t row = 0; row < first.rows.size(); ++row) again.rows[row].back() = first.rows[row].back();
    EXPECT_EQ(first.rows, again.rows);
}

}  // namespace
}  // namespace passung::test
