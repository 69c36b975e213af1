#include <gtest/gtest.h>

#include <array>

#include "core/base/types.h"
#include "tests/ui/cli/program.h"

namespace passung::test {
namespace {

/// An ASCII STL of a cuboid of 1 × 2 × 3, the first `count` of its 12 triangles; the last two are its top.
std::string cuboid(std::size_t count) {
    const std::array<Vec3, 8> corner = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 2, 0), Vec3(0, 2, 0),
                                        Vec3(0, 0, 3), Vec3(1, 0, 3), Vec3(1, 2, 3), Vec3(0, 2, 3)};
    constexpr std::array<std::array<std::size_t, 3>, 12> kTriangles = {{{0, 2, 1},
                                                                        {0, 3, 2},
                                                                        {0, 1, 5},
                                                                        {0, 5, 4},
                                                                        {1, 2, 6},
                                                                        {1, 6, 5},
                                                                        {2, 3, 7},
                                                                        {2, 7, 6},
                                                                        {3, 0, 4},
                                                                        {3, 4, 7},
                                                                        {4, 5, 6},
                                                                        {4, 6, 7}}};
    std::string text = "solid cuboid\n";
    for (std::size_t i = 0; i < count; ++i) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const std::size_t c : kTriangles[i]) {
            text += "vertex";
            for (int axis = 0; axis < 3; ++axis) text += " " + std::to_string(static_cast<int>(corner[c][axis]));
            text += "\n";
        }
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid cuboid\n";
}

/// The value that the report gives to `name`.
std::string valueOf(const std::string& report, const std::string& name) {
    for (const std::string& line : linesOf(report)) {
        if (line.substr(0, 2 + name.size() + 1) != "  " + name + " ") continue;
        return line.substr(line.find_first_not_of(' ', 2 + name.size()));
    }
    return "no line " + name;
}

class MeshReport : public testing::Test {
protected:
    std::string report(const std::string& mesh, const std::vector<std::string>& options = {}) {
        writeText(folder_ / "part.stl", mesh);
        std::vector<std::string> arguments = {"mesh", "part.stl"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const Ended ended = runProgram(folder_.path(), arguments);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        return ended.out;
    }

    TempFolder folder_;
};

TEST_F(MeshReport, OfAClosedCuboidSaysItsSizeAndThatItIsWatertight) {
    // Truth: closed form (a cuboid of 1 × 2 × 3)
    const std::string mm = report(cuboid(12));
    EXPECT_EQ(valueOf(mm, "triangles"), "12");
    EXPECT_EQ(valueOf(mm, "vertices"), "8");
    EXPECT_EQ(valueOf(mm, "size"), "1 x 2 x 3 mm");
    EXPECT_EQ(valueOf(mm, "least x, y, z"), "0, 0, 0 mm");
    EXPECT_EQ(valueOf(mm, "greatest x, y, z"), "1, 2, 3 mm");
    EXPECT_EQ(valueOf(mm, "centre of bounds"), "0.5, 1, 1.5 mm");
    EXPECT_EQ(valueOf(mm, "origin"), "within the bounds, 1.87083 mm from their centre");
    EXPECT_EQ(valueOf(mm, "area"), "22 mm²");
    EXPECT_EQ(valueOf(mm, "volume"), "6 mm³");
    EXPECT_EQ(valueOf(mm, "watertight"), "yes");
    EXPECT_EQ(valueOf(mm, "holes"), "0");
    EXPECT_EQ(valueOf(mm, "inside"), "a closed solid");
    EXPECT_NE(mm.find("nothing to repair"), std::string::npos) << mm;
    const std::string cm = report(cuboid(12), {"--unit", "cm"});
    EXPECT_EQ(valueOf(cm, "size"), "10 x 20 x 30 mm");
    EXPECT_EQ(valueOf(cm, "volume"), "6000 mm³");
}

TEST_F(MeshReport, OfAnOpenBoxSaysWhatIsMissing) {
    // Truth: closed form (a cuboid without its top: one hole with four edges)
    const std::string open = report(cuboid(10));
    EXPECT_EQ(valueOf(open, "triangles"), "10");
    EXPECT_EQ(valueOf(open, "watertight"), "no");
    EXPECT_EQ(valueOf(open, "holes"), "1");
    EXPECT_EQ(valueOf(open, "boundary edges"), "4");
    EXPECT_EQ(valueOf(open, "area"), "20 mm²");
    EXPECT_EQ(valueOf(open, "volume"), "6 mm³ (as repaired)");
    EXPECT_EQ(valueOf(open, "inside"), "a closed solid, as repaired");
    EXPECT_NE(open.find("  found, and what was done:\n    - The surface is open: 4 edges"), std::string::npos) << open;
    EXPECT_NE(open.find("    - 1 hole was closed.\n    - 4 triangles were added for that.\n"), std::string::npos)
        << open;
}

TEST_F(MeshReport, SaysThatTwoSolidsOverlap) {
    // Truth: closed form (two tetrahedra of 1000/6 mm³, one moved so that edges pass through faces)
    writeText(folder_ / "two.off",
              "OFF\n8 8 0\n0 0 0\n10 0 0\n0 10 0\n0 0 10\n1 2 3\n11 2 3\n1 12 3\n1 2 13\n"
              "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n3 4 6 5\n3 4 5 7\n3 4 7 6\n3 5 6 7\n");
    const Ended ended = runProgram(folder_.path(), {"mesh", "two.off"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_EQ(valueOf(ended.out, "volume"), "333.333 mm³ (overlaps counted twice)");
    EXPECT_EQ(valueOf(ended.out, "shells"), "2");
    EXPECT_NE(valueOf(ended.out, "crossing triangles"), "0");
    EXPECT_NE(ended.out.find("triangles pass through each other; left"), std::string::npos) << ended.out;
}

TEST_F(MeshReport, GivesTheDimensionsOfAShape) {
    // Truth: closed form: 20 g6 is 19.980 to 19.993 mm, in the middle 19.9865 mm.
    writeText(folder_ / "peg.toml",
              "[[part]]\nname = \"p\"\n"
              "shape = { kind = \"peg\", fit = \"H7/g6\", nominal_diameter = 20, length = 50, chamfer = 0.5 }\n");
    const Ended ended = runProgram(folder_.path(), {"mesh", "peg.toml"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_EQ(valueOf(ended.out, "format"), "peg");
    EXPECT_EQ(valueOf(ended.out, "diameter"), "19.9865 mm");
    EXPECT_EQ(valueOf(ended.out, "length"), "50 mm");
    EXPECT_EQ(valueOf(ended.out, "size"), "19.9865 x 19.9865 x 50 mm");
    EXPECT_EQ(valueOf(ended.out, "watertight"), "yes");
}

}  // namespace
}  // namespace passung::test
